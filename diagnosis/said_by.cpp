#include "diagnosis/said_by.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace driftwright::diagnosis {
namespace {

using Words = std::set<std::string>;

/// Quantities that a key of the catalogue stands for.
const std::map<std::string, std::vector<StatedQuantity>>& quantities() {
  using enum StatedQuantity;
  static const std::map<std::string, std::vector<StatedQuantity>> map = {{"heat_source", {kHeat}},
                                                                         {"friction_law", {kHeat}},
                                                                         {"heat_window", {kHeat, kSpeed}},
                                                                         {"recorded_drive", {kHeat, kExchange}},
                                                                         {"coolant", {kHeat, kExchange}},
                                                                         {"radiation", {kHeat, kExchange}},
                                                                         {"convection", {kExchange}},
                                                                         {"forced_convection", {kExchange}},
                                                                         {"contact", {kExchange}},
                                                                         {"conductivity", {kExchange}},
                                                                         {"link", {kExchange}},
                                                                         {"exchange_window", {kExchange}},
                                                                         {"heat_capacity", {kCapacity}},
                                                                         {"hidden_body", {kCapacity}},
                                                                         {"sensor_bias", {kReading}},
                                                                         {"sensor_lag", {kReading}},
                                                                         {"sensor_drift", {kReading}},
                                                                         {"sensor_detached", {kReading}},
                                                                         {"sensor_swap", {kReading}},
                                                                         {"sensor_place", {kReading}},
                                                                         {"mount_shift", {kDisplacement}},
                                                                         {"expansion", {kDisplacement}},
                                                                         {"spindle_growth", {kDisplacement}},
                                                                         {"centrifugal", {kDisplacement}},
                                                                         {"displacement_path", {kDisplacement}},
                                                                         {"scale_expansion", {kDisplacement}},
                                                                         {"probe_lag", {kDisplacement}},
                                                                         {"ambient", {kAmbient}},
                                                                         {"stratification", {kAmbient}},
                                                                         {"speed_override", {kSpeed}},
                                                                         {"missing_stop", {kSpeed}},
                                                                         {"clock_offset", {kClock}},
                                                                         {"run_state", {kHeat, kExchange, kSpeed}}};
  return map;
}

Words words_of(const std::string& where) {
  Words words;
  std::istringstream list(where);
  for (std::string name; std::getline(list, name, ',');) {
    if (name != effects::kAmbientName) words.insert(name);
  }
  return words;
}

}  // namespace

bool says(const Statement& s, const std::string& effect, const std::string& where) {
  const auto of = quantities().find(effect);
  if (of == quantities().end() || std::find(of->second.begin(), of->second.end(), s.quantity) == of->second.end())
    return false;
  const bool is_of_all = s.place.front() == "all";
  if (s.quantity == StatedQuantity::kAmbient || s.quantity == StatedQuantity::kClock || s.quantity == StatedQuantity::kSpeed)
    return true;
  if (effect == "run_state") return is_of_all;
  if (is_of_all) return false;
  Words stated(s.place.begin(), s.place.end());
  stated.erase(effects::kAmbientName);
  const Words claimed = words_of(where);
  if (s.quantity == StatedQuantity::kExchange || s.follows == "exchanged")
    return std::includes(stated.begin(), stated.end(), claimed.begin(), claimed.end());
  return std::any_of(claimed.begin(), claimed.end(), [&](const std::string& w) { return stated.contains(w); });
}

const Stated* stated_as(const Posterior& posterior, const std::string& effect, const std::string& where) {
  for (const Stated& s : posterior.stated) {
    if (says(s.says, effect, where)) return &s;
  }
  return nullptr;
}

}  // namespace driftwright::diagnosis
