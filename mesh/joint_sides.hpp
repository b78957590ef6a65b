#pragma once
// Sides of joints on which bodies slide or turn, and bodies moved on them.

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesh/motion.hpp"
#include "mesh/pick_surfaces.hpp"

namespace driftwright::mesh {

/// Largest sine between a face of a guide and the way along it. Ends of a facet of a turned guide rise by half its angle:
/// sin(180/n degrees) for n facets around, less than this from n = 32 on. A face across the way has 1.
inline constexpr double kMostRise = 0.1;

/// Adds to both sides of a joint the outer faces of their own regions that continue them along a way: the whole guide on
/// which one body slides or turns on the other. A face continues a side if one of the side's faces, moved along the way,
/// covers the centre of the face, with the same normal. Faces that the way crosses are not continued.
/// @param outer  described_outer_faces(mesh)
void continue_sides(Mesh& mesh, const Joint& joint, std::span<const DescribedFacet> outer, const Way& way);

/// The regions whose faces a surface consists of, each once.
[[nodiscard]] std::vector<int> regions_of_surface(const Mesh& mesh, const std::string& surface,
                                                  std::span<const DescribedFacet> outer);

/// Moves the nodes of each region. @param motions  of each region; regions that share nodes must have the same
/// @returns  two regions that share nodes and have different motions; nothing is moved then
[[nodiscard]] std::optional<std::pair<int, int>> move_regions(Mesh& mesh, const std::vector<Motion>& motions);

}  // namespace driftwright::mesh
