#pragma once
// Probabilities of what is missing: sets of statements, found by beam search, with their evidence summed over each facet.

#include <limits>
#include <optional>

#include "diagnosis/statement_evidence.hpp"

namespace driftwright::diagnosis {

/// The course over time that a record requires at a place, whatever its cause: a random walk of a few steps, alone in the
/// machine.
struct StatedCourse {
  std::string record;
  std::vector<double> edge_s;  ///< begin of each step, and end of the last one
  std::vector<double> value;   ///< one less, in the statement's unit
};

/// A statement with its best size and its probabilities.
struct Stated {
  Statement says;
  double size = 0.0;             ///< in says.unit; for an unknown course its root mean square
  double low = 0.0, high = 0.0;  ///< 95 %, by linear theory; both equal to the size for an unknown course
  double log_evidence = 0.0;     ///< of the best set that contains it, over nothing [nats]
  double probability = 0.0;      ///< that this quantity is wrong at this place, with any course
  double p_quantity = 0.0;       ///< that this quantity is wrong, at any place
  double p_place = 0.0;          ///< of this place, if the quantity is right
  double p_follows = 0.0;        ///< that it has this course, if quantity and place are right
  struct Windows {
    Statement says;
    double size = 0.0;
  };
  std::optional<Windows> windows =
      {};  ///< the best windows of the same quantity and place, even if another course is likelier
  std::vector<StatedCourse> course = {};  ///< for each record; empty if the grammar has no course for the quantity
};

struct Posterior {
  double nothing = std::numeric_limits<double>::quiet_NaN();  ///< probability that nothing is wrong; NaN: not computed
  double power = 1.0;                                         ///< exponent of the evidence between statements
  std::vector<Stated>
      stated;  ///< by falling probability, each quantity and place once; those of at least 0.01, and the first few
};

/// Exponent of the evidence, if the best explanation explains `explained` [nats] and its law is wrong by a share
/// law_error of its effect.
[[nodiscard]] double temper(double explained, double law_error);
/// Mean squares that wrong laws leave in addition to noise, from an exponential prior with mean 2 law_error² E and from
/// the rest (n values, with the standard deviation sqrt(2 n) of noise).
/// @param explained  E [nats]. @param left  squares of whitened readings minus the best explanation. @param n  number of
/// readings
[[nodiscard]] double law_squares(double explained, double law_error, double left, double n);

/// @param residual, nuisance  as in StatementEvidence
[[nodiscard]] Posterior posterior(const StatementSpace& space, const Eigen::VectorXd& residual,
                                  const Eigen::MatrixXd& nuisance, const StatementOptions& options = {});

/// Statements in addition to a fit of some claims: their space about the fitted machine, and the readings that free
/// numbers may absorb.
class StatedBeside {
 public:
  /// @param fitter  settled at the fit, with its noise; must outlive this
  /// @throws SolveError  if the fit's state has no solution
  StatedBeside(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit);
  [[nodiscard]] Posterior posterior(const StatementOptions& options) const;
  /// Squares of the readings that a fit leaves, as for StatementOptions::left.
  [[nodiscard]] double left(const Fit& fit) const;

 private:
  StatementSpace space_;
  const Comparison& comparison_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd nuisance_;
};

/// Statements of several posteriors, each quantity and place once with its largest probability; the probability of
/// nothing is that of the first, but no more than the likeliest statement leaves.
[[nodiscard]] Posterior joined(const std::vector<Posterior>& posteriors);

}  // namespace driftwright::diagnosis
