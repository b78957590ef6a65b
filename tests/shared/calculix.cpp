#include "tests/shared/calculix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "mesh/topology.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::fixtures {
namespace {

using mesh::CellShape;

const char* calculix_name(CellShape shape) {
  switch (shape) {
    case CellShape::kTet4:
      return "C3D4";
    case CellShape::kTet10:
      return "C3D10";
    case CellShape::kHex8:
      return "C3D8";
    case CellShape::kHex20:
      return "C3D20";
    case CellShape::kWedge6:
      return "C3D6";
    case CellShape::kWedge15:
      return "C3D15";
    default:
      throw std::logic_error("calculix_name: a facet is no element");
  }
}

std::vector<int> sorted_corners(CellShape facet, std::span<const int> nodes) {
  std::vector<int> corners(nodes.begin(), nodes.begin() + mesh::n_corners_of(facet));
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace

bool has_calculix() {
  return std::system("command -v ccx > /dev/null 2>&1") == 0;
}

std::string calculix_model(const mesh::Mesh& mesh, const solver::RegionMaterials& materials,
                           const std::vector<std::string>& node_sets) {
  std::string deck = "*NODE, NSET=NALL\n";
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const auto x = mesh.coords.col(i);
    deck += fmt::format("{}, {:.12e}, {:.12e}, {:.12e}\n", i + 1, x[0], x[1], x[2]);
  }
  for (std::size_t region = 0; region < mesh.regions.size(); ++region) {
    const std::vector<int> cells = mesh.cells_in(static_cast<int>(region));
    deck +=
        fmt::format("*ELEMENT, TYPE={}, ELSET=E{}\n", calculix_name(mesh.cells.shape[cells.front()]), mesh.regions[region]);
    for (int c : cells) {  // corners and mid-side nodes in the order of Abaqus, which is VTK's
      deck += fmt::format("{}", c + 1);
      int in_line = 1;
      for (int node : mesh.cells.nodes(c)) {
        deck += in_line++ % 16 == 0 ? ",\n" : ", ";
        deck += fmt::format("{}", node + 1);
      }
      deck += "\n";
    }
  }
  for (const std::string& surface : node_sets) {
    deck += fmt::format("*NSET, NSET=N{}\n", surface);
    for (int f : mesh.facets_on(mesh.surface(surface))) {
      for (int node : mesh.facets.nodes(f)) deck += fmt::format("{},\n", node + 1);
    }
  }
  for (std::size_t region = 0; region < mesh.regions.size(); ++region) {
    const solver::Material& m = materials[region];
    deck += fmt::format(
        "*MATERIAL, NAME=M{0}\n*ELASTIC\n{1:.12e}, {2:.12e}\n*EXPANSION, ZERO=0.\n{3:.12e}\n*CONDUCTIVITY\n{4:.12e}\n"
        "*DENSITY\n{5:.12e}\n*SPECIFIC HEAT\n{6:.12e}\n*SOLID SECTION, ELSET=E{0}, MATERIAL=M{0}\n",
        mesh.regions[region], m.youngs_modulus_Pa, m.poisson_ratio, m.expansion_1_K.x, m.conductivity_W_mK, m.density_kg_m3,
        m.heat_capacity_J_kgK);
  }
  return deck + "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 0.\n";
}

std::string calculix_film(const mesh::Mesh& mesh, const std::string& surface, double sink_K, double htc_W_m2K) {
  std::map<std::vector<int>, std::pair<int, int>> face_at;  // corners to element and face
  for (int c = 0; c < mesh.cells.size(); ++c) {
    int number = 1;
    for (const mesh::Face& face : mesh::faces_of(mesh.cells.shape[c])) {
      std::vector<int> nodes;
      for (int i = 0; i < mesh::n_nodes_of(face.shape); ++i) nodes.push_back(mesh.cells.nodes(c)[face.node[i]]);
      face_at[sorted_corners(face.shape, nodes)] = {c, number++};
    }
  }
  std::string lines;
  for (int f : mesh.facets_on(mesh.surface(surface))) {
    const auto [cell, face] = face_at.at(sorted_corners(mesh.facets.shape[f], mesh.facets.nodes(f)));
    lines += fmt::format("{}, F{}, {:.12e}, {:.12e}\n", cell + 1, face, sink_K, htc_W_m2K);
  }
  return lines;
}

CalculixResult run_calculix(const std::string& job, const std::string& deck, int n_nodes, int limit_s) {
  const std::string folder = temporary_folder().string();
  (void)write_file(job + ".inp", deck);
  const int status = std::system(
      fmt::format("cd '{}' && OMP_NUM_THREADS=1 timeout {} ccx -i {} > {}.log 2>&1", folder, limit_s, job, job).c_str());
  const auto fail = [&](const std::string& why) {
    std::stringstream log;
    log << std::ifstream(folder + "/" + job + ".log").rdbuf();
    const std::string text = log.str();
    throw std::runtime_error(why + ": " + text.substr(text.size() - std::min<std::size_t>(text.size(), 2000)));
  };
  if (status != 0) fail(fmt::format("ccx ended with {}", status));
  CalculixResult result;
  std::ifstream dat(folder + "/" + job + ".dat");
  std::string line;
  Eigen::VectorXd* temperature = nullptr;
  Eigen::Matrix3Xd* displacement = nullptr;
  while (std::getline(dat, line)) {
    const auto at = line.find("and time");
    if (at != std::string::npos) {
      const double time_s = std::stod(line.substr(at + 8));
      const bool is_temperature = line.find("temperatures") != std::string::npos;
      temperature = is_temperature ? &(result.temperature[time_s] = Eigen::VectorXd::Zero(n_nodes)) : nullptr;
      displacement = is_temperature ? nullptr : &(result.displacement[time_s] = Eigen::Matrix3Xd::Zero(3, n_nodes));
      continue;
    }
    std::istringstream numbers(line);
    int node = 0;
    if (!(numbers >> node)) continue;
    if (temperature) numbers >> (*temperature)[node - 1];
    if (displacement)
      numbers >> (*displacement)(0, node - 1) >> (*displacement)(1, node - 1) >> (*displacement)(2, node - 1);
    if (!numbers) fail("ccx wrote '" + line + "'");
  }
  if (result.temperature.empty() && result.displacement.empty()) fail("ccx printed nothing");
  return result;
}

}  // namespace driftwright::fixtures
