#include "solver/share.hpp"

#include <algorithm>

namespace driftwright::solver {

Eigen::VectorXd Share::part_of(const Eigen::VectorXd& whole) const {
  Eigen::VectorXd part(n_unknowns() - (whole.size() == n_whole_nodes ? n_lumped : 0));
  for (int i = 0; i < static_cast<int>(part.size()); ++i) part[i] = whole[whole_index(i)];
  return part;
}

int Share::held_index(int whole_unknown) const {
  if (whole_unknown >= n_whole_nodes) return is_first ? whole_unknown - n_whole_nodes + mesh.n_nodes() : -1;
  const auto held_end = whole_node.begin() + std::min(n_held, mesh.n_nodes());
  const auto found = std::lower_bound(whole_node.begin(), held_end, whole_unknown);  // held nodes come first, ascending
  return found == held_end || *found != whole_unknown ? -1 : static_cast<int>(found - whole_node.begin());
}

}  // namespace driftwright::solver
