#pragma once
// Lines from a file descriptor as they come, with a limit to the wait.

#include <string>
#include <utility>

namespace driftwright::follow {

class LineSource {
 public:
  enum class Got { kLine, kNothingYet, kEnd };
  /// @param name  of the file, for messages
  LineSource(int file, std::string name) : file_(file), name_(std::move(name)) {}

  /// The next line, without its line break. @param wait_s  at most so long, less where a signal comes
  /// @throws InputError  when the file cannot be read
  [[nodiscard]] Got next(std::string& line, double wait_s);

 private:
  int file_;
  std::string name_;
  std::string rest_;
  std::size_t begin_ = 0;  // of the next line in rest_
  bool at_end_ = false;
};

}  // namespace driftwright::follow
