#include "machine/mesh_demand.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

#include "machine/model.hpp"
#include "machine/reduced_machine.hpp"
#include "solver/elasticity.hpp"
#include "solver/rigid_motion.hpp"
#include "solver/stiffness_assembly.hpp"
#include "solver/stiffness_factor.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kMB = 1048576.0;
// Measured values (docs/theory/performance.md) [bytes]: the process without a mesh, and per pair of coupled nodes.
constexpr double kProgram = 74.0 * kMB;
constexpr double kAssembled = 254.0;       // both triangles of blocks, CHOLMOD's copy, mesh and loads
constexpr double kMultigrid = 610.0;       // the same with all levels
constexpr double kHeatMatrix = 12.0;       // a number and its column
constexpr int kHeatMatrices = 8;           // in addition to one for each set of coefficients
constexpr double kVectorsOfOutput = 8.0;   // number of copies
constexpr double kVectorsOfPoint = 280.0;  // basis, its products and fields, for each set of coefficients
// Seconds: per multiplication, per byte of a factor in a solve, per pair of nodes for assembly and for multigrid, per basis.
constexpr double kMultiplied_s = 3.3e-11, kSolved_s = 2e-10, kAssembled_s = 1.2e-6, kCycled_s = 1.4e-6, kBasis_s = 3e-9;

/// The number after a word at the start of a line of a system file, or that of the whole file if the word is empty; infinite
/// if there is none.
double number_in(const std::string& file, const std::string& word) {
  std::ifstream in(file);
  double number = 0.0;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(word) && std::istringstream(line.substr(word.size())) >> number) return number;
  }
  return std::numeric_limits<double>::infinity();
}

double half_of_memory() {
  return 0.5 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

/// The number of elastic solves.
int n_solves(const Scenario& scenario, const PlacedMachine& placed, bool full) {
  const auto n = static_cast<int>(placed.functionals.size());
  if (scenario.solver.fields_format == FieldsFormat::kNone) return n;
  return n + (full ? n_fields(scenario) : kStates);
}

}  // namespace

MeshDemand mesh_demand(const Scenario& scenario, const PlacedMachine& placed, bool full) {
  const mesh::Mesh& mesh = placed.mesh;
  if (mesh.n_nodes() == 0) return {.memory_bytes = kProgram, .time_s = 0.1, .method = "lumped nodes"};
  const bool is_elastic = needs_elasticity(placed, scenario.solver.fields_format != FieldsFormat::kNone);
  std::vector<solver::SpringLayer> layers;
  if (is_elastic) layers = solver::holding(mesh, placed.materials, placed.supports, placed.joints).layers;
  const solver::BlockPattern nodes = solver::stiffness_pattern(mesh, layers);
  const auto n_pairs = static_cast<double>(nodes.column.size());
  const double n = mesh.n_nodes();
  MeshDemand demand{.memory_bytes = kProgram + 6.0 * kHeatMatrix * n_pairs,
                    .time_s = 0.5 + 0.2 * kAssembled_s * n_pairs,
                    .method = "heat alone"};
  double stays = kProgram;  // memory that remains in use while the elastic machine is kept
  if (is_elastic) {
    const int solves = n_solves(scenario, placed, full);
    solver::FactorSize factor;
    bool by_factor = solver::factor_pays(3 * mesh.n_nodes(), solves);
    if (by_factor) {
      factor = solver::factor_size(nodes, 3);
      by_factor = factor.bytes + factor.bytes_while_made <= half_of_memory();
    }
    const double outputs = 8.0 * n * static_cast<double>(placed.functionals.size());
    if (by_factor) {
      demand.method = "elasticity by a Cholesky factor";
      demand.memory_bytes = kProgram + factor.bytes + factor.bytes_while_made + kAssembled * n_pairs + outputs;
      demand.time_s += kAssembled_s * n_pairs + kMultiplied_s * factor.work + solves * kSolved_s * factor.bytes;
      stays += factor.bytes;
    } else {
      demand.method = "elasticity by multigrid";
      demand.memory_bytes = kProgram + kMultigrid * n_pairs + outputs;
      demand.time_s += (kAssembled_s + solves * kCycled_s) * n_pairs;
      stays += (kMultigrid - kAssembled / 2.0) * n_pairs;
    }
  }
  if (full) return demand;
  demand.method += ", reduced model";
  const solver::FactorSize heat = solver::factor_size(nodes, 1);
  std::vector<const Cyclogram*> cyclograms;
  for (const Cyclogram& c : scenario.cyclograms) cyclograms.push_back(&c);
  const auto n_points = static_cast<double>(reduction_plan(scenario, cyclograms).demand.points().size());
  const auto n_outputs = static_cast<double>(placed.functionals.size() + placed.sensor_weights.size());
  const double reducing = stays + heat.bytes + heat.bytes_while_made + kHeatMatrix * n_pairs * (kHeatMatrices + n_points) +
                          8.0 * n * (kVectorsOfOutput * n_outputs + kVectorsOfPoint * n_points);
  demand.memory_bytes = std::max(demand.memory_bytes, reducing);
  const double n_basis = kVectorsOfPoint * n_points / 3.0;
  demand.time_s +=
      kBasis_s * n * n_basis * n_basis + kSolved_s * heat.bytes * n_basis + kMultiplied_s * heat.work * 10.0 * n_points;
  return demand;
}

double room_bytes() {
  double room = 1024.0 * number_in("/proc/meminfo", "MemAvailable:");
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line;
       std::getline(groups, line);) {  // "0::/user.slice/..." of version 2; the limits of parent groups also apply
    if (!line.starts_with("0::")) continue;
    for (std::string group = line.substr(3); !group.empty(); group.resize(group.find_last_of('/'))) {
      const std::string folder = "/sys/fs/cgroup" + group;
      const double most = number_in(folder + "/memory.max", ""), taken = number_in(folder + "/memory.current", "");
      if (most < std::numeric_limits<double>::infinity() && taken < most) room = std::min(room, most - taken);
    }
  }
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    room = std::min(room, static_cast<double>(space.rlim_cur) - 1024.0 * number_in("/proc/self/status", "VmSize:"));
  return std::max(0.0, room);
}

void require_room(const Scenario& scenario, const PlacedMachine& placed, const MeshDemand& demand, double room_bytes) {
  if (demand.memory_bytes - kProgram <= room_bytes) return;  // the program itself is already in memory
  std::string change = "a coarser mesh, or a machine with more memory";
  if (scenario.solver.model == ModelKind::kReduced) {
    const double full = mesh_demand(scenario, placed, true).memory_bytes;
    if (full < 0.9 * demand.memory_bytes)
      change = fmt::format("`model: full` in `solver` (about {:.1f} GB), {}", 1e-9 * full, change);
  }
  throw InputError(
      scenario.machine->where,
      fmt::format(
          "{} nodes would take about {:.1f} GB of memory, and {:.1f} GB are left here: it would swap, or be killed. Take {}",
          placed.mesh.n_nodes(), 1e-9 * demand.memory_bytes, 1e-9 * room_bytes, change));
}

}  // namespace driftwright::scenarios
