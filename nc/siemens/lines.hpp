#pragma once
// Splits Siemens programs into lines and words, without interpreting them.

#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"

namespace driftwright {

/// One line.
struct SiemensLine {
  Where where = {};
  std::string text = {};   ///< without its comment, but with all characters before it, so that columns are those of the file
  std::size_t begin = 0;   ///< index after block number, '/' and label
  std::string label = {};  ///< upper case
  std::string number = {};  ///< such as "N100"
  bool deletable = false;   ///< '/'
  /// Index of a related line. IF: its ELSE or ENDIF; ELSE: ENDIF; WHILE, FOR, LOOP, REPEAT: the closing line; a closing
  /// line: the opening one.
  std::size_t partner = 0;
};

/// One word.
struct SiemensWord {
  enum Kind { kNumber, kAssignment, kCall, kKeyword };  // X10; X=..., R1=...; CYCLE81(...); TRANS
  Kind kind = kNumber;
  std::string name = {};   ///< upper case: "X", "S1", "CR", "CYCLE81", "MCALL CYCLE81"
  std::string value = {};  ///< digits, expression, or arguments without their brackets
  std::string mode = {};   ///< of X=IC(...): "IC"
  std::string text = {};   ///< as written
  std::size_t column = 0;  ///< of the value, from 0

  [[nodiscard]] double number() const;
};

/// @throws InputError  at that column of the line, from 0
[[noreturn]] void fail_at(const SiemensLine& line, std::size_t column, const std::string& message);

/// The lines that are not empty. @throws InputError  for a loop or branch that is not closed
[[nodiscard]] std::vector<SiemensLine> siemens_lines(const std::string& path, const std::vector<std::string>& text);

/// The words of a line. @throws InputError  for text that is not a word
[[nodiscard]] std::vector<SiemensWord> siemens_words(const SiemensLine& line);

/// The name that begins at text[at], upper case, or ""; `at` is then the index after it.
[[nodiscard]] std::string siemens_name(const std::string& text, std::size_t& at);

[[nodiscard]] bool is_r_parameter(const std::string& name);

/// The arguments of a call and their columns.
[[nodiscard]] std::vector<std::pair<std::string, std::size_t>> siemens_arguments(const SiemensWord& call);

}  // namespace driftwright
