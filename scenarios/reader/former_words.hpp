#pragma once
// Words of scenarios of earlier releases: `hall`, the air around the machine, is now called `ambient` everywhere. The former word is read for one
// release more, with a note that says what to write instead.

#include <string>
#include <vector>

#include "base/config_tree.hpp"

namespace driftwright::scenarios {

/// A former word and what is written now.
struct FormerWord {
  Where where;
  std::string present;  ///< as it is to be written there, such as "to: ambient"
};

/// The tree of a scenario, or of a map with its list `effects` alone, in present words. @param found  gets each former word
/// @throws InputError  where a scenario has the former key beside the present one
[[nodiscard]] ConfigNodePtr in_present_words(const ConfigNodePtr& root, std::vector<FormerWord>& found);

/// read_config_tree() of a scenario's file in present words, with a note on standard error for each former one.
[[nodiscard]] ConfigNodePtr read_scenario_tree(const std::string& path);

/// An address in a scenario (base/config_address.hpp) in present words, with such a note.
[[nodiscard]] std::string address_in_present_words(const std::string& address, const Where& where);
/// A value that a study puts at an address, likewise.
[[nodiscard]] ConfigNodePtr value_in_present_words(const ConfigNodePtr& value, const std::string& address);

/// The name of a body or of an exchange in a file that an earlier release wrote.
[[nodiscard]] std::string name_in_present_words(std::string name);

}  // namespace driftwright::scenarios
