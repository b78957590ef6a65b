#pragma once
// What became of the films of files on the mesh: how much of each surface they cover, and what was kept of their integrals.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "effects/effect.hpp"
#include "mesh/mesh.hpp"

namespace driftwright::scenarios {

/// One state of a film on the mesh. Vectors have NaN where the file has no value.
struct MappedState {
  double at = 0.0;                                    ///< [rpm] or [s]
  double in_file_W_K = 0.0;                           ///< ∫ h dA over the cells of the file; NaN: it has points
  double mapped_W_K = 0.0;                            ///< over the surface
  std::vector<double> facet_film_W_m2K, facet_air_K;  ///< means of each facet of the mesh; air empty without it
  Eigen::VectorXd node_film_W_m2K;                    ///< ∫ h |N_i| dA / ∫ |N_i| dA of each node, for pictures
};

/// A film of a file on the mesh.
struct MappedFilm {
  std::string name, surface;
  effects::FieldOver over = effects::FieldOver::kNothing;
  int n_values = 0;
  bool has_cells = false;
  double reach_m = 0.0, area_m2 = 0.0, uncovered_m2 = 0.0;
  std::vector<MappedState> states;
};

/// Maps the films of all effects that have read a file.
/// @throws InputError  for a surface that does not exist, for a file more than 100 times as large as its surface without a
///                     `reach` (another unit of lengths), and for faces that the file does not cover, unless the effect has
///                     a film for them (`elsewhere`)
[[nodiscard]] std::vector<MappedFilm> mapped_films(const std::vector<effects::Effect>& effects, const mesh::Mesh& mesh);

}  // namespace driftwright::scenarios
