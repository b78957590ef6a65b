#pragma once
// Finds a value in a tree by an address as a person writes it.
//
//     ambient[0][1]                                     entries of lists by number, from zero, as error messages count
//     machine.column.wall                            keys of maps
//     effects[bearing_friction@spindle].load         entries of lists by the words that name them
//
// The words that name an entry are its values of type, name, region, surface, joint, node, tank and to; `@` joins several where
// one does not single it out. A key may hold dots: the longest key that fits is taken.

#include <string>
#include <vector>

#include "base/config_tree.hpp"

namespace driftwright {

/// Indices into ConfigNode::items, from the root on.
using ConfigSteps = std::vector<std::size_t>;

/// @param asked  where the address stands, for messages
/// @throws InputError  at `asked`, with what there is instead and the nearest of it, when a key or entry does not exist or
///                     several entries carry the words
[[nodiscard]] ConfigSteps find_address(const ConfigNode& root, const std::string& address, const Where& asked);

}  // namespace driftwright
