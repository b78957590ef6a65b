#pragma once
// What the kinds of candidates share: the machine and runs they look at, and knobs of a usual make.

#include "diagnosis/candidates.hpp"

namespace driftwright::diagnosis {

inline constexpr double kFactor = 0.7;  ///< 1 sigma of the logarithm of a factor that is an effect
inline constexpr double kMinute_s = 60.0, kHour_s = 3600.0;

/// What all candidates look at.
struct Scene {
  const Twin& twin;
  const std::vector<MeasuredRun>& runs;
  double top_rpm = 1.0, typical_rpm = 1.0;  ///< laws of speed are stated at the typical one
  double heat_W = 1.0;                      ///< of all sources at the top speed
  bool moves_axes = false;
  std::vector<std::string> sensors = {}, displacements = {};  ///< that were measured
  effects::HeatBalance own = {};                              ///< of the scenario
};

[[nodiscard]] Scene scene_of(const Twin& twin, const std::vector<MeasuredRun>& runs);

/// A knob around 0 of a value in its unit. @param prior_sd, step  of the value
[[nodiscard]] Knob knob(std::string name, std::string unit, double prior_sd, double step,
                        std::function<void(TwinState&, double)> set);
/// One around the factor 1.
[[nodiscard]] Knob factor(std::function<void(TwinState&, double)> set);
/// The same knob for what the machine itself does not notice.
[[nodiscard]] Knob on_readings(Knob k);
/// When something began, in s within a run [s]; and where to look first, n - 1 places.
[[nodiscard]] Knob time_knob(std::string name, double run_length_s, std::function<void(TwinState&, double)> set);
[[nodiscard]] std::vector<std::vector<double>> time_grid(double run_length_s, int n);
[[nodiscard]] double length_s(const MeasuredRun& run);
/// Regions and lumped nodes, as the scenario names them.
[[nodiscard]] std::vector<effects::Body> bodies(const Scene& s);

// Each adds its kinds of candidates to the list.
void add_heat(const Scene& s, std::vector<Candidate>& list);
void add_friction(const Scene& s, std::vector<Candidate>& list);
void add_exchanges(const Scene& s, std::vector<Candidate>& list);
void add_materials(const Scene& s, std::vector<Candidate>& list);
void add_hall(const Scene& s, std::vector<Candidate>& list);
void add_drive(const Scene& s, std::vector<Candidate>& list);
void add_displacements(const Scene& s, std::vector<Candidate>& list);
void add_sensors(const Scene& s, std::vector<Candidate>& list);

}  // namespace driftwright::diagnosis
