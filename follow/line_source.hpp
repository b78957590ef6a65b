#pragma once
// Lines from a file descriptor as they come, with a limit to the wait.

#include <string>

namespace driftwright::follow {

class LineSource {
 public:
  enum class Got { kLine, kNothingYet, kEnd };
  explicit LineSource(int file) : file_(file) {}

  /// The next line, without its line break. @param wait_s  at most so long, less where a signal comes
  /// @throws InputError  when the file cannot be read
  [[nodiscard]] Got next(std::string& line, double wait_s);

 private:
  int file_;
  std::string rest_;
  std::size_t begin_ = 0;  // of the next line in rest_
  bool at_end_ = false;
};

}  // namespace driftwright::follow
