#pragma once
// Words of scenarios of earlier releases: `hall`, the air around the machine, is now called `ambient` everywhere. The
// former word is still read in this release, with a note that says what to write instead.

#include <string>
#include <vector>

#include "base/config_tree.hpp"

namespace driftwright::scenarios {

/// A former word and its replacement.
struct FormerWord {
  Where where;
  std::string present;  ///< the text to write there, such as "to: ambient"
};

/// The tree of a scenario, or of a map with only its list `effects`, with present words. @param found  receives each
/// former word
/// @throws InputError  if a scenario has both the former and the present key
[[nodiscard]] ConfigNodePtr in_present_words(const ConfigNodePtr& root, std::vector<FormerWord>& found);

/// read_config_tree() of a scenario's file with present words; prints a note to standard error for each former word.
[[nodiscard]] ConfigNodePtr read_scenario_tree(const std::string& path);

/// An address in a scenario (base/config_address.hpp) with present words, and such notes.
[[nodiscard]] std::string address_in_present_words(const std::string& address, const Where& where);
/// A value that a study sets at an address, likewise.
[[nodiscard]] ConfigNodePtr value_in_present_words(const ConfigNodePtr& value, const std::string& address);

/// The name of a body or of an exchange in a file that an earlier release wrote.
[[nodiscard]] std::string name_in_present_words(std::string name);

}  // namespace driftwright::scenarios
