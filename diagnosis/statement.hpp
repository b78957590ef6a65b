#pragma once
// What may be missing, as one grammar: quantity x place x what it follows x records x size. Each statement is a column (or, of an unknown course, several): what
// a unit of it does to the whitened readings, by the twin's own linear operator.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit.hpp"
#include "diagnosis/linear_operator.hpp"

namespace driftwright::diagnosis {

enum class StatedQuantity { kHeat, kExchange, kCapacity, kReading, kDisplacement, kAmbient, kSpeed, kClock };
[[nodiscard]] const char* word(StatedQuantity quantity);

/// A time within which a statement holds, as its cells tell it.
struct StatedWindow {
  std::size_t run = 0;
  double begin_s = 0.0, end_s = 0.0;
  double wide_s = 0.0;  ///< of the cell at its ends: the times are known to that
};

/// A statement without its size.
struct Statement {
  StatedQuantity quantity = StatedQuantity::kHeat;
  std::vector<std::string> place;          ///< bodies, the ambient, instruments
  std::string at = {};                     ///< the surface or joint of these, where there are such; else empty
  std::string follows;                     ///< constant, running, power of NAME, temperature of NAME, window, unknown ...
  std::string law;                         ///< what it follows in full: exponent, lag, times
  std::vector<char> in_run;                ///< in which records it holds
  std::vector<StatedWindow> windows = {};  ///< of what follows a window
  std::vector<std::string> record = {};    ///< their names
  double unit_size = 1.0;                  ///< size that a column of a unit stands for, in `unit`: what is typical of it
  std::string unit;
};

/// "heat in spindle, while the spindle turns", "thermometer t_head, 84 % of the ambient from 95 min on": what is missing, where, and what it follows.
[[nodiscard]] std::string words(const Statement& statement);
/// Its records: "all", "monday", "tuesday and friday".
[[nodiscard]] std::string records_text(const Statement& statement);

/// What acts in the machine or on its readings by a unit of a statement. Of all runs.
struct Acting {
  std::shared_ptr<const std::vector<LinearOperator::Load>> loads;  ///< null: it acts on a channel alone
  std::string channel;
  std::vector<Eigen::RowVectorXd> course;  ///< over the intervals, of a channel over the rows
  bool always = false;                     ///< it acted before the run as at its beginning
};

/// A statement that is known but for its size, or, in cells of time, but for when: windows and unknown courses are put together from these.
struct StatementColumn {
  Statement says;  ///< in_run is left open
  std::vector<Acting> acts;
  std::vector<Eigen::VectorXd> of_run;  ///< whitened and condensed
};
struct StatementCells {
  Statement says;  ///< follows and in_run are left open
  std::vector<Acting> acts;
  struct Run {
    std::vector<Eigen::Index> edge;  ///< rows between the cells, one more than these
    std::vector<double> edge_s;
    Eigen::MatrixXd of_cell;  ///< whitened and condensed, a column a cell
  };
  std::vector<Run> runs;
  bool lasts = false;  ///< what begins in one lasts, as a clock that is set does
};

/// A window, by rows of a record.
struct StatedRows {
  std::size_t run = 0;
  Eigen::Index first = 0, end = 0;
};

/// One statement of a set as it is taken: which records, which times, how much.
struct Chosen {
  bool is_cells = false;
  std::size_t index = 0;
  /// Of each record, what the unit is times there: one number, or one of each cell; empty where it does nothing.
  std::vector<Eigen::VectorXd> amount;
  /// In one record the rows that its cells stand for, where they are known; else it is those between the cells' edges.
  std::optional<StatedRows> rows = {};
};

/// All that the grammar can say of a machine in its records.
class StatementSpace {
 public:
  /// @param fitter  outlives it
  /// @param state   that the machine is linear about
  /// @throws SolveError  where the state has no solution
  StatementSpace(const Fitter& fitter, const TwinState& state);

  std::vector<StatementColumn> columns;
  std::vector<StatementCells> cells;
  struct Rows {
    Eigen::Index first = 0, n = 0;
  };
  std::vector<Rows> rows;           ///< of each run
  std::vector<std::string> record;  ///< its name
  Eigen::Index together = 1;        ///< of the comparison's condensed readings in each
  /// Whitened readings as the columns have them.
  [[nodiscard]] Eigen::MatrixXd condense(const Comparison& comparison, const Eigen::MatrixXd& whitened) const;

  /// What chosen statements do to the channels of each run, n_channels x n_rows.
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
