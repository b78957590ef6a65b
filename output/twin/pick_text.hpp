#pragma once
// Places on a mesh as a scenario writes them.

#include <string>

#include "mesh/pickable_faces.hpp"

namespace driftwright::output {

/// A name as YAML: in quotes where it could be read as something else.
[[nodiscard]] std::string yaml_word(const std::string& name);

/// The keys of an entry of `machine: surfaces` that pick the face, after its name: "region: column, plane: {through: [0 mm,
/// 0 mm, 300 mm], normal: [0, 0, 1]}". Numbers are written with the digits that PickableFace has.
[[nodiscard]] std::string pick_text(const std::string& region, const mesh::FacePick& pick);

/// Its shape in words: "plane, normal [0, 0, 1]".
[[nodiscard]] std::string pick_words(const mesh::FacePick& pick);

}  // namespace driftwright::output
