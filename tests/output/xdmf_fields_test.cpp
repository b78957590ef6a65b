#include "output/xdmf_fields.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <unistd.h>
#include <vtkNew.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>

#include "base/errors.hpp"
#include "mesh/topology.hpp"
#include "output/hdf5_file.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::output::xdmf_fields_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre, ::testing::ElementsAreArray, ::testing::HasSubstr, ::testing::ThrowsMessage;

/// Cells of these shapes, each with nodes of its own, side by side, in two regions by turns.
mesh::Mesh mesh_of(const std::vector<mesh::CellShape>& shapes) {
  mesh::Mesh m;
  m.regions = {"column", "spindle_housing"};
  for (const mesh::CellShape shape : shapes) {
    std::vector<int> nodes;
    for (const Eigen::Vector3d& x : mesh::reference_nodes(shape)) {
      nodes.push_back(m.n_nodes());
      m.coords.conservativeResize(3, m.n_nodes() + 1);
      m.coords.rightCols<1>() = x + Eigen::Vector3d(m.cells.size(), 0.0, 1. / 3);
    }
    m.cells.add(shape, nodes, m.cells.size() % 2);
  }
  return m;
}

/// An array of an HDF5 file, read with the HDF5 library itself.
struct Array {
  std::vector<hsize_t> size;
  std::vector<double> values;
  std::size_t bytes_per_value = 0;
  bool deflated = false;
  std::vector<hsize_t> chunk;
};

Array read_array(const fs::path& file, const std::string& dataset) {
  Array array;
  const hid_t in = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t data = H5Dopen2(in, dataset.c_str(), H5P_DEFAULT);
  if (in < 0 || data < 0) throw std::runtime_error("no '" + dataset + "' in " + file.string());
  const hid_t space = H5Dget_space(data), type = H5Dget_type(data), how = H5Dget_create_plist(data);
  array.size.resize(H5Sget_simple_extent_ndims(space));
  H5Sget_simple_extent_dims(space, array.size.data(), nullptr);
  array.values.resize(H5Sget_simple_extent_npoints(space));
  EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()), 0);
  array.bytes_per_value = H5Tget_size(type);
  for (int f = 0; f < H5Pget_nfilters(how); ++f) {
    std::size_t n_values = 0;
    unsigned flags = 0, config = 0;
    array.deflated |= H5Pget_filter2(how, f, &flags, &n_values, nullptr, 0, nullptr, &config) == H5Z_FILTER_DEFLATE;
  }
  array.chunk.resize(array.size.size());
  if (H5Pget_layout(how) == H5D_CHUNKED) H5Pget_chunk(how, static_cast<int>(array.chunk.size()), array.chunk.data());
  H5Pclose(how), H5Tclose(type), H5Sclose(space), H5Dclose(data), H5Fclose(in);
  return array;
}

std::string read_text(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

class XdmfFieldsTest : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove_all(out_); }

  static Eigen::VectorXd temperature_degC(const mesh::Mesh& m, double time_s) {
    return Eigen::VectorXd::LinSpaced(m.n_nodes(), 20.0, 31.5).array() + 0.1 * time_s;
  }
  static Eigen::Matrix3Xd displacement_um(const mesh::Mesh& m, double time_s) {
    return Eigen::Matrix3Xd::NullaryExpr(3, m.n_nodes(), [&](auto i, auto n) { return i - 0.25 * n + time_s; });
  }
  static StressField stress(const mesh::Mesh& m, double time_s) {
    return {Eigen::Matrix<double, 6, Eigen::Dynamic>::NullaryExpr(6, m.n_nodes(),
                                                                  [&](auto i, auto n) { return 100.0 * i + n - time_s; }),
            Eigen::VectorXd::LinSpaced(m.n_nodes(), time_s, 5.0)};
  }

  void write_two_times(const fs::path& target, const mesh::Mesh& m, bool with_stress) const {
    ResultsFolder folder(target, false, {.version = "1.2.3", .scenario = "a & b.yaml"});
    FieldSeries series(folder, m, FieldsFormat::kXdmf);
    for (const double time_s : times_s_) {
      const StressField s = stress(m, time_s);
      series.write(time_s, temperature_degC(m, time_s), displacement_um(m, time_s), with_stress ? &s : nullptr);
    }
    series.finish();
    EXPECT_EQ(series.file_to_open(), "fields.xdmf");
    EXPECT_EQ(series.n_times(), 2);
    folder.commit();
  }

  /// What a reader of XDMF does: finds the array that a DataItem names and holds it against the stated form.
  Array follow(vtkXMLDataElement* parent) const {
    vtkXMLDataElement* item = parent->FindNestedElementWithName("DataItem");
    if (!item) throw std::runtime_error("no DataItem");
    EXPECT_STREQ(item->GetAttribute("Format"), "HDF");
    std::string place = item->GetCharacterData();
    const std::size_t colon = place.find(":/");
    const Array array = read_array(out_ / place.substr(0, colon), place.substr(colon + 1));
    std::vector<hsize_t> stated(3);
    stated.resize(item->GetVectorAttribute("Dimensions", 3, reinterpret_cast<vtkIdType*>(stated.data())));
    EXPECT_EQ(array.size, stated) << place;
    EXPECT_EQ(std::to_string(array.bytes_per_value), item->GetAttribute("Precision")) << place;
    EXPECT_TRUE(array.deflated) << place;
    EXPECT_EQ(array.chunk, array.size) << place;  // small enough for one chunk
    return array;
  }
  vtkXMLDataElement* domain() {
    parser_->SetFileName((out_ / "fields.xdmf").c_str());
    if (parser_->Parse() != 1) throw std::runtime_error("fields.xdmf is no XML");
    EXPECT_STREQ(parser_->GetRootElement()->GetName(), "Xdmf");
    return parser_->GetRootElement()->FindNestedElementWithName("Domain");
  }
  /// The grid of time i.
  vtkXMLDataElement* grid(int i) {
    vtkXMLDataElement* collection = domain()->FindNestedElementWithName("Grid");
    EXPECT_STREQ(collection->GetAttribute("GridType"), "Collection");
    EXPECT_STREQ(collection->GetAttribute("CollectionType"), "Temporal");
    EXPECT_EQ(collection->GetNumberOfNestedElements(), 2);
    return collection->GetNestedElement(i);
  }
  static vtkXMLDataElement* attribute(vtkXMLDataElement* grid, const char* name, const char* type, const char* center) {
    vtkXMLDataElement* found = grid->FindNestedElementWithNameAndAttribute("Attribute", "Name", name);
    if (!found) throw std::runtime_error(std::string("no attribute ") + name);
    EXPECT_STREQ(found->GetAttribute("AttributeType"), type);
    EXPECT_STREQ(found->GetAttribute("Center"), center);
    return found;
  }

  const fs::path out_ = fs::path(::testing::TempDir()) / ("xdmf_fields_test-" + std::to_string(getpid()));
  const std::array<double, 2> times_s_ = {0.0, 90.1};
  const mesh::Mesh mixed_ =
      mesh_of({mesh::CellShape::kHex8, mesh::CellShape::kHex20, mesh::CellShape::kWedge6, mesh::CellShape::kWedge15,
               mesh::CellShape::kTet4, mesh::CellShape::kTet10, mesh::CellShape::kHex8});
  vtkNew<vtkXMLDataParser> parser_;
};

TEST_F(XdmfFieldsTest, FieldsReadBackAsWrittenAtEachTimeOfAMixedMesh) {
  write_two_times(out_, mixed_, true);
  for (int i = 0; i < 2; ++i) {
    vtkXMLDataElement* at = grid(i);
    double time_s = -1.0;
    at->FindNestedElementWithName("Time")->GetScalarAttribute("Value", time_s);
    EXPECT_EQ(time_s, times_s_[i]);

    const Array temperature = follow(attribute(at, "temperature_degC", "Scalar", "Node"));
    const Array displacement = follow(attribute(at, "displacement_um", "Vector", "Node"));
    const Array components = follow(attribute(at, "stress_MPa", "Matrix", "Node"));
    const Array von_mises = follow(attribute(at, "von_mises_MPa", "Scalar", "Node"));
    const hsize_t n_nodes = mixed_.n_nodes();
    EXPECT_THAT(temperature.size, ElementsAre(n_nodes));
    EXPECT_THAT(displacement.size, ElementsAre(n_nodes, 3));
    EXPECT_THAT(components.size, ElementsAre(n_nodes, 6));
    EXPECT_THAT(von_mises.size, ElementsAre(n_nodes));
    const Eigen::VectorXd t = temperature_degC(mixed_, time_s);
    const Eigen::Matrix3Xd u = displacement_um(mixed_, time_s);
    const StressField s = stress(mixed_, time_s);
    for (int n = 0; n < mixed_.n_nodes(); ++n) {  // 32 bits in the file
      EXPECT_FLOAT_EQ(temperature.values[n], t[n]);
      EXPECT_FLOAT_EQ(von_mises.values[n], s.von_mises_MPa[n]);
      for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(displacement.values[3 * n + c], u(c, n));
      for (int c = 0; c < 6; ++c) EXPECT_FLOAT_EQ(components.values[6 * n + c], s.stress_MPa(c, n));
    }
  }
}

TEST_F(XdmfFieldsTest, BothTimesNameTheSameMeshWhichKeeps64Bits) {
  write_two_times(out_, mixed_, false);
  for (const char* part : {"Topology", "Geometry"}) {
    const auto place = [&](int i) {
      return std::string(
          grid(i)->FindNestedElementWithName(part)->FindNestedElementWithName("DataItem")->GetCharacterData());
    };
    EXPECT_EQ(place(0), place(1));
  }
  vtkXMLDataElement* geometry = grid(1)->FindNestedElementWithName("Geometry");
  EXPECT_STREQ(geometry->GetAttribute("GeometryType"), "XYZ");
  const Array coordinates = follow(geometry);
  EXPECT_THAT(coordinates.size, ElementsAre(mixed_.n_nodes(), 3));
  EXPECT_THAT(coordinates.values, ElementsAreArray(mixed_.coords.data(), mixed_.coords.size()));
  EXPECT_EQ(grid(0)->FindNestedElementWithNameAndAttribute("Attribute", "Name", "stress_MPa"), nullptr);
}

/// Numbers of the shapes from the table in "XDMF Model and Format"; read without any reader of ours.
TEST_F(XdmfFieldsTest, MixedCellsAreTheNumberOfTheirShapeAndTheirNodes) {
  write_two_times(out_, mixed_, false);
  vtkXMLDataElement* topology = grid(0)->FindNestedElementWithName("Topology");
  EXPECT_STREQ(topology->GetAttribute("TopologyType"), "Mixed");
  EXPECT_STREQ(topology->GetAttribute("NumberOfElements"), "7");
  std::vector<double> wanted;
  const int numbers[] = {9, 48, 8, 40, 6, 38, 9};
  for (int c = 0; c < 7; ++c) {
    wanted.push_back(numbers[c]);
    wanted.insert(wanted.end(), mixed_.cells.nodes(c).begin(), mixed_.cells.nodes(c).end());
  }
  EXPECT_EQ(follow(topology).values, wanted);
}

TEST_F(XdmfFieldsTest, CellsOfOneShapeAreATableOfNodes) {
  const std::vector<std::pair<mesh::CellShape, std::string>> shapes = {
      {mesh::CellShape::kHex8, "Hexahedron"},  {mesh::CellShape::kHex20, "Hexahedron_20"},
      {mesh::CellShape::kWedge6, "Wedge"},     {mesh::CellShape::kWedge15, "Wedge_15"},
      {mesh::CellShape::kTet4, "Tetrahedron"}, {mesh::CellShape::kTet10, "Tetrahedron_10"}};
  for (const auto& [shape, name] : shapes) {
    const mesh::Mesh m = mesh_of({shape, shape, shape});
    write_two_times(out_, m, false);
    vtkXMLDataElement* topology = grid(0)->FindNestedElementWithName("Topology");
    EXPECT_EQ(topology->GetAttribute("TopologyType"), name);
    EXPECT_STREQ(topology->GetAttribute("NumberOfElements"), "3");
    const Array cells = follow(topology);
    EXPECT_THAT(cells.size, ElementsAre(3, mesh::n_nodes_of(shape)));
    EXPECT_THAT(cells.values, ElementsAreArray(m.cells.node));
  }
}

TEST_F(XdmfFieldsTest, RegionsKeepTheirNamesAndTheFileSaysItsOrigin) {
  write_two_times(out_, mixed_, false);
  EXPECT_THAT(follow(attribute(grid(1), "region", "Scalar", "Cell")).values, ElementsAre(0, 1, 0, 1, 0, 1, 0));
  const auto information = [&](const char* name) {
    return std::string(domain()->FindNestedElementWithNameAndAttribute("Information", "Name", name)->GetAttribute("Value"));
  };
  EXPECT_EQ(information("made_by"), "Driftwright 1.2.3, a & b.yaml");
  EXPECT_EQ(information("region_names"), "column\nspindle_housing");
}

TEST_F(XdmfFieldsTest, SameInputGivesTheSameBytesOnAnotherDay) {
  write_two_times(out_ / "a", mixed_, true);
  sleep(2);  // time stamps of HDF5 count seconds
  write_two_times(out_ / "b", mixed_, true);
  for (const char* file : {"fields.h5", "fields.xdmf"}) {
    EXPECT_FALSE(read_text(out_ / "a" / file).empty());
    EXPECT_TRUE(read_text(out_ / "a" / file) == read_text(out_ / "b" / file)) << file;
  }
}

TEST_F(XdmfFieldsTest, RefusesFieldsThatDoNotFitAndTimeThatDoesNotIncrease) {
  ResultsFolder folder(out_, false, {});
  FieldSeries series(folder, mixed_, FieldsFormat::kXdmf);
  const int n_nodes = mixed_.n_nodes();
  const Eigen::VectorXd t = temperature_degC(mixed_, 0.0);
  const Eigen::Matrix3Xd u = displacement_um(mixed_, 0.0);
  EXPECT_THROW(series.write(0.0, Eigen::VectorXd::Zero(n_nodes - 1), u), std::logic_error);
  EXPECT_THROW(series.write(0.0, t, Eigen::Matrix3Xd::Zero(3, n_nodes + 1)), std::logic_error);
  StressField s = stress(mixed_, 0.0);
  s.von_mises_MPa.resize(n_nodes - 1);
  EXPECT_THROW(series.write(0.0, t, u, &s), std::logic_error);
  series.write(1.0, t, u);
  EXPECT_THROW(series.write(1.0, t, u), std::logic_error);
  EXPECT_THROW(series.write(std::nan(""), t, u), std::logic_error);
  s = stress(mixed_, 0.0);
  EXPECT_THROW(series.write(2.0, t, u, &s), std::logic_error);  // stresses at some times only
}

TEST_F(XdmfFieldsTest, RefusesFacetsAmongTheCells) {
  ResultsFolder folder(out_, false, {});
  EXPECT_THROW(FieldSeries(folder, mesh_of({mesh::CellShape::kTri3}), FieldsFormat::kXdmf), std::logic_error);
}

TEST_F(XdmfFieldsTest, AFullDiskIsNoticed) {
  ResultsFolder folder(out_, false, {});
  fs::create_symlink("/dev/full", folder.path("fields.h5"));
  EXPECT_REFUSED(FieldSeries(folder, mixed_, FieldsFormat::kXdmf), "fields.h5': No space left on device");
}

/// While it lives no file can grow beyond so many bytes: a disk that is full at a chosen place.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t n_bytes) : old_action_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit = {.rlim_cur = n_bytes, .rlim_max = old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_action_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit old_ = {};
  void (*old_action_)(int);
};

/// Small arrays wait in HDF5's cache until they are closed, large ones do not, and the file's own pages until it is closed.
TEST_F(XdmfFieldsTest, AFullDiskIsNoticedAtOnceForArraysOfAnySizeAndWhenClosing) {
  fs::create_directories(out_);
  const auto too_large = ThrowsMessage<InputError>(HasSubstr(".h5': File too large"));
  std::vector<double> values(3 * 70000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(1.0 * i);
  for (const std::size_t n_values : {std::size_t{6}, values.size()}) {
    Hdf5File file(out_ / (std::to_string(n_values) + ".h5"));
    const FileSizeLimit limit(200);
    EXPECT_THAT([&] { file.write("a", std::span(values).first(n_values), 3); }, too_large) << n_values;
  }
  Hdf5File file(out_ / "whole.h5");
  file.write("a", values, 3);  // its place in the file's index is written at the end
  const FileSizeLimit limit(200);
  EXPECT_THAT([&] { file.close(); }, too_large);
}

TEST_F(XdmfFieldsTest, AFileThatCannotBeMadeIsNamedWithTheReason) {
  EXPECT_REFUSED(Hdf5File(out_ / "no_folder" / "a.h5"), "no_folder/a.h5': No such file or directory");
}

TEST_F(XdmfFieldsTest, LongArraysAreSplitIntoChunksAndRowsMustBeWhole) {
  fs::create_directories(out_);
  std::vector<float> values(3 * 70000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 1000);
  Hdf5File file(out_ / "a.h5");
  file.write("long", values, 3);
  EXPECT_THROW(file.write("ragged", std::span(values).first(7), 3), std::logic_error);
  EXPECT_THROW(file.write("empty", std::span(values).first(0)), std::logic_error);
  file.close();
  EXPECT_THROW(file.write("late", values), std::logic_error);
  const Array array = read_array(out_ / "a.h5", "long");
  EXPECT_THAT(array.size, ElementsAre(70000, 3));
  EXPECT_THAT(array.chunk, ElementsAre(65536, 3));
  EXPECT_THAT(array.values, ElementsAreArray(values));
}

}  // namespace
}  // namespace driftwright::output::xdmf_fields_test
