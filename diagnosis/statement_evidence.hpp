#pragma once
// Evidence of sets of statements, by linear algebra on one Gram matrix.
//
//     log E(set) = -1/2 log det(1 + W X'X W) + 1/2 b'(X'X + W⁻²)⁻¹ b,   b = X'r,   products by (1 + A A')⁻¹
//
// X: columns of the set; W: widths of their sizes' normal priors; r: what was measured less the prediction; A: a sigma of each number that is known roughly, which is so marginalised. A size's
// prior is a mixture of normal ones over widths that are log-uniform: heavy tails. Of a statement that may hold at many times the evidence is the mean over the times.
// The prior is a description length: uniform over quantities, places of a quantity, what it follows there, its laws, and which records, so that more places or laws buy nothing.

#include <limits>
#include <map>
#include <optional>

#include "diagnosis/statement.hpp"

namespace driftwright::diagnosis {

struct StatementOptions {
  double nothing = 0.5;  ///< probability that nothing is wrong, before any reading: even odds
  double one_more =
      0.25;  ///< of a set of one statement more, over the set: three faulty machines in four are wrong in one way
  double all_records =
      0.6;  ///< that something holds in all records, of several; the rest is shared by one alone, those up to one, from one on, and others
  double rare_records = 0.25;  ///< of that rest, what other choices of records share
  /// Of what holds in all cells of a place's time: windows one, from a time on (in one record, and in those after it), several of one size.
  double once = 0.4, lasting = 0.2, lasting_on = 0.2, several = 0.2;
  std::vector<double> widths = {
      0.03, 0.1, 0.3, 1.0,
      3.0};                ///< of sizes' priors, in the statement's typical size: three decades about what a fault does
  int most = 3;            ///< statements of a set
  double explained = 0.0;  ///< what claims that they stand beside explain already [nats]
  int beam = 6;            ///< sets that are taken further; 12 name the same
  /// Share of what it does that a law is off by: what a set explains, E nats, then leaves 2 law_error² E squares that no noise makes, and evidence counts 1 / (1 + 2 law_error² E) of
  /// itself. Of 0, 0.05, 0.07, 0.1 and 0.14 the one whose probabilities came true on simulated machines (docs/theory/diagnosis.md).
  double law_error = 0.05;
  /// Whether what the best explanation leaves over is asked how far laws are off: then evidence between statements counts as that tells.
  bool observed = false;
  double left = std::numeric_limits<double>::infinity();  ///< squares that a full fit leaves, where there is one
};

/// What time a statement is given: always, or in cells.
enum class When {
  kGiven,         ///< a column's own
  kWindow,        ///< one, in one record
  kLasting,       ///< from a time on, in one record
  kLastingOn,     ///< and in the records after it
  kWindows,       ///< several of one size, in any records
  kUnknown,       ///< a random walk, in one record
  kUnknownInAll,  ///< in all
};

/// A statement with its evidence on top of a set.
struct Scored {
  std::size_t of = 0;  ///< index of the column; the first cells follow the last column
  When when = When::kGiven;
  std::size_t run = 0;                  ///< of what is in one
  std::size_t records = 0;              ///< of columns: which choice of records
  Eigen::Index first = 0, end = 0;      ///< cells of the run: the likeliest ones
  std::optional<StatedRows> rows = {};  ///< of these cells, where a row more or less counts
  std::vector<double> cells = {};       ///< of several windows: 1 where one is
  int n_windows = 0;
  double width = 1.0;  ///< the likeliest
  double log_prior = 0.0, log_evidence = 0.0;
};

/// Columns, and what the numbers known roughly have of them.
struct TakenColumns {
  Eigen::MatrixXd x, nuisance;
};

/// A statement that was taken into a set.
struct Item {
  Statement says;
  Chosen chosen;  ///< by units
  TakenColumns columns;
  Eigen::VectorXd width;
};

class StatementEvidence {
 public:
  /// @param space     outlives it
  /// @param residual  whitened, as the space condenses it
  /// @param nuisance  the same of a sigma of each number that is known roughly, n_rows x n_numbers
  StatementEvidence(const StatementSpace& space, const StatementOptions& options, const Eigen::VectorXd& residual,
                    const Eigen::MatrixXd& nuisance);

  /// Every statement on top of a set; log_prior and log_evidence are its own.
  [[nodiscard]] std::vector<Scored> scored(const std::vector<Item>& set) const;
  [[nodiscard]] Item item(const Scored& scored) const;
  /// A course of any shape in all records, alone, of a statement's quantity at its place; none: the grammar has none.
  [[nodiscard]] std::optional<Scored> any_course(const Statement& says) const;
  [[nodiscard]] Statement said(const Scored& scored) const;

  /// Sizes of a set's columns by their units, and their covariance.
  struct Sizes {
    TakenColumns columns;
    Eigen::VectorXd size;
    Eigen::MatrixXd covariance;
  };
  [[nodiscard]] Sizes sizes(const std::vector<Item>& set) const;
  /// Squares that a set leaves of the residual.
  [[nodiscard]] double left(const std::vector<Item>& set) const;
  [[nodiscard]] Eigen::Index n_rows() const { return residual_.x.rows(); }
  /// A choice by units times sizes. @param size  of its item's columns
  void scale(Chosen& chosen, const Scored& scored, const Eigen::VectorXd& size) const;

 private:
  struct Cells {
    Eigen::MatrixXd nuisance, squares;
    Eigen::VectorXd along;
    std::vector<Eigen::Index> first;  ///< of each run, and their number
  };
  struct OfRun {  ///< all columns in one run; what the nuisance takes of them is taken off once the records are chosen
    Eigen::MatrixXd x, nuisance;
    Eigen::VectorXd squares, along;
  };
  struct Records {
    std::vector<char> in;
    double log_prior = 0.0;
  };
  struct CellsPrior {
    double window = 0.0, unknown = 0.0;
  };
  [[nodiscard]] Eigen::MatrixXd products(const TakenColumns& a, const TakenColumns& b) const;
  [[nodiscard]] Cells cells_of(const StatementCells& cells) const;
  [[nodiscard]] Chosen chosen(const Scored& scored) const;
  [[nodiscard]] std::vector<StatedWindow> windows_of(const Chosen& chosen) const;
  [[nodiscard]] Eigen::Index n_pieces_of(const Scored& scored) const;
  [[nodiscard]] double mixed(double squares, double along, double& best_width) const;
  void score_columns(const Sizes& on, std::vector<Scored>& list) const;
  void score_windows(std::size_t k, const Sizes& on, const Eigen::MatrixXd& g, const Eigen::VectorXd& along,
                     std::vector<Scored>& list) const;
  /// Evidence of a window whose edges may lie at any rows of the cells about them: the mean. Of what acts on a channel alone, which has no time constant that hides its edges.
  /// @param scored  the likeliest cells; takes the likeliest rows
  [[nodiscard]] double of_rows(std::size_t k, const Sizes& on, Scored& scored) const;
  void score_several(std::size_t k, const Eigen::MatrixXd& g, const Eigen::VectorXd& along, std::vector<Scored>& list) const;
  void score_unknown(std::size_t k, const Eigen::MatrixXd& g, const Eigen::VectorXd& along, std::vector<Scored>& list) const;
  void set_records();
  void set_priors();

  const StatementSpace& space_;
  StatementOptions options_;
  Eigen::MatrixXd q_;      ///< A = Q S V'
  Eigen::VectorXd share_;  ///< S² / (1 + S²)
  TakenColumns residual_;
  std::vector<OfRun> of_run_;
  std::vector<Cells> cells_;
  std::vector<Records> records_;
  std::vector<double> prior_;  ///< of columns, records aside
  std::vector<CellsPrior> prior_cells_;
};

}  // namespace driftwright::diagnosis
