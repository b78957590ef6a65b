#include "output/vtk_fields.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <array>
#include <fstream>
#include <sstream>

#include "mesh/topology.hpp"
#include "output/field_series.hpp"

namespace driftwright::output::vtk_fields_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr, ::testing::ThrowsMessage;

/// A quadratic tetrahedron on a linear one; 11 nodes.
mesh::Mesh two_tetrahedra() {
  mesh::Mesh m;
  m.coords.resize(3, 11);
  m.coords << 0, 1, 0, 0, .5, .5, 0, 0, .5, 0, 0,  //
      0, 0, 1, 0, 0, .5, .5, 0, 0, .5, 0,          //
      0, 0, 0, 1, 0, 0, 0, .5, .5, .5, -1. / 3;
  m.regions = {"column", "spindle_housing"};
  m.cells.add(mesh::CellShape::kTet10, std::array{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, 1);
  m.cells.add(mesh::CellShape::kTet4, std::array{0, 2, 1, 10}, 0);
  return m;
}

class VtkFieldsTest : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove_all(out_); }

  void write_two_times(const fs::path& target) {
    ResultsFolder folder(target, false, {.version = "1.2.3", .scenario = "a.yaml"});
    FieldSeries series(folder, mesh_);
    series.write(0.0, Eigen::VectorXd::Constant(11, 20.0), Eigen::Matrix3Xd::Zero(3, 11));
    series.write(90.5, temperature_degC_, displacement_um_);
    series.finish();
    folder.commit();
  }
  static std::string read(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }

  const fs::path out_ = fs::path(::testing::TempDir()) / ("vtk_fields_test-" + std::to_string(getpid()));
  const mesh::Mesh mesh_ = two_tetrahedra();
  const Eigen::VectorXd temperature_degC_ = Eigen::VectorXd::LinSpaced(11, 20.0, 31.5);
  const Eigen::Matrix3Xd displacement_um_ =
      Eigen::Matrix3Xd::NullaryExpr(3, 11, [](auto i, auto j) { return i - 0.25 * j; });
};

TEST_F(VtkFieldsTest, FieldsReadBackAsWritten) {
  write_two_times(out_);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((out_ / "fields/fields_0001.vtu").c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();

  ASSERT_EQ(grid->GetNumberOfPoints(), 11);
  ASSERT_EQ(grid->GetNumberOfCells(), 2);
  EXPECT_EQ(grid->GetPoint(10)[2], -1. / 3);  // coordinates keep 64 bits
  EXPECT_EQ(grid->GetCellType(0), VTK_QUADRATIC_TETRA);
  EXPECT_EQ(grid->GetCellType(1), VTK_TETRA);
  EXPECT_EQ(grid->GetCell(0)->GetPointId(9), 9);
  EXPECT_EQ(grid->GetCell(1)->GetPointId(1), 2);

  vtkDataArray* temperature = grid->GetPointData()->GetArray("temperature_degC");
  vtkDataArray* displacement = grid->GetPointData()->GetArray("displacement_um");
  ASSERT_TRUE(temperature != nullptr && displacement != nullptr);
  ASSERT_EQ(displacement->GetNumberOfComponents(), 3);
  for (int n = 0; n < 11; ++n) {
    EXPECT_FLOAT_EQ(temperature->GetTuple1(n), temperature_degC_[n]);  // 32 bits in the file
    for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(displacement->GetComponent(n, i), displacement_um_(i, n));
  }
}

TEST_F(VtkFieldsTest, EveryCellIsWrittenAsItsVtkTypeWithItsNodesInOrder) {
  const std::vector<std::pair<mesh::CellShape, int>> shapes = {
      {mesh::CellShape::kHex8, VTK_HEXAHEDRON}, {mesh::CellShape::kHex20, VTK_QUADRATIC_HEXAHEDRON},
      {mesh::CellShape::kWedge6, VTK_WEDGE},    {mesh::CellShape::kWedge15, VTK_QUADRATIC_WEDGE},
      {mesh::CellShape::kTet4, VTK_TETRA},      {mesh::CellShape::kTet10, VTK_QUADRATIC_TETRA}};
  mesh::Mesh m;
  m.regions = {"body"};
  for (const auto& [shape, type] : shapes) {
    const auto xi = mesh::reference_nodes(shape);
    std::vector<int> nodes;
    for (const Eigen::Vector3d& x : xi) {
      nodes.push_back(m.n_nodes());
      m.coords.conservativeResize(3, m.n_nodes() + 1);
      m.coords.rightCols<1>() = x;
    }
    m.cells.add(shape, nodes, 0);
  }
  ResultsFolder folder(out_, false, {});
  const fs::path file = folder.path("mesh.vtu");
  write_mesh(m, {}, file);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  for (int c = 0; c < m.cells.size(); ++c) {
    EXPECT_EQ(reader->GetOutput()->GetCellType(c), shapes[c].second);
    vtkCell* cell = reader->GetOutput()->GetCell(c);
    ASSERT_EQ(cell->GetNumberOfPoints(), static_cast<int>(m.cells.nodes(c).size()));
    for (int i = 0; i < cell->GetNumberOfPoints(); ++i) EXPECT_EQ(cell->GetPointId(i), m.cells.nodes(c)[i]);
  }
}

TEST_F(VtkFieldsTest, StressesAreWrittenIfGivenWithNamedComponents) {
  ResultsFolder folder(out_, false, {});
  FieldSeries series(folder, mesh_);
  StressField stress{Eigen::Matrix<double, 6, Eigen::Dynamic>::Random(6, 11), Eigen::VectorXd::LinSpaced(11, 0.0, 5.0)};
  series.write(0.0, temperature_degC_, displacement_um_, &stress);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(folder.path("fields/fields_0000.vtu").c_str());
  reader->Update();
  vtkDataArray* components = reader->GetOutput()->GetPointData()->GetArray("stress_MPa");
  vtkDataArray* von_mises = reader->GetOutput()->GetPointData()->GetArray("von_mises_MPa");
  ASSERT_TRUE(components != nullptr && von_mises != nullptr);
  ASSERT_EQ(components->GetNumberOfComponents(), 6);
  EXPECT_STREQ(components->GetComponentName(0), "XX");
  EXPECT_STREQ(components->GetComponentName(4), "YZ");
  EXPECT_STREQ(components->GetComponentName(5), "XZ");
  for (int n = 0; n < 11; ++n) {
    for (int i = 0; i < 6; ++i) EXPECT_FLOAT_EQ(components->GetComponent(n, i), stress.stress_MPa(i, n));
    EXPECT_FLOAT_EQ(von_mises->GetTuple1(n), stress.von_mises_MPa[n]);
  }
  stress.von_mises_MPa.resize(10);
  EXPECT_THROW(series.write(1.0, temperature_degC_, displacement_um_, &stress), std::logic_error);
}

TEST_F(VtkFieldsTest, RegionsKeepTheirNamesAndFilesSayTheirTimeAndOrigin) {
  write_two_times(out_);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((out_ / "fields/fields_0001.vtu").c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  EXPECT_EQ(grid->GetCellData()->GetArray("region")->GetTuple1(0), 1);
  EXPECT_EQ(grid->GetCellData()->GetArray("region")->GetTuple1(1), 0);
  const auto text = [&](const char* array, int i) {
    return std::string(vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray(array))->GetValue(i));
  };
  EXPECT_EQ(text("region_names", 0), "column");
  EXPECT_EQ(text("region_names", 1), "spindle_housing");
  EXPECT_THAT(text("made_by", 0), HasSubstr("1.2.3, a.yaml"));
  EXPECT_EQ(grid->GetFieldData()->GetArray("TimeValue")->GetTuple1(0), 90.5);
}

TEST_F(VtkFieldsTest, FilesAreCompressedAndAppended) {
  write_two_times(out_);
  const std::string text = read(out_ / "fields/fields_0000.vtu");
  EXPECT_THAT(text, HasSubstr("vtkZLibDataCompressor"));
  EXPECT_THAT(text, HasSubstr("<AppendedData encoding=\"raw\">"));
}

TEST_F(VtkFieldsTest, PvdListsEachFileWithItsTime) {
  write_two_times(out_);
  vtkNew<vtkXMLDataParser> parser;
  parser->SetFileName((out_ / "fields.pvd").c_str());
  ASSERT_EQ(parser->Parse(), 1);
  vtkXMLDataElement* collection = parser->GetRootElement()->FindNestedElementWithName("Collection");
  ASSERT_NE(collection, nullptr);
  ASSERT_EQ(collection->GetNumberOfNestedElements(), 2);
  const double times_s[] = {0.0, 90.5};
  for (int i = 0; i < 2; ++i) {
    vtkXMLDataElement* entry = collection->GetNestedElement(i);
    double time_s = -1.0;
    entry->GetScalarAttribute("timestep", time_s);
    EXPECT_EQ(time_s, times_s[i]);
    EXPECT_TRUE(fs::exists(out_ / entry->GetAttribute("file")));
  }
}

TEST_F(VtkFieldsTest, SameInputGivesTheSameBytes) {
  write_two_times(out_ / "a");
  write_two_times(out_ / "b");
  for (const char* file : {"fields.pvd", "fields/fields_0000.vtu", "fields/fields_0001.vtu"}) {
    EXPECT_EQ(read(out_ / "a" / file), read(out_ / "b" / file));
  }
}

TEST_F(VtkFieldsTest, RefusesFieldsThatDoNotFitAndTimeThatDoesNotIncrease) {
  ResultsFolder folder(out_, false, {});
  FieldSeries series(folder, mesh_);
  const Eigen::VectorXd short_field = Eigen::VectorXd::Zero(10);
  EXPECT_THROW(series.write(0.0, short_field, displacement_um_), std::logic_error);
  EXPECT_THROW(series.write(0.0, temperature_degC_, Eigen::Matrix3Xd::Zero(3, 12)), std::logic_error);
  series.write(1.0, temperature_degC_, displacement_um_);
  EXPECT_THROW(series.write(1.0, temperature_degC_, displacement_um_), std::logic_error);
}

TEST_F(VtkFieldsTest, AFullDiskIsNoticed) {
  ResultsFolder folder(out_, false, {});
  fs::create_symlink("/dev/full", folder.path("fields/fields_0000.vtu"));
  FieldSeries series(folder, mesh_);
  EXPECT_THAT([&] { series.write(0.0, temperature_degC_, displacement_um_); },
              ThrowsMessage<std::runtime_error>(HasSubstr("No space left")));
}

TEST_F(VtkFieldsTest, NumbersOfRegionsStandOnTheirCells) {
  {
    ResultsFolder folder(out_, false, {});
    const std::vector<RegionField> fields = {{"heat_W", {3.0, -7.5}}};
    write_region_fields(mesh_, fields, folder.path("heat.vtu"));
    const std::vector<RegionField> wrong = {{"heat_W", {3.0}}};
    EXPECT_THROW(write_region_fields(mesh_, wrong, out_.parent_path() / "never_written.vtu"), std::logic_error);
    folder.commit();
  }
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((out_ / "heat.vtu").c_str());
  reader->Update();
  vtkDataArray* heat = reader->GetOutput()->GetCellData()->GetArray("heat_W");
  ASSERT_NE(heat, nullptr);
  ASSERT_EQ(heat->GetNumberOfTuples(), 2);
  EXPECT_EQ(heat->GetTuple1(0), -7.5);  // the first cell is of the second region
  EXPECT_EQ(heat->GetTuple1(1), 3.0);
}

TEST_F(VtkFieldsTest, MeshCarriesQualityPerCell) {
  ResultsFolder folder(out_, false, {});
  const fs::path file = folder.path("mesh.vtu");
  write_mesh(mesh_, std::array{0.75, 0.5}, file);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkDataArray* quality = reader->GetOutput()->GetCellData()->GetArray("quality");
  ASSERT_NE(quality, nullptr);
  EXPECT_EQ(quality->GetTuple1(0), 0.75);
  EXPECT_EQ(quality->GetTuple1(1), 0.5);
  EXPECT_THROW(write_mesh(mesh_, std::array{1.0}, file), std::logic_error);
}

}  // namespace
}  // namespace driftwright::output::vtk_fields_test
