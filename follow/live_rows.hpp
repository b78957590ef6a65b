#pragma once
// The rows that were taken, as a run for predictors: readings, drive and ambient, as far back as predictors look.

#include <deque>

#include "base/machine_run.hpp"
#include "follow/stream_row.hpp"

namespace driftwright::follow {

/// A recorded column that a machine follows at the value of the last row (Drive::signals).
struct FollowedColumn {
  std::string signal;  ///< as the effect calls it
  std::string name, unit;
};

class LiveRows {
 public:
  /// @param channels     of the stream
  /// @param ambient      channel in degC that reads the ambient; "": not needed
  /// @param reference_K  reference temperature that the ambient is counted from
  /// @param wants_drive  whether the rows must contain the spindle speed
  /// @param columns      that must be among the channels
  LiveRows(const std::vector<Channel>& channels, const std::string& ambient, double reference_K, bool wants_drive,
           const std::vector<FollowedColumn>& columns = {});

  /// Takes a row; a missing drive or ambient keeps its last value.
  /// @return false if drive, ambient or a followed column is still unknown, so that the run has not begun
  bool add(double run_s, const std::vector<double>& values);
  /// Takes speed, feeds and cutting power alone, of a row that comes sooner than the predictor wants one.
  void between(double run_s, const std::vector<double>& values);
  /// Time since the last row that was added.
  [[nodiscard]] double since_row_s(double run_s) const { return run_s - start_s_ - run_.readings.time_s.back(); }

  [[nodiscard]] MachineRun& run() { return run_; }
  [[nodiscard]] const MachineRun& run() const { return run_; }
  /// Rows since the start of the run, including those no longer kept.
  [[nodiscard]] std::size_t n_rows() const { return run_.n_forgotten + run_.readings.n_samples(); }
  /// Age [s], at the last row, of the oldest of spindle speed, ambient and followed columns, as far as they are needed.
  [[nodiscard]] double drive_age_s() const;
  /// The names of those that are older than `age_s`.
  [[nodiscard]] std::vector<std::string> older_than(double age_s) const;
  /// The names of those that no row has given yet.
  [[nodiscard]] std::vector<std::string> not_given() const;
  /// The drive between the last row but one and the last row.
  [[nodiscard]] const Drive& drive_before() const { return before_; }
  [[nodiscard]] const Drive& drive() const { return drive_; }    ///< from the last row on
  [[nodiscard]] double ambient_K() const { return ambient_K_; }  ///< at the last row, minus the reference temperature

  /// The last row and what it continues from, for the state file.
  struct State {
    double start_s = 0.0;  ///< start of the run, by the guard's time
    std::size_t n_rows = 0;
    double time_s = 0.0, ambient_K = 0.0, top_rpm = 0.0;
    double speed_age_s = 0.0, ambient_age_s = 0.0;
    std::vector<double> values;
    Drive drive;                                             ///< from the last row on; its signals are in `followed`
    std::vector<double> followed = {}, followed_age_s = {};  ///< value and age of each followed column
  };
  [[nodiscard]] State state() const;
  /// @throws InputError  for a state with another number of followed columns
  void recall(const State& state);

 private:
  void forget();
  void hear(double run_s, const std::vector<double>& values);
  void add_section(double time_s);

  MachineRun run_;
  double reference_C_, ambient_K_, top_rpm_ = 0.0, start_s_ = 0.0;
  double section_end_s_ = 0.0;                                  // of the last section, in the run
  std::deque<std::size_t> n_sections_;                          // that each row has added; 0 of the first
  std::size_t n_new_sections_ = 0;                              // since the last row
  double now_s_ = 0.0, speed_at_s_ = 0.0, ambient_at_s_ = 0.0;  ///< by the guard's time
  bool wants_drive_, has_drive_ = false;
  std::size_t speed_, cutting_, ambient_;  ///< indices of channels; kNone if missing
  std::array<std::size_t, 3> feed_{};
  struct ColumnAge {
    std::size_t channel;
    double at_s;  ///< of its last value, by the guard's time
  };
  std::vector<ColumnAge> followed_;  // as drive_.signals
  Drive drive_, before_;
};

}  // namespace driftwright::follow
