#pragma once
// The order in which lines of a Siemens program run, and its variables: labels and jumps, branches, loops, repetitions.

#include <memory>
#include <string>
#include <vector>

#include "nc/execution.hpp"
#include "nc/siemens/lines.hpp"

namespace driftwright {

/// Runs a program line by line: IF ELSE ENDIF, WHILE, FOR, LOOP, REPEAT UNTIL, GOTOF GOTOB GOTO, REPEAT A B P=n, REPEATB,
/// DEF.
/// @throws InputError  file, line and column; also for a loop without end (NcExecution::count())
/// Source: Siemens, SINUMERIK 840D sl / 828D, Programming Manual Job Planning (6FC5398-2BP40), program jumps and branches,
/// program part repetition, control structures.
class SiemensSource {
 public:
  SiemensSource(const std::string& path, const std::vector<std::string>& text, NcExecution& run);
  ~SiemensSource();

  /// The next line that is a block; null after the last line.
  [[nodiscard]] const SiemensLine* next();

  /// The value of the expression `text`, which begins at that column of the line. @param alone  it has nothing after it
  [[nodiscard]] double value_of(const SiemensLine& line, const std::string& text, std::size_t column, bool alone) const;
  /// True for R parameters and for variables that the program has defined.
  [[nodiscard]] bool is_variable(const std::string& name) const;
  void set_variable(const std::string& name, double value);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace driftwright
