#pragma once
// What effects say about heat, in words of the machine (regions, surfaces, joints), before any mesh or matrix.
// The solver turns each entry into a matrix or a load.

#include <functional>
#include <string>
#include <vector>

namespace driftwright::effects {

/// What drives the machine at one instant.
struct Inputs {
  double speed_rpm = 0.0;
  double hall_K = 0.0;  ///< hall temperature minus the reference temperature
};

/// A coefficient that depends on the inputs alone.
using Law = std::function<double(const Inputs&)>;

/// Heat released evenly over the volume of a region. power_W > 0 heats.
struct HeatInput {
  std::string name;
  std::string region;
  Law power_W;
};

/// Film on a surface: heat out of the body q = htc (T_surface - T_surrounding) per area.
struct Film {
  std::string name;
  std::string surface;
  Law htc_W_m2K;
  std::string surrounding;  ///< "hall" or the name of a lumped node
};

/// Contact across a joint: q = conductance (T_a - T_b) per area.
struct Contact {
  std::string name;
  std::string joint;
  double conductance_W_m2K = 0.0;
};

/// A body with one temperature, such as the air near the nose.
struct LumpedNode {
  std::string name;
  double capacity_J_K = 0.0;
  double hall_conductance_W_K = 0.0;  ///< to the hall
};

struct HeatBalance {
  std::vector<HeatInput> heats;
  std::vector<Film> films;
  std::vector<Contact> contacts;
  std::vector<LumpedNode> nodes;
};

}  // namespace driftwright::effects
