#pragma once
// Machines that differ from their model as real ones do, months of their work, and faults that begin in them at some hour: what thresholds of a watch
// are simulated on, and what a watch is tried by.

#include "base/listener.hpp"
#include "follow/watch.hpp"

namespace driftwright::follow {

struct TrialSettings {
  double top_rpm = 0.0;
  double scatter =
      0.1;  ///< of each heat source, film, joint and link, of all conduction and of all rates: standard deviation of the logarithm
  double period_s = 60.0;
};

/// What goes wrong in a trial.
struct TrialFault {
  enum class Kind { kNone, kFilm, kFanStops, kPreload, kSensorFallsOff, kDoorOpens };
  Kind kind = Kind::kNone;
  double onset_s = 0.0;
  std::size_t index = 0;  ///< of the exchange, source or sensor
  double factor = 1.0;    ///< on it
};
[[nodiscard]] const char* words(TrialFault::Kind kind);

/// A machine whose numbers are off from the model's, and the observer that `validate` would have fitted to three tests of it.
class TrialMachine {
 public:
  /// @param model    whose model, start and settings are taken; what it has learned is not
  /// @param sensors  that are watched
  TrialMachine(const compensation::Observer& model, std::vector<std::string> sensors, const TrialSettings& settings,
               std::uint64_t seed);

  /// Days of a shop: sections of 15 min to 2 h at speeds from rest to the top between 6 and 22 h, rests at night and at week-ends; an ambient that
  /// follows the day and wanders. Thermometers read with the model's noise.
  [[nodiscard]] compensation::ObservedRun work(double duration_s, const TrialFault& fault, std::uint64_t seed) const;

  /// Time constant [s] of what a fault is in: of the heat that it brings, b'K⁻²b / b'K⁻¹b with M = 1, at half the top speed.
  [[nodiscard]] double time_constant_s(const TrialFault& fault) const;
  /// What the readings until a time tell of a fault, in nats, by an observer that knows all else: half the sum of squares of what it makes of them, in
  /// blocks of half an hour against their noise and the error of the model.
  [[nodiscard]] double nats(double duration_s, const TrialFault& fault, std::uint64_t seed) const;

  [[nodiscard]] const compensation::Observer& observer() const { return observer_; }
  [[nodiscard]] const std::vector<std::string>& sensors() const { return sensors_; }
  [[nodiscard]] const solver::ReducedSystem& system() const { return machine_; }

 private:
  [[nodiscard]] Eigen::MatrixXd readings_K(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                           const std::vector<double>& time_s, const TrialFault& fault) const;
  [[nodiscard]] compensation::ObservedRun read(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                               const TrialFault& fault, std::uint64_t seed, bool with_drift) const;

  compensation::Observer::State model_;
  std::vector<std::string> sensors_;
  TrialSettings settings_;
  solver::ReducedSystem machine_;
  std::vector<Eigen::Index> output_;  // of each sensor
  compensation::Observer observer_;
};

/// Thermometers that a watch can read: outputs of the observer's model in K that are not the ambient alone, as far as a stream has them.
[[nodiscard]] std::vector<std::string> watchable_sensors(const compensation::Observer& observer,
                                                         const std::vector<Channel>& channels);

inline constexpr int kTrialMachines = 100;  ///< so many that the few whose numbers are furthest off are among them
inline constexpr double kTrialDays = 7.0;   ///< of each, a week-end among them

/// Thresholds by simulation: so high that each scale alone raises an alarm in one of 300 days, by the tail of daily maxima over all machines.
/// @param n_machines  for the thresholds; 30 more tell what is usual
/// @throws std::logic_error  for none of them, or less than a day
[[nodiscard]] WatchLimits simulated_limits(const compensation::Observer& model, const std::vector<std::string>& sensors,
                                           const TrialSettings& settings, int n_machines, double days_each,
                                           const Listener& listener);

}  // namespace driftwright::follow
