// Meshes in input files of Abaqus and CalculiX, written by hand.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "tests/mesh/imported.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::mesh::import_inp_test {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

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
  EXPECT_REFUSED(import_mesh(recipe(path, 1.0)), "600 m large", "100 m", "mm (0.6 m)?");
  EXPECT_REFUSED(import_mesh(recipe(write_file("small.inp", kThreeCells), 1e-4)), "0.0006 m large",
                 "inch (0.152 m) or m (6 m)?");
}

}  // namespace
}  // namespace driftwright::mesh::import_inp_test
