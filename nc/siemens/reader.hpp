#pragma once
// Reads programs in the language of Siemens' SINUMERIK 840D, 840D sl, 828D, ONE (language mode G290), for milling. It knows:
//
//   G0 G1 G2 G3 (I J K from the start, I=AC( ), CR=, TURN=), X=AC( ) X=IC( ), G17 G18 G19, G90 G91, G93 G94 G95, F, FB=
//   G70 G71 G700 G710            inch, mm; with G70 and G71 the feed stays in mm, because a metric basic system is assumed
//   G4 F | S                     dwell in seconds, in turns of the spindle
//   S S1= M3 M4 M5 M1=3, SPOS=   the spindle; M6 takes NcSettings::tool_change_s; T D
//   SUPA G53 G153 G74 G75        need NcSettings::machine_zero_m
//   TRANS ATRANS                 shifts of the origin. ROT MIRROR: the path as written, with a note; SCALE is refused
//   G54 ... G57, G505 ... G599, G500 positions count as in the previous one, with a note; G41 G42: as programmed, with a
//   note G331 G332 (K), G63 tapping CYCLE81 82 83 84 85, MCALL drilling; CYCLE83 with its amounts of degression R1=..., DEF
//   REAL A=..., IF GOTOF GOTOB GOTO, IF ELSE ENDIF, WHILE, FOR, LOOP, REPEAT UNTIL, REPEAT A B P=n, REPEATB MSG( ), SETAL(
//   ), STOPRE, SOFT, BRISK, FFWON, COMPCAD, CYCLE832 and the like without effect; M30 M2 M17 RET end
// Everything else is an InputError with its position, unless NcSettings::ignored names it; unknown M words are kept, with a
// note.
// Source: Siemens, SINUMERIK 840D sl / 828D, Programming Manual Fundamentals (6FC5398-1BP40) and Job Planning
// (6FC5398-2BP40).

#include <string>
#include <vector>

#include "nc/execution.hpp"

namespace driftwright {

/// Runs the program. @throws InputError  as read_nc_program()
void run_siemens_program(const std::string& path, const std::vector<std::string>& lines, NcExecution& run);

}  // namespace driftwright
