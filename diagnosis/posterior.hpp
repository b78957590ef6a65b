#pragma once
// What is missing, as probabilities: sets of statements found by beam search, and their evidence summed facet by facet.

#include <limits>
#include <optional>

#include "diagnosis/statement_evidence.hpp"

namespace driftwright::diagnosis {

/// What a record asks for at a place over time, whatever it follows: a random walk of a few steps, alone in the machine.
struct StatedCourse {
  std::string record;
  std::vector<double> edge_s;  ///< beginnings of the steps, and the end of the last one
  std::vector<double> value;   ///< one fewer, in the statement's unit
};

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
  struct Windows {
    Statement says;
    double size = 0.0;
  };
  std::optional<Windows> windows =
      {};  ///< the best ones of the same quantity and place; also where another course is likelier
  std::vector<StatedCourse> course = {};  ///< of each record; empty where the grammar has no course for the quantity
};

struct Posterior {
  double nothing = std::numeric_limits<double>::quiet_NaN();  ///< probability that nothing is wrong; NaN: not weighed
  double power = 1.0;                                         ///< that evidence counts with between statements
  std::vector<Stated>
      stated;  ///< by falling probability, each quantity and place once; those of a hundredth and more, and the first few
};

/// Power that evidence counts with where the best explanation explains so much [nats], its law being off by a share of what it does (StatementOptions::law_error).
[[nodiscard]] double temper(double explained, double law_error);
/// Squares that laws leave, beside those of noise: their mean, of an exponential prior with the mean 2 law_error² E and of what is left over [n, with the standard deviation
/// sqrt(2 n) of noise]. @param explained  E [nats]. @param left  squares of whitened readings less the best explanation. @param n  how many of these
[[nodiscard]] double law_squares(double explained, double law_error, double left, double n);

/// @param residual, nuisance  as StatementEvidence has them
[[nodiscard]] Posterior posterior(const StatementSpace& space, const Eigen::VectorXd& residual,
                                  const Eigen::MatrixXd& nuisance, const StatementOptions& options = {});

/// What is to be said of readings beside a fit of some claims: the space about the machine as fitted, and the readings that its free numbers may take up.
class StatedBeside {
 public:
  /// @param fitter  settled at the fit, with its noise; outlives it
  /// @throws SolveError  where the fit's state has no solution
  StatedBeside(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit);
  [[nodiscard]] Posterior posterior(const StatementOptions& options) const;
  /// Squares that a fit leaves of the readings, as StatementOptions::left has them.
  [[nodiscard]] double left(const Fit& fit) const;

 private:
  StatementSpace space_;
  const Comparison& comparison_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd nuisance_;
};

/// Statements of several posteriors, each quantity and place once, with the greatest of its probabilities; the first one says whether nothing is wrong.
[[nodiscard]] Posterior joined(const std::vector<Posterior>& posteriors);

}  // namespace driftwright::diagnosis
