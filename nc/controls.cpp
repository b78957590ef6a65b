#include "nc/controls.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.hpp"

namespace driftwright {

// Each in nc/<key>/control.cpp.
NcControl linuxcnc_control();
NcControl siemens_control();
NcControl heidenhain_control();

const std::vector<NcControl>& nc_controls() {
  static const std::vector<NcControl> controls = {linuxcnc_control(), siemens_control(), heidenhain_control()};
  return controls;
}

const NcControl& nc_control(const std::string& key, const std::vector<NcControl>& known) {
  const auto found = std::find_if(known.begin(), known.end(), [&](const NcControl& c) { return c.key == key; });
  if (found != known.end()) return *found;
  throw InputError(fmt::format("'{}' is no control that is known here; {} are", key,
                               enumerated(of_each_control(&NcControl::key, known), " and ")));
}

std::vector<std::string> of_each_control(std::string NcControl::*word, const std::vector<NcControl>& known) {
  std::vector<std::string> words;
  for (const NcControl& control : known) words.push_back(control.*word);
  return words;
}

std::string enumerated(const std::vector<std::string>& words, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text += (i == 0 ? "" : i + 1 < words.size() ? ", " : last) + words[i];
  return text;
}

}  // namespace driftwright
