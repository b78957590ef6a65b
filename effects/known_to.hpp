#pragma once
// How well the numbers of a scenario entry are known: `known_to: 20 %`, `guess` or `fixed`, for all of them or by name.

#include <map>
#include <string>
#include <vector>

#include "base/config_map.hpp"

namespace driftwright::effects {

/// Standard deviations of logarithms by the name of a number; "" for all others. 0: the number is not fitted.
using KnownTo = std::map<std::string, double>;
inline constexpr double kGuess = 0.6931471805599453;  ///< standard deviation for `guess`: ln 2, a factor of 2

/// The schema of the key `known_to` of an entry with numbers of these names; none: of names that the entry declares.
[[nodiscard]] schema::Key known_to_key(const std::vector<std::string>& names);
/// Reads `known_to` of an entry; empty if the key is missing. @param names  of the numbers that may be uncertain
/// @throws InputError  for another word, a share outside 0.1 % to 200 %, a name that is not in `names`
[[nodiscard]] KnownTo read_known_to(const ConfigMap& in, const std::vector<std::string>& names);
/// The standard deviation given for a number, or `otherwise` if none is given.
[[nodiscard]] double known_to(const KnownTo& said, const std::string& name, double otherwise);
/// The YAML text that read_known_to() reads: "20 %", "guess", "fixed", or a map of these.
[[nodiscard]] std::string yaml_of(const KnownTo& said);

}  // namespace driftwright::effects
