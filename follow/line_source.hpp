#pragma once
// Lines from a file descriptor as they come, with a limit to the wait.

#include "follow/row_source.hpp"

namespace driftwright::follow {

class LineSource final : public RowSource {
 public:
  explicit LineSource(int file) : file_(file) {}

  /// @throws InputError  when the file cannot be read
  [[nodiscard]] Got next(std::string& line, double wait_s) override;

 private:
  int file_;
  std::string rest_;
  std::size_t begin_ = 0;  // of the next line in rest_
  bool at_end_ = false;
};

}  // namespace driftwright::follow
