#include "mesh/read_vtu.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>

#include "base/errors.hpp"
#include "mesh/shape.hpp"

namespace driftwright::mesh {
namespace {

std::optional<CellShape> shape_of_vtk(int type) {
  switch (type) {
    case VTK_TRIANGLE:
      return CellShape::kTri3;
    case VTK_QUADRATIC_TRIANGLE:
      return CellShape::kTri6;
    case VTK_QUAD:
      return CellShape::kQuad4;
    case VTK_QUADRATIC_QUAD:
      return CellShape::kQuad8;
    case VTK_TETRA:
      return CellShape::kTet4;
    case VTK_QUADRATIC_TETRA:
      return CellShape::kTet10;
    case VTK_HEXAHEDRON:
      return CellShape::kHex8;
    case VTK_QUADRATIC_HEXAHEDRON:
      return CellShape::kHex20;
    case VTK_WEDGE:
      return CellShape::kWedge6;
    case VTK_QUADRATIC_WEDGE:
      return CellShape::kWedge15;
    default:
      return std::nullopt;
  }
}

/// Names of an integer cell array's values: entry i of `names`, or else <kind>_<i>.
class Groups {
 public:
  Groups(vtkUnstructuredGrid* grid, const char* array, const char* names)
      : kind_(array),
        values_(grid->GetCellData()->GetArray(array)),
        names_(vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray(names))) {}
  [[nodiscard]] bool exist() const { return values_ != nullptr; }
  [[nodiscard]] int of(vtkIdType cell) const { return static_cast<int>(values_->GetTuple1(cell)); }
  [[nodiscard]] std::string name(int value) const {
    if (names_ && value >= 0 && value < names_->GetNumberOfValues()) return names_->GetValue(value);
    return fmt::format("{}_{}", kind_, value);
  }

 private:
  std::string kind_;
  vtkDataArray* values_;
  vtkStringArray* names_;
};

/// Turns a wedge that stands on its head into one with a positive Jacobian; true if it did.
bool turn_wedge(const RawMesh& raw, CellShape shape, std::vector<int>& nodes) {
  Eigen::Matrix3Xd x(3, nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) x.col(static_cast<Eigen::Index>(i)) = raw.coords.col(nodes[i]);
  if (!(jacobian(shape_values(shape, {1.0 / 3, 1.0 / 3, 0.5}), x, shape).det < 0.0)) return false;
  std::swap(nodes[1], nodes[2]);
  std::swap(nodes[4], nodes[5]);
  if (shape == CellShape::kWedge15) {
    std::swap(nodes[6], nodes[8]);
    std::swap(nodes[9], nodes[11]);
    std::swap(nodes[13], nodes[14]);
  }
  return true;
}

void append_text(vtkObject*, unsigned long, void* text, void* message) {
  *static_cast<std::string*>(text) += static_cast<const char*>(message);
}

}  // namespace

RawMesh read_vtu(const std::string& path) {
  RawMesh raw;
  raw.path = path;
  const auto fail = [&](const std::string& message) { throw InputError(path + ": " + message); };
  std::string errors;
  vtkNew<vtkCallbackCommand> on_error;
  on_error->SetCallback(append_text);
  on_error->SetClientData(&errors);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->AddObserver("ErrorEvent", on_error);
  reader->SetReaderErrorObserver(on_error);
  reader->SetParserErrorObserver(on_error);
  reader->SetFileName(path.c_str());
  {
    static std::mutex one_at_a_time;  // the switch is the whole process's
    const std::lock_guard alone(one_at_a_time);
    vtkObject::GlobalWarningDisplayOff();  // VTK would print what goes into our message
    reader->Update();
    vtkObject::GlobalWarningDisplayOn();
  }
  vtkUnstructuredGrid* grid = reader->GetOutput();
  if (!errors.empty()) fail("VTK cannot read it: " + errors.substr(0, errors.find('\n')));
  if (grid->GetNumberOfCells() == 0) fail("VTK finds no unstructured grid with cells in it");

  raw.coords.resize(3, grid->GetNumberOfPoints());
  for (vtkIdType n = 0; n < grid->GetNumberOfPoints(); ++n) {
    grid->GetPoint(n, raw.coords.col(n).data());
    raw.node_number.push_back(n);
  }
  const Groups region(grid, "region", "region_names"), surface(grid, "surface", "surface_names");
  std::map<int, int> region_index, surface_index;  // value of the array -> our index
  int n_turned = 0, n_unnamed = 0;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    vtkCell* cell = grid->GetCell(c);
    if (cell->GetCellDimension() < 2) continue;
    const auto shape = shape_of_vtk(grid->GetCellType(c));
    if (!shape) {
      fail(
          fmt::format("cell {} is of VTK's type {}, which is not computed with; tetrahedra, hexahedra of 8 and 20 nodes and "
                      "wedges of 6 and 15 are",
                      c, grid->GetCellType(c)));
    }
    std::vector<int> nodes;
    for (int i = 0; i < cell->GetNumberOfPoints(); ++i) nodes.push_back(static_cast<int>(cell->GetPointId(i)));
    if (dimension_of(*shape) == 2) {
      if (!surface.exist() || surface.of(c) < 0) {
        ++n_unnamed;
        continue;
      }
      const auto [index, is_new] = surface_index.try_emplace(surface.of(c), static_cast<int>(raw.facet_surfaces.size()));
      if (is_new) raw.facet_surfaces.push_back({surface.name(surface.of(c)), {}, {}});
      RawMesh::FacetSurface& of = raw.facet_surfaces[index->second];
      of.corners.emplace_back(nodes.begin(), nodes.begin() + n_corners_of(*shape));
      of.number.push_back(c);
      continue;
    }
    if (n_corners_of(*shape) == 6) n_turned += turn_wedge(raw, *shape, nodes);
    const auto [index, is_new] =
        region_index.try_emplace(region.exist() ? region.of(c) : 0, static_cast<int>(raw.regions.size()));
    if (is_new) {
      raw.regions.push_back(region.exist() ? region.name(region.of(c)) : std::filesystem::path(path).stem().string());
    }
    raw.cells.add(*shape, nodes, index->second);
    raw.cell_number.push_back(c);
  }
  if (n_turned > 0) raw.notes.push_back(fmt::format("{} wedges stood on their heads and were turned", n_turned));
  if (n_unnamed > 0) raw.notes.push_back(fmt::format("{} 2-D cells without a surface were left out", n_unnamed));
  return raw;
}

}  // namespace driftwright::mesh
