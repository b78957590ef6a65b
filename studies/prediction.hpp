#pragma once
// The drift of a job ahead of its run, by the machine's model: what `predict` shows and `schedule` corrects.

#include <memory>
#include <optional>

#include "compensation/judging/iso230_3.hpp"
#include "machine/job_series.hpp"
#include "machine/simulated_run.hpp"

namespace driftwright::studies {

/// What a prediction begins with, as the command line says it.
struct PredictionOptions {
  std::string start = {};  ///< what the machine did before, a record CSV or a cyclogram of the scenario; empty: its start
  std::string after_pause = {};  ///< at rest between that record and the job, such as "30 min"; empty: none
  int parts = 1;                 ///< how many times the job is done
  std::string between = {};      ///< at rest between two of them, such as "2 min"; empty: none
  std::string model = {};        ///< "reduced", "full" or empty: predicting_model()
};

/// How a displacement or tilt changed over the run before, from its first reading to its last.
struct StartCheck {
  std::string channel, unit;
  double recorded = 0.0;  ///< by the record
  double modelled = 0.0;  ///< by the model between the same times
};

struct Prediction {
  Record record;                           ///< of the job and its repetitions, from 0 at the start of the first part
  std::vector<scenarios::PartRows> parts;  ///< rows of each part in it
  std::string predicted_by;                ///< for terminal and report: the model, in words
  std::string started_from;                ///< the same: what was before; empty: the scenario's start
  std::vector<StartCheck> start_checks;    ///< of a record that has displacements or tilts of the machine's
};

/// The model that predictions run when nobody names one: the reduced model, also where the scenario asks for the full one, since a
/// prediction is there before its job; the full one where the scenario asks for it and it is of lumped nodes alone, or holds a
/// temperature that is prescribed over time, which no reduced model follows.
[[nodiscard]] scenarios::ModelKind predicting_model(const scenarios::Scenario& scenario);

/// Models of one scenario's machine that predictions run on, each opened once. Calls may come from several threads.
class PredictingModels {
 public:
  PredictingModels();
  ~PredictingModels();
  /// The model for a cyclogram in the ambients of `scenario`, by its `solver.model`.
  [[nodiscard]] std::shared_ptr<const scenarios::Model> of(const scenarios::Scenario& scenario, const Cyclogram& cyclogram,
                                                           const Listener& listener);

 private:
  struct Known;
  std::unique_ptr<Known> known_;
};

/// A machine that is about to do a job.
struct Outlook {
  scenarios::MachineModel machine;  ///< the scenario's, in the ambient of the series
  std::shared_ptr<const scenarios::Model> model;
  Eigen::VectorXd start;         ///< state of the model at the start of the series
  scenarios::JobSeries series;   ///< what was before, the pause, the job
  std::optional<Record> before;  ///< the record that the series starts from
  std::string started_from;      ///< in words; empty: the scenario's start
};
/// @param job, verb  as predict_drift() @throws InputError  the same
[[nodiscard]] Outlook outlook_of(const scenarios::Scenario& scenario, const Cyclogram& job, const PredictionOptions& options,
                                 const Listener& listener, const std::string& verb, PredictingModels& models);

/// Simulates the job, after what was before it.
/// @param job   a cyclogram that has passed check_cyclogram()
/// @param verb  for messages
/// @throws InputError  without a machine, for a record that is no run of it, for durations that cannot be read, for a series that the
///                     machine cannot run or that has too many rows
[[nodiscard]] Prediction predict_drift(const scenarios::Scenario& scenario, const Cyclogram& job,
                                       const PredictionOptions& options, const Listener& listener, const std::string& verb,
                                       PredictingModels& models);
/// The same with a model of its own. @param verb  for messages
[[nodiscard]] Prediction predict_drift(const scenarios::Scenario& scenario, const Cyclogram& job,
                                       const PredictionOptions& options, const Listener& listener, const std::string& verb);

/// The figures of ISO 230-3 of a prediction; none behind another run: the machine is not in balance with its ambient then.
[[nodiscard]] compensation::Iso230Figures iso_figures(const Prediction& prediction);

/// What a record says drove the machine, as a cyclogram named as its source is; looked at by check_cyclogram().
/// @throws InputError  for a record that tells no cyclogram, for a cyclogram that the machine cannot run
[[nodiscard]] Cyclogram cyclogram_of(const scenarios::Scenario& scenario, const Record& record);

/// The cyclogram of that name in the scenario, or the one that a record CSV tells, named as the file without its folder and ending; looked
/// at by check_cyclogram().
/// @param name_or_file  a file ends with .csv
/// @throws InputError  for a name that does not exist, for a CSV that tells no cyclogram, for a cyclogram that the machine cannot run
[[nodiscard]] Cyclogram named_cyclogram(const scenarios::Scenario& scenario, const std::string& name_or_file);

}  // namespace driftwright::studies
