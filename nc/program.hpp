#pragma once
// Reads an NC program: the spindle speeds and axis travels that it commands over time.
//
// nc/siemens/ and nc/heidenhain/ describe the languages of Siemens and Heidenhain. The words of
// RS-274 (ISO 6983) below are used as the LinuxCNC documentation ("G-Codes", "M-Codes", "O Codes", "G-code Overview")
// defines them unless noted; the order of execution within a block is also LinuxCNC's:
//   G0 G1 G2 G3 (I J K or R, P turns)       straight lines and arcs; the feed applies along the path, helix included
//   G4 P | X | U                            dwell: P in NcSettings::dwell_P_s, X and U in seconds (Fanuc)
//   G10 L2 L20, G52 G92 G92.1 G92.2 shifts of the origin; G54 ... G59.3: without known offsets, positions count as in the
//                                           previous one, with a note (known from NcSettings::parameters, G10 L2)
//   G17 G18 G19  G20 G21  G90 G91  G90.1 G91.1   planes, inch and mm, absolute and incremental. G20 and G21 apply to their
//                                           whole block, F included (LinuxCNC would read F before)
//   G28 G30 G53                             need NcSettings::machine_zero_m: G28 and G30 end at it, G53 counts from it
//   G38.2 G38.3 G38.4 G38.5                 as if the probe touched at the end of its way, with a note
//   G73 G81 G82 G83 G84 G85 G80 G98 G99     canned cycles (nc/drilling.hpp); Z R Q P hold within an unbroken series. G80 may
//                                           be in one block with another motion word but a cycle's, which is then the motion
//   G93 G94 G95, F, S, T                    each of the three forgets the feed before it
//   M0 M1 M60  M2 M30                       halt without time; end
//   M3 M4 M5 M19                            spindle. S alone does not turn it; M3 at S0 waits for an S. M19 stops it
//   M6                                      takes NcSettings::tool_change_s; no spindle turns during and after it, until
//                                           the next M3 or M4 (one in the same block counts: it comes after the change)
//   M98 M99, O words, #parameters, [ ]      nc/iso_source.hpp
// Without effect on times and speeds: D H T, G40 G43 G49 G61 G61.1 G64 (P Q) G67 G69 G97 G15, G50 G50.1 (Fanuc, and Siemens
// in ISO code) in a block without words for them, G54 first in the program, G10 L1 L10 L11, M7 M8 M9 M48 M49. Without
// effect, with a note: G41 G42 (the path is counted along the programmed contour) and M words that are not known here. Every
// other G word is an InputError, unless NcSettings::ignored names it. At the start: axes at 0 of the program, G17 G21 G90
// G91.1 G94 G98 (LinuxCNC starts with G99), no motion word, no feed, spindle at rest.

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "nc/controls.hpp"
#include "nc/limits.hpp"
#include "nc/step.hpp"

namespace driftwright {

/// Data of the machine and control that the program text does not contain.
struct NcSettings {
  std::optional<double> rapid_m_s;      ///< rapid speed along the line; compulsory for programs with rapids
  std::optional<double> tool_change_s;  ///< time of M6; compulsory for programs with M6
  double dwell_P_s = 1.0;               ///< duration of P1 with G4 and in canned cycles [s]: 1, or 1e-3 as on Fanuc
  std::optional<std::array<double, 3>> machine_zero_m;  ///< in the coordinates of the program
  std::set<std::string> ignored;                        ///< G and M words to ignore, with their P Q R L E, such as "M88"
  std::string control = "linuxcnc";                     ///< key of the control whose language the program uses
  /// Numbered parameters that the machine holds, such as 5221 of G54 in mm (LinuxCNC).
  std::map<int, double> parameters = {};
  std::optional<NcLimits> limits = {};  ///< of the axes; none: all speeds are as programmed
};

/// A program as executed.
struct NcProgram {
  std::vector<NcMove> moves;
  std::vector<NcStep> steps;             ///< its blocks in order of execution; the last one ends it
  std::vector<std::string> notes;        ///< words that were ignored and might matter, with their lines
  const NcLanguage* language = nullptr;  ///< that it is in; null only before it is read

  [[nodiscard]] double duration_s() const;
};

/// Reads a program in the first language of its control that recognises it.
/// @param controls  that are known; the program keeps pointers to their languages
/// @throws InputError  file, line, column: for a word that is unknown, refused, unused in its block or in conflict with
///                     another, for a move that cannot be timed, for a program without end (M2, M30 or '%'); without place
///                     for a control that is not known, for a program in none of its languages
[[nodiscard]] NcProgram read_nc_program(const std::string& path, const NcSettings& settings,
                                        const std::vector<NcControl>& controls = nc_controls());

}  // namespace driftwright
