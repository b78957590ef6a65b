#pragma once
// The lines of an RS-274 program before they are run.

#include <string>
#include <vector>

#include "nc/block.hpp"

namespace driftwright {

struct IsoLine {
  enum Kind {
    kBlock,     ///< words with numbers: `block` has them
    kComputed,  ///< words with parameters or expressions
    kFlow,      ///< an O word
    kPercent,
  };
  Kind kind = kBlock;
  Where where = {};
  std::string text = {};          ///< upper case, without blanks, comments and block number
  std::vector<int> columns = {};  ///< of each of its characters, from 1, and behind them
  NcBlock block = {};
  std::string label = {};    ///< of an O word: "100", "<NAME>"; "" where it is computed
  std::string keyword = {};  ///< "SUB", "IF" ...; "" for a number alone
  std::size_t rest = 0;      ///< where in `text` the label (computed) or what follows the keyword begins
};

/// All that hold something; behind the second '%' there are none.
/// @throws InputError  file, line and column: for a file that cannot be opened, a '(' without ')', a letter without a number
/// Source: LinuxCNC documentation, "G-code Overview", Format of a line, Numbers, Comments, File requirements.
[[nodiscard]] std::vector<IsoLine> read_iso_lines(const std::string& path);

/// The words of a line from text[at], where numbers alone stand behind the letters. @throws InputError
[[nodiscard]] std::vector<NcWord> plain_words(const IsoLine& line);

}  // namespace driftwright
