#pragma once
// The corrections that `driftwright inject` inserts: a table by row or time of the stream, or numbers from a pipe as they
// arrive.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compensation/injector/quadrature.hpp"

namespace driftwright::compensation {

/// Conversion of numbers to quarter steps. Units: "um" (the tool's error, actual - commanded) and "count" (of the control).
struct CorrectionScale {
  double period_um = 0.0;  ///< travel of one signal period; 0: unknown, values in um are refused
  compensation::Counting counting = compensation::Counting::kX4;
  double row_s = 0.0;       ///< time of one row; 0: unknown, times are refused
  std::string unit = "um";  ///< of numbers from a pipe
  /// Of a table with more than two columns, or axis in lines of `follow`; empty: `predicted_um`, or the only axis.
  std::string column = {};
  bool is_strict = true;  ///< true: a line of a pipe that is no correction is an error; false: it is reported as a fault
};

/// The requested correction in quarter steps, row by row.
class CorrectionInput {
 public:
  /// A regular file is a table: its header names `row` (input rows, from 1), `time_s` or `time_min` first, then one column
  /// in `_um` or `_count`, or several of which `column` selects one, as in the corrected.csv of `compensate`. A value
  /// applies from its row or time on; before the first one the request is 0. Anything else (a FIFO, /dev/fd/3) is a pipe:
  /// one number per line, or a line of JSON as `follow` writes it, in force from the first row that is read after it.
  /// @throws InputError  with line and what is allowed
  CorrectionInput(const std::string& path, const CorrectionScale& scale);
  ~CorrectionInput();
  CorrectionInput(const CorrectionInput&) = delete;
  CorrectionInput& operator=(const CorrectionInput&) = delete;

  /// The request [quarter steps] for a row. Row numbers must not decrease.
  [[nodiscard]] double quarters_at(std::int64_t row);
  /// The last row up to which the request stays unchanged.
  [[nodiscard]] std::int64_t holds_until() const;
  /// Reads what the pipe contains now, at most 1 MiB, without waiting. @throws InputError if it is strict: when a line is no
  /// correction, or has no end
  void poll();
  /// The faults in lines since the last call, one sentence each.
  [[nodiscard]] std::vector<std::string> take_faults() { return std::exchange(faults_, {}); }
  /// Number of corrections read from the pipe.
  [[nodiscard]] std::int64_t n_told() const { return n_told_; }

 private:
  struct Step {
    std::int64_t row;
    double quarters;
  };
  [[nodiscard]] std::size_t column_of(const std::vector<std::string>& header, std::int64_t line) const;
  void read_table();
  void take_line(std::string_view line);

  std::string path_;
  CorrectionScale scale_;
  std::vector<Step> steps_;
  std::size_t next_ = 0;
  double quarters_ = 0.0;
  int pipe_ = -1;
  std::string rest_;                       // incomplete line of the pipe
  std::int64_t n_lines_ = 0, n_told_ = 0;  // of the pipe
  bool is_endless_ = false;
  std::vector<std::string> faults_;
};

}  // namespace driftwright::compensation
