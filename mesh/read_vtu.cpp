#include "mesh/read_vtu.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkStringOutputWindow.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "mesh/read_apart.hpp"
#include "mesh/shape.hpp"
#include "mesh/weld_points.hpp"

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

bool is_point_or_line(int type) {
  switch (type) {
    case VTK_EMPTY_CELL:
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
    case VTK_LINE:
    case VTK_POLY_LINE:
    case VTK_QUADRATIC_EDGE:
    case VTK_CUBIC_LINE:
      return true;
    default:
      return false;
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
  /// True if each cell has one integer of acceptable size.
  [[nodiscard]] bool are_sound(vtkIdType n_cells) const {
    if (!exist()) return true;
    if (values_->GetNumberOfComponents() != 1 || values_->GetNumberOfTuples() != n_cells) return false;
    for (vtkIdType c = 0; c < n_cells; ++c) {
      const double value = values_->GetComponent(c, 0);
      if (!(std::abs(value) < 1e9) || value != std::floor(value)) return false;
    }
    return true;
  }
  [[nodiscard]] int of(vtkIdType cell) const { return static_cast<int>(values_->GetComponent(cell, 0)); }
  [[nodiscard]] std::string name(int value) const {
    if (names_ && value >= 0 && value < names_->GetNumberOfValues()) return clean_name(names_->GetValue(value));
    return fmt::format("{}_{}", kind_, value);
  }

 private:
  std::string kind_;
  vtkDataArray* values_;
  vtkStringArray* names_;
};

/// Turns an upside-down wedge, so that its Jacobian becomes positive; true if it did.
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

/// Extracts the sentences from VTK's "ERROR: In vtkXMLDataReader.cxx, line 410\nvtkXMLUnstructuredGridReader (0x55..):
/// sentence\n\n".
std::string reasons(const std::string& messages) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> found;
  std::istringstream lines(messages);
  for (std::string line; std::getline(lines, line) && found.size() < kMost;) {
    if (line.find("ERROR: In ") != std::string::npos || line.find("Warning: In ") != std::string::npos) continue;
    if (const auto object = line.find("): "); object != std::string::npos) line.erase(0, object + 3);
    if (!line.empty() && std::find(found.begin(), found.end(), line) == found.end()) found.push_back(line);
  }
  return fmt::format("{}", fmt::join(found, " "));
}

/// Collects VTK's messages, which would otherwise go to standard error.
class VtkWords {
 public:
  VtkWords() : before_(vtkOutputWindow::GetInstance()) { vtkOutputWindow::SetInstance(words_); }
  ~VtkWords() { vtkOutputWindow::SetInstance(before_); }
  VtkWords(const VtkWords&) = delete;
  VtkWords& operator=(const VtkWords&) = delete;
  [[nodiscard]] std::string text() { return words_->GetOutput(); }

 private:
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkNew<vtkStringOutputWindow> words_;
};

/// Checks all indices into other arrays before VTK uses them.
void require_sound(vtkUnstructuredGrid* grid, const std::function<void(const std::string&)>& fail) {
  const vtkIdType n_points = grid->GetNumberOfPoints(), n_cells = grid->GetNumberOfCells();
  vtkCellArray* cells = grid->GetCells();
  vtkUnsignedCharArray* types = grid->GetCellTypesArray();
  if (!cells || !types || types->GetNumberOfValues() != n_cells || cells->GetNumberOfCells() != n_cells)
    fail(fmt::format("it has {} cells and types of {}; the file is damaged", n_cells,
                     types ? types->GetNumberOfValues() : 0));
  vtkDataArray *offsets = cells->GetOffsetsArray(), *nodes = cells->GetConnectivityArray();
  const auto at = [](vtkDataArray* array, vtkIdType i) { return array->GetComponent(i, 0); };
  const auto n_listed = static_cast<double>(nodes->GetNumberOfValues());
  if (offsets->GetNumberOfValues() != n_cells + 1 || at(offsets, 0) != 0.0 || at(offsets, n_cells) != n_listed)
    fail(fmt::format("the offsets of its {} cells do not divide the {} nodes that are listed; the file is damaged", n_cells,
                     n_listed));
  for (vtkIdType c = 0; c < n_cells; ++c) {
    const double size = at(offsets, c + 1) - at(offsets, c);
    const auto shape = shape_of_vtk(types->GetValue(c));
    if (size < 0.0 || at(offsets, c + 1) > n_listed || (shape && size != n_nodes_of(*shape)))
      fail(fmt::format("cell {}, of VTK's type {}, has {} nodes; the file is damaged", c, types->GetValue(c), size));
    for (auto i = static_cast<vtkIdType>(at(offsets, c)); i < static_cast<vtkIdType>(at(offsets, c + 1)); ++i) {
      if (const double node = at(nodes, i); !(node >= 0.0 && node < static_cast<double>(n_points)))
        fail(fmt::format("cell {} has node {}, and there are nodes 0 to {}", c, node, n_points - 1));
    }
  }
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
    static std::mutex one_at_a_time;  // VTK's output window belongs to the whole process
    const std::lock_guard alone(one_at_a_time);
    VtkWords words;
    const BoundedTime bounded(most_to_read_s(path));
    try {
      reader->Update();
    } catch (const std::length_error&) {
      fail("VTK cannot read it: a count in it cannot be right");
    }
    if (words.text().find("ERROR: In ") != std::string::npos) errors += words.text();  // not for warnings alone
  }
  vtkUnstructuredGrid* grid = reader->GetOutput();
  if (!errors.empty()) fail("VTK cannot read it: " + reasons(errors));
  if (grid->GetNumberOfCells() == 0) fail("VTK finds no unstructured grid with cells in it");

  require_sound(grid, fail);
  raw.coords.resize(3, grid->GetNumberOfPoints());
  for (vtkIdType n = 0; n < grid->GetNumberOfPoints(); ++n) {
    grid->GetPoint(n, raw.coords.col(n).data());
    raw.node_number.push_back(n);
  }
  const Groups region(grid, "region", "region_names"), surface(grid, "surface", "surface_names");
  for (const auto& [groups, name] : {std::pair{&region, "region"}, {&surface, "surface"}}) {
    if (!groups->are_sound(grid->GetNumberOfCells()))
      fail(fmt::format("the cell array '{}' does not hold one whole number below 1e9 for each of the {} cells", name,
                       grid->GetNumberOfCells()));
  }
  std::map<int, int> region_index, surface_index;  // value of the array -> our index
  int n_turned = 0, n_unnamed = 0;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    const int type = grid->GetCellType(c);
    if (is_point_or_line(type)) continue;
    const auto shape = shape_of_vtk(type);
    if (!shape) {
      fail(
          fmt::format("cell {} is of VTK's type {}, which is not computed with; tetrahedra, hexahedra of 8 and 20 nodes and "
                      "wedges of 6 and 15 are",
                      c, type));
    }
    std::vector<int> nodes;
    vtkIdType n_nodes = 0;
    const vtkIdType* node = nullptr;
    grid->GetCellPoints(c, n_nodes, node);
    for (vtkIdType i = 0; i < n_nodes; ++i) nodes.push_back(static_cast<int>(node[i]));
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
  if (n_turned > 0) raw.notes.push_back(fmt::format("{} wedges were upside down and were turned", n_turned));
  if (n_unnamed > 0) raw.notes.push_back(fmt::format("{} 2-D cells without a surface were left out", n_unnamed));
  weld_points(raw);
  return raw;
}

}  // namespace driftwright::mesh
