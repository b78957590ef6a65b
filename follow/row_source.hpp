#pragma once
// Interface of all sources of rows: lines of text, with a limit on the wait.

#include <string>

namespace driftwright::follow {

class RowSource {
 public:
  enum class Got { kLine, kNothingYet, kEnd };
  virtual ~RowSource() = default;
  /// The next line, without its line break. @param wait_s  longest wait; a signal ends it earlier
  /// @throws InputError  if no readable line can come any more
  [[nodiscard]] virtual Got next(std::string& line, double wait_s) = 0;
};

}  // namespace driftwright::follow
