#pragma once
// Lines from a file descriptor as they arrive, with a limit on the wait.

#include <string>
#include <utility>

#include "follow/row_source.hpp"

namespace driftwright::follow {

class LineSource final : public RowSource {
 public:
  /// @param name  of the file, for messages
  LineSource(int file, std::string name) : file_(file), name_(std::move(name)) {}

  /// @throws InputError  when the file cannot be read
  [[nodiscard]] Got next(std::string& line, double wait_s) override;

 private:
  int file_;
  std::string name_;
  std::string rest_;
  std::size_t begin_ = 0;  // of the next line in rest_
  bool at_end_ = false;
};

}  // namespace driftwright::follow
