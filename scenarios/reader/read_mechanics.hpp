#pragma once
// Reads `supports:` and `joints:`: what holds the machine to the ground and its parts to each other.

#include "base/config_map.hpp"
#include "solver/mechanics.hpp"

namespace driftwright::scenarios {

/// A support with where it stands in the file.
struct SupportEntry {
  solver::Support support;
  Where where;
};

/// A joint's mechanics with where its name stands.
struct JointEntry {
  solver::JointMechanics mechanics;
  Where where;
};

/// What an entry of `supports` and one of `joints` may hold.
[[nodiscard]] schema::Map support_schema();
[[nodiscard]] schema::Map joint_schema();

/// {surface, fixed: [x, y, z]}, {surface, sliding: true}, {surface, springs: [kx, ky, kz]}; at least one of the three.
/// @throws InputError
[[nodiscard]] SupportEntry read_support(const ConfigMap& in);

/// {name, mechanics: tied | sliding | none}, {name, normal_stiffness, tangential_stiffness} or
/// {name, axis, axial_stiffness, radial_stiffness}. @throws InputError
[[nodiscard]] JointEntry read_joint(const ConfigMap& in);

}  // namespace driftwright::scenarios
