#pragma once
// Encoder signals for other programs: value change dumps for waveform viewers and logic analysers, and files for
// LinuxCNC's HAL. Each class writes row by row and stores none.

#include <cstdint>
#include <fstream>
#include <string>

#include "compensation/injector/quadrature.hpp"

namespace driftwright::output {

using compensation::Lines;

/// A value change dump (IEEE 1364-2005, clause 18) of the lines before and after the injector: a_in, b_in, a_out, b_out,
/// and the index lines z_in and z_out if there are any.
class VcdFile {
 public:
  /// @param row_s  time of a row; the timescale is the largest of 1, 10, 100 s, ms, us, ns, ps that divides it
  /// @throws InputError  when the file cannot be written, or a row is shorter than 1 ps
  VcdFile(const std::string& path, double row_s, bool has_index, const std::string& made_by);

  /// Sets the lines from this row on; `row` must not decrease. @throws InputError  when the time of the row does not fit
  /// 64 bits
  void row(std::int64_t row, Lines in, Lines out);
  /// Ends the last row. @throws InputError  when not all could be written
  void finish();

 private:
  std::string path_;
  std::ofstream file_;
  std::int64_t ticks_per_row_, most_rows_;
  bool has_index_;
  std::int64_t last_row_ = -1;
  Lines last_in_ = 0, last_out_ = 0;
};

/// Rows for LinuxCNC's `halstreamer`: "A B n", with an index "A B Z n"; n counts the rows from 1, so that a HAL file sees
/// which row was played. LinuxCNC's `encoder` starts at 00: if the signal does not, the steps from there to its first row
/// are written first.
class HalStreamFile {
 public:
  /// @throws InputError  when the file cannot be written
  HalStreamFile(const std::string& path, bool has_index);
  void row(Lines lines);
  /// @throws InputError  when not all could be written
  void finish();

  /// Number of rows written, and the rawcounts that an `encoder` shows after the last one.
  [[nodiscard]] std::int64_t n_rows() const { return n_rows_; }
  [[nodiscard]] std::int64_t expected_count(compensation::Counting counting) const;

 private:
  void write(Lines lines);
  std::string path_;
  std::ofstream file_;
  bool has_index_;
  std::int64_t n_rows_ = 0;
  compensation::QuadratureCounter x4_, x1_{0, compensation::Counting::kX1};
};

/// A HAL file that plays such rows, one per millisecond, into LinuxCNC's `encoder` and says the count that is expected.
/// @param counting  x4 or x1: LinuxCNC's `encoder` knows no x2
[[nodiscard]] std::string hal_text(const std::string& stream_path, const HalStreamFile& stream, bool has_index,
                                   compensation::Counting counting, const std::string& made_by);

}  // namespace driftwright::output
