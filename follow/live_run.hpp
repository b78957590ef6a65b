#pragma once
// The rows that were taken, as a run that predictors follow: readings, drive and ambient, as far back as they look.

#include "compensation/predictors/observed_run.hpp"
#include "follow/stream_row.hpp"

namespace driftwright::follow {

class LiveRun {
 public:
  /// @param channels     of the stream
  /// @param ambient         channel in degC that reads the ambient; "": nobody asks for it
  /// @param reference_K  that the ambient counts from
  /// @param wants_drive  whether rows must say what drives the machine
  LiveRun(const std::vector<Channel>& channels, const std::string& ambient, double reference_K, bool wants_drive);

  /// Takes a row; a drive or ambient that is missing goes on as it was. @return false: no row has told drive and ambient yet, and this one does
  /// neither, so that the run has not begun
  bool add(double run_s, const std::vector<double>& values);

  [[nodiscard]] compensation::ObservedRun& run() { return run_; }
  [[nodiscard]] const compensation::ObservedRun& run() const { return run_; }
  /// Rows since the start of the run, those no longer kept among them.
  [[nodiscard]] std::size_t n_rows() const { return run_.n_forgotten + run_.readings.n_samples(); }
  /// How long before the last row what drives the machine was last given: the older of the spindle's speed and the ambient, where they are asked for [s].
  [[nodiscard]] double drive_age_s() const;
  /// Which of them were given longer ago than this.
  [[nodiscard]] std::vector<std::string> older_than(double age_s) const;
  /// From the row before the last until the last.
  [[nodiscard]] const Drive& drive_before() const { return before_; }
  [[nodiscard]] double ambient_K() const { return ambient_K_; }  ///< at the last row, minus the reference temperature

  /// The last row and what it goes on from, such as goes into a file.
  struct State {
    double start_s = 0.0;  ///< of the run, by the guard's time
    std::size_t n_rows = 0;
    double time_s = 0.0, ambient_K = 0.0, top_rpm = 0.0;
    double speed_age_s = 0.0, ambient_age_s = 0.0;
    std::vector<double> values;
    Drive drive;  ///< from the last row on
  };
  [[nodiscard]] State state() const;
  void recall(const State& state);

 private:
  void forget();

  compensation::ObservedRun run_;
  double reference_C_, ambient_K_, top_rpm_ = 0.0, start_s_ = 0.0;
  double now_s_ = 0.0, speed_at_s_ = 0.0, ambient_at_s_ = 0.0;  ///< by the guard's time
  bool wants_drive_, has_drive_ = false;
  std::size_t speed_, cutting_, ambient_;  ///< channels; none where there is no such one
  std::array<std::size_t, 3> feed_{};
  Drive drive_, before_;
};

}  // namespace driftwright::follow
