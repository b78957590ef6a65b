// Mesh files of three formats and drawings, each in a process of its own as the program reads them.

#include "mesh/imported_mesh.hpp"
#include "mesh/read_apart.hpp"
#include "tests/fuzz/driver.hpp"

using namespace driftwright;

int main(int argc, char** argv) {
  mesh::all_threads_are_ours();  // as in the program; otherwise OpenMP's threads would read the files in this process
  const bool reads_drawings = argc > 1 && std::string(argv[1]) == "step";  // which take a hundred times as long
  if (reads_drawings) {
    --argc;
    ++argv;
  }
  fuzz::Target target{.name = reads_drawings ? "step" : "mesh",
                      .corpus = {"tests/fuzz/corpus/meshes"},
                      .extensions = {".msh", ".inp", ".vtu"},
                      .words = {"$Nodes", "$EndNodes", "$Elements", "$PhysicalNames", "*NODE", "*ELEMENT, TYPE=C3D8",
                                "*NSET", "<DataArray", "</DataArray>", "NumberOfCells=\"", "offset=\"", "\xFF\xFF\xFF\xFF"},
                      .read = [](const std::filesystem::path& file) {
                        mesh::ImportedMesh recipe;
                        recipe.path = file.string();
                        recipe.unit_m = 1e-3;
                        recipe.mesh_size_m = 0.03;
                        recipe.element_order = 1;
                        recipe.region_points.push_back({"body", {0.05, 0.01, 0.01}, {}});  // drawings: a point in each solid
                        (void)mesh::import_mesh(recipe);
                      }};
  if (reads_drawings) {
    target.extensions = {".step"};
    target.words = {"#1", "#10", "=", "(", ")", ";", "'", "*", "$", "CARTESIAN_POINT", "ADVANCED_FACE", "EDGE_LOOP", "-1."};
  }
  return fuzz::run(argc, argv, target);
}
