#pragma once
// Lines of Siemens programs and their words, before they mean anything.

#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"

namespace driftwright {

struct SiemensLine {
  Where where = {};
  std::string text = {};    ///< without its comment; as long as it was in front, so that columns are those of the file
  std::size_t begin = 0;    ///< behind block number, '/' and label
  std::string label = {};   ///< upper case
  std::string number = {};  ///< such as "N100"
  bool deletable = false;   ///< '/'
  /// IF: its ELSE or ENDIF; ELSE: ENDIF; WHILE, FOR, LOOP, REPEAT: the line that closes it; and that one: the one that opens it.
  std::size_t partner = 0;
};

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

/// The lines that hold something. @throws InputError  for a loop or branch that is not closed
[[nodiscard]] std::vector<SiemensLine> siemens_lines(const std::string& path, const std::vector<std::string>& text);

/// @throws InputError  for what is no word
[[nodiscard]] std::vector<SiemensWord> siemens_words(const SiemensLine& line);

/// The name that begins at text[at], upper case, or ""; `at` then stands behind it.
[[nodiscard]] std::string siemens_name(const std::string& text, std::size_t& at);

[[nodiscard]] bool is_r_parameter(const std::string& name);

/// Arguments of a call and their columns.
[[nodiscard]] std::vector<std::pair<std::string, std::size_t>> siemens_arguments(const SiemensWord& call);

}  // namespace driftwright
