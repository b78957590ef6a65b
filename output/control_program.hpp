#pragma once
// A formula with its limits as a program in a control's own language. (drift_model_c writes it as C, linuxcnc_component for
// LinuxCNC.)

#include <span>

#include "output/drift_model_files.hpp"

namespace driftwright::output {

/// kStructuredText (IEC 61131-3, for any PLC) and kSiemens (synchronized actions) run in a cycle, and contain lags, trust
/// and slew limit. A program of kHeidenhain or kFanuc runs when an NC program calls it, and knows no time: it contains
/// formulas without lags, their ranges and the clamp.
enum class ControlLanguage { kStructuredText, kSiemens, kHeidenhain, kFanuc };

/// The axis that is corrected.
struct ControlAxis {
  char letter = 'Z';
  /// Siemens: the axis moves against the sign of SD43900 (docs/how-to/table.md, "Sign"); measured on the machine.
  bool against_dk = false;
};

struct ControlProgram {
  std::string file, text;
  /// By which its correction may differ from guarded() [um] while no reading is doubted: constants have as many digits as
  /// the language keeps. 1e-9 with 17 digits.
  double error_um = 0.0;
};

/// The program gives, row by row, what guarded() gives as long as no reading is missing, jumps or contradicts the others:
/// rises from the first row, validity ranges with their loss of trust, terms, lags, fading trust, clamp and slew limit; of
/// kHeidenhain and kFanuc without lags, and trust and correction act at once. It replaces no reading and takes no probings.
/// @param name  of the strategy, from which the names of file and program are made
/// @throws InputError  for what the language cannot hold, with what to use instead: lags and speeds in kHeidenhain and
///                     kFanuc, too many readings or numbers
[[nodiscard]] ControlProgram control_program(const DeployedModel& deployed, ControlLanguage language,
                                             const std::string& name, const ControlAxis& axis, const std::string& made_by);

/// The same for an axis whose correction depends on where it is, in every cycle of the control: kStructuredText has the
/// position as an input, kSiemens writes SD43900, SD43910 and SD43920 by the machine position of the axis.
/// @param places  two or more, by rising position
/// @throws InputError  as above; for kHeidenhain and kFanuc, whose shift is one number for the whole travel; for places
///                     whose rows have different intervals, or of which only some count from the first row
[[nodiscard]] ControlProgram control_program_over_travel(std::span<const PlacedModel> places, ControlLanguage language,
                                                         const std::string& name, const ControlAxis& axis,
                                                         const std::string& made_by);

}  // namespace driftwright::output
