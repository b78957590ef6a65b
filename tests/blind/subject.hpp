#pragma once
// A machine for cases: its nominal scenario, the finer mesh of the truth, and a small system for cheap derivatives.

#include <string>
#include <vector>

#include "blind/network.hpp"
#include "machine/machine.hpp"

namespace driftwright::blind {

/// All numbers of a machine that may differ from its scenario.
struct Values {
  std::vector<effects::Effect> effects;
  std::vector<double> conductivity, heat_capacity, expansion;  ///< factors, per region
  std::vector<double> node_capacity;                           ///< factors, per lumped node
  std::vector<std::vector<double>> sensitivity;                ///< factors, per displacement and term
};

/// A number that scatters: its logarithm is normal around the nominal value, with this standard deviation.
struct ScatterParameter {
  std::string name;
  double sigma = 0.1;
  enum class Of { kEffect, kConductivity, kHeatCapacity, kExpansion, kSensitivity } of = Of::kEffect;
  std::size_t index = 0;  ///< of the effect, region or displacement
  std::size_t term = 0;   ///< parameter of the effect, term of the displacement
  std::string place;      ///< region, or the effect's name()
};

struct Subject {
  std::string name, yaml;  ///< yaml: the scenario a user would have
  std::string drawing;     ///< file the scenario names, or ""
  scenarios::MachineModel model;
  scenarios::PlacedMachine placed;         ///< on the truth's mesh
  std::vector<Eigen::MatrixXd> influence;  ///< per region: n_nodes x n_displacements
  std::vector<std::string> nodes;          ///< lumped nodes, in their order
  double top_speed_rpm = 0.0;
  // The small system at nominal values, M-orthonormal, and the contributions of each region and node.
  SmallNetwork small;
  std::vector<Eigen::MatrixXd> small_mass, small_conduction, small_displacement;  ///< per region
  Eigen::MatrixXd small_node;                                                     ///< size x n_nodes
  std::vector<double> node_capacity_J_K;
  std::vector<ScatterParameter> scatter;

  [[nodiscard]] bool is_lumped() const { return placed.mesh.n_nodes() == 0; }
  [[nodiscard]] std::size_t n_sensors() const { return model.sensors.size(); }
  [[nodiscard]] std::size_t n_outputs() const { return model.sensors.size() + model.displacements.size(); }
  [[nodiscard]] std::string output_name(std::size_t i) const {
    return i < n_sensors() ? model.sensors[i].name : model.displacements[i - n_sensors()].name;
  }
};

/// Names of the machines that cases use in turn.
[[nodiscard]] const std::vector<std::string>& subject_names();

/// @param folder      of the machines' scenarios
/// @param mesh_share  size of the truth's cells over those of the scenario
/// @throws InputError, SolveError  as scenarios::place()
[[nodiscard]] Subject make_subject(const std::string& folder, const std::string& name, double mesh_share = 0.7);

[[nodiscard]] Values nominal_values(const Subject& subject);
/// Multiplies one number.
void scale(Values& values, const ScatterParameter& parameter, double factor);

/// The heat balance of the values, followed by a source without power for every region, surface and node ("spare <name>")
/// and a film without coefficient for every surface: places for hidden effects, so that the structure is always the same.
[[nodiscard]] effects::HeatBalance balance_of(const Subject& subject, const Values& values);

[[nodiscard]] FullNetwork full_network(const Subject& subject, const Values& values);
[[nodiscard]] SmallNetwork small_network(const Subject& subject, const Values& values);

}  // namespace driftwright::blind
