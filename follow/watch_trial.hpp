#pragma once
// Simulated machines that differ from their model as real ones do, at work for days, with faults that begin at some time.
// The thresholds of a watch are simulated on them, and a watch is tested on them.

#include "base/listener.hpp"
#include "follow/watch.hpp"

namespace driftwright::follow {

struct TrialSettings {
  double top_rpm = 0.0;
  double scatter =
      0.1;  ///< standard deviation of the logarithm of each source, film, joint and link, all conduction and all rates
  double period_s = 60.0;  ///< of the rows
};

/// A fault that begins in a trial.
struct TrialFault {
  enum class Kind { kNone, kFilm, kFanStops, kPreload, kSensorFallsOff, kDoorOpens };
  Kind kind = Kind::kNone;
  double onset_s = 0.0;
  std::size_t index = 0;  ///< of the exchange, source or sensor
  double factor = 1.0;    ///< factor on it
};
[[nodiscard]] const char* words(TrialFault::Kind kind);

/// A machine whose numbers differ from the model's, and the observer that `validate` would have fitted to three tests of
/// it.
class TrialMachine {
 public:
  /// @param model    gives the model, start and settings; what it has learned is not used
  /// @param sensors  sensors to watch
  TrialMachine(const compensation::Observer& model, std::vector<std::string> sensors, const TrialSettings& settings,
               std::uint64_t seed);

  /// Days of a shop: sections of 15 min to 2 h at speeds from rest to the top speed between 6 and 22 h, rest at night and
  /// at week-ends, and an ambient with a daily wave and a random part. Thermometers read with the model's noise.
  /// @param with_drift  the readings include the displacement that the observer predicts, with its noise
  [[nodiscard]] MachineRun work(double duration_s, const TrialFault& fault, std::uint64_t seed,
                                bool with_drift = false) const;

  /// Time constant [s] of the part with the fault: of the heat that the fault adds, b'K⁻²b / b'K⁻¹b with M = 1, at half
  /// the top speed.
  [[nodiscard]] double time_constant_s(const TrialFault& fault) const;
  /// Evidence [nats] of a fault in the readings up to a time, for an observer that knows all else: half the sum of
  /// squares of the fault's effect on them, in blocks of half an hour, over their noise and the error of the model.
  [[nodiscard]] double nats(double duration_s, const TrialFault& fault, std::uint64_t seed) const;

  [[nodiscard]] const compensation::Observer& observer() const { return observer_; }
  [[nodiscard]] const std::vector<std::string>& sensors() const { return sensors_; }
  [[nodiscard]] const solver::ReducedSystem& system() const { return machine_; }

 private:
  [[nodiscard]] Eigen::MatrixXd readings_K(const Cyclogram& cyclogram, const TimeSeries& ambient,
                                           const std::vector<double>& time_s, const TrialFault& fault) const;
  [[nodiscard]] MachineRun read(const Cyclogram& cyclogram, const TimeSeries& ambient, const TrialFault& fault,
                                std::uint64_t seed, bool with_drift) const;

  compensation::Observer::State model_;
  std::vector<std::string> sensors_;
  TrialSettings settings_;
  solver::ReducedSystem machine_;
  std::vector<Eigen::Index> output_;  // of each sensor
  compensation::Observer observer_;
};

/// Thermometers that a watch can read: outputs in K of the observer's model that are not the ambient alone, and that the
/// stream has.
[[nodiscard]] std::vector<std::string> watchable_sensors(const compensation::Observer& observer,
                                                         const std::vector<Channel>& channels);

inline constexpr int kTrialMachines = 100;  ///< enough to include some with extreme numbers
inline constexpr double kTrialDays = 7.0;   ///< for each machine; includes a week-end

/// Simulates the thresholds: each scale alone raises an alarm on one of 300 days, by the tail of daily maxima over all
/// machines.
/// @param n_machines  for the thresholds; 30 more give the covariance
/// @throws std::logic_error  for less than one machine, or less than a day
[[nodiscard]] WatchLimits simulated_limits(const compensation::Observer& model, const std::vector<std::string>& sensors,
                                           const TrialSettings& settings, int n_machines, double days_each,
                                           const Listener& listener);

/// The limits that an observer is deployed with: those of simulated machines that work up to the top speed of its training
/// runs, but none below twice what the training runs themselves reach, as the observer's own bound of trust (`most_apart`).
/// Rows of the simulation are means over 5 min: noise is less by the root of the rows in one.
/// @return none for an observer without thermometers, and for training runs in which the spindle never turns
[[nodiscard]] std::optional<WatchLimits> deployed_limits(const compensation::Observer& observer,
                                                         std::span<const MachineRun> training, const Listener& listener);

}  // namespace driftwright::follow
