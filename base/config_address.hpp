#pragma once
// Finds a value in a tree by an address as a person writes it.
//
//     ambient[0][1]                                     entries of lists by number, from zero, as error messages count
//     machine.column.wall                            keys of maps
//     effects[bearing_friction@spindle].load         entries of lists by the words that name them
//
// The words that name an entry are its values of type, name, region, surface, joint, node, tank and to; `@` joins several
// words where one is not unique. A key may contain dots: the longest matching key is used.

#include <string>
#include <vector>

#include "base/config_tree.hpp"

namespace driftwright {

/// Indices into ConfigNode::items, from the root on.
using ConfigSteps = std::vector<std::size_t>;

/// @param asked  position where the address is written, for messages
/// @throws InputError  at `asked`, when a key or entry does not exist or several entries match; the message lists what
///                     exists and the nearest name
[[nodiscard]] ConfigSteps find_address(const ConfigNode& root, const std::string& address, const Where& asked);

}  // namespace driftwright
