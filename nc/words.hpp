#pragma once
// The G and M words that the program knows, and the words of one block as they are used up.

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "nc/block.hpp"

namespace driftwright {

/// The number of a G or M word times ten: G5.1 is 51.
using NcCode = int;

/// Name of a word: "G5.1" for ('G', 51).
[[nodiscard]] std::string nc_word_name(char letter, NcCode code);

/// The number P of a work offset: 1 for G54 ... 9 for G59.3.
[[nodiscard]] int work_offset_number(NcCode system);

/// The code in `codes` that belongs to that group of G words (such as "motion").
[[nodiscard]] std::optional<NcCode> of_group(const std::vector<NcCode>& codes, const std::string& group);

/// G73, G81 to G89.
[[nodiscard]] bool is_canned_cycle(NcCode g);

[[nodiscard]] bool contains(const std::vector<NcCode>& codes, NcCode code);

/// The words of a block, with a mark on each used one. The block must outlive it.
class NcWords {
 public:
  /// @throws InputError  for a letter other than G and M that occurs twice
  explicit NcWords(const NcBlock& block);

  /// True if there is an unused word of that letter, or of one of those letters.
  [[nodiscard]] bool has(char letter) const { return find(letter) < used_.size(); }
  [[nodiscard]] bool has_any(const std::string& letters) const;
  /// Takes an unused word's value and marks it as used.
  std::optional<double> take(char letter);
  /// True if an unused word's value is known before the program runs; true without such a word.
  [[nodiscard]] bool certain(char letter) const;
  /// Marks all unused words of those letters as used.
  void take_all(const std::string& letters);
  /// As take(), for a word that exists. @throws InputError for a value below zero; for one that is not a count from 1 to
  /// 100000
  double take_not_negative(char letter);
  int take_count(char letter);
  /// G or M codes in their order, all used now; those of `ignored` are left out, and with them the words P Q R L E. So are M
  /// codes that are not known here: unknown() has them.
  /// @throws InputError  for a G code that is not known here, with a hint, for two of one group, and for G80 beside a canned
  /// cycle
  std::vector<NcCode> take_codes(char letter, const std::set<std::string>& ignored);
  [[nodiscard]] const std::vector<std::string>& unknown() const { return unknown_; }
  /// @throws InputError  for the first unused word
  void reject_unused() const;

 private:
  [[noreturn]] void fail(std::size_t i, const std::string& message) const;
  [[nodiscard]] std::size_t find(char letter) const;
  const NcBlock& block_;
  std::vector<bool> used_;
  std::string pardoned_;
  std::vector<std::string> unknown_;
};

}  // namespace driftwright
