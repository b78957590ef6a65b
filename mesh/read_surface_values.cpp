#include "mesh/read_surface_values.hpp"

#include <fmt/format.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDataSetReader.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <filesystem>
#include <mutex>
#include <new>
#include <stdexcept>

#include "base/errors.hpp"

namespace driftwright::mesh {
namespace {

/// Corners of a face of VTK's type; 0: no face.
vtkIdType n_corners_of_face(int type, vtkIdType n_points) {
  switch (type) {
    case VTK_TRIANGLE:
    case VTK_QUADRATIC_TRIANGLE:
      return 3;
    case VTK_QUAD:
    case VTK_QUADRATIC_QUAD:
    case VTK_BIQUADRATIC_QUAD:
      return 4;
    case VTK_POLYGON:
      return n_points;
    default:
      return 0;
  }
}

template <class Reader>
vtkSmartPointer<vtkDataSet> read_with(const std::string& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

vtkSmartPointer<vtkDataSet> read_data_set(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".vtp") return read_with<vtkXMLPolyDataReader>(path);
  if (extension == ".vtu") return read_with<vtkXMLUnstructuredGridReader>(path);
  return read_with<vtkDataSetReader>(path);
}

}  // namespace

SurfaceValues read_surface_values(const std::string& path) {
  const auto fail = [&](const std::string& message) { throw InputError(path + ": " + message); };
  vtkSmartPointer<vtkDataSet> data;
  std::string said;
  {
    static std::mutex one_at_a_time;  // VTK's output window belongs to the whole process
    const std::lock_guard alone(one_at_a_time);
    const vtkSmartPointer<vtkOutputWindow> before = vtkOutputWindow::GetInstance();
    const vtkNew<vtkStringOutputWindow> words;
    vtkOutputWindow::SetInstance(words);
    try {
      data = read_data_set(path);
    } catch (const std::length_error&) {
      said = "ERROR: In ";
    } catch (const std::bad_alloc&) {
      said = "ERROR: In ";
    }
    said += words->GetOutput();
    vtkOutputWindow::SetInstance(before);
  }
  if (!data || said.find("ERROR: In ") != std::string::npos) fail("VTK cannot read it; the file is damaged, or no VTK file");

  SurfaceValues values;
  std::vector<vtkIdType> cells;
  std::vector<std::vector<vtkIdType>> corners;
  const vtkIdType n_points = data->GetNumberOfPoints();
  const vtkNew<vtkIdList> ids;
  vtkIdType n_corners = 0;
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c) {
    data->GetCellPoints(c, ids);
    const vtkIdType n = n_corners_of_face(data->GetCellType(c), ids->GetNumberOfIds());
    if (n < 3) continue;
    if (ids->GetNumberOfIds() < n) fail(fmt::format("cell {} has {} points; the file is damaged", c, ids->GetNumberOfIds()));
    cells.push_back(c);
    corners.emplace_back();
    for (vtkIdType i = 0; i < n; ++i) {
      const vtkIdType point = ids->GetId(i);
      if (point < 0 || point >= n_points)
        fail(fmt::format("cell {} has point {}, and there are points 0 to {}", c, point, n_points - 1));
      corners.back().push_back(point);
    }
    n_corners += n;
    values.corner_from.push_back(static_cast<int>(n_corners));
  }
  if (cells.empty()) fail("it has no faces (triangles, quadrilaterals or polygons)");
  values.corner.resize(3, n_corners);
  Eigen::Index column = 0;
  for (const auto& of_face : corners) {
    for (const vtkIdType point : of_face) data->GetPoint(point, values.corner.col(column++).data());
  }
  for (int a = 0; a < data->GetPointData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = data->GetPointData()->GetArray(a);
    if (!array || !array->GetName() || array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != n_points)
      continue;
    std::vector<double>& of_faces = values.arrays[array->GetName()];
    for (const auto& of_face : corners) {
      double sum = 0.0;
      for (const vtkIdType point : of_face) sum += array->GetComponent(point, 0);
      of_faces.push_back(sum / static_cast<double>(of_face.size()));
    }
  }
  for (int a = 0; a < data->GetCellData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = data->GetCellData()->GetArray(a);
    if (!array || !array->GetName() || array->GetNumberOfComponents() != 1 ||
        array->GetNumberOfTuples() != data->GetNumberOfCells())
      continue;
    std::vector<double>& of_faces = values.arrays[array->GetName()];
    of_faces.clear();
    for (const vtkIdType c : cells) of_faces.push_back(array->GetComponent(c, 0));
  }
  return values;
}

}  // namespace driftwright::mesh
