// Mesh files and drawings that are damaged: a sentence that names the file, never the end of the program.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <thread>

#include "base/errors.hpp"
#include "mesh/imported_mesh.hpp"
#include "mesh/mesh_bytes.hpp"
#include "mesh/read_apart.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::mesh::damaged_mesh_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Mesh two_parts() {
  Mesh m = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.2}, .n = {2, 1, 3}});
  m.notes = {"a note", ""};
  m.joints = {{"a/b", "a/b@a", "a/b@b"}};
  return m;
}

TEST(MeshBytes, GiveTheSameMesh) {
  const Mesh m = two_parts(), back = mesh_of_bytes(mesh_bytes(m));
  EXPECT_EQ(back.coords, m.coords);
  for (auto cells : {&Mesh::cells, &Mesh::facets}) {
    EXPECT_EQ((back.*cells).shape, (m.*cells).shape);
    EXPECT_EQ((back.*cells).offset, (m.*cells).offset);
    EXPECT_EQ((back.*cells).node, (m.*cells).node);
    EXPECT_EQ((back.*cells).group, (m.*cells).group);
  }
  EXPECT_EQ(back.regions, m.regions);
  EXPECT_EQ(back.surfaces, m.surfaces);
  EXPECT_EQ(back.notes, m.notes);
  ASSERT_EQ(back.joints.size(), 1u);
  EXPECT_EQ(back.joints[0].side_b, "a/b@b");
  const std::string bytes = mesh_bytes(m);
  for (const std::size_t size : {std::size_t(0), std::size_t(7), bytes.size() / 2, bytes.size() - 1})
    EXPECT_THROW((void)mesh_of_bytes(bytes.substr(0, size)), std::logic_error) << size;
  EXPECT_THROW((void)mesh_of_bytes(bytes + "x"), std::logic_error);
}

TEST(ReadApart, HandsOverWhatIsReadAndWhatIsRefused) {
  EXPECT_EQ(mesh_bytes(read_apart("a.msh", two_parts)), mesh_bytes(two_parts()));
  const auto throwing = [](auto e) { return [e] { (void)read_apart("a.msh", [e]() -> Mesh { throw e; }); }; };
  EXPECT_THAT(throwing(InputError("wrong")), ThrowsMessage<InputError>("wrong"));
  EXPECT_THAT(throwing(RangeError("beyond")), ThrowsMessage<RangeError>("beyond"));
  EXPECT_THAT(throwing(SolveError("gave up")), ThrowsMessage<SolveError>("gave up"));
  EXPECT_THAT(throwing(std::logic_error("our bug")), ThrowsMessage<std::logic_error>("our bug"));
  EXPECT_THAT(throwing(std::bad_alloc()), ThrowsMessage<InputError>(AllOf(HasSubstr("a.msh"), HasSubstr("memory"))));
}

TEST(ReadApart, ADeathIsASentenceAboutTheFile) {
  const auto dying = [](std::function<void()> how) {
    return [how] {
      (void)read_apart("a.step", [&]() -> Mesh {
        how();
        return {};
      });
    };
  };
  EXPECT_THAT(dying([] { std::raise(SIGSEGV); }),
              ThrowsMessage<InputError>(AllOf(HasSubstr("a.step"), HasSubstr("Segmentation fault"), HasSubstr("damaged"))));
  EXPECT_THAT(dying([] { std::abort(); }), ThrowsMessage<InputError>(HasSubstr("Aborted")));
  EXPECT_THAT(dying([] { throw 42; }), ThrowsMessage<InputError>(HasSubstr("Aborted")));
  EXPECT_THAT(dying([] { std::raise(SIGKILL); }), ThrowsMessage<InputError>(HasSubstr("lack of memory")));
  EXPECT_THAT(dying([] { _exit(0); }), ThrowsMessage<InputError>(HasSubstr("ended before its time")));
  EXPECT_THAT(dying([] {
                const BoundedTime bounded(most_to_read_s("no such file"));
                std::raise(SIGXCPU);  // as the system does it after 5 s
              }),
              ThrowsMessage<InputError>(HasSubstr("5 s of processor time")));
}

TEST(ReadApart, AProcessWithThreadsThatMayBeForeignReadsHere) {
  bool was_here = false;
  std::thread([&] { (void)read_apart("a.msh", [&] { return was_here = true, Mesh{}; }); }).join();
  EXPECT_TRUE(was_here);
  was_here = false;
  (void)read_apart("a.msh", [&] { return was_here = true, Mesh{}; });
  EXPECT_FALSE(was_here);  // one thread again
}

// --- files ---------------------------------------------------------------------------------------------------------

struct Damage {
  const char* name;
  std::function<void(std::string&)> by;
  const char* word;  ///< of the message
};

void replace(std::string& text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), by);
}

void expect_refused(const std::string& sample, const std::string& as, const Damage& damage) {
  std::string text = read_text(sample);
  damage.by(text);
  ImportedMesh recipe;
  recipe.path = write_file(as, text);
  recipe.unit_m = 1e-3;
  EXPECT_REFUSED(import_mesh(recipe), as, damage.word) << damage.name;
}

const char* const kTwoTets = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="5" NumberOfCells="2">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 10 0 0 0 10 0 0 0 10 0 0 -10
</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 0 2 1 4</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray>
</Cells>
<CellData><DataArray type="Int32" Name="region" format="ascii">0 1</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>
)";

TEST(DamagedVtu, IsRefusedWithWhatIsWrong) {
  all_threads_are_ours();
  const std::string sample = write_file("two_tets.vtu", kTwoTets);
  ImportedMesh recipe;
  recipe.path = sample;
  recipe.unit_m = 1e-3;
  EXPECT_EQ(import_mesh(recipe).cells.size(), 2);
  const auto swap = [](const char* what, const char* by) { return [=](std::string& t) { replace(t, what, by); }; };
  const std::vector<Damage> all = {
      {"a node that is not there", swap("0 2 1 4<", "0 2 1 5<"), "cell 1 has node 5, and there are nodes 0 to 4"},
      {"a node below 0", swap("0 2 1 4<", "0 2 1 -4<"), "cell 1 has node -4"},
      {"a node far away", swap("0 2 1 4<", "0 2 1 4000000000<"), "cell 1 has node 4000000000"},
      {"offsets that go back", swap(">4 8<", ">8 4<"), "damaged"},
      {"a tetrahedron of three nodes", swap(">4 8<", ">3 8<"), "cell 0, of VTK's type 10, has 3 nodes"},
      {"a hexahedron of four nodes", swap(">10 10<", ">10 12<"), "cell 1, of VTK's type 12, has 4 nodes"},
      {"too few points", swap("0 0 10 0 0 -10", "0 0 10"), "oints"},
      {"regions of two numbers", swap("Name=\"region\"", "Name=\"region\" NumberOfComponents=\"2\""), ""},
      {"regions that are no numbers",
       swap("type=\"Int32\" Name=\"region\" format=\"ascii\">0 1",
            "type=\"Float64\" Name=\"region\" format=\"ascii\">0 1e300"),
       "'region' does not hold"},
      {"no XML", swap("</Points>", "</Point>"), "XML"},
  };
  for (const Damage& damage : all) expect_refused(sample, "damaged.vtu", damage);
}

const char* const kTets22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
3 1 "block"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 10 0 0
3 0 10 0
4 0 0 10
5 0 0 -10
$EndNodes
$Elements
2
7 4 2 1 1 1 2 3 4
9 4 2 1 1 1 3 2 5
$EndElements
)";

TEST(DamagedMsh, IsRefusedWithTheFile) {
  all_threads_are_ours();
  const std::string sample = write_file("tets.msh", kTets22);
  ImportedMesh recipe;
  recipe.path = sample;
  recipe.unit_m = 1e-3;
  EXPECT_EQ(import_mesh(recipe).cells.size(), 2);
  const auto swap = [](const char* what, const char* by) { return [=](std::string& t) { replace(t, what, by); }; };
  const std::vector<Damage> all = {
      {"a node that is not there", swap("1 3 2 5\n", "1 3 2 6\n"), ""},
      {"a node below 0", swap("1 3 2 5\n", "1 3 2 -5\n"), ""},
      {"a number of nodes below 0", swap("$Nodes\n5", "$Nodes\n-5"), ""},
      {"far too many nodes", swap("$Nodes\n5", "$Nodes\n9000000000000"), ""},
      {"a number of elements below 0", swap("$Elements\n2", "$Elements\n-2"), ""},
      {"a kind of element that is none", swap("7 4 2", "7 4000 2"), ""},
      {"more tags than there are", swap("7 4 2", "7 4 2000000"), ""},
  };
  for (const Damage& damage : all) expect_refused(sample, "damaged.msh", damage);
}

// Without a process of their own a fifth of such files ended in a signal inside OpenCASCADE.
TEST(DamagedStep, IsRefusedOrRead) {
  all_threads_are_ours();
  const std::string whole = read_text("tests/fuzz/corpus/meshes/plate_with_hole.step");
  ASSERT_GT(whole.size(), 10000u);
  int n_refused = 0;
  // the first is refused, the second ends in a signal; one that lasts for ever is below
  std::vector<std::pair<std::size_t, std::size_t>> cuts = {{900, 47}, {whole.size() - 900, 47}};
  for (std::size_t i = 0; i < 7; ++i) cuts.emplace_back(1500 + 2100 * i, 40 + i);
  for (const auto& [at, length] : cuts) {
    std::string text = whole;
    text.erase(at, length);
    ImportedMesh recipe;
    recipe.path = write_file("damaged.step", text);
    recipe.mesh_size_m = 0.03;
    recipe.element_order = 1;
    recipe.region_points = {{"plate", {0.01, 0.01, 0.01}, {}}};
    try {
      (void)import_mesh(recipe);
    } catch (const InputError& e) {
      ++n_refused;
    } catch (const SolveError& e) {  // a body that cannot be meshed
      ++n_refused;
    }
  }
  RecordProperty("refused_of_9", n_refused);
  EXPECT_GT(n_refused, 1);
}

TEST(DamagedStep, ACornerAtInfinityIsRefusedInTime) {  // OpenCASCADE compares its solid with a point for ever
  all_threads_are_ours();
  std::string text = read_text("tests/fuzz/corpus/meshes/box.step");
  const std::string corner = "#34 = CARTESIAN_POINT('',(0.,";
  ASSERT_NE(text.find(corner), std::string::npos);
  text.replace(text.find(corner), corner.size(), "#34 = CARTESIAN_POINT('',(1e99999,");
  ImportedMesh recipe;
  recipe.path = write_file("endless.step", text);
  recipe.unit_m = 1e-3;
  recipe.mesh_size_m = 0.03;
  recipe.element_order = 1;
  recipe.region_points = {{"body", {0.05, 0.01, 0.01}, {}}};
  EXPECT_REFUSED(import_mesh(recipe), "endless.step", "longer than 5 s");
}

}  // namespace
}  // namespace driftwright::mesh::damaged_mesh_test
