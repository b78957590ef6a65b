#pragma once
// The blocks (lines) of an NC program as words: a letter and a number each. What the words mean is in nc_program.

#include <string>
#include <vector>

#include "base/errors.hpp"

namespace driftwright {

struct NcWord {
  char letter = ' ';  ///< upper case
  double value = 0.0;
  std::string text;  ///< such as "G01", upper case, without blanks
  int column = 1;    ///< counts from one
};

struct NcBlock {
  std::vector<NcWord> words;  ///< without the number N of the block
  Where where;                ///< of its first word

  [[nodiscard]] Where at(const NcWord& word) const;
};

/// Reads an NC program (RS-274) into blocks; lines without words make none.
///
/// Comments stand in ( ) or follow a semicolon. Letters may be small, blanks may stand anywhere outside a comment. A '%' on
/// a line of its own before any word starts the program, the next one ends it. The number of a program (O1234 alone on its
/// line) and the block delete character '/' in the first place are skipped: such a block is read, as with the switch off.
/// @throws InputError  file, line and column: for a file that cannot be opened, a '(' without ')', a letter without a number
///                     and for what would need computing: parameters '#', expressions '[ ]', O words with more to them
/// Source: LinuxCNC documentation, "G-code Overview", Format of a line, Numbers, Comments, File requirements.
[[nodiscard]] std::vector<NcBlock> read_nc_blocks(const std::string& path);

}  // namespace driftwright
