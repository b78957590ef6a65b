#pragma once
// Rows "A B" or "A B index" of a live encoder signal as text: in from one file descriptor, out to another.

#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compensation/injector/quadrature.hpp"

namespace driftwright::compensation {

/// Reads rows of 0 and 1, two or three columns, equal in all rows. Returns rows as soon as they arrive.
class RowReader {
 public:
  /// @param is_strict  true: an invalid row ends the reading; false: the previous row replaces it, and it is reported as a
  ///                   fault. An invalid first row is dropped
  explicit RowReader(int file, bool is_strict = true) : file_(file), is_strict_(is_strict) {}

  /// The rows that have arrived, at least one; none at the end. Waits until there is one. The span is valid until the next
  /// call.
  /// @throws InputError  if strict: with line and what is allowed, after the rows before it have been returned
  [[nodiscard]] std::span<const compensation::Lines> next();
  /// The faults in lines since the last call of next(), one sentence each.
  [[nodiscard]] const std::vector<std::string>& faults() const { return faults_; }
  /// The bytes of these rows' lines, as received.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] bool has_index() const { return n_columns_ == 3; }

 private:
  void take_line(const char* begin, const char* end);
  void take_good_line(const char* begin, const char* end);

  int file_;
  bool is_strict_;
  compensation::Lines last_ = 0;  // of the rows so far
  std::vector<std::string> faults_;
  std::vector<compensation::Lines> rows_;
  std::string bytes_;
  std::string rest_;  // bytes of an incomplete line
  std::exception_ptr error_;
  std::int64_t n_lines_ = 0;
  int n_columns_ = 0;
  bool at_end_ = false, is_endless_ = false;
};

/// Writes bytes immediately.
/// @return false  when the reader has closed the pipe
/// @throws InputError  when they cannot be written for another reason, such as a full disk
[[nodiscard]] bool write_bytes(int file, std::string_view bytes);

/// Writes rows in that form, immediately; returns and throws as write_bytes().
[[nodiscard]] bool write_rows(int file, std::span<const compensation::Lines> rows, bool with_index);

}  // namespace driftwright::compensation
