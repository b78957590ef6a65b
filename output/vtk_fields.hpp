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

/// A vector at each point.
struct PointVectors {
  std::string name;  ///< of the point array, with its unit
  Eigen::Matrix3Xd value;
};
/// Writes the points of a grid with vectors: hexahedra, quadrilaterals or lines between neighbours where at most three of
/// the counts are above one, single points otherwise.
/// @param n       number of points along each direction of the grid; the first changes fastest
/// @param place_m 3 x n_points
/// @param file    a path from ResultsFolder::path()
/// @throws std::logic_error  when the counts do not fit @throws InputError  when the file cannot be written
void write_point_grid(const std::vector<int>& n, const Eigen::Matrix3Xd& place_m, std::span<const PointVectors> vectors,
                      double time_s, const std::filesystem::path& file);

/// Text of a .pvd file that lists files with their times [s].
[[nodiscard]] std::string pvd_text(const std::vector<double>& times_s, const std::vector<std::string>& files);

}  // namespace driftwright::output
