#pragma once
// Splits an RS-274 program into lines, before it is run.

#include <string>
#include <vector>

#include "nc/block.hpp"

namespace driftwright {

/// One line with its kind.
struct IsoLine {
  enum Kind {
    kBlock,     ///< words with plain numbers, in `block`
    kComputed,  ///< words with parameters or expressions
    kFlow,      ///< an O word
    kPercent,
  };
  Kind kind = kBlock;
  Where where = {};
  std::string text = {};          ///< upper case, without blanks, comments and block number
  std::vector<int> columns = {};  ///< column of each of its characters and of the end, from 1
  NcBlock block = {};
  std::string label = {};    ///< of an O word: "100", "<NAME>"; "" if computed
  std::string keyword = {};  ///< "SUB", "IF" ...; "" for a number without keyword
  std::size_t rest = 0;      ///< index in `text` where the computed label, or the part after the keyword, begins
};

/// All lines of a text that are not empty, up to the second '%'.
/// @throws InputError  file, line and column: for a '(' without ')', a letter without a number
/// Source: LinuxCNC documentation, "G-code Overview", Format of a line, Numbers, Comments, File requirements.
[[nodiscard]] std::vector<IsoLine> read_iso_lines(const std::string& path, const std::vector<std::string>& texts);

/// The words of a line from text[at] on, where all values are plain numbers. @throws InputError
[[nodiscard]] std::vector<NcWord> plain_words(const IsoLine& line);

}  // namespace driftwright
