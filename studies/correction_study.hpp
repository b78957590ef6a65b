#pragma once
// One run, corrected by one predictor through one actuator: what `compensate` shows.

#include <optional>

#include "base/listener.hpp"
#include "compensation/judging/iso230_3.hpp"
#include "compensation/judging/probed_run.hpp"
#include "compensation/predictors/deployed_predictor.hpp"
#include "compensation/predictors/score.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::studies {

struct CorrectionRequest {
  std::string through = {};               ///< none, injector or schedule
  const Cyclogram* cyclogram = nullptr;   ///< to simulate; null: a record is given
  std::string measured = {}, after = {};  ///< a record CSV or a part of one, and the record that it continues; empty: none
  std::optional<double> probed_every_s = {};  ///< through none: the axis is probed, too; the predictor must have a process
};

/// The drift that is left after the correction, over the run's own rows.
struct CorrectionStudy {
  compensation::DeployedPredictor predictor = {};
  std::string run = {};  ///< name of the cyclogram or record
  std::vector<double> time_s = {}, drift_um = {}, predicted_um = {}, left_um = {};
  std::vector<bool> at_rest = {};  ///< rows at which the axis rests, which are judged, if it moves at all; empty: all
  compensation::Score before = {}, after = {};
  /// What is left with probings at equal intervals, with `left_um` per row; none: not asked for.
  std::optional<compensation::ProbedRun> probed = {};
  std::optional<double> margin_um = {};  ///< margin that the plan keeps, if there is one
  compensation::Iso230Figures iso = {};  ///< of the drift, and of the drift that is left
  std::vector<std::string> notes = {};   ///< how the run was read, one sentence each
};

/// Simulates or reads the run, predicts its drift and corrects it by the actuator.
/// @param predictor  none: the machine's thermal modes
/// @throws InputError  for a record that the predictor cannot follow, a drift for which no schedule is possible, and as
/// read_records() and open_model()
[[nodiscard]] CorrectionStudy correct_run(const scenarios::Scenario& scenario,
                                          std::optional<compensation::DeployedPredictor> predictor,
                                          const CorrectionRequest& request, const Listener& listener);

/// The values of the judged rows: while an axis moves, it lags behind its command, which is no thermal error.
[[nodiscard]] std::vector<double> judged_rows(const CorrectionStudy& study, const std::vector<double>& values);

}  // namespace driftwright::studies
