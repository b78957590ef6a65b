#pragma once
// Reads programs in the DIN/ISO language of Heidenhain's controls (iTNC 530, TNC 320, 620, 640), for milling. It knows:
//
//   %NAME G71 *  ...  N99 %NAME G71 *   G70 inch, G71 mm; ; comments, '*' at the end of blocks
//   G00 G01 G02 G03 G05 G06 (I J the pole, absolute in G90; R) G10 G11 G12 G13 G15 G16 polar: R, H, about the pole; G29 the
//   pole here G17 G18 G19 G20, T1 G17 S500 the tool's axis and the tool; G99 T1 L R, G30 G31, G51 without effect G90 G91
//   (from their place in the block on), G40 G41 G42 G43 G44 G04 F dwell in seconds G54 G53 G28 G73 G72 G247 G36 G62 datum
//   shift, datum table, mirror, rotation, scale (1 alone), preset, orientation, tolerance G200 201 202 203 206 207 240, G79,
//   M89, M99 drilling, boring, tapping, centring with their Q parameters G98 L1, L1,0, L1,3, Q1 = ..., D00 to D13 labels,
//   subprograms, repetitions, Q parameters, jumps G24 G25 G26 G27 counted as programmed, with a note
// Everything else is an InputError with its line; unknown M words are kept, with a note.
// Source: Heidenhain, iTNC 530 User's Manual DIN/ISO Programming (606497-2x) and TNC 640 User's Manual DIN/ISO Programming
// (892909-2x).

#include <string>
#include <vector>

#include "nc/execution.hpp"

namespace driftwright {

/// Runs the program. @throws InputError  as read_nc_program()
void run_heidenhain_program(const std::string& path, const std::vector<std::string>& lines, NcExecution& run);

}  // namespace driftwright
