#pragma once
// The roles of a record's columns: drives of the machine, ambient, thermometers and displacements.

#include <span>
#include <string>
#include <vector>

#include "base/record.hpp"

namespace driftwright::identification {

inline constexpr std::size_t kFewestRows = 30;  ///< of a record from which something is learned

/// The role of each column.
struct RecordRoles {
  std::string speed;                       ///< channel in rpm, or ""
  std::vector<std::string> drives;         ///< other channels that may drive: powers, switches, valves
  std::string ambient;                     ///< channel in degC, or ""
  std::vector<std::string> thermometers;   ///< in degC, or in K (rises); without the ambient
  std::vector<std::string> displacements;  ///< in um
  std::vector<std::string> guesses;        ///< sentences: assumptions, and columns that are not used
};

/// What the user says about the roles.
struct RoleHints {
  std::string ambient;              ///< "": guessed
  std::vector<std::string> drives;  ///< in addition to those that are recognised by their unit
};

/// Finds the roles of the channels that all records have. In rpm: the speed. In degC: thermometers. The ambient is the one
/// of them whose name contains one of the words ambient, room, hall, outdoor, environment, surroundings; else, as a guess,
/// the one that follows the drives least, if it follows them by less than half. In K: rises of thermometers. In um:
/// displacements. In W, V, percent, count, 1, W_m2, mm_min: drives. A spindle that turns at one speed all the time counts as
/// switched on in the first row.
/// @throws InputError  without a drive that changes, without a thermometer or displacement, for a hint that is not in all
///                     records, records with too few rows, and names that are not allowed in scenarios
[[nodiscard]] RecordRoles record_roles(std::span<const Record> records, const RoleHints& hints);

}  // namespace driftwright::identification
