#pragma once
// Writes a mesh and a load for CalculiX (ccx, G. Dhondt, calculix.de), runs it, and reads its output. Temperatures are
// above the reference, and its absolute zero is left unset: linear problems only.

#include <map>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "solver/heat_assembly.hpp"

namespace driftwright::fixtures {

/// True when the program `ccx` is on PATH.
[[nodiscard]] bool has_calculix();

/// Nodes, cells, materials and sections; the sets NALL, one Eregion per region, and Nsurface for each of `node_sets`.
[[nodiscard]] std::string calculix_model(const mesh::Mesh& mesh, const solver::RegionMaterials& materials,
                                         const std::vector<std::string>& node_sets);

/// The lines of *FILM for a surface: element, face, sink temperature, coefficient.
[[nodiscard]] std::string calculix_film(const mesh::Mesh& mesh, const std::string& surface, double sink_K, double htc_W_m2K);

/// The values that *NODE PRINT wrote for NALL: by time, seven digits.
struct CalculixResult {
  std::map<double, Eigen::VectorXd> temperature;    ///< n_nodes [K]
  std::map<double, Eigen::Matrix3Xd> displacement;  ///< 3 x n_nodes [m]
};

/// Runs a deck in the test's temporary folder, for at most `limit_s`. @throws std::runtime_error  when ccx fails, with
/// its output
[[nodiscard]] CalculixResult run_calculix(const std::string& job, const std::string& deck, int n_nodes, int limit_s = 200);

}  // namespace driftwright::fixtures
