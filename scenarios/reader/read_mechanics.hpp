#pragma once
// Reads `supports:` and `joints:`: the connections of the machine to the ground and of its parts to each other.

#include "base/config_map.hpp"
#include "solver/mechanics.hpp"

namespace driftwright::scenarios {

/// A support, with its line in the file.
struct SupportEntry {
  solver::Support support;
  Where where;
};

/// A joint's mechanics, with the line of its name.
struct JointEntry {
  solver::JointMechanics mechanics;
  Where where;
};

/// The schemas of an entry of `supports` and of `joints`.
[[nodiscard]] schema::Map support_schema();
[[nodiscard]] schema::Map joint_schema();

/// {surface, fixed: [x, y, z]}, {surface, sliding: true}, {surface, springs: [kx, ky, kz]}; at least one of the three.
/// @throws InputError
[[nodiscard]] SupportEntry read_support(const ConfigMap& in);

/// {name, mechanics: tied | sliding | none}, {name, normal_stiffness, tangential_stiffness} or
/// {name, axis, axial_stiffness, radial_stiffness}. @throws InputError
[[nodiscard]] JointEntry read_joint(const ConfigMap& in);

}  // namespace driftwright::scenarios
