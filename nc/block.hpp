#pragma once
// The blocks (lines) of an RS-274 program as words: a letter and a number each. What the words mean is in iso_reader.

#include <string>
#include <vector>

#include "base/errors.hpp"

namespace driftwright {

struct NcWord {
  char letter = ' ';  ///< upper case
  double value = 0.0;
  std::string text;       ///< such as "G01", upper case, without blanks
  int column = 1;         ///< counts from one
  bool certain = true;    ///< false: known only at the machine
  bool computed = false;  ///< of a parameter or expression
};

struct NcBlock {
  std::vector<NcWord> words;  ///< without the number N of the block
  Where where;                ///< of its first word

  [[nodiscard]] Where at(const NcWord& word) const;
};

}  // namespace driftwright
