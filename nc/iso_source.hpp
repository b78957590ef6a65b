#pragma once
// The order in which blocks of an RS-274 program run, and their numbers: parameters, expressions, subprograms, loops and
// branches.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nc/block.hpp"
#include "nc/execution.hpp"
#include "nc/expression.hpp"

namespace driftwright {

/// The value of a parameter that the interpreter itself provides, such as 5420 or <_FEED>; none: an ordinary parameter.
using NcMachineParameters = std::function<std::optional<NcValue>(const std::string& name)>;

/// Runs an RS-274 program line by line as LinuxCNC does:
///
///   #1 = [...], #<name> = ..., #<_global> = ...   #1 to #30 and names without '_' belong to each subroutine
///   O100 SUB ... O100 RETURN [..] ... O100 ENDSUB [..], O100 CALL [..] [..]; a missing routine is searched in a file beside
///   the program O100 IF ELSEIF ELSE ENDIF, WHILE ENDWHILE, DO WHILE, REPEAT ENDREPEAT, BREAK, CONTINUE M98 P1000 L2 ...
///   O1000 ... M99; M99 in the main program ends it here, with a note: a control would start again
///
/// A condition or loop that depends on a value known only at the machine is evaluated with 0 (a probe: as if it touched at
/// the end of its path), with a note.
/// @throws InputError  file, line and column; also for a loop without end (NcExecution::count())
/// Source: LinuxCNC documentation, "O Codes" and "G-code Overview".
class IsoSource {
 public:
  IsoSource(const std::string& path, const std::vector<std::string>& lines, NcExecution& run, NcMachineParameters machine);
  ~IsoSource();
  /// The next block with words; none after the last line.
  [[nodiscard]] std::optional<NcBlock> next();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace driftwright
