#pragma once
// Predicts the drift of a job before it runs, by the machine's model: what `predict` shows and `schedule` corrects.

#include <memory>
#include <optional>

#include "base/record_band.hpp"
#include "compensation/judging/iso230_3.hpp"
#include "machine/job_series.hpp"
#include "machine/simulated_run.hpp"

namespace driftwright::studies {

/// The conditions before the job, as on the command line.
struct PredictionOptions {
  std::string start =
      {};  ///< run of the machine before, a record CSV or a cyclogram of the scenario; empty: the scenario's start
  std::string after_pause = {};  ///< pause between that run and the job, such as "30 min"; empty: none
  int parts = 1;                 ///< number of times that the job is done
  std::string between = {};      ///< pause between two of them, such as "2 min"; empty: none
  std::string model = {};        ///< "reduced", "full" or empty: predicting_model()
  bool with_band = false;        ///< also computes Prediction::band
};

/// The change of a displacement or tilt over the run before, from its first reading to its last.
struct StartCheck {
  std::string channel, unit;
  double recorded = 0.0;  ///< from the record
  double modelled = 0.0;  ///< from the model between the same times
};

struct Prediction {
  Record record;                           ///< of the job and its repetitions, from 0 at the start of the first part
  std::vector<scenarios::PartRows> parts;  ///< rows of each part in it
  std::string predicted_by;                ///< the model, in words, for terminal and report
  std::string started_from;                ///< the run before, in words; empty: the scenario's start
  std::vector<StartCheck> start_checks;    ///< for a record with displacements or tilts of the machine
  std::optional<RecordBand> band = {};     ///< of the record (known_band.hpp), if asked for
};

/// False if a temperature is prescribed over time, which no reduced model can follow.
[[nodiscard]] bool can_be_reduced(const scenarios::MachineModel& machine);

/// The default model of predictions: the reduced model, even if the scenario says full, since a prediction must be ready
/// before its job. It is the full model if the scenario says so and has lumped nodes only, or has a temperature that is
/// prescribed over time, which no reduced model can follow.
[[nodiscard]] scenarios::ModelKind predicting_model(const scenarios::Scenario& scenario);

/// The models of one scenario's machine for predictions, each opened once. Calls may come from several threads.
class PredictingModels {
 public:
  PredictingModels();
  ~PredictingModels();
  /// The model for a cyclogram in the ambients of `scenario`, according to its `solver.model`.
  [[nodiscard]] std::shared_ptr<const scenarios::Model> of(const scenarios::Scenario& scenario, const Cyclogram& cyclogram,
                                                           const Listener& listener);

 private:
  struct Known;
  std::unique_ptr<Known> known_;
};

/// A machine before a job.
struct Outlook {
  scenarios::MachineModel machine;  ///< the scenario's, in the ambient of the series
  std::shared_ptr<const scenarios::Model> model;
  Eigen::VectorXd start;        ///< state of the model at the start of the series
  scenarios::JobSeries series;  ///< the run before, the pause, the job
  Record before;                ///< the record that the series starts from; no rows: none
  std::string started_from;     ///< the run before, in words; empty: the scenario's start
};
/// @param job, verb  as predict_drift() @throws InputError  the same
[[nodiscard]] Outlook outlook_of(const scenarios::Scenario& scenario, const Cyclogram& job, const PredictionOptions& options,
                                 const Listener& listener, const std::string& verb, PredictingModels& models);

/// Simulates the run before and the job.
/// @param job   a cyclogram that has passed check_cyclogram()
/// @param verb  for messages
/// @throws InputError  without a machine; for a record that is no run of it, durations that cannot be read, and a series
/// that the machine cannot run or that has too many rows
[[nodiscard]] Prediction predict_drift(const scenarios::Scenario& scenario, const Cyclogram& job,
                                       const PredictionOptions& options, const Listener& listener, const std::string& verb,
                                       PredictingModels& models);
/// The same with a model of its own. @param verb  for messages
[[nodiscard]] Prediction predict_drift(const scenarios::Scenario& scenario, const Cyclogram& job,
                                       const PredictionOptions& options, const Listener& listener, const std::string& verb);

/// The figures of ISO 230-3 of a prediction; empty after a previous run, because the machine is then not in balance with
/// its ambient.
[[nodiscard]] compensation::Iso230Figures iso_figures(const Prediction& prediction);

/// The drive of a record as a cyclogram, named after its source and checked by check_cyclogram().
/// @throws InputError  for a record without a drive, and for a cyclogram that the machine cannot run
[[nodiscard]] Cyclogram cyclogram_of(const scenarios::Scenario& scenario, const Record& record);

/// The scenario's cyclogram of that name, or that of a record CSV, named after the file without folder and extension;
/// checked by check_cyclogram().
/// @param name_or_file  a name that ends with .csv is a file
/// @throws InputError  for a name that does not exist, a CSV without a drive, or a cyclogram that the machine cannot run
[[nodiscard]] Cyclogram named_cyclogram(const scenarios::Scenario& scenario, const std::string& name_or_file);

}  // namespace driftwright::studies
