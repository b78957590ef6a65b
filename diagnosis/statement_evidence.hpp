#pragma once
// Evidence of sets of statements, by linear algebra on one Gram matrix.
//
//     log E(set) = -1/2 log det(1 + W X'X W) + 1/2 b'(X'X + W⁻²)⁻¹ b,   b = X'r,   products by (1 + A A')⁻¹
//
// X: columns of the set; W: widths of their sizes' normal priors; r: measured minus predicted; A: one standard deviation
// of each roughly known number, which is marginalised in this way. A size's prior is a mixture of normal distributions
// with log-uniform widths: heavy tails. For a statement that may hold at many times, the evidence is the mean over the
// times. The prior is a description length: uniform over quantities, places of a quantity, courses there, their laws, and
// records, so that more places or laws give no advantage.

#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "diagnosis/statement.hpp"

namespace driftwright::diagnosis {

struct StatementOptions {
  double nothing = 0.5;  ///< prior probability that nothing is wrong: even odds
  double one_more =
      0.25;  ///< prior of a set with one more statement, relative to the set: three faulty machines in four have one fault
  double all_records =
      0.6;  ///< prior that a fault is in all of several records; the rest is for one, the first, the last or other records
  double rare_records = 0.25;  ///< share of other choices of records in that rest
  /// For cells of time: priors of one window, of a permanent change (in one record, and in those after it), and of
  /// several windows of one size.
  double once = 0.4, lasting = 0.2, lasting_on = 0.2, several = 0.2;
  std::vector<double> widths = {0.03, 0.1, 0.3, 1.0,
                                3.0};  ///< of sizes' priors, in typical sizes: three decades around a usual fault
  int most = 3;                        ///< largest number of statements in a set
  double explained = 0.0;              ///< explained already by the claims of the fit [nats]
  int beam = 6;                        ///< number of sets that are extended; 12 give the same names
  /// Share of its effect by which a law is wrong: a set that explains E nats then leaves 2 law_error² E squares that are
  /// not noise, and evidence is weighed by 1 / (1 + 2 law_error² E). Of 0, 0.05, 0.07, 0.1 and 0.14 this is the value
  /// with correct probabilities on simulated machines (docs/theory/diagnosis.md).
  double law_error = 0.05;
  /// Whether the rest of the best explanation is used to estimate the laws' error, which then weighs the evidence between
  /// statements.
  bool observed = false;
  double left = std::numeric_limits<double>::infinity();  ///< squares that a full fit leaves, if there is one
};

/// The time of a statement: given, or in cells.
enum class When {
  kGiven,         ///< as in its column
  kWindow,        ///< one window in one record
  kLasting,       ///< from a time on, in one record
  kLastingOn,     ///< the same, and in the records after it
  kWindows,       ///< several windows of one size, in any records
  kUnknown,       ///< a random walk, in one record
  kUnknownInAll,  ///< a random walk in all records
};

/// A statement with its evidence in addition to a set.
struct Scored {
  std::size_t of = 0;  ///< index of the column; the first cells follow the last column
  When when = When::kGiven;
  std::size_t run = 0;                  ///< for those in one record
  std::size_t records = 0;              ///< for columns: index of the choice of records
  Eigen::Index first = 0, end = 0;      ///< cells of the run, the likeliest ones
  std::optional<StatedRows> rows = {};  ///< exact rows of these cells, if single rows matter
  std::vector<double> cells = {};       ///< for several windows: 1 in a window
  int n_windows = 0;
  double width = 1.0;  ///< the likeliest width
  double log_prior = 0.0, log_evidence = 0.0;
};

/// Columns, and their components along the roughly known numbers.
struct TakenColumns {
  Eigen::MatrixXd x, nuisance;
};

/// Share of a column's squares, below which roughly known numbers can fully replace it.
inline constexpr double kNothingLeft = 1e-9;

/// Number of steps of an unknown course in a record of n cells.
[[nodiscard]] Eigen::Index n_pieces_of(Eigen::Index n_cells);
/// Maps steps that last, a random walk, to cells: n_cells x n_pieces.
[[nodiscard]] Eigen::MatrixXd walk(Eigen::Index n_cells);

/// A statement that belongs to a set.
struct Item {
  Statement says;
  Chosen chosen;  ///< by units
  TakenColumns columns;
  Eigen::VectorXd width;
};

class StatementEvidence {
 public:
  /// @param space     must outlive this
  /// @param residual  whitened, condensed as in the space
  /// @param nuisance  the same for one standard deviation of each roughly known number, n_rows x n_numbers
  StatementEvidence(const StatementSpace& space, const StatementOptions& options, const Eigen::VectorXd& residual,
                    const Eigen::MatrixXd& nuisance);

  /// Every statement in addition to a set; log_prior and log_evidence are those of the statement alone.
  [[nodiscard]] std::vector<Scored> scored(const std::vector<Item>& set) const;
  [[nodiscard]] Item item(const Scored& scored) const;
  /// A course of any shape in all records, alone, for a statement's quantity at its place; none if the grammar has none.
  [[nodiscard]] std::optional<Scored> any_course(const Statement& says) const;
  [[nodiscard]] Statement said(const Scored& scored) const;

  /// Sizes of a set's columns in their units, and their covariance.
  struct Sizes {
    TakenColumns columns;
    Eigen::VectorXd size;
    Eigen::MatrixXd covariance;
  };
  [[nodiscard]] Sizes sizes(const std::vector<Item>& set) const;
  /// Squares of the residual that a set leaves.
  [[nodiscard]] double left(const std::vector<Item>& set) const;
  [[nodiscard]] Eigen::Index n_rows() const { return residual_.x.rows(); }
  /// Multiplies a choice in units by sizes. @param size  of its item's columns
  void scale(Chosen& chosen, const Scored& scored, const Eigen::VectorXd& size) const;

 private:
  struct Cells {
    Eigen::MatrixXd nuisance, squares;
    Eigen::VectorXd along;
    std::vector<Eigen::Index> first;  ///< of each run, and the total number
  };
  struct OfRun {  ///< all columns in one run; the nuisance is projected out once the records are chosen
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
  /// Evidence of one column of a size with this class's prior. @param best_width  receives the likeliest width
  [[nodiscard]] double mixed(double squares, double along, double& best_width) const;
  /// The same for many columns, without the widths.
  [[nodiscard]] Eigen::ArrayXd mixed(const Eigen::ArrayXd& squares, const Eigen::ArrayXd& along) const;
  /// Windows that are evaluated together: products of their columns, and their first and last places.
  struct Windows {
    std::vector<double> squares, along;
    std::vector<std::pair<Eigen::Index, Eigen::Index>> edges;
    void add(double d, double b, Eigen::Index first, Eigen::Index end) {
      squares.push_back(d);
      along.push_back(b);
      edges.emplace_back(first, end);
    }
  };
  struct OfWindows {
    Eigen::ArrayXd evidence;
    std::size_t best = 0;  ///< index of the likeliest window
    double width = 1.0;    ///< its likeliest width
  };
  void score_columns(const Sizes& on, std::vector<Scored>& list) const;
  // From here on in statement_times.cpp.
  /// @param windows  one at least
  [[nodiscard]] OfWindows evaluated(const Windows& windows) const;
  void score_windows(std::size_t k, const Sizes& on, const Eigen::MatrixXd& g, const Eigen::VectorXd& along,
                     std::vector<Scored>& list) const;
  /// Mean evidence of a window whose edges may be at any row of the neighbouring cells. For actions on a channel
  /// directly, in which no time constant hides the edges.
  /// @param scored  the likeliest cells; receives the likeliest rows
  [[nodiscard]] double of_rows(std::size_t k, const Sizes& on, Scored& scored) const;
  void score_several(std::size_t k, const Eigen::MatrixXd& g, const Eigen::VectorXd& along, std::vector<Scored>& list) const;
  void score_unknown(std::size_t k, const Eigen::MatrixXd& g, const Eigen::VectorXd& along, std::vector<Scored>& list) const;
  void set_records();  ///< with set_priors() in statement_priors.cpp
  void set_priors();

  const StatementSpace& space_;
  StatementOptions options_;
  Eigen::MatrixXd q_;      ///< A = Q S V'
  Eigen::VectorXd share_;  ///< S² / (1 + S²)
  TakenColumns residual_;
  std::vector<OfRun> of_run_;
  std::vector<Cells> cells_;
  std::vector<Records> records_;
  std::vector<double> prior_;  ///< of columns, without the records
  std::vector<CellsPrior> prior_cells_;
};

}  // namespace driftwright::diagnosis
