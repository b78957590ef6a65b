#pragma once
// A block (line) of an RS-274 program as a list of words, each a letter and a number. iso_reader interprets the words.

#include <string>
#include <vector>

#include "base/errors.hpp"

namespace driftwright {

struct NcWord {
  char letter = ' ';  ///< upper case
  double value = 0.0;
  std::string text;       ///< such as "G01", upper case, without blanks
  int column = 1;         ///< counts from one
  bool certain = true;    ///< false: the value is known only at the machine
  bool computed = false;  ///< the value comes from a parameter or expression
};

struct NcBlock {
  std::vector<NcWord> words;  ///< without the number N of the block
  Where where;                ///< position of its first word

  [[nodiscard]] Where at(const NcWord& word) const;
};

}  // namespace driftwright
