#pragma once
// What a seed determines: class, machine, cyclograms, ambient, noise, and the hidden effects with their places.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "blind/hidden.hpp"

namespace driftwright::blind {

enum class CaseClass { kOne, kTwo, kNone, kOutside, kConfounded };
[[nodiscard]] const char* class_name(CaseClass of);
/// From this seed on, cases have one of the effects that were added to the catalogue later, in a lumped machine: probe
/// lag, a coolant that the scenario lacks, a door. Earlier seeds still make the same cases.
inline constexpr std::uint64_t kFirstOfLater = 400;
/// Of 40 consecutive seeds 12 have one effect, 10 two, 10 none, 5 one outside the catalogue, 3 are confounded, in mixed
/// order.
[[nodiscard]] CaseClass class_of(std::uint64_t seed);
/// Index into subject_names(); each class is combined with each machine.
[[nodiscard]] std::size_t subject_of(std::uint64_t seed);

/// The recorded ambient: a ramp and a slow sine, over the reference.
struct AmbientCurve {
  double start_K = 0.0, ramp_K_s = 0.0, sine_K = 0.0, period_s = 7200.0, phase = 0.0;
  [[nodiscard]] double at(double time_s) const;
};

/// A range of 1 to 3 K over a record, partly ramp, partly sine.
[[nodiscard]] AmbientCurve draw_ambient(double duration_s, Random& random);

struct RecordPlan {
  std::string name;  ///< "measured_1", "measured_2" or "holdout"
  Cyclogram drive;   ///< as recorded
  AmbientCurve ambient;
};

/// Noise of a channel, in its record's unit (degC or um).
struct Noise {
  double white = 0.05;
  double slow = 0.0, slow_s = 240.0;  ///< AR(1): standard deviation, time constant
  double quantum = 0.0;
  /// Standard deviation of a reading, rounding included.
  [[nodiscard]] double total() const;
  /// Standard deviation of white noise that hides a slow signal, in rows of interval_s, as well as this noise does.
  [[nodiscard]] double against_slow(double interval_s) const;
};

struct CasePlan {
  std::uint64_t seed = 0;
  CaseClass of = CaseClass::kNone;
  std::vector<RecordPlan> records;  ///< measured ones, then the holdout
  std::vector<Noise> noise;         ///< per output
  double ambient_noise_K = 0.02;
  std::vector<std::string> confusable;  ///< "<key> <where>": effects that the records cannot distinguish from the truth
  bool displacements_only = false;      ///< the records hold no temperature of the confounded region
  std::string confusion;                ///< reason for the confusion, in words
  [[nodiscard]] std::size_t n_measured() const { return records.size() - 1; }
};

/// Draws everything except the hidden effects. Records of a confounded case are drawn with its effects.
[[nodiscard]] CasePlan draw_plan(const Subject& subject, std::uint64_t seed);

/// An effect of the catalogue at any place, with the middle size of its range.
[[nodiscard]] Hidden draw_hidden(const Subject& subject, const CasePlan& plan, Random& random);
/// An effect whose law is in no catalogue.
[[nodiscard]] Hidden draw_foreign(const Subject& subject, Random& random);
/// Effects that the records cannot distinguish from others; fills the plan's confusable, and sets records that hide the
/// difference.
[[nodiscard]] std::vector<Hidden> draw_confounded(const Subject& subject, CasePlan& plan, Random& random);

}  // namespace driftwright::blind
