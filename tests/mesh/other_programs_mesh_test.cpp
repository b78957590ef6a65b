// Meshes and drawings as other programs write them: input decks in any order and system, cells with points of their own,
// products of one name, bodies that overlap. Volumes and areas are closed forms.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <regex>
#include <set>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "mesh/gmsh_parts.hpp"
#include "mesh/mesh_step.hpp"
#include "mesh/outer_planes.hpp"
#include "mesh/overlapping_cells.hpp"
#include "mesh/read_apart.hpp"
#include "tests/mesh/imported.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::mesh::other_programs_mesh_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

std::string written(const std::string& name, const std::string& text) {
  const std::string path = path_of(name);
  write_bytes(path, text);
  return path;
}

Mesh mesh_in_mm(const std::string& path) {
  return import_mesh(recipe(path, 1e-3));
}
Mesh mesh_of_deck(const std::string& text) {
  return mesh_in_mm(written("deck.inp", text));
}

double litres(const Mesh& m, const std::string& region) {
  return 1e3 * volume(m, region);
}

// Two cubes of 1 l on each other, numbered with gaps.
const char* const kNodes = R"(*NODE
1,0,0,0
2,100,0,0
3,100,100,0
4,0,100,0
11,0,0,100
12,100,0,100
13,100,100,100
14,0,100,100
21,0,0,200
22,100,0,200
23,100,100,200
24,0,100,200
)";
const char* const kCells = R"(*ELEMENT, TYPE=C3D8, ELSET=block
1,1,2,3,4,11,12,13,14
5,11,12,13,14,21,22,23,24
)";

TEST(DeckOfAnotherProgram, MayListItsBlocksInAnyOrder) {
  EXPECT_NEAR(litres(mesh_of_deck(std::string(kCells) + kNodes), "block"), 2.0, 1e-12);
}

TEST(DeckOfAnotherProgram, RangesSkipNumbersThatAreNone) {
  const Mesh m = mesh_of_deck(std::string(kNodes) + kCells +
                              "*NSET, NSET=top, GENERATE\n20,30\n*NSET, NSET=middle, GENERATE\n11,9223372036854775807,1\n"
                              "*ELSET, ELSET=upper, GENERATE\n2,9223372036854775806,3\n*SURFACE, NAME=roof\nupper,S2\n");
  EXPECT_NEAR(area(m, "top"), 0.01, 1e-14);
  EXPECT_NEAR(area(m, "roof"), 0.01, 1e-14);
  EXPECT_NEAR(area(m, "middle"), 0.05, 1e-14);  // all that the upper cube has outside
}

TEST(DeckOfAnotherProgram, SetsMayHoldEachOther) {
  const Mesh m =
      mesh_of_deck(std::string(kNodes) + kCells +
                   "*ELSET, ELSET=a\n1\n*ELSET, ELSET=b\na,5\n*ELSET, ELSET=a\nb,a,b,b\n*SURFACE, NAME=s\na,S1\n");
  EXPECT_NEAR(area(m, "s"), 0.02, 1e-14);  // the lower face of both, each once
}

TEST(DeckOfAnotherProgram, SurfaceWithoutAFaceIsAllThatIsFree) {
  const Mesh m = mesh_of_deck(std::string(kNodes) + kCells + "*SURFACE, NAME=skin\nblock,\n*SURFACE, NAME=upper\n5,\n");
  EXPECT_NEAR(area(m, "skin"), 0.10, 1e-14);
  EXPECT_NEAR(area(m, "upper"), 0.05, 1e-14);
}

TEST(DeckOfAnotherProgram, WhatIsNoPartOfTheMeshIsLeftOutWithANote) {
  const std::string tool =
      "*NODE\n101,0,0,250\n102,100,0,250\n103,100,100,250\n104,0,100,250\n"
      "*ELEMENT, TYPE=R3D4, ELSET=tool\n9,101,102,103,104\n"
      "*ELEMENT, TYPE=M3D4, ELSET=membrane\n10,21,22,23,24\n"
      "*SURFACE, NAME=tool_face\ntool,SPOS\n*SURFACE, NAME=coat\nmembrane,SPOS\n";
  const Mesh m = mesh_of_deck(std::string(kNodes) + kCells + tool + "*SURFACE, NAME=top\n5,S2\n");
  EXPECT_THAT(m.surfaces, UnorderedElementsAre("top", "coat", "membrane"));
  EXPECT_NEAR(area(m, "coat"), 0.01, 1e-14);  // a membrane that covers a cell's face
  EXPECT_THAT(m.notes, Contains(HasSubstr("surface 'tool_face' lost 1 elements")));
  EXPECT_REFUSED(mesh_of_deck(std::string(kNodes) + kCells + "*SURFACE, NAME=top\n6,S2\n"), ":18: there is no element 6");
}

// A quarter of a ring of six chords: half the product of two radii and the sine of the angle between them is a triangle's
// area.
TEST(DeckOfAnotherProgram, NodesInCylindricalCoordinatesAreUnderstood) {
  constexpr int kSteps = 6;
  std::string nodes = "*NODE, SYSTEM=C\n", cells = "*ELEMENT, TYPE=C3D8, ELSET=ring\n";
  const auto number = [](int step, int layer, int radius) { return 1 + step + 100 * layer + 10000 * radius; };
  for (int step = 0; step <= kSteps; ++step) {
    for (const int layer : {0, 1}) {
      for (const int radius : {0, 1})
        nodes += fmt::format("{},{},{},{}\n", number(step, layer, radius), 40 + 20 * radius, 15 * step, 30 * layer);
    }
  }
  for (int step = 0; step < kSteps; ++step) {
    cells += fmt::format("{}", 1 + step);
    for (const int layer : {0, 1}) {
      for (const auto& [more, radius] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}})
        cells += fmt::format(",{}", number(step + more, layer, radius));
    }
    cells += "\n";
  }
  const double area_mm2 = kSteps * 0.5 * std::sin(15.0 * std::numbers::pi / 180.0) * (60.0 * 60.0 - 40.0 * 40.0);
  EXPECT_NEAR(litres(mesh_of_deck(nodes + cells), "ring"), 1e-6 * area_mm2 * 30.0, 1e-12);
  nodes.replace(nodes.find("SYSTEM=C"), 8, "SYSTEM=S");
  EXPECT_REFUSED(mesh_of_deck(nodes + cells), ":1:", "SYSTEM=s", "C (radius");
}

TEST(DeckOfAnotherProgram, KeywordsThatMakeNodesOrElementsAreRefusedAtTheirLine) {
  for (const std::string keyword : {"*NGEN", "*NFILL", "*NCOPY, CHANGE NUMBER=5, OLD SET=a", "*ELGEN", "*SYSTEM"}) {
    EXPECT_REFUSED(mesh_of_deck(std::string(kNodes) + keyword + "\n1,11,1\n" + kCells),
                   ":14:", keyword.substr(0, keyword.find(',')));
  }
  EXPECT_REFUSED(mesh_of_deck("*NODE, INPUT=nodes.inp\n" + std::string(kCells)), ":1: INPUT= is not followed");
}

struct Sections {
  const char* name;
  const char* sets;
  std::vector<std::string> regions;
};
class DeckWithSections : public ::testing::TestWithParam<Sections> {};

TEST_P(DeckWithSections, HasTheFinerOfBothDivisionsForRegions) {
  const Mesh m = mesh_of_deck(std::string(kNodes) + GetParam().sets);
  EXPECT_THAT(m.regions, ::testing::UnorderedElementsAreArray(GetParam().regions));
  for (const std::string& region : m.regions)
    EXPECT_NEAR(litres(m, region), 2.0 / static_cast<double>(m.regions.size()), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    All, DeckWithSections,
    ::testing::Values(
        Sections{"one_block_two_materials",
                 "*ELEMENT, TYPE=C3D8, ELSET=Evolumes\n1,1,2,3,4,11,12,13,14\n5,11,12,13,14,21,22,23,24\n*ELSET, "
                 "ELSET=invar\n1\n*ELSET, ELSET=copper\n5\n*SOLID SECTION, ELSET=invar, MATERIAL=a\n*SOLID SECTION, "
                 "ELSET=copper, MATERIAL=b\n",
                 {"invar", "copper"}},
        Sections{"two_blocks_one_material",
                 "*ELEMENT, TYPE=C3D8, ELSET=foot\n1,1,2,3,4,11,12,13,14\n*ELEMENT, TYPE=C3D8, "
                 "ELSET=head\n5,11,12,13,14,21,22,23,24\n*ELSET, ELSET=all\nfoot,head\n*SOLID SECTION, ELSET=all\n",
                 {"foot", "head"}},
        Sections{"a_section_of_a_part_alone",
                 "*ELEMENT, TYPE=C3D8, ELSET=block\n1,1,2,3,4,11,12,13,14\n5,11,12,13,14,21,22,23,24\n*ELSET, "
                 "ELSET=invar\n1\n*SOLID SECTION, ELSET=invar\n",
                 {"block"}},
        Sections{"lines_without_names",
                 "*ELEMENT, TYPE=C3D8\n1,1,2,3,4,11,12,13,14\n5,11,12,13,14,21,22,23,24\n*ELSET, ELSET=invar\n1\n*ELSET, "
                 "ELSET=copper\n5\n*SOLID SECTION, ELSET=invar\n*SOLID SECTION, ELSET=copper\n",
                 {"invar", "copper"}}),
    [](const auto& test) { return std::string(test.param.name); });

// --- overlap ----------------------------------------------------------------------------------------------------------

/// Two boxes of two cells along each edge; the second is shifted along z and turned about it.
Mesh two_boxes(CellShape shape, double z_m, double size_m = 0.1, double turn_rad = 0.0) {
  Mesh m = fixtures::two_boxes({{0, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2}, shape},
                               {{0, 0, z_m}, {size_m, size_m, size_m}, {2, 2, 2}, shape}, "a.z1", "b.z0");
  const Eigen::Vector3d middle(0.5 * size_m, 0.5 * size_m, 0.0);
  std::set<int> second;
  for (int c = 0; c < m.cells.size(); ++c) {
    if (m.cells.group[c] == 1) second.insert(m.cells.nodes(c).begin(), m.cells.nodes(c).end());
  }
  for (int n : second)
    m.coords.col(n) = middle + Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()) * (m.coords.col(n) - middle);
  return m;
}

class Overlap : public ::testing::TestWithParam<CellShape> {};

TEST_P(Overlap, IsFoundWhereOneBodyReachesIntoAnother) {
  for (const double turn_rad : {0.0, 0.5}) {
    EXPECT_FALSE(find_overlap(two_boxes(GetParam(), 0.1, 0.1, turn_rad))) << "they touch";
    EXPECT_FALSE(find_overlap(two_boxes(GetParam(), 0.13, 0.1, turn_rad))) << "a gap";
    EXPECT_TRUE(find_overlap(two_boxes(GetParam(), 0.07, 0.1, turn_rad))) << "30 mm deep";
    EXPECT_TRUE(find_overlap(two_boxes(GetParam(), 0.0, 0.1, turn_rad))) << "at one place";
    EXPECT_TRUE(find_overlap(two_boxes(GetParam(), 0.04, 0.02, turn_rad))) << "one wholly in the other";
  }
  const Mesh deep = two_boxes(GetParam(), 0.07);
  EXPECT_FALSE(find_overlap(deep, {5, 5})) << "bodies that stay together are not compared";
  EXPECT_TRUE(find_overlap(deep, {5, 4}));
  const auto found = find_overlap(two_boxes(GetParam(), 0.04, 0.02));
  ASSERT_TRUE(found);
  EXPECT_GT(found->point_m[2], 0.04);
  EXPECT_LT(found->point_m[2], 0.06);
}
INSTANTIATE_TEST_SUITE_P(Shapes, Overlap,
                         ::testing::Values(CellShape::kTet4, CellShape::kTet10, CellShape::kHex8, CellShape::kHex20,
                                           CellShape::kWedge6));

TEST(OverlappingDeck, IsRefusedWithTheNumbersOfTwoElements) {
  const std::string shifted =
      "*NODE\n31,0,0,60\n32,100,0,60\n33,100,100,60\n34,0,100,60\n41,0,0,160\n42,100,0,160\n43,100,100,160\n44,0,100,160\n"
      "*ELEMENT, TYPE=C3D8, ELSET=head\n7,31,32,33,34,41,42,43,44\n";
  EXPECT_REFUSED(mesh_of_deck(std::string(kNodes) + kCells + shifted),
                 "elements 1 (region 'block') and 7 ('head') overlap at [25 mm, 25 mm, 75 mm]");
}

// --- cells with points of their own -------------------------------------------------------------------------------------

/// VTK's file of boxes of 100 mm that lie side by side in x, each with eight points of its own; `regions` of the cells.
std::string boxes_apart(const std::vector<int>& regions, double gap_mm = 0.0) {
  std::string points, nodes, offsets, types, numbers;
  for (int c = 0; c < static_cast<int>(regions.size()); ++c) {
    for (const double z : {0.0, 100.0}) {
      for (const auto& [x, y] : {std::pair{0.0, 0.0}, {100.0, 0.0}, {100.0, 100.0}, {0.0, 100.0}})
        points += fmt::format("{} {} {}\n", x + c * (100.0 + gap_mm), y, z);
    }
    for (int i = 0; i < 8; ++i) nodes += fmt::format("{} ", 8 * c + i);
    offsets += fmt::format("{} ", 8 * (c + 1));
    types += "12 ";
    numbers += fmt::format("{} ", regions[static_cast<std::size_t>(c)]);
  }
  return fmt::format(
      R"(<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="{}" NumberOfCells="{}">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{}</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">{}</DataArray><DataArray type="Int32" Name="offsets" format="ascii">{}</DataArray><DataArray type="UInt8" Name="types" format="ascii">{}</DataArray></Cells>
<CellData><DataArray type="Int32" Name="region" format="ascii">{}</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>)",
      8 * regions.size(), regions.size(), points, nodes, offsets, types, numbers);
}

TEST(CellsWithPointsOfTheirOwn, OfOneRegionAreOneBody) {
  const Mesh one = mesh_in_mm(written("apart.vtu", boxes_apart({0, 0, 0})));
  EXPECT_EQ(one.n_nodes(), 16);
  EXPECT_NEAR(litres(one, one.regions.front()), 3.0, 1e-12);
  EXPECT_THAT(one.notes, ElementsAre(HasSubstr("16 of 24 remain")));
  const Mesh two = mesh_in_mm(written("apart2.vtu", boxes_apart({0, 0, 1, 1})));
  EXPECT_EQ(two.n_nodes(), 24);  // 12 of each region: bodies of two regions touch
  const Mesh gap = mesh_in_mm(written("gap.vtu", boxes_apart({0, 0}, 0.1)));
  EXPECT_EQ(gap.n_nodes(), 16);
  EXPECT_TRUE(gap.notes.empty());
  EXPECT_EQ(mesh_in_mm(written("rounded.vtu", boxes_apart({0, 0}, 1e-5))).n_nodes(), 12);  // single precision
}

// --- drawings -----------------------------------------------------------------------------------------------------------

/// A drawing whose products have these names, in the order in which they are drawn.
std::string drawing(const std::string& name, const std::vector<std::string>& products, const std::function<void()>& draw) {
  const std::string path = path_of(name);
  {
    const GmshSession session;
    gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
    draw();
    gmsh::model::occ::synchronize();
    gmsh::write(path);
  }
  std::string text = read_bytes(path);
  for (std::size_t i = 0; i < products.size(); ++i)
    text = std::regex_replace(text, std::regex(fmt::format("'Open CASCADE STEP translator [0-9.]+ [0-9]+\\.{}'", i + 1)),
                              "'" + products[i] + "'");
  write_bytes(path, text);
  return path;
}

ImportedMesh drawn(const std::string& path) {
  ImportedMesh recipe;
  recipe.path = path;
  recipe.mesh_size_m = 0.02;
  return recipe;
}

/// Meshed in a process of its own, as the program does it.
Mesh mesh_drawn(const ImportedMesh& recipe, bool as_it_comes) {
  return read_apart(recipe.path, [&] { return mesh_step(recipe, as_it_comes); });
}

void two_blocks() {
  gmsh::model::occ::addBox(0, 0, 0, 100, 60, 40);
  gmsh::model::occ::addBox(0, 0, 40, 50, 60, 30);
}

TEST(DrawingOfAnotherProgram, KindsOfShapesAreNoNames) {
  const std::string path = drawing("solids.step", {"SOLID", "SOLID"}, two_blocks);
  const Mesh m = mesh_drawn(drawn(path), true);
  EXPECT_THAT(m.regions, UnorderedElementsAre("solid_1", "solid_2"));
  ASSERT_EQ(m.joints.size(), 1U);
  EXPECT_NEAR(area(m, m.joints[0].side_a), 0.05 * 0.06, 1e-12);
  EXPECT_REFUSED(mesh_drawn(drawn(path), false), "has no name; give it one by a point");
  EXPECT_THAT(mesh_drawn(drawn(drawing("one.step", {"bed", "SOLID"}, two_blocks)), true).regions,
              UnorderedElementsAre("bed", "solid_2"));
}

TEST(DrawingOfAnotherProgram, EqualBoltsAreOneRegionAndJoinedEach) {
  const std::string path = drawing("bolts.step", {"plate", "bolt", "bolt"}, [] {
    namespace occ = gmsh::model::occ;
    const int plate = occ::addBox(0, 0, 0, 120, 60, 20);
    gmsh::vectorpair bolts, out;
    std::vector<gmsh::vectorpair> map;
    for (const double x : {30.0, 90.0}) bolts.emplace_back(3, occ::addCylinder(x, 30, 0, 0, 0, 40, 8));
    occ::cut({{3, plate}}, bolts, out, map, -1, true, false);
  });
  const Mesh m = mesh_drawn(drawn(path), true);
  EXPECT_THAT(m.regions, UnorderedElementsAre("plate", "bolt"));
  ASSERT_EQ(m.joints.size(), 1U);
  const std::vector<OuterFacet> facets = outer_facets(m);
  std::set<int> parts;
  for (const OuterFacet& f : facets) parts.insert(f.part);
  EXPECT_EQ(parts.size(), 1U) << "both bolts hang on the plate by the joint";
  EXPECT_TRUE(plane_contacts(m, facets, outer_planes(m, facets)).empty());
}

TEST(DrawingOfAnotherProgram, VolumeThatTheMeshLosesIsSaid) {
  const std::string path = drawing("rod.step", {}, [] { gmsh::model::occ::addCylinder(0, 0, 0, 0, 0, 200, 20); });
  ImportedMesh recipe = drawn(path);
  recipe.element_order = 1;
  recipe.mesh_size_m = 0.03;
  const Mesh coarse = mesh_drawn(recipe, false);
  const double drawn_l = 1e3 * std::numbers::pi * 0.02 * 0.02 * 0.2, meshed_l = litres(coarse, coarse.regions[0]);
  ASSERT_LT(meshed_l, 0.98 * drawn_l);
  EXPECT_THAT(coarse.notes, Contains(AllOf(HasSubstr(fmt::format("{:.3g} l in the mesh", meshed_l)),
                                           HasSubstr(fmt::format("{:.3g} l in the drawing", drawn_l)))));
  recipe.element_order = 2;
  recipe.mesh_size_m = 0.01;
  EXPECT_TRUE(mesh_drawn(recipe, false).notes.empty());
}

}  // namespace
}  // namespace driftwright::mesh::other_programs_mesh_test
