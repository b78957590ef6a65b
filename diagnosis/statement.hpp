#pragma once
// A grammar of what may be missing: quantity x place x course x records x size. Each statement is a column (for an
// unknown course several): the effect of one unit on the whitened readings, by the twin's linear operator.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit.hpp"
#include "diagnosis/linear_operator.hpp"

namespace driftwright::diagnosis {

enum class StatedQuantity { kHeat, kExchange, kCapacity, kReading, kDisplacement, kAmbient, kSpeed, kClock };
[[nodiscard]] const char* word(StatedQuantity quantity);

/// A time within which a statement holds, at the resolution of its cells.
struct StatedWindow {
  std::size_t run = 0;
  double begin_s = 0.0, end_s = 0.0;
  double wide_s = 0.0;  ///< width of the cell at its ends: uncertainty of the times
};

/// A statement without its size.
struct Statement {
  StatedQuantity quantity = StatedQuantity::kHeat;
  std::vector<std::string> place = {};     ///< bodies, the ambient, instruments
  std::string at = {};                     ///< surface or joint at that place, if there is one; else empty
  std::string follows = {};                ///< constant, running, power of NAME, temperature of NAME, window, unknown ...
  std::string law = {};                    ///< its course in full: exponent, lag, times
  std::vector<char> in_run = {};           ///< marks the records in which it holds
  std::vector<StatedWindow> windows = {};  ///< for a course `window`
  std::vector<std::string> record = {};    ///< names of the records
  double unit_size = 1.0;                  ///< typical size, in `unit`; a column is for this size
  std::string unit = {};
};

/// "heat in spindle, while the spindle turns", "thermometer t_head, 84 % of the ambient from 95 min on": what, where, and
/// its course.
[[nodiscard]] std::string words(const Statement& statement);
/// The two parts of it: "heat in spindle", and "while the spindle turns"; empty if the first one says all.
[[nodiscard]] std::string subject_words(const Statement& statement);
[[nodiscard]] std::string course_words(const Statement& statement);
/// Its records: "all", "monday", "tuesday and friday".
[[nodiscard]] std::string records_text(const Statement& statement);

/// The action of one unit of a statement in the machine or on its readings, for all runs.
struct Acting {
  std::shared_ptr<const std::vector<LinearOperator::Load>> loads;  ///< null: it acts on a channel directly
  std::string channel;
  std::vector<Eigen::RowVectorXd> course;  ///< over the intervals; for a channel over the rows
  bool always = false;                     ///< before the run it had the value of the run's beginning
};

/// A statement with all known except its size, or, in cells of time, its times: windows and unknown courses are composed
/// of cells.
struct StatementColumn {
  Statement says;  ///< without in_run
  std::vector<Acting> acts;
  std::vector<Eigen::VectorXd> of_run;  ///< whitened and condensed
};
struct StatementCells {
  Statement says;  ///< without follows and in_run
  std::vector<Acting> acts;
  struct Run {
    std::vector<Eigen::Index> edge;  ///< first row of each cell, and the end of the last one
    std::vector<double> edge_s;
    Eigen::MatrixXd of_cell;  ///< whitened and condensed, one column per cell
  };
  std::vector<Run> runs;
  bool lasts = false;  ///< a change in a cell is permanent, such as a set clock
};

/// A window as rows of a record.
struct StatedRows {
  std::size_t run = 0;
  Eigen::Index first = 0, end = 0;
};

/// A statement as chosen for a set: its records, times and size.
struct Chosen {
  bool is_cells = false;
  std::size_t index = 0;
  /// For each record the factor on the unit: one number, or one per cell; empty if it has no effect there.
  std::vector<Eigen::VectorXd> amount;
  /// In one record, the exact rows of its cells, if known; otherwise the rows between the cells' edges.
  std::optional<StatedRows> rows = {};
};

/// All statements of the grammar about a machine and its records.
class StatementSpace {
 public:
  /// @param fitter  must outlive this
  /// @param state   state at which the machine is linearised
  /// @throws SolveError  if the state has no solution
  StatementSpace(const Fitter& fitter, const TwinState& state);

  std::vector<StatementColumn> columns;
  std::vector<StatementCells> cells;
  struct Rows {
    Eigen::Index first = 0, n = 0;
  };
  std::vector<Rows> rows;           ///< of each run
  std::vector<std::string> record;  ///< its name
  Eigen::Index together = 1;        ///< number of the comparison's condensed readings summed in each row
  /// Whitened readings in the rows of the columns.
  [[nodiscard]] Eigen::MatrixXd condense(const Comparison& comparison, const Eigen::MatrixXd& whitened) const;

  /// The effect of chosen statements on the channels of each run, n_channels x n_rows.
  [[nodiscard]] std::vector<Eigen::MatrixXd> readings(const std::vector<Chosen>& chosen) const;
  /// Readings of a run's channels, whitened and condensed. @param readings  n_channels x n_rows
  [[nodiscard]] Eigen::VectorXd condensed(std::size_t run, const Eigen::MatrixXd& readings) const;
  [[nodiscard]] const std::vector<double>& time_s(std::size_t run) const { return machine_[run].time_s(); }

 private:
  friend class StatementBuilder;
  [[nodiscard]] Eigen::RowVectorXd course_of(const Chosen& chosen, const Acting& acting, std::size_t run) const;
  const Comparison& comparison_;
  std::vector<std::size_t> first_block_;  ///< of the comparison, of each run
  std::vector<LinearOperator> machine_;
  std::vector<std::vector<std::string>> channels_;  ///< of each run
};

}  // namespace driftwright::diagnosis
