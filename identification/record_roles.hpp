#pragma once
// Which columns of records drive the machine, which is its ambient, which are thermometers and displacements.

#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::identification {

struct RecordRoles {
  std::string speed;                       ///< channel in rpm, or ""
  std::vector<std::string> drives;         ///< other channels that may drive: powers, switches, valves
  std::string ambient;                     ///< channel in degC, or ""
  std::vector<std::string> thermometers;   ///< in degC, or in K: rises; without the ambient
  std::vector<std::string> displacements;  ///< in um
  std::vector<std::string> guesses;        ///< sentences: what nobody said, and what takes no part
};

/// What the user says of it.
struct RoleHints {
  std::string ambient;              ///< "": guessed
  std::vector<std::string> drives;  ///< beside those whose unit makes them one
};

/// Channels that all records have. In rpm: the speed. In degC: thermometers; of these the ambient is the one that says so by its name (a word of it: ambient, room, hall, outdoor, environment, surroundings),
/// else the one that follows the drives least, a guess, if it follows them by less than half. In K: rises of thermometers. In um: displacements. In W, V, percent, count, 1, W_m2, mm_min: drives.
/// A spindle that turns at one speed all the time counts as switched on in the first row.
/// @throws InputError  without a drive that changes, without a thermometer or displacement, for a hint that not all records have, records with too few rows, and names that no scenario can hold
[[nodiscard]] RecordRoles record_roles(std::span<const Record> records, const RoleHints& hints);

}  // namespace driftwright::identification
