#pragma once
// Meshes and fields as VTK's XML files: compressed .vtu, and a .pvd that lists them with their times.

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "output/field_series.hpp"

namespace driftwright::output {

/// Writes fields as one file fields/fields_<0000...>.vtu per time, each with the mesh, and fields.pvd. Field arrays of
/// each file: `region_names`, `TimeValue` [s] and `made_by`. Callers use FieldSeries.
[[nodiscard]] std::unique_ptr<FieldWriter> make_vtu_writer(ResultsFolder& folder, const mesh::Mesh& mesh);

/// One number per facet.
struct FacetField {
  std::string name;           ///< of the cell array, with its unit
  std::vector<double> value;  ///< in the order of Mesh::facets; NaN: none
};

/// Writes a mesh without fields: cell arrays `region` and `quality` [-], field array `region_names`; then its facets as
/// 2-D cells with the cell array `surface` (-1 on cells) and the field array `surface_names`, including sides of joints,
/// so that mesh::read_vtu() reads the same mesh again. Facets have region -1 and quality NaN.
/// @param quality  one value per cell, or empty to leave the array out
/// @param fields   further cell arrays, NaN on cells
/// @param file     a path from ResultsFolder::path()
/// @throws std::logic_error    when `quality` or a field has another length
/// @throws InputError  when the file cannot be written
void write_mesh(const mesh::Mesh& mesh, std::span<const double> quality, const std::filesystem::path& file,
                std::span<const FacetField> fields = {});

/// VTK's number of a shape, such as 24 of a quadratic tetrahedron.
[[nodiscard]] int vtk_cell_type(mesh::CellShape shape);

/// One number per region.
struct RegionField {
  std::string name;           ///< of the cell array, with its unit
  std::vector<double> value;  ///< in the order of Mesh::regions
};
/// Writes a mesh with numbers of its regions as cell arrays, beside `region` and the field array `region_names`.
/// @param file  a path from ResultsFolder::path()
/// @throws std::logic_error  when a field has another length than there are regions
/// @throws InputError  when the file cannot be written
void write_region_fields(const mesh::Mesh& mesh, std::span<const RegionField> fields, const std::filesystem::path& file);

}  // namespace driftwright::output
