#pragma once
// What `driftwright inject` is told to insert: a table by row or time of the stream, or numbers from a pipe as they come.

#include <cstdint>
#include <string>
#include <vector>

#include "compensation/injector/quadrature.hpp"

namespace driftwright::compensation {

/// How numbers become quarter steps. Units: "um" (the tool's error, actual - commanded) and "count" (of the control).
struct CorrectionScale {
  double period_um = 0.0;  ///< travel of one signal period; 0: not told, so that um are refused
  compensation::Counting counting = compensation::Counting::kX4;
  double row_s = 0.0;       ///< time of one row; 0: not told, so that times are refused
  std::string unit = "um";  ///< of numbers from a pipe
};

/// The wished correction in quarter steps, row after row.
class CorrectionInput {
 public:
  /// A regular file is a table: the header names `row` (input rows, from 1), `time_s` or `time_min` first, then one column in `_um`
  /// or `_count`; a value holds from its row or time on, before the first one the wish is 0. Anything else (a FIFO, /dev/fd/3) is a
  /// pipe: one number a line, in force from the first row that is read after it.
  /// @throws InputError  with line and what is allowed
  CorrectionInput(const std::string& path, const CorrectionScale& scale);
  ~CorrectionInput();
  CorrectionInput(const CorrectionInput&) = delete;
  CorrectionInput& operator=(const CorrectionInput&) = delete;

  /// The wish [quarter steps] for a row. Rows may not fall.
  [[nodiscard]] double quarters_at(std::int64_t row);
  /// The last row up to which the wish stays as it is.
  [[nodiscard]] std::int64_t holds_until() const;
  /// Reads what the pipe holds by now, 1 MiB at most, without waiting. @throws InputError  when a line is no number, or endless
  void poll();

 private:
  struct Step {
    std::int64_t row;
    double quarters;
  };
  void read_table();

  std::string path_;
  CorrectionScale scale_;
  std::vector<Step> steps_;
  std::size_t next_ = 0;
  double quarters_ = 0.0;
  int pipe_ = -1;
  std::string rest_;          // of a line of the pipe
  std::int64_t n_lines_ = 0;  // of the pipe
};

}  // namespace driftwright::compensation
