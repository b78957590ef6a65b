#pragma once
// What is missing, as probabilities: sets of statements found by beam search, and their evidence summed facet by facet.

#include <limits>

#include "diagnosis/statement_evidence.hpp"

namespace driftwright::diagnosis {

/// A statement at its best size, and how sure it is.
struct Stated {
  Statement says;
  double size = 0.0;             ///< in says.unit; of an unknown course its root mean square
  double low = 0.0, high = 0.0;  ///< 95 %, by linear theory; both the size where it is of an unknown course
  double log_evidence = 0.0;     ///< of the best set that it is in, over nothing [nats]
  double probability = 0.0;      ///< that this quantity is wrong at this place, whatever it follows
  double p_quantity = 0.0;       ///< that this quantity is, wherever
  double p_place = 0.0;          ///< of this place, if the quantity is
  double p_follows = 0.0;        ///< that it follows this, if quantity and place are right
};

struct Posterior {
  double nothing = std::numeric_limits<double>::quiet_NaN();  ///< probability that nothing is wrong; NaN: not weighed
  std::vector<Stated> stated;  ///< by falling probability, each quantity and place once; those of a hundredth and more
};

/// @param residual, nuisance  as StatementEvidence has them
[[nodiscard]] Posterior posterior(const StatementSpace& space, const Eigen::VectorXd& residual,
                                  const Eigen::MatrixXd& nuisance, const StatementOptions& options = {});

/// What measured records say against a scenario, statement by statement, nothing named and nothing written: a few seconds.
/// @param fresh       with the scenario's numbers and unknown columns, at the scenario
/// @param as_written  its prediction
/// @param least       noise that no reading is better than
/// @throws SolveError  where the scenario has no solution
[[nodiscard]] Posterior statements_of(const Fitter& fresh, const Prediction& as_written, const NoiseFloor& least,
                                      const StatementOptions& options = {});

}  // namespace driftwright::diagnosis
