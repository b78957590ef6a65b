#pragma once
// Which blocks of an RS-274 program run, and with which numbers: parameters, expressions, subprograms, loops and branches.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nc/block.hpp"
#include "nc/expression.hpp"
#include "nc/run.hpp"

namespace driftwright {

/// What the interpreter itself knows of a parameter such as 5420 or <_FEED>; none: it is an ordinary one.
using NcMachineParameters = std::function<std::optional<NcValue>(const std::string& name)>;

/// Runs an RS-274 program line by line as LinuxCNC does:
///
///   #1 = [...], #<name> = ..., #<_global> = ...   #1 to #30 and names without '_' belong to each subroutine
///   O100 SUB ... O100 RETURN [..] ... O100 ENDSUB [..], O100 CALL [..] [..]; a routine that the program does not have is looked for in a file beside it
///   O100 IF ELSEIF ELSE ENDIF, WHILE ENDWHILE, DO WHILE, REPEAT ENDREPEAT, BREAK, CONTINUE
///   M98 P1000 L2 ... O1000 ... M99; M99 of the program itself ends it here, with a note: the control begins again
///
/// A condition or loop that hangs on what is known only at the machine is followed as if that were 0 (a probe: as if it touched at the end of its way),
/// with a note.
/// @throws InputError  file, line and column; also for a loop without end (NcRun::count())
/// Source: LinuxCNC documentation, "O Codes" and "G-code Overview".
class IsoSource {
 public:
  IsoSource(const std::string& path, NcRun& run, NcMachineParameters machine);
  ~IsoSource();
  /// The next block with words, or none behind the last line.
  [[nodiscard]] std::optional<NcBlock> next();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace driftwright
