#pragma once
// The controls whose NC programs are known, each with its languages.

#include <string>
#include <vector>

#include "nc/language.hpp"

namespace driftwright {

/// The controls of one maker.
struct NcControl {
  std::string key;           ///< in scenarios and options, such as "siemens"
  std::string title;         ///< such as "Siemens"
  std::string about;         ///< its languages, such as "DIN/ISO or plain language"
  bool named_words = false;  ///< words and calls may have names, such as SHOPTOOL
  /// The first that recognises a program reads it. The objects live as long as the program runs.
  std::vector<const NcLanguage*> languages;
};

/// All of them; the first is the default of scenarios.
[[nodiscard]] const std::vector<NcControl>& nc_controls();

/// The control with that key. @throws InputError  for a key that no control has
[[nodiscard]] const NcControl& nc_control(const std::string& key, const std::vector<NcControl>& known = nc_controls());

/// One word of each control, such as &NcControl::key.
[[nodiscard]] std::vector<std::string> of_each_control(std::string NcControl::*word,
                                                       const std::vector<NcControl>& known = nc_controls());

/// Words of a sentence: "a, b or c". @param last  between the last two, such as " or "
[[nodiscard]] std::string enumerated(const std::vector<std::string>& words, const std::string& last);

}  // namespace driftwright
