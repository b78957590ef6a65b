#pragma once
// How well the numbers of an entry of a scenario are known: `known_to: 20 %`, `guess` or `fixed`, for all of them or by name.

#include <map>
#include <string>
#include <vector>

#include "base/config_map.hpp"

namespace driftwright::effects {

/// Standard deviations of logarithms by the name of a number; "": of all others. 0: a number that is taken as it is.
using KnownTo = std::map<std::string, double>;
inline constexpr double kGuess = 0.6931471805599453;  ///< a factor of 2

/// The key `known_to` of an entry with numbers of these names, one at least.
[[nodiscard]] schema::Key known_to_key(const std::vector<std::string>& names);
/// Reads `known_to` of an entry; empty where it does not exist. @param names  of the numbers that may be known roughly
/// @throws InputError  for another word, a share beyond 0.1 % to 200 %, a number that has no such name
[[nodiscard]] KnownTo read_known_to(const ConfigMap& in, const std::vector<std::string>& names);
/// What is said of a number, or how well it is known where nothing is.
[[nodiscard]] double known_to(const KnownTo& said, const std::string& name, double otherwise);
/// As read_known_to() reads it: "20 %", "guess", "fixed", or a map of these.
[[nodiscard]] std::string yaml_of(const KnownTo& said);

}  // namespace driftwright::effects
