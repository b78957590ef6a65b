#pragma once
// A machine's linear model with the temperature of every point where a thermometer could be, and its runs.

#include "base/machine_run.hpp"
#include "compensation/predictors/observer_left.hpp"
#include "compensation/sensors/regression_left.hpp"
#include "machine/model.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "studies/placement_spots.hpp"

namespace driftwright::studies {

struct PlacementModel {
  scenarios::Model opened;       ///< reduced
  solver::ReducedSystem system;  ///< linear
  Eigen::VectorXd start;
  double start_ambient_K = 0.0;
  std::vector<Spot> spots;  ///< candidates, with mounted sensors last; after them the scenario's other sensors
  int n_candidates = 0, n_mounted = 0;
  Eigen::MatrixXd rows;  ///< temperature at each spot: rows * z + ambient * T_ambient [K over the reference], n_spots x size
  Eigen::VectorXd ambient;
  std::vector<Eigen::Index> drifts;   ///< outputs of the system
  std::vector<std::string> channels;  ///< their names
  std::vector<std::string> regions, left_out;
  bool is_linearised = false;

  [[nodiscard]] std::vector<int> mounted() const;
  [[nodiscard]] int n_free() const { return n_candidates - n_mounted; }
};

/// Opens the scenario's machine as a reduced model with temperatures everywhere. Laws that depend on temperatures are
/// frozen at those after 8 h of the mean drive.
/// @param mounted   sensors of the scenario that are mounted already
/// @param channels  displacements or tilts to predict, the drift
/// @throws InputError  for unknown names, and for thermostats, which no linear model can follow
[[nodiscard]] PlacementModel placement_model(const scenarios::Scenario& scenario,
                                             const std::vector<const Cyclogram*>& cyclograms, const SpotRules& rules,
                                             const std::vector<std::string>& mounted,
                                             const std::vector<std::string>& channels, const Listener& listener);

/// Reduced states of a system with the same unknowns over a run of felt_run(), at the times of its readings, size x n_rows.
/// The start is the scenario's, plus the difference of the run's ambient.
[[nodiscard]] Eigen::MatrixXd states_of(const PlacementModel& model, const solver::ReducedSystem& system,
                                        const MachineRun& run);
/// Drifts since the start, n_rows x n_drifts [um].
[[nodiscard]] Eigen::MatrixXd drift_um(const PlacementModel& model, const MachineRun& run, const Eigen::MatrixXd& states);

/// The effect of each heat source, film, joint and link, all conduction and all rates of change on the states of runs, by
/// differences over 1 % of each: for each run and factor a matrix size x n_rows.
[[nodiscard]] std::vector<std::vector<Eigen::MatrixXd>> factor_states(const PlacementModel& model,
                                                                      const std::vector<MachineRun>& runs);
/// The effect of these factors on candidates and drifts.
/// @param by_factor  factor_states() of the runs
/// @param rows       of the candidates, as PlacementModel::rows
[[nodiscard]] std::vector<compensation::RunSensitivity> sensitivities(
    const PlacementModel& model, const std::vector<MachineRun>& runs,
    const std::vector<std::vector<Eigen::MatrixXd>>& by_factor, double noise_K, const Eigen::MatrixXd& rows);
/// The names of these factors.
[[nodiscard]] std::vector<std::string> factor_names(const PlacementModel& model);

/// States of runs of machines that differ from the model by random factors (compensation::scattered()), for each machine
/// and run.
/// @param seeds  one machine for each scatter and seed
[[nodiscard]] std::vector<std::vector<Eigen::MatrixXd>> scattered_states(const PlacementModel& model,
                                                                         const std::vector<MachineRun>& runs,
                                                                         const std::vector<double>& scatter,
                                                                         const std::vector<int>& seeds);
/// The temperatures of candidates and the drifts of those machines; the runs of one cyclogram are one group.
/// @param n_ambients  number of runs of each cyclogram, which follow each other (runs_in_all_ambients())
/// @param states      scattered_states() of the runs
[[nodiscard]] std::vector<compensation::RunOfCandidates> scattered_runs(
    const PlacementModel& model, const std::vector<MachineRun>& runs, std::size_t n_ambients,
    const std::vector<std::vector<Eigen::MatrixXd>>& states, const Eigen::MatrixXd& rows, const Eigen::VectorXd& ambient);

}  // namespace driftwright::studies
