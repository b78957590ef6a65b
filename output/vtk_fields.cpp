#include "output/vtk_fields.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <limits>
#include <stdexcept>

namespace driftwright::output {
namespace {

/// Adds a named array of the given type, replacing one of that name, and returns it to be filled.
template <typename Array>
Array* add_array(vtkFieldData* data, const char* name, int n_components, vtkIdType n_tuples) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(n_components);
  array->SetNumberOfTuples(n_tuples);
  data->AddArray(array);
  return array;  // kept alive by `data`
}

void add_names(vtkUnstructuredGrid* grid, const char* array, const std::vector<std::string>& names) {
  auto* strings = add_array<vtkStringArray>(grid->GetFieldData(), array, 1, static_cast<vtkIdType>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) strings->SetValue(static_cast<vtkIdType>(i), names[i]);
}

void add_cells(const mesh::Cells& cells, vtkUnstructuredGrid* grid) {
  for (int c = 0; c < cells.size(); ++c) {
    const auto nodes = cells.nodes(c);
    const std::vector<vtkIdType> ids(nodes.begin(), nodes.end());
    grid->InsertNextCell(vtk_cell_type(cells.shape[c]), static_cast<vtkIdType>(ids.size()), ids.data());
  }
}

/// Points, cells and regions of a mesh, without fields. With facets, these follow the cells as 2-D cells of region -1.
void build_grid(const mesh::Mesh& mesh, bool with_facets, vtkUnstructuredGrid* grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.n_nodes());
  for (int n = 0; n < mesh.n_nodes(); ++n) points->SetPoint(n, mesh.coords.col(n).data());
  grid->SetPoints(points);

  const int n_facets = with_facets ? mesh.facets.size() : 0;
  grid->AllocateExact(mesh.cells.size() + n_facets,
                      static_cast<vtkIdType>(mesh.cells.node.size() + mesh.facets.node.size()));
  add_cells(mesh.cells, grid);
  if (n_facets > 0) add_cells(mesh.facets, grid);

  auto* region = add_array<vtkIntArray>(grid->GetCellData(), "region", 1, mesh.cells.size() + n_facets);
  region->FillValue(-1);
  for (int c = 0; c < mesh.cells.size(); ++c) region->SetValue(c, mesh.cells.group[c]);
  add_names(grid, "region_names", mesh.regions);
  if (n_facets > 0) {
    auto* surface = add_array<vtkIntArray>(grid->GetCellData(), "surface", 1, mesh.cells.size() + n_facets);
    surface->FillValue(-1);
    for (int f = 0; f < n_facets; ++f) surface->SetValue(mesh.cells.size() + f, mesh.facets.group[f]);
    add_names(grid, "surface_names", mesh.surfaces);
  }
}

/// Writes to memory first, so that writing to disk is checked in one place.
void write_grid(vtkUnstructuredGrid* grid, const std::filesystem::path& file) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  writer->SetHeaderTypeToUInt64();
  writer->WriteToOutputStringOn();
  if (writer->Write() != 1) throw std::runtime_error(fmt::format("VTK could not make '{}'", file.string()));
  write_file(file, writer->GetOutputString());
}

class VtuWriter : public FieldWriter {
 public:
  VtuWriter(ResultsFolder& folder, const mesh::Mesh& mesh) : folder_(folder) {
    build_grid(mesh, false, grid_);
    const Provenance& made_by = folder.made_by();
    add_array<vtkStringArray>(grid_->GetFieldData(), "made_by", 1, 1)
        ->SetValue(0, fmt::format("Driftwright {}, {}", made_by.version, made_by.scenario));
  }

  std::string file_to_open() const override { return "fields.pvd"; }

  void write(std::size_t i, double time_s, const Eigen::VectorXd& temperature_degC, const Eigen::Matrix3Xd& displacement_um,
             const StressField* stress) override {
    vtkUnstructuredGrid* grid = grid_;
    const vtkIdType n_nodes = grid->GetNumberOfPoints();
    auto* temperature = add_array<vtkFloatArray>(grid->GetPointData(), "temperature_degC", 1, n_nodes);
    auto* displacement = add_array<vtkFloatArray>(grid->GetPointData(), "displacement_um", 3, n_nodes);
    for (vtkIdType n = 0; n < n_nodes; ++n) {
      temperature->SetValue(n, static_cast<float>(temperature_degC[n]));
      displacement->SetTuple(n, displacement_um.col(n).data());
    }
    if (stress) {
      auto* components = add_array<vtkFloatArray>(grid->GetPointData(), "stress_MPa", 6, n_nodes);
      int c = 0;
      for (const char* name : {"XX", "YY", "ZZ", "XY", "YZ", "XZ"}) components->SetComponentName(c++, name);
      auto* von_mises = add_array<vtkFloatArray>(grid->GetPointData(), "von_mises_MPa", 1, n_nodes);
      for (vtkIdType n = 0; n < n_nodes; ++n) {
        components->SetTuple(n, stress->stress_MPa.col(n).data());
        von_mises->SetValue(n, static_cast<float>(stress->von_mises_MPa[n]));
      }
    }
    add_array<vtkDoubleArray>(grid->GetFieldData(), "TimeValue", 1, 1)->SetValue(0, time_s);
    write_grid(grid, folder_.path(fmt::format("fields/fields_{:04}.vtu", i)));
  }

  void finish(const std::vector<double>& times_s) override {
    std::vector<std::string> files;
    for (std::size_t i = 0; i < times_s.size(); ++i) files.push_back(fmt::format("fields/fields_{:04}.vtu", i));
    folder_.write_text("fields.pvd", pvd_text(times_s, files));
  }

 private:
  ResultsFolder& folder_;
  vtkNew<vtkUnstructuredGrid> grid_;
};

}  // namespace

int vtk_cell_type(mesh::CellShape shape) {
  switch (shape) {
    case mesh::CellShape::kTri3:
      return VTK_TRIANGLE;
    case mesh::CellShape::kTri6:
      return VTK_QUADRATIC_TRIANGLE;
    case mesh::CellShape::kTet4:
      return VTK_TETRA;
    case mesh::CellShape::kTet10:
      return VTK_QUADRATIC_TETRA;
    case mesh::CellShape::kQuad4:
      return VTK_QUAD;
    case mesh::CellShape::kQuad8:
      return VTK_QUADRATIC_QUAD;
    case mesh::CellShape::kHex8:
      return VTK_HEXAHEDRON;
    case mesh::CellShape::kHex20:
      return VTK_QUADRATIC_HEXAHEDRON;
    case mesh::CellShape::kWedge6:
      return VTK_WEDGE;
    case mesh::CellShape::kWedge15:
      return VTK_QUADRATIC_WEDGE;
  }
  throw std::logic_error("a cell shape without a VTK type");
}

std::unique_ptr<FieldWriter> make_vtu_writer(ResultsFolder& folder, const mesh::Mesh& mesh) {
  return std::make_unique<VtuWriter>(folder, mesh);
}

void write_mesh(const mesh::Mesh& mesh, std::span<const double> quality, const std::filesystem::path& file,
                std::span<const FacetField> fields) {
  vtkNew<vtkUnstructuredGrid> grid;
  build_grid(mesh, true, grid);
  if (!quality.empty()) {
    if (quality.size() != static_cast<std::size_t>(mesh.cells.size())) {
      throw std::logic_error(fmt::format("{} qualities for {} cells", quality.size(), mesh.cells.size()));
    }
    auto* array = add_array<vtkFloatArray>(grid->GetCellData(), "quality", 1, grid->GetNumberOfCells());
    array->FillValue(std::numeric_limits<float>::quiet_NaN());
    for (int c = 0; c < mesh.cells.size(); ++c) array->SetValue(c, static_cast<float>(quality[c]));
  }
  for (const FacetField& field : fields) {
    if (field.value.size() != static_cast<std::size_t>(mesh.facets.size()))
      throw std::logic_error(fmt::format("{}: {} values for {} facets", field.name, field.value.size(), mesh.facets.size()));
    auto* array = add_array<vtkFloatArray>(grid->GetCellData(), field.name.c_str(), 1, grid->GetNumberOfCells());
    array->FillValue(std::numeric_limits<float>::quiet_NaN());
    for (int f = 0; f < mesh.facets.size(); ++f)
      array->SetValue(mesh.cells.size() + f, static_cast<float>(field.value[static_cast<std::size_t>(f)]));
  }
  write_grid(grid, file);
}

void write_region_fields(const mesh::Mesh& mesh, std::span<const RegionField> fields, const std::filesystem::path& file) {
  vtkNew<vtkUnstructuredGrid> grid;
  build_grid(mesh, false, grid);
  for (const RegionField& f : fields) {
    if (f.value.size() != mesh.regions.size())
      throw std::logic_error(fmt::format("{}: {} values for {} regions", f.name, f.value.size(), mesh.regions.size()));
    auto* array = add_array<vtkFloatArray>(grid->GetCellData(), f.name.c_str(), 1, grid->GetNumberOfCells());
    for (int c = 0; c < mesh.cells.size(); ++c)
      array->SetValue(c, static_cast<float>(f.value[static_cast<std::size_t>(mesh.cells.group[c])]));
  }
  write_grid(grid, file);
}

void write_point_grid(const std::vector<int>& n, const Eigen::Matrix3Xd& place_m, std::span<const PointVectors> vectors,
                      double time_s, const std::filesystem::path& file) {
  std::vector<std::pair<int, int>> directions;  // number of points, and distance of neighbours in their list
  int n_points = 1;
  for (const int of_direction : n) {
    if (of_direction > 1) directions.emplace_back(of_direction, n_points);
    n_points *= of_direction;
  }
  if (place_m.cols() != n_points)
    throw std::logic_error(fmt::format("{} points for a grid of {}", place_m.cols(), n_points));
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(n_points);
  for (int i = 0; i < n_points; ++i) points->SetPoint(i, place_m.col(i).data());
  grid->SetPoints(points);
  const std::size_t dimension = directions.size() > 3 ? 0 : directions.size();
  constexpr int kTypes[] = {VTK_VERTEX, VTK_LINE, VTK_QUAD, VTK_HEXAHEDRON};
  for (int i = 0; i < n_points; ++i) {
    std::vector<vtkIdType> corners = {i};
    bool is_inside = true;  // a cell begins here
    for (std::size_t d = 0; d < dimension; ++d) {
      const auto& [of_direction, step] = directions[d];
      is_inside = is_inside && (i / step) % of_direction + 1 < of_direction;
      const std::size_t n_corners = corners.size();
      for (std::size_t c = 0; c < n_corners; ++c) corners.push_back(corners[c] + step);
    }
    for (std::size_t c = 2; dimension >= 2 && c < corners.size(); c += 4)
      std::swap(corners[c], corners[c + 1]);  // around a face
    if (is_inside) grid->InsertNextCell(kTypes[dimension], static_cast<vtkIdType>(corners.size()), corners.data());
  }
  for (const PointVectors& v : vectors) {
    if (v.value.cols() != n_points) throw std::logic_error(fmt::format("{}: {} vectors", v.name, v.value.cols()));
    auto* array = add_array<vtkFloatArray>(grid->GetPointData(), v.name.c_str(), 3, n_points);
    for (int i = 0; i < n_points; ++i) array->SetTuple(i, v.value.col(i).data());
  }
  add_array<vtkDoubleArray>(grid->GetFieldData(), "TimeValue", 1, 1)->SetValue(0, time_s);
  write_grid(grid, file);
}

std::string pvd_text(const std::vector<double>& times_s, const std::vector<std::string>& files) {
  std::string pvd = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n";
  for (std::size_t i = 0; i < times_s.size(); ++i)
    pvd += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", times_s[i], files[i]);
  return pvd + "  </Collection>\n</VTKFile>\n";
}

}  // namespace driftwright::output
