#pragma once
// Where rows come from, whatever it is: text, line by line, with a limit to the wait.

#include <string>

namespace driftwright::follow {

class RowSource {
 public:
  enum class Got { kLine, kNothingYet, kEnd };
  virtual ~RowSource() = default;
  /// The next line, without its line break. @param wait_s  at most so long, less where a signal comes
  /// @throws InputError  where nothing can come any more that could be read
  [[nodiscard]] virtual Got next(std::string& line, double wait_s) = 0;
};

}  // namespace driftwright::follow
