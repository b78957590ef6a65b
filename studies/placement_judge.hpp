#pragma once
// What a real observer and a real regression leave of the drift when they read thermometers at chosen places, on machines and cyclograms that were not
// chosen on.

#include "compensation/predictors/observer.hpp"
#include "studies/placement_runs.hpp"

namespace driftwright::studies {

/// Root mean squares over all rows, drifts, runs and machines [um].
struct Residual {
  double observer_um = 0.0, regression_um = 0.0;
};

/// Machines that differ from the model by random factors are the truth. The observer has the model as it is and no test; the regression was fitted to
/// each machine's runs of the cyclograms that places were chosen on. Readings have noise; the drift that is judged has none.
class PlacementJudge {
 public:
  /// @param model       outlives this
  /// @param candidates  that sets to be judged are made of
  /// @param seeds       of each scatter, one machine each
  PlacementJudge(const PlacementModel& model, const std::vector<PlacementRun>& fitted, const std::vector<PlacementRun>& judged,
                 std::vector<int> candidates, const std::vector<double>& scatter, const std::vector<int>& seeds, double noise_K);

  /// Of each set. Without a thermometer the observer is the model alone, and the regression leaves the drift as it is.
  [[nodiscard]] std::vector<Residual> of(const std::vector<std::vector<int>>& sets) const;
  /// Of a set, when the regression knows but one run of the machine, and the observer has learned from the same run with its drift measured.
  [[nodiscard]] Residual behind_test(const std::vector<int>& set, const PlacementRun& test) const;
  [[nodiscard]] double drift_um() const;  ///< root mean square of what there is to correct
  [[nodiscard]] double noise_K() const { return noise_K_; }

 private:
  struct Machine {
    solver::ReducedSystem system;
    std::vector<Record> fitted;  ///< since the start
    std::vector<compensation::ObservedRun> judged;
  };
  struct Sum {
    double observer = 0.0, regression = 0.0, n = 0.0;
  };
  [[nodiscard]] compensation::ObservedRun read(const solver::ReducedSystem& system, const PlacementRun& run, std::uint64_t seed) const;
  [[nodiscard]] std::vector<std::string> names(const std::vector<int>& set) const;
  void add(Sum& sum, const Machine& machine, const std::vector<Record>& fitted, const std::vector<int>& set,
           const std::vector<compensation::ObservedRun>& learned) const;

  const PlacementModel& model_;
  std::vector<int> candidates_;
  double noise_K_ = 0.0;
  std::vector<compensation::Observer> observers_;  ///< of each drift, without sensors
  std::vector<Machine> machines_;
};

}  // namespace driftwright::studies
