#pragma once
// All that differs between the languages of NC programs: how a program is recognised and read, how the lines of corrections
// are written, what forbids them. Nothing outside of a language's own folder knows which language it handles.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "nc/step.hpp"

namespace driftwright {

class NcLanguage;
class NcExecution;

/// How corrections are written.
struct NcOffsetOptions {
  const NcLanguage* language = nullptr;      ///< of the program (NcProgram::language); compulsory
  bool shares_shift = false;                 ///< NcLanguage::shares_shift(); corrected_nc_program() sets it
  bool absolute = false;                     ///< the offset is set to base_m plus the correction; its previous value is lost
  int work_offset = 540;                     ///< absolute, LinuxCNC: 540 ... 590, 591, 592, 593 for G54 ... G59.3
  std::array<double, 3> base_m = {0, 0, 0};  ///< absolute: the offset (base frame, datum shift) without corrections
  std::array<bool, 3> axes = {false, false, false};  ///< the axes that are corrected
  std::vector<std::string> remarks = {};             ///< for the program's user, after the first comment
};

/// A change of the corrections.
struct NcShift {
  std::array<bool, 3> axes;            ///< that change
  std::array<double, 3> from_m, to_m;  ///< corrections before and after it, both as_written_m()
  NcModes before;                      ///< in force before it
};

/// A straight motion to an absolute position.
struct NcLine {
  bool rapid;
  std::array<std::optional<double>, 3> to_m;  ///< of the axes to name
  std::string feed;                           ///< such as "F200", or none
  NcModes before;
};

/// What inserted lines have where the program's own have it.
struct NcBlockForm {
  std::optional<std::string> number_letter = {};  ///< before the block number: "N", ""; none: lines need no numbers
  std::string end = {};                           ///< of a block, such as "*"
};

/// Lines that let others apply to one run of a line that runs several times.
struct NcRunCounter {
  std::string zero;         ///< before the first motion of the program
  std::string count;        ///< before the line
  std::string open, close;  ///< around the others
};

/// A language of NC programs. Its control makes one object of it (nc/controls.hpp).
class NcLanguage {
 public:
  virtual ~NcLanguage() = default;

  /// Name in results, such as "Siemens in ISO code (G291)".
  [[nodiscard]] virtual std::string name() const = 0;

  // --- reading

  /// True if the lines are a program in this language.
  [[nodiscard]] virtual bool recognises(const std::vector<std::string>& lines) const = 0;
  /// Runs the program: interprets its words and calls `run`. @throws InputError  as read_nc_program()
  virtual void read(const std::string& path, const std::vector<std::string>& lines, NcExecution& run) const = 0;

  // --- lines of corrections

  /// Lines that change the corrections, in addition to what the operator has set; absolute: that set the offset.
  [[nodiscard]] virtual std::vector<std::string> offset_lines(const NcOffsetOptions& options,
                                                              const NcShift& shift) const = 0;
  /// Lines of a straight motion in any mode. By default in words of ISO 6983: G0, G1, G90, G91.
  [[nodiscard]] virtual std::vector<std::string> straight_lines(const NcLine& line) const;
  /// A comment.
  [[nodiscard]] virtual std::string remark_line(const std::string& text) const = 0;
  /// Lines before the first offset: they stop the program where corrections would go wrong.
  [[nodiscard]] virtual std::vector<std::string> guard_lines(const NcOffsetOptions& /*options*/) const { return {}; }
  [[nodiscard]] virtual NcBlockForm block_form() const { return {}; }
  /// @param line  of the program, from 1; none: no correction may change at a line that runs several times
  [[nodiscard]] virtual std::optional<NcRunCounter> run_counter(std::size_t /*line*/, int /*nth_run*/) const { return {}; }
  [[nodiscard]] bool counts_runs() const { return run_counter(1, 1).has_value(); }

  // --- what forbids corrections

  /// The words that state the unit, such as "G21 or G20".
  [[nodiscard]] virtual std::string unit_words() const = 0;
  /// False: offsets are written in mm, so the program must be in mm.
  [[nodiscard]] virtual bool writes_inches() const { return false; }
  /// True if the program itself sets the shift that corrections are added to.
  [[nodiscard]] virtual bool shares_shift(const std::vector<NcStep>& /*steps*/) const { return false; }
  /// @throws InputError  for a block whose own offsets contradict the options
  virtual void check(const std::vector<NcStep>& /*steps*/, const NcOffsetOptions& /*options*/) const {}
  /// As check(), of a program into which lines are inserted. By default a block that removes corrections must not move.
  /// @param front  the step before which the first offset is inserted
  virtual void check_written(const std::vector<NcStep>& steps, std::size_t front, const NcOffsetOptions& options) const;

  // --- what is said to the user

  /// What absolute corrections overwrite, such as "The base frame".
  [[nodiscard]] virtual std::string offset_name(const NcOffsetOptions& options) const = 0;
  /// Comment at the start of a corrected program: where corrections go that are added.
  [[nodiscard]] virtual std::string remark(const NcOffsetOptions& options) const = 0;
  /// Where corrections are written, and whether such programs have been run on a control.
  [[nodiscard]] virtual std::string advice(bool absolute) const = 0;
};

}  // namespace driftwright
