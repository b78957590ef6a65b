// Mesh files of every format against closed forms of what is in them, and files that cannot be right. Both
// begin with the same files, so they are in one place.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "mesh/gmsh_parts.hpp"
#include "mesh/imported_mesh.hpp"
#include "mesh/quality.hpp"
#include "mesh/step_unit.hpp"
#include "mesh/topology.hpp"
#include "mesh/unnamed_geometry.hpp"
#include "output/vtk_fields.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::mesh::import_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using ::testing::UnorderedElementsAre;

std::string path_of(const std::string& name) {
  return (temporary_folder() / name).string();
}

ImportedMesh recipe(const std::string& path, double unit_m) {
  ImportedMesh r;
  r.path = path;
  r.unit_m = unit_m;
  return r;
}

double volume(const Mesh& m, const std::string& region) {
  return volume_m3(m, m.region(region));
}
double area(const Mesh& m, const std::string& surface) {
  return area_m2(m, m.surface(surface));
}

/// Largest distance of a mid-side node from the middle of its edge, in a mesh whose edges should be straight.
double largest_bow_m(const Mesh& m) {
  double largest = 0.0;
  for (int c = 0; c < m.cells.size(); ++c) {
    if (!is_quadratic(m.cells.shape[c])) continue;
    const auto nodes = m.cells.nodes(c);
    int middle = n_corners_of(m.cells.shape[c]);
    for (const auto& [a, b] : edges_of(m.cells.shape[c])) {
      largest = std::max(largest,
                         (m.coords.col(nodes[middle++]) - 0.5 * (m.coords.col(nodes[a]) + m.coords.col(nodes[b]))).norm());
    }
  }
  return largest;
}

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
  EXPECT_THAT([&] { (void)import_mesh(recipe(path, 1e-3)); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("27 nodes"), HasSubstr("SecondOrderIncomplete"))));
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
  EXPECT_THAT([&] { (void)import_mesh(recipe(write_file("far.msh", renumber("1100000")), 1.0)); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("too far apart"), HasSubstr("renumber"))));
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

// --- .inp by hand ------------------------------------------------------------------------------------------------

/// A cube, a wedge on its side and a tetrahedron that shares no face with them, in cm.
const char* const kThreeCells = R"(** a comment
*HEADING
 *not a keyword of ours* but text
*Node, NSET=Nall
1, 0, 0, 0
2, 1., 0, 0
3, 1, 1, 0
4, 0, 1.0E0, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1D0
9, 2, 0, 0
10, 2, 0, 1
20, 5, 0, 0
21, 6, 0, 0
22, 5, 1, 0
23, 5, 0, 1
99, 50, 0, 0
*ELEMENT, TYPE=C3D8R,
 ELSET=Hex
11, 1, 2, 3, 4,
5, 6, 7, 8
*element, type=C3D6, elset=WEDGE
12, 2, 9, 3, 6, 10, 7
*Element, Type=DC3D4, Elset=Tet
13, 20, 21, 22, 23
*Element, Type=S4, Elset=shells
14, 1, 2, 3, 4
*Element, Type=S3, Elset=loose
15, 1, 2, 7
*ELSET, ELSET=all, GENERATE
11, 13
*ELSET, ELSET=both
hex, wedge
*NSET, NSET=underside
1, 2, 3, 4, 9
*NSET, NSET=edge
1, 2
*NSET, NSET=some, GENERATE
1, 9, 2
*SURFACE, NAME=Top, TYPE=ELEMENT
hex, S2
12, S2
*SURFACE, NAME=back, TYPE=NODE
underside
*MATERIAL, NAME=steel
*ELASTIC
210000, 0.3
*STEP
*STATIC
*BOUNDARY
underside, 1, 3
*END STEP
)";

TEST(InpFile, SetsSurfacesContinuationLinesAndForeignKeywordsAreUnderstood) {
  const Mesh m = import_mesh(recipe(write_file("three.inp", kThreeCells), 1e-2));
  EXPECT_THAT(m.regions, UnorderedElementsAre("hex", "wedge", "tet"));
  EXPECT_NEAR(volume(m, "hex"), 1e-6, 1e-18);
  EXPECT_NEAR(volume(m, "wedge"), 0.5e-6, 1e-18);
  EXPECT_NEAR(volume(m, "tet"), 1e-6 / 6, 1e-18);
  EXPECT_THAT(m.surfaces, UnorderedElementsAre("top", "back", "underside",
                                               "shells"));  // `edge`, `some`, `loose` cover no face, Nall is all
  EXPECT_NEAR(area(m, "top"), 1.5e-4, 1e-16);
  EXPECT_NEAR(area(m, "back"), 1.5e-4, 1e-16);
  EXPECT_NEAR(area(m, "underside"), 1.5e-4, 1e-16);
  EXPECT_NEAR(area(m, "shells"), 1e-4, 1e-16);
  EXPECT_EQ(m.n_nodes(), 14);
  EXPECT_THAT(m.notes,
              UnorderedElementsAre("1 nodes that no cell uses were left out", "1 elements that are not 3-D were left out"));
}

TEST(InpFile, NamedSetsMakeTheRegionsAndMustCoverEveryElementOnce) {
  ImportedMesh r = recipe(write_file("sets.inp", kThreeCells), 1e-2);
  r.region_sets = {"both", "tet"};
  const Mesh m = import_mesh(r);
  EXPECT_THAT(m.regions, UnorderedElementsAre("both", "tet"));
  EXPECT_NEAR(volume(m, "both"), 1.5e-6, 1e-18);
  r.region_sets = {"hex", "tet"};
  EXPECT_REFUSED(import_mesh(r), "element 12 is in none of the regions");
  r.region_sets = {"all", "tet"};
  EXPECT_REFUSED(import_mesh(r), "element 13 is in the regions 'all' and 'tet'");
  r.region_sets = {"boht", "tet"};
  EXPECT_REFUSED(import_mesh(r), "Did you mean 'both'?");
  r.region_sets = {"both", "tet", "shells"};
  EXPECT_REFUSED(import_mesh(r), "region 'shells' has no cells");
}

TEST(InpFile, FacesHaveTheNumbersOfAbaqus) {
  // Abaqus Analysis User's Guide, 28.1.4: the nodes of each face. Middles of the faces of unit cells, by hand.
  struct Case {
    const char* nodes;
    std::vector<Eigen::Vector3d> middle;
  };
  const double t = 1.0 / 3;
  const std::vector<Case> cases = {
      {"1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n*ELEMENT,TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n",
       {{.5, .5, 0}, {.5, .5, 1}, {.5, 0, .5}, {1, .5, .5}, {.5, 1, .5}, {0, .5, .5}}},
      {"1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,1,0,1\n6,0,1,1\n*ELEMENT,TYPE=C3D6\n1,1,2,3,4,5,6\n",
       {{t, t, 0}, {t, t, 1}, {.5, 0, .5}, {.5, .5, .5}, {0, .5, .5}}},
      {"1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n", {{t, t, 0}, {t, 0, t}, {t, t, t}, {0, t, t}}}};
  for (const Case& c : cases) {
    std::string text = std::string("*NODE\n") + c.nodes;
    for (std::size_t i = 1; i <= c.middle.size(); ++i) {
      text += fmt::format("*SURFACE, NAME=f{0}\n1, S{0}\n", i);
    }
    const Mesh m = import_mesh(recipe(write_file("faces.inp", text), 1.0));
    for (std::size_t i = 1; i <= c.middle.size(); ++i) {
      const std::vector<int> facets = m.facets_on(m.surface(fmt::format("f{}", i)));
      ASSERT_EQ(facets.size(), 1U);
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      const auto nodes = m.facets.nodes(facets[0]);
      for (int n : nodes) middle += m.coords.col(n) / static_cast<double>(nodes.size());
      EXPECT_LT((middle - c.middle[i - 1]).norm(), 1e-15) << "S" << i;
    }
  }
}

struct Mistake {
  const char* name;
  const char* right;
  const char* wrong;
  std::vector<const char*> message;
};
class BadInp : public ::testing::TestWithParam<Mistake> {};

TEST_P(BadInp, IsRefusedAtItsLineOrElement) {
  std::string text = kThreeCells;
  const auto at = text.find(GetParam().right);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(GetParam().right).size(), GetParam().wrong);
  const std::string path = write_file("bad.inp", text);
  try {
    (void)import_mesh(recipe(path, 1e-2));
    ADD_FAILURE() << "it was taken";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr(path + ":"));
    for (const char* part : GetParam().message) EXPECT_THAT(e.what(), HasSubstr(part));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadInp,
    ::testing::Values(
        Mistake{"inverted", "13, 20, 21, 22, 23", "13, 20, 22, 21, 23", {"element 13 in region 'tet' is inverted"}},
        Mistake{"flat", "23, 5, 0, 1", "23, 5, 0, 0", {"element 13", "inverted or folded"}},
        Mistake{"twice",
                "*Element, Type=S4",
                "113, 21, 22, 20, 23\n*Element, Type=S4",
                {"elements 13 and 113 have the same nodes"}},
        Mistake{"nan", "9, 2, 0, 0", "9, nan, 0, 0", {"node 9", "not a finite number"}},
        Mistake{"decimal_comma", "9, 2, 0, 0", "9, 2,0, 0,0, 0,0", {":13: a node is", "decimal point"}},
        Mistake{"no_number", "9, 2, 0, 0", "9, two, 0, 0", {":13: 'two' is no number"}},
        Mistake{"unknown_node", "13, 20, 21, 22, 23", "13, 20, 21, 22, 77", {":27: element 13: there is no node 77"}},
        Mistake{"too_few_nodes", "12, 2, 9, 3, 6, 10, 7", "12, 2, 9, 3, 6, 10", {"element 12 has 5 nodes; 6 are required"}},
        Mistake{"node_twice", "9, 2, 0, 0", "8, 2, 0, 0", {"node 8 is defined twice"}},
        Mistake{"element_twice", "13, 20, 21, 22, 23", "12, 20, 21, 22, 23", {"element 12 is defined twice"}},
        Mistake{"face_twice", "15, 1, 2, 7", "14, 1, 2, 7", {":31: element 14 is defined twice"}},
        Mistake{"pyramid", "TYPE=C3D8R", "TYPE=C3D5", {"type c3d5", "C3D20"}},
        Mistake{"unknown_set", "hex, S2", "hexx, S2", {"there is no element set 'hexx'"}},
        Mistake{"no_such_face", "12, S2", "12, S6", {"face 's6' of element 12; S1 to S5"}},
        Mistake{
            "set_of_nothing", "*ELSET, ELSET=both\nhex, wedge", "*ELSET, ELSET=both\n11, 55", {"there is no element 55"}},
        Mistake{"from_below_zero",
                "*ELSET, ELSET=both\nhex, wedge",
                "*ELSET, ELSET=both, GENERATE\n-9223372036854775807, 9223372036854775807",
                {"0 <= first <= last"}},
        Mistake{"face_of_nothing", "hex, S2", ",", {"a line of a *SURFACE is"}},
        Mistake{"surface_on_edge",
                "NAME=back, TYPE=NODE\nunderside",
                "NAME=back, TYPE=NODE\nedge",
                {"'back' cover no outer face"}},
        Mistake{"include", "*MATERIAL, NAME=steel", "*INCLUDE, INPUT=more.inp", {"*INCLUDE is not followed"}},
        Mistake{"too_large", "9, 2, 0, 0", "9, 2e6, 0, 0", {"1 mm to 100 m is allowed"}},
        Mistake{"hex_against_tet",
                "*Element, Type=DC3D4",
                "*NODE\n98, 0.5, 0.5, 3\n*ELEMENT, TYPE=C3D4, ELSET=more\n15, 5, 6, 7, 98\n*Element, Type=DC3D4",
                {"meets a four-sided face of element 11 with a triangle"}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(ImportUnits, OfTheWrongSizeAreNoticedWithTheLikelyOnes) {
  std::string text = kThreeCells;  // from x = 0 to 600
  text.replace(text.find("21, 6, 0, 0"), 11, "21, 600, 0, 0");
  const std::string path = write_file("units.inp", text);
  EXPECT_NO_THROW((void)import_mesh(recipe(path, 1e-3)));
  EXPECT_THAT([&] { (void)import_mesh(recipe(path, 1.0)); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("600 m large"), HasSubstr("100 m"), HasSubstr("mm (0.6 m)?"))));
  EXPECT_THAT([&] { (void)import_mesh(recipe(write_file("small.inp", kThreeCells), 1e-4)); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("0.0006 m large"), HasSubstr("inch (0.152 m) or m (6 m)?"))));
}

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

// --- STEP --------------------------------------------------------------------------------------------------------

template <class Draw>
std::string write_step(const std::string& name, Draw draw, const std::string& unit = "MM") {
  const GmshSession session;
  gmsh::option::setString("Geometry.OCCTargetUnit", unit);
  draw();
  gmsh::model::occ::synchronize();
  gmsh::write(path_of(name));
  return path_of(name);
}

TEST(StepFile, OfTwoTouchingBoxesHasTheirVolumesAndTheJoint) {
  ImportedMesh r = recipe(write_step("boxes.step",
                                     [] {
                                       gmsh::model::occ::addBox(0, 0, 0, 100, 60, 40);  // mm, Gmsh's unit of STEP files
                                       gmsh::model::occ::addBox(0, 0, 40, 50, 60, 30);
                                     }),
                          0.0);
  r.mesh_size_m = 0.03;
  r.region_points = {{"column", {0.09, 0.03, 0.02}, {}}, {"head", {0.02, 0.03, 0.06}, {}}};
  r.surfaces = {{"foot", "column", PlanePick{{0, 0, 0}, {0, 0, -1}}, {}}, {"rest", "", RemainingPick{}, {}}};
  const Mesh m = import_mesh(r);
  EXPECT_NEAR(volume(m, "column"), 0.1 * 0.06 * 0.04, 1e-12);
  EXPECT_NEAR(volume(m, "head"), 0.05 * 0.06 * 0.03, 1e-12);
  ASSERT_NE(m.joint("column/head"), nullptr);
  EXPECT_NEAR(area(m, m.joint("column/head")->side_a), 0.05 * 0.06, 1e-12);
  EXPECT_NEAR(area(m, "foot"), 0.1 * 0.06, 1e-12);
  const double column_m2 = 2 * (0.1 * 0.06 + 0.1 * 0.04 + 0.06 * 0.04),
               head_m2 = 2 * (0.05 * 0.06 + 0.05 * 0.03 + 0.06 * 0.03);
  EXPECT_NEAR(area(m, "rest"), column_m2 + head_m2 - 2 * 0.05 * 0.06 - 0.1 * 0.06, 1e-12);
  EXPECT_THAT(m.cells.shape, ::testing::Each(CellShape::kTet10));

  r.region_points[1].at_m = {1, 1, 1};
  EXPECT_REFUSED(import_mesh(r), "'head' lies in 0 solids");
  r.region_points.pop_back();
  r.surfaces.clear();
  EXPECT_THAT(import_mesh(r).regions, UnorderedElementsAre("column", HasSubstr("Open CASCADE")));  // as the file calls it
}

TEST(StepFile, OfACylinderInASleeveHasTheCurvedJointAndBore) {
  using std::numbers::pi;
  ImportedMesh r = recipe(write_step("sleeve.stp",
                                     [] {
                                       namespace occ = gmsh::model::occ;
                                       occ::addCylinder(0, 0, -10, 0, 0, 120, 20);
                                       gmsh::vectorpair out;
                                       std::vector<gmsh::vectorpair> map;
                                       occ::cut({{3, occ::addCylinder(0, 0, 0, 0, 0, 100, 40)}},
                                                {{3, occ::addCylinder(0, 0, 0, 0, 0, 100, 20)}}, out, map);
                                     }),
                          0.0);
  r.mesh_size_m = 0.015;
  r.mesh_size_of_region_m = {{"shaft", 0.01}};
  r.region_points = {{"shaft", {0, 0, 0.05}, {}}, {"sleeve", {0.03, 0, 0.05}, {}}};
  r.surfaces = {{"outside", "sleeve", CylinderPick{{0, 0, 0}, {0, 0, 1}, 0.08}, {}},
                {"end", "shaft", PlanePick{{0, 0, 0.11}, {0, 0, 1}}, {}}};
  const Mesh m = import_mesh(r);
  // Quadratic edges of 0.01 m on a radius of 0.02 m: sagitta of the parabola's error (l/r)^4/... below 2e-3 in all.
  EXPECT_NEAR(volume(m, "shaft"), pi * 0.02 * 0.02 * 0.12, 2e-3 * pi * 0.02 * 0.02 * 0.12);
  EXPECT_NEAR(volume(m, "sleeve"), pi * (0.0016 - 0.0004) * 0.1, 2e-3 * pi * 0.0012 * 0.1);
  ASSERT_NE(m.joint("shaft/sleeve"), nullptr);
  EXPECT_NEAR(area(m, m.joint("shaft/sleeve")->side_a), pi * 0.04 * 0.1, 2e-3 * pi * 0.004);
  EXPECT_NEAR(area(m, m.joint("shaft/sleeve")->side_b), pi * 0.04 * 0.1, 2e-3 * pi * 0.004);
  EXPECT_NEAR(area(m, "outside"), pi * 0.08 * 0.1, 2e-3 * pi * 0.008);
  EXPECT_NEAR(area(m, "end"), pi * 0.0004, 2e-3 * pi * 0.0004);
}

TEST(StepFile, SaysItsUnitUnlessTheScenarioKnowsBetter) {
  const auto box = [] { gmsh::model::occ::addBox(0, 0, 0, 0.1, 0.06, 0.04); };
  // Gmsh writes millimetres; the same numbers under other units.
  const std::string in_mm = read_bytes(write_step("box_MM.step", box)), milli = "SI_UNIT(.MILLI.,.METRE.)";
  for (const auto& [unit, word, metres] : {std::tuple{"MM", ".MILLI.", 1e-3}, {"CM", ".CENTI.", 1e-2}, {"M", "$", 1.0}}) {
    std::string text = in_mm;
    for (std::size_t at = 0; (at = text.find(milli, at)) != std::string::npos; ++at)
      text.replace(at, milli.size(), fmt::format("SI_UNIT({},.METRE.)", word));
    ImportedMesh r = recipe(write_file(fmt::format("box_{}.step", unit), text), 0.0);
    r.mesh_size_m = 0.04 * metres;
    r.region_points = {{"box", {0.05 * metres, 0.03 * metres, 0.02 * metres}, {}}};
    EXPECT_NEAR(unit_of_step_m(r.path), metres, 1e-15) << unit;
    EXPECT_NEAR(volume(import_mesh(r), "box"), 0.1 * 0.06 * 0.04 * std::pow(metres, 3), 1e-9 * std::pow(metres, 3)) << unit;
    r.unit_m = 1.0;
    r.mesh_size_m = 0.04;
    r.region_points = {{"box", {0.05, 0.03, 0.02}, {}}};
    EXPECT_NEAR(volume(import_mesh(r), "box"), 0.1 * 0.06 * 0.04, 1e-9) << unit;
  }
  const UnnamedGeometry drawn_in_m = read_unnamed_geometry(path_of("box_MM.step"), "");
  EXPECT_EQ(drawn_in_m.unit, "m");
  EXPECT_TRUE(drawn_in_m.unit_is_a_guess);
  EXPECT_NEAR(drawn_in_m.mesh.coords.row(0).maxCoeff(), 0.1, 1e-12);
  EXPECT_NEAR(read_unnamed_geometry(path_of("box_MM.step"), "mm").mesh.coords.row(0).maxCoeff(), 1e-4, 1e-12);
  EXPECT_EQ(read_unnamed_geometry(path_of("box_M.step"), "").unit, "");
}

TEST(StepFile, ThatIsNoneIsRefused) {
  ImportedMesh r = recipe(write_file("no.step", "this is no drawing\n"), 0.0);
  r.mesh_size_m = 0.01;
  EXPECT_REFUSED(import_mesh(r), "no.step");
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
  EXPECT_THAT([&] { (void)import_mesh(r); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("no outer face lies there"), HasSubstr("x 0.0 to 100.0 mm"))));
  r.surfaces = {plane("x", "c", 0.1, 1)};
  EXPECT_REFUSED(import_mesh(r), "no region 'c'; there are a, b");
  r.surfaces = {plane("x", "a", 0.1, 1), plane("x", "b", 0.2, 1)};
  EXPECT_REFUSED(import_mesh(r), "surface 'x' already");
}

}  // namespace
}  // namespace driftwright::mesh::import_test
