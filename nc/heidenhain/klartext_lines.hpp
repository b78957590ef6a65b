#pragma once
// Splits programs in Heidenhain's plain language into blocks, and path blocks into words, without interpreting them.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "nc/heidenhain/execution.hpp"

namespace driftwright {

/// True if the lines are a program in this language.
[[nodiscard]] bool is_klartext(const std::vector<std::string>& lines);

/// Splits the lines into blocks: lines that end with '~' continue, and CYCL DEF 7.1 belongs to 7.0.
[[nodiscard]] std::vector<HeidenhainLine> klartext_blocks(const std::string& path, const std::vector<std::string>& lines);

/// The words after the first word of a path block.
struct KlartextPath {
  std::array<std::optional<double>, 3> at = {}, by = {};  ///< X and IX, as written
  std::optional<double> pr, pa, ipr, ipa, radius, length, angle, mb;
  std::optional<bool> clockwise;
  bool rapid = false, automatic = false, mb_max = false;
  std::optional<double> feed;
  std::optional<char> side;  ///< '0', 'L', 'R'
  std::vector<int> m;
  bool plain = true;
  std::string feed_word;
};

/// The words of a path block from text[i] on. @throws InputError  for text that is not a word, for an axis named twice
[[nodiscard]] KlartextPath klartext_path(const HeidenhainExecution& tnc, const HeidenhainLine& line, std::size_t i);

}  // namespace driftwright
