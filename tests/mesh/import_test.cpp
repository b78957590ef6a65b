// Mesh files of Gmsh and our own against closed forms of what is in them, files that cannot be right, and surfaces picked
// in them.

#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "mesh/gmsh_parts.hpp"
#include "output/vtk_fields.hpp"
#include "tests/mesh/imported.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::mesh::import_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

// --- .msh and .inp by Gmsh ---------------------------------------------------------------------------------------

enum class Kind { kTet, kHex, kWedge };

/// A block of 100 x 60 x 80 mm, written in mm by Gmsh: regions lower and upper, 40 mm high each, which share their nodes;
/// surfaces foot and top.
void write_block(const std::string& path, Kind kind, int order, double version, bool binary, bool incomplete = true) {
  const GmshSession session;
  namespace geo = gmsh::model::geo;
  const int p[] = {geo::addPoint(0, 0, 0), geo::addPoint(100, 0, 0), geo::addPoint(100, 60, 0), geo::addPoint(0, 60, 0)};
  std::vector<int> lines;
  for (int i = 0; i < 4; ++i) lines.push_back(geo::addLine(p[i], p[(i + 1) % 4]));
  const int base = geo::addPlaneSurface({geo::addCurveLoop(lines)});
  const std::vector<int> layers = kind == Kind::kTet ? std::vector<int>{} : std::vector<int>{2};
  gmsh::vectorpair lower, upper;
  geo::extrude({{2, base}}, 0, 0, 40, lower, layers, {}, kind != Kind::kTet);
  geo::extrude({lower[0]}, 0, 0, 40, upper, layers, {}, kind != Kind::kTet);
  for (int line : lines) geo::mesh::setTransfiniteCurve(line, 4);
  if (kind == Kind::kHex) {
    geo::mesh::setTransfiniteSurface(base);
    geo::mesh::setRecombine(2, base);
  }
  geo::synchronize();
  const auto name = [](int dim, int tag, const char* text) {
    gmsh::model::setPhysicalName(dim, gmsh::model::addPhysicalGroup(dim, {tag}), text);
  };
  name(3, lower[1].second, "lower");
  name(3, upper[1].second, "upper");
  name(2, base, "foot");
  name(2, upper[0].second, "top");
  gmsh::option::setNumber("Mesh.MeshSizeMax", 30);
  gmsh::option::setNumber("Mesh.SecondOrderIncomplete", incomplete);
  gmsh::model::mesh::generate(3);
  if (order == 2) gmsh::model::mesh::setOrder(2);
  gmsh::option::setNumber("Mesh.MshFileVersion", version);
  gmsh::option::setNumber("Mesh.Binary", binary);
  gmsh::write(path);
}

CellShape shape_of(Kind kind, int order) {
  switch (kind) {
    case Kind::kTet:
      return order == 1 ? CellShape::kTet4 : CellShape::kTet10;
    case Kind::kHex:
      return order == 1 ? CellShape::kHex8 : CellShape::kHex20;
    default:
      return order == 1 ? CellShape::kWedge6 : CellShape::kWedge15;
  }
}

void expect_block(const Mesh& m, Kind kind, int order) {
  EXPECT_THAT(m.regions, UnorderedElementsAre("lower", "upper"));
  EXPECT_THAT(m.cells.shape, ::testing::Each(shape_of(kind, order)));
  if (kind == Kind::kHex) {
    EXPECT_EQ(m.cells.size(), 3 * 3 * 4);
  }
  EXPECT_NEAR(volume(m, "lower"), 0.1 * 0.06 * 0.04, 1e-15);  // rounding: the file has 16 digits
  EXPECT_NEAR(volume(m, "upper"), 0.1 * 0.06 * 0.04, 1e-15);
  EXPECT_NEAR(area(m, "foot"), 0.1 * 0.06, 1e-14);
  EXPECT_NEAR(area(m, "top"), 0.1 * 0.06, 1e-14);
  EXPECT_LT(largest_bow_m(m), 1e-10);  // a mid-side node on a wrong edge would be off by millimetres
  EXPECT_TRUE(m.joints.empty());       // regions that share nodes are one body
  for (int f : m.facets_on(m.surface("top"))) {
    for (int n : m.facets.nodes(f)) EXPECT_NEAR(m.coords(2, n), 0.08, 1e-12);
  }
}

struct GmshFile {
  Kind kind;
  int order;
  double version;
  bool binary;
};
class MshFile : public ::testing::TestWithParam<GmshFile> {};

TEST_P(MshFile, GivesVolumesAreasAndNodesOfTheBlock) {
  const GmshFile& file = GetParam();
  const std::string path = path_of("block.msh");
  write_block(path, file.kind, file.order, file.version, file.binary);
  expect_block(import_mesh(recipe(path, 1e-3)), file.kind, file.order);
}

std::vector<GmshFile> all_files() {
  std::vector<GmshFile> files;
  for (Kind kind : {Kind::kTet, Kind::kHex, Kind::kWedge}) {
    for (int order : {1, 2}) {
      for (double version : {2.2, 4.1}) {
        for (bool binary : {false, true}) files.push_back({kind, order, version, binary});
      }
    }
  }
  return files;
}
std::string name_of_file(const ::testing::TestParamInfo<GmshFile>& test) {
  const auto& [kind, order, version, binary] = test.param;
  return std::string(kind == Kind::kTet   ? "Tet"
                     : kind == Kind::kHex ? "Hex"
                                          : "Wedge") +
         std::to_string(order) + (version < 3 ? "V22" : "V41") + (binary ? "Binary" : "Ascii");
}
INSTANTIATE_TEST_SUITE_P(Each, MshFile, ::testing::ValuesIn(all_files()), name_of_file);

TEST(MshErrors, HexahedraOf27NodesAreRefusedWithTheOptionThatHelps) {
  const std::string path = path_of("hex27.msh");
  write_block(path, Kind::kHex, 2, 4.1, false, false);
  EXPECT_REFUSED(import_mesh(recipe(path, 1e-3)), "27 nodes", "SecondOrderIncomplete");
}

TEST(MshErrors, AFileThatIsNoneIsRefused) {
  EXPECT_THROW((void)import_mesh(recipe(write_file("no.msh", "this is no mesh\n"), 1e-3)), InputError);
  EXPECT_THROW((void)import_mesh(recipe(write_file("cut.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 8"), 1e-3)),
               InputError);
}

const char* const kTwoTets22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0 0 -1
$EndNodes
$Elements
2
7 4 2 0 1 1 2 3 4
9 4 2 0 2 1 3 2 5
$EndElements
)";

TEST(MshErrors, VolumesWithoutNamesAreRefusedWithWhatToWrite) {
  EXPECT_REFUSED(import_mesh(recipe(write_file("bare.msh", kTwoTets22), 1.0)), "Physical Volume(\"column\")");
}

TEST(MshErrors, NodeNumbersFarApartAreRefusedAndGapsAreNot) {
  std::string text = kTwoTets22;
  text.replace(text.find("7 4 2 0 1"), 9, "7 4 2 5 1");
  text.replace(text.find("9 4 2 0 2"), 9, "9 4 2 5 2");
  const auto renumber = [&](const std::string& number) {  // node 5
    std::string renumbered = text;
    renumbered.replace(renumbered.find("5 0 0 -1"), 1, number);
    renumbered.replace(renumbered.find("3 2 5"), 5, "3 2 " + number);
    return renumbered;
  };
  EXPECT_EQ(import_mesh(recipe(write_file("gaps.msh", renumber("900000")), 1.0)).n_nodes(), 5);
  EXPECT_REFUSED(import_mesh(recipe(write_file("far.msh", renumber("1100000")), 1.0)), "too far apart", "renumber");
}

TEST(MshErrors, VolumesMustLieInOneRegionEach) {
  std::string text = kTwoTets22;
  text.replace(text.find("7 4 2 0 1"), 9, "7 4 2 5 1");  // the first volume alone in a physical one
  EXPECT_REFUSED(import_mesh(recipe(write_file("half.msh", text), 1.0)), "volume 2 is in no physical volume");
  text.replace(text.find("9 4 2 0 2"), 9, "9 4 2 5 2");
  const Mesh m = import_mesh(recipe(write_file("whole.msh", text), 1.0));
  EXPECT_THAT(m.regions, UnorderedElementsAre("volume_5"));  // it has a number and no name
  EXPECT_NEAR(volume(m, "volume_5"), 1.0 / 3, 1e-15);
}

TEST(MshErrors, AFacetThatIsNoFaceOfACellIsRefusedByItsNumber) {
  std::string text = kTwoTets22;
  text.replace(text.find("2\n7 4 2 0 1"), 11, "3\n21 2 2 8 1 1 4 5\n7 4 2 5 1");
  text.replace(text.find("9 4 2 0 2"), 9, "9 4 2 5 2");
  EXPECT_REFUSED(import_mesh(recipe(write_file("facet.msh", text), 1.0)),
                 "element 21 of surface 'surface_8' is no face of a cell");
}

class GmshInp : public ::testing::TestWithParam<GmshFile> {};

TEST_P(GmshInp, GivesTheSameBlock) {
  const std::string path = path_of("block.inp");
  write_block(path, GetParam().kind, GetParam().order, 4.1, false);
  expect_block(import_mesh(recipe(path, 1e-3)), GetParam().kind, GetParam().order);  // its physical groups, as they are
  ImportedMesh named = recipe(path, 1e-3);
  named.region_sets = {"lower", "upper"};
  expect_block(import_mesh(named), GetParam().kind, GetParam().order);
}
INSTANTIATE_TEST_SUITE_P(Each, GmshInp,
                         ::testing::Values(GmshFile{Kind::kTet, 1, 4.1, false}, GmshFile{Kind::kTet, 2, 4.1, false},
                                           GmshFile{Kind::kHex, 1, 4.1, false}, GmshFile{Kind::kHex, 2, 4.1, false},
                                           GmshFile{Kind::kWedge, 1, 4.1, false}, GmshFile{Kind::kWedge, 2, 4.1, false}),
                         name_of_file);

// --- .vtu --------------------------------------------------------------------------------------------------------

class VtuRoundTrip : public ::testing::TestWithParam<CellShape> {};

TEST_P(VtuRoundTrip, OfOurOwnMeshGivesTheSameMesh) {
  Mesh written = fixtures::two_boxes({{0, 0, 0}, {0.1, 0.2, 0.3}, {2, 2, 2}, GetParam()},
                                     {{0.1, 0, 0}, {0.1, 0.2, 0.3}, {1, 3, 2}, GetParam()}, "a.x1", "b.x0");
  for (std::string& s : written.surfaces) {
    if (s == "a.x1") s = "a/b@a";
    if (s == "b.x0") s = "a/b@b";
  }
  written.joints = {{"a/b", "a/b@a", "a/b@b"}};
  const std::string path = path_of("own.vtu");
  output::write_mesh(written, scaled_jacobians(written), path);
  const Mesh m = import_mesh(recipe(path, 1.0));
  EXPECT_EQ(m.regions, written.regions);
  EXPECT_THAT(m.surfaces, ::testing::UnorderedElementsAreArray(written.surfaces));
  EXPECT_EQ(m.coords, written.coords);
  EXPECT_EQ(m.cells.node, written.cells.node);
  EXPECT_EQ(m.cells.group, written.cells.group);
  EXPECT_TRUE(m.notes.empty());
  for (const std::string& s : written.surfaces) EXPECT_NEAR(area(m, s), area(written, s), 1e-15) << s;
  ASSERT_EQ(m.joints.size(), 1U);
  EXPECT_EQ(m.joints[0].name, "a/b");
  EXPECT_EQ(m.joints[0].side_a, "a/b@a");
}
INSTANTIATE_TEST_SUITE_P(Shapes, VtuRoundTrip,
                         ::testing::Values(CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20,
                                           CellShape::kWedge6, CellShape::kWedge15));

TEST(VtuFile, WedgesOnTheirHeadsAreTurned) {
  // VTK's text requires that the triangle 012 faces outwards; its functions, and most writers, the opposite.
  for (CellShape shape : {CellShape::kWedge6, CellShape::kWedge15}) {
    Mesh written = fixtures::box_mesh({.n = {1, 1, 1}, .shape = shape});
    written.facets = {};
    std::vector<int>& n = written.cells.node;  // the first wedge
    std::swap(n[1], n[2]);
    std::swap(n[4], n[5]);
    if (shape == CellShape::kWedge15) {
      std::swap(n[6], n[8]);
      std::swap(n[9], n[11]);
      std::swap(n[13], n[14]);
    }
    const std::string path = path_of("head.vtu");
    output::write_mesh(written, {}, path);
    const Mesh m = import_mesh(recipe(path, 1.0));
    EXPECT_NEAR(volume(m, "body"), 1.0, 1e-14);
    EXPECT_LT(largest_bow_m(m), 1e-15);
    EXPECT_THAT(m.notes, Contains(HasSubstr("1 wedges")));
  }
}

TEST(VtuFile, ThatIsNoneIsRefused) {
  EXPECT_REFUSED(import_mesh(recipe(write_file("no.vtu", "this is no mesh\n"), 1e-3)), "no.vtu");
}

TEST(Neighbours, OfLinearAndQuadraticCellsAreRefused) {
  Mesh m;
  fixtures::add_box(m, {{0, 0, 0}, {1, 1, 1}, {1, 1, 1}, CellShape::kHex8}, "a", "a.");
  fixtures::add_box(m, {{1, 0, 0}, {1, 1, 1}, {1, 1, 1}, CellShape::kHex20}, "b", "b.");
  fixtures::merge_nodes(m);
  m.facets = {};
  output::write_mesh(m, {}, path_of("orders.vtu"));
  EXPECT_REFUSED(import_mesh(recipe(path_of("orders.vtu"), 1.0)),
                 "elements 0 and 1 share an edge but not the node in its middle");
}

TEST(Neighbours, ThreeOnOneFaceAreRefused) {
  Mesh m;
  m.regions = {"body"};
  m.coords.resize(3, 6);
  m.coords << 0, 1, 0, 0, .1, .2, 0, 0, 1, 0, .1, .2, 0, 0, 0, 1, 2, 3;
  for (int top : {3, 4, 5}) m.cells.add(CellShape::kTet4, std::vector{0, 1, 2, top}, 0);
  output::write_mesh(m, {}, path_of("overlap.vtu"));
  EXPECT_REFUSED(import_mesh(recipe(path_of("overlap.vtu"), 1.0)), "elements 0, 1 and 2 have one face in common");
}

// --- picking and joints ------------------------------------------------------------------------------------------

class Picking : public ::testing::Test {
 protected:
  /// Two boxes of hexahedra that touch at x = 0.1 and share no nodes, without surfaces.
  static ImportedMesh boxes() {
    Mesh m = fixtures::two_boxes({{0, 0, 0}, {0.1, 0.2, 0.3}, {2, 2, 2}, CellShape::kHex20},
                                 {{0.1, 0, 0}, {0.1, 0.2, 0.3}, {1, 3, 2}, CellShape::kHex20}, "a.x1", "b.x0");
    m.facets = {};
    m.surfaces.clear();
    output::write_mesh(m, {}, path_of("boxes.vtu"));
    return recipe(path_of("boxes.vtu"), 1.0);
  }
  static SurfacePick plane(const std::string& name, const std::string& region, double x, double normal) {
    return {name, region, PlanePick{{x, 0, 0}, {normal, 0, 0}}, {}};
  }
};

TEST_F(Picking, PlanesLookOutOfTheBodyAndRemainingIsTheRest) {
  ImportedMesh r = boxes();
  r.surfaces = {plane("right_of_a", "", 0.1, 1),
                plane("left_of_b", "", 0.1, -1),
                plane("left", "a", 0, -1),
                {"rest", "a", RemainingPick{}, {}}};
  const Mesh m = import_mesh(r);
  EXPECT_NEAR(area(m, "right_of_a"), 0.06, 1e-15);  // the touching face of b looks the other way
  EXPECT_NEAR(area(m, "left_of_b"), 0.06, 1e-15);
  for (int f : m.facets_on(m.surface("left_of_b"))) EXPECT_GE(m.facets.nodes(f)[0], 4 * 9 + 45);  // nodes of b come last
  EXPECT_NEAR(area(m, "rest"), 2 * 0.1 * 0.3 + 2 * 0.1 * 0.2, 1e-15);
}

TEST_F(Picking, JointsTakeCopiesOfTheirSidesAndRefuseSharedNodes) {
  ImportedMesh r = boxes();
  r.surfaces = {plane("right_of_a", "a", 0.1, 1), plane("left_of_b", "b", 0.1, -1), {"rest", "a", RemainingPick{}, {}}};
  r.joints = {{"a/b", "right_of_a", "left_of_b", {}}};
  const Mesh m = import_mesh(r);
  ASSERT_NE(m.joint("a/b"), nullptr);
  EXPECT_EQ(m.joint("a/b")->side_a, "a/b@right_of_a");
  EXPECT_NEAR(area(m, "a/b@right_of_a"), 0.06, 1e-15);
  EXPECT_NEAR(area(m, "a/b@left_of_b"), 0.06, 1e-15);
  r.joints = {{"a/b", "right_of_a", "rest", {}}};
  EXPECT_REFUSED(import_mesh(r), "share nodes");
  r.joints = {{"a/b", "right_of_a", "nowhere", {}}};
  EXPECT_REFUSED(import_mesh(r), "no surface 'nowhere'");
}

TEST_F(Picking, ThatFindsNothingOrRepeatsANameIsRefused) {
  ImportedMesh r = boxes();
  r.surfaces = {plane("x", "a", 0.05, 1)};
  EXPECT_REFUSED(import_mesh(r), "no outer face lies there", "x 0.0 to 100.0 mm");
  r.surfaces = {plane("x", "c", 0.1, 1)};
  EXPECT_REFUSED(import_mesh(r), "no region 'c'; there are a, b");
  r.surfaces = {plane("x", "a", 0.1, 1), plane("x", "b", 0.2, 1)};
  EXPECT_REFUSED(import_mesh(r), "surface 'x' already");
}

}  // namespace
}  // namespace driftwright::mesh::import_test
