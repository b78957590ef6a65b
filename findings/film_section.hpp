#pragma once
// Films of files, as they lie on the mesh: a table and a picture of each.

#include <span>

#include "machine/mapped_films.hpp"
#include "output/document.hpp"

namespace driftwright::findings {

/// Nothing for a machine without such films. The picture shows the state with the largest film, grey where the file has
/// none.
void add_films(output::Section& section, std::span<const scenarios::MappedFilm> films, const mesh::Mesh& mesh);

}  // namespace driftwright::findings
