#include <fmt/format.h>

#include <filesystem>

#include "app/film_fields.hpp"
#include "app/results.hpp"
#include "base/delimited_text.hpp"
#include "base/file_name.hpp"
#include "findings/mesh_convergence_document.hpp"
#include "findings/scenario_document.hpp"
#include "mesh/quality.hpp"
#include "mesh/unnamed_geometry.hpp"
#include "scenarios/reader/geometry.hpp"
#include "studies/prediction.hpp"

namespace driftwright::app {
namespace {

/// Reads a mesh or a drawing alone, without a scenario.
mesh::Mesh read_file(const MeshOptions& options) {
  mesh::UnnamedGeometry read = mesh::read_unnamed_geometry(options.scenario, options.units);
  if (read.unit_is_a_guess) {
    read.mesh.notes.push_back(
        fmt::format("lengths are taken to be in {}, by the size of the machine; --units says another unit", read.unit));
  }
  return std::move(read.mesh);
}

scenarios::Geometry geometry_of(const MeshOptions& options, bool is_file) {
  if (is_file) return {clean_name(std::filesystem::path(options.scenario).stem().string()), {}};
  if (!options.units.empty())
    throw InputError(
        "--units is allowed only with a mesh file; a scenario says the unit of its mesh itself (`machine: units`)");
  scenarios::Geometry geometry = scenarios::read_geometry(options.scenario);
  if (std::holds_alternative<scenarios::LumpedMachine>(geometry.machine.mesh))
    throw InputError(geometry.machine.where, "a lumped machine has no mesh");
  return geometry;
}

void show_convergence(const MeshOptions& options) {
  if (mesh::is_geometry_file(options.scenario))
    throw InputError(
        fmt::format("--convergence runs a cyclogram of a machine, so it needs a scenario; '{}' is a mesh or a drawing. "
                    "`driftwright init` writes a scenario of it",
                    clean_name(options.scenario)));
  const scenarios::Scenario scenario = read_scenario(options);
  (void)scenarios::require_machine(scenario, "mesh --convergence");
  if (options.cyclogram.empty() && scenario.cyclograms.empty())
    throw InputError("The scenario has no cyclogram. --convergence needs one: name a record CSV with --cyclogram");
  const Cyclogram cyclogram =
      options.cyclogram.empty() ? scenario.cyclograms.front() : studies::named_cyclogram(scenario, options.cyclogram);
  output::ResultsFolder folder = open_results(options, scenario.name);
  Progress progress(options.quiet);
  const studies::MeshConvergence found =
      studies::mesh_convergence(scenario, cyclogram, options.most_elements, progress.listener());
  finish(findings::document_of(found, scenario, folder.made_by()), folder, progress, options);
}

}  // namespace

void mesh(const MeshOptions& options) {
  if (options.convergence) return show_convergence(options);
  const bool is_file = mesh::is_geometry_file(options.scenario);
  const scenarios::Geometry geometry = geometry_of(options, is_file);
  output::ResultsFolder folder = open_results(options, file_name(geometry.name, ""));
  Progress progress(options.quiet);
  progress.begin("meshing");
  const mesh::Mesh mesh = is_file ? read_file(options) : scenarios::build_mesh(geometry.machine.mesh);
  const std::vector<scenarios::MappedFilm> films = scenarios::mapped_films(geometry.machine.effects, mesh);
  output::write_mesh(mesh, mesh::scaled_jacobians(mesh), folder.path("mesh.vtu"), facet_fields(films));
  finish(findings::mesh_document(geometry.name, geometry.machine, mesh, films, folder.made_by()), folder, progress, options);
}

}  // namespace driftwright::app
