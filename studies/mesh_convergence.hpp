#pragma once
// Whether a machine's mesh is fine enough: one cyclogram on three meshes, and the error of each displacement, tilt and
// thermometer that follows.

#include <string>
#include <vector>

#include "base/cyclogram.hpp"
#include "scenarios/reader/scenario.hpp"
#include "studies/grid_convergence.hpp"
#include "studies/mesh_ladder.hpp"

namespace driftwright::studies {

/// One of the three meshes, and what its run took.
struct MeshLevel {
  double factor = 1.0;  ///< on the mesh sizes of the scenario
  double size_m = 0.0;  ///< MeshRung::size_m
  int n_elements = 0;
  int n_unknowns = 0;
  double seconds = 0.0;    ///< wall time of meshing, model and cyclogram
  bool was_known = false;  ///< the reduced model came from disk, so `seconds` is short
};

/// A number of the cyclogram on the three meshes, from coarse to fine.
struct ConvergedValue {
  std::string channel;
  std::string unit;                   ///< um, urad, or K for the rise of a thermometer since the start
  bool is_peak = false;               ///< false: at the end
  std::array<double, 3> values = {};  ///< peaks have the sign of the largest deviation on the finest mesh
  GridConvergence convergence;
};

struct MeshConvergence {
  std::string cyclogram;
  std::string model;                   ///< which model was run on each mesh, in words
  double highest_order = 0.0;          ///< of point values in theory: order of the elements plus one
  std::array<MeshLevel, 3> levels;     ///< from coarse to fine
  std::size_t own = 0;                 ///< index of the scenario's own mesh
  std::vector<ConvergedValue> values;  ///< channels in the order of the record, each at the end, then its peak
};

/// Runs a cyclogram on three meshes of the scenario's machine with the scenario's model (full or reduced). The reduced
/// model's error (`reduction_tolerance`) is the resolution of its results.
/// @param most_elements  of the finest mesh, if it is finer than the scenario's
/// @throws InputError  as mesh_ladder() @throws SolveError
[[nodiscard]] MeshConvergence mesh_convergence(const scenarios::Scenario& scenario, const Cyclogram& cyclogram,
                                               int most_elements, const Listener& listener);

/// The displacement or tilt with the largest error on the scenario's own mesh, relative to its own largest value; null if
/// there is none that changes from mesh to mesh by more than the model's own error.
[[nodiscard]] const ConvergedValue* worst_displacement(const MeshConvergence& found);

}  // namespace driftwright::studies
