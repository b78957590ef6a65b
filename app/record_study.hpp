#pragma once
// Ranking and regression on records, measured or simulated, judged on records they were not fitted on.

#include "app/verbs.hpp"
#include "compensation/grey_relational.hpp"
#include "compensation/regression.hpp"
#include "compensation/score.hpp"
#include "scenarios/scenario.hpp"

namespace driftwright::app {

/// One strategy on one test record.
struct JudgedPrediction {
  std::string strategy;
  std::string test;
  std::vector<double> predicted;  ///< per row of the test record, NaN where there is none
  compensation::Score error;      ///< of measured - predicted, on the rows that every strategy predicts
};

struct RecordStudy {
  std::vector<Record> train, test;
  std::string target;
  compensation::Ranking ranking;
  compensation::Regression regression;
  std::vector<JudgedPrediction> judged;  ///< test by test: regression, then the two baselines
};

/// Reads the records and checks that they have the study's channels.
/// @throws InputError  for a missing file or channel, and when a file is both trained on and judged by
[[nodiscard]] RecordStudy read_records(const scenarios::Study& study, const RecordOptions& options);

/// Ranks the candidates on the training records: `study.candidates`, or every temperature channel but the target and `ambient`.
void rank(RecordStudy& study, const scenarios::Study& settings);

/// Fits on the training records, judges on each test record.
void fit_and_judge(RecordStudy& study, const scenarios::Study& settings);

}  // namespace driftwright::app
