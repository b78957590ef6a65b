#pragma once
// Films of files as arrays on the faces of a mesh, for ParaView.

#include <vector>

#include "machine/model.hpp"
#include "output/results_folder.hpp"
#include "output/vtk_fields.hpp"

namespace driftwright::app {

/// Film coefficients `h_W_m2K` and air temperatures `T_air_degC` of the faces, one array a state: `_at_3000_rpm`,
/// `_at_20_min`. NaN where no file has a value.
[[nodiscard]] std::vector<output::FacetField> facet_fields(const std::vector<scenarios::MappedFilm>& films);

/// Writes these arrays into films.vtu, beside the fields of a run. A machine whose films are of no file has none. A reduced
/// machine has no faces, so its mesh is made again.
/// @param model  of the machine
void write_films(const scenarios::MachineModel& model, const scenarios::Model& machine, output::ResultsFolder& folder);

}  // namespace driftwright::app
