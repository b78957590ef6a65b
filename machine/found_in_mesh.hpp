#pragma once
// Whether what a scenario names is in its mesh, and effects are where they may be. Every function throws InputError at the
// place in the scenario, with the names that there are.

#include <string>
#include <vector>

#include "effects/effect.hpp"
#include "mesh/mesh.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::scenarios {

/// @param what  is named, such as "region"
void must_be_one_of(const Where& where, const std::string& what, const std::string& name,
                    const std::vector<std::string>& known);

/// Surfaces that may have films: not the sides of joints.
[[nodiscard]] std::vector<std::string> outer_surfaces(const mesh::Mesh& mesh);
[[nodiscard]] std::vector<std::string> joint_names(const mesh::Mesh& mesh);

/// Films and supports must be outside: a surface must not contain a facet between two cells.
void require_outside(const mesh::Mesh& mesh, const std::string& surface, const Where& where);

/// Places and references of all effects, pairs that exclude each other, and a contact for each joint.
void check_effects(const MachineModel& model, const mesh::Mesh& mesh, const effects::HeatBalance& balance);

/// The bodies of a displacement by sensitivities: regions and lumped nodes.
void check_bodies(const BySensitivity& by, const mesh::Mesh& mesh, const effects::HeatBalance& balance);

}  // namespace driftwright::scenarios
