#pragma once
// Reads programs in Heidenhain's plain language (iTNC 530, TNC 320, 620, 640), for milling. It knows:
//
//   BEGIN PGM NAME MM | INCH, END PGM, BLK FORM, TOOL DEF, ; comments, * structure
//   TOOL CALL 5 Z S2500 F500     takes NcSettings::tool_change_s if it names a tool; without one it sets the speed
//   L X+10 IY-5 R0 F500 M3       FMAX, F AUTO, RL, RR; LP PR PA; several M words
//   CC, C DR+, CP IPA+720 IZ-5 DR-, CR R+5, CT, CTP    arcs and helices; RND, CHF: counted as programmed, with a note
//   APPR, DEP                    counted as a straight line at the feed, with a note
//   CYCL DEF 7 8 9 10 11 13 26 32 247   datum, mirror, dwell, rotation, scale (1 alone), orientation, tolerance, preset
//   CYCL DEF 200 201 202 203 206 207 240, CYCL CALL, CYCL CALL POS, M89, M99   drilling, boring, tapping, centring
//   LBL 1, CALL LBL 1, CALL LBL 1 REP3, Q1 = ..., FN 0 to 13   subprograms, repetitions, Q parameters, jumps
//   STOP, M0 M1 M2 M30; M91 and M140 MB MAX need NcSettings::machine_zero_m
// Everything else is an InputError with its line; unknown M words are kept, with a note.
// Source: Heidenhain, TNC 640 User's Manual Klartext Programming (892903-2x) and Cycle Programming (892905-2x); iTNC 530
// likewise (606493-2x).

#include <string>
#include <vector>

#include "nc/execution.hpp"

namespace driftwright {

/// Runs the program. @throws InputError  as read_nc_program()
void run_klartext_program(const std::string& path, const std::vector<std::string>& lines, NcExecution& run);

}  // namespace driftwright
