#pragma once
// Judges chosen places: the drift that an observer and a regression leave when they read thermometers there, on machines
// and cyclograms that were not used for the choice.

#include "compensation/predictors/observer.hpp"
#include "studies/placement_runs.hpp"

namespace driftwright::studies {

/// Root mean squares over all rows, drifts, runs and machines [um].
struct Residual {
  double observer_um = 0.0, regression_um = 0.0;
};

/// The true machines differ from the model by random factors. The observer has the unchanged model and no test; the
/// regression was fitted to each machine's runs of the cyclograms that places were chosen on. Readings have noise; the
/// judged drift has none.
class PlacementJudge {
 public:
  /// @param model       must outlive this
  /// @param candidates  the sets to be judged consist of these
  /// @param seeds       one machine for each scatter and seed
  PlacementJudge(const PlacementModel& model, const std::vector<MachineRun>& fitted, const std::vector<MachineRun>& judged,
                 std::vector<int> candidates, const std::vector<double>& scatter, const std::vector<int>& seeds,
                 double noise_K);

  /// The residuals of each set. Without a thermometer the observer is the model alone, and the regression leaves the
  /// drift unchanged.
  [[nodiscard]] std::vector<Residual> of(const std::vector<std::vector<int>>& sets) const;
  /// The residual of a set when the regression was fitted to one run of the machine only, and the observer has learned
  /// from the same run with its measured drift.
  [[nodiscard]] Residual behind_test(const std::vector<int>& set, const MachineRun& test) const;
  [[nodiscard]] double drift_um() const;  ///< root mean square of the uncorrected drift
  [[nodiscard]] double noise_K() const { return noise_K_; }

 private:
  struct Machine {
    solver::ReducedSystem system;
    std::vector<Record> fitted;  ///< counted from the start
    std::vector<MachineRun> judged;
  };
  struct Sum {
    double observer = 0.0, regression = 0.0, n = 0.0;
  };
  [[nodiscard]] MachineRun read(const solver::ReducedSystem& system, const MachineRun& run, std::uint64_t seed) const;
  [[nodiscard]] std::vector<std::string> names(const std::vector<int>& set) const;
  void add(Sum& sum, const Machine& machine, const std::vector<Record>& fitted, const std::vector<int>& set,
           const std::vector<MachineRun>& learned) const;

  const PlacementModel& model_;
  std::vector<int> candidates_;
  double noise_K_ = 0.0;
  std::vector<compensation::Observer> observers_;  ///< one for each drift, without sensors
  std::vector<Machine> machines_;
};

}  // namespace driftwright::studies
