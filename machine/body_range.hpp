#pragma once
// How cold and how warm each body became in a run, and what of that no machine does.

#include <string>
#include <vector>

#include "machine/model.hpp"

namespace driftwright::scenarios {

/// Temperatures of a region or lumped node in a run, absolute.
struct BodyRange {
  std::string body;
  double low_K = 0.0, high_K = 0.0;
  double highest_s = 0.0;  ///< time of the highest
};

/// Takes the states of a run: all of the full model, of a reduced one with a mesh some, since each takes the temperatures of all its nodes. A reduced
/// model does not tell those of its lumped nodes, and one opened without fields tells none.
class BodyRangeWatch {
 public:
  /// @param n_states  that the run will have. The model outlives the watch.
  BodyRangeWatch(const MachineModel& machine, const Model& model, std::size_t n_states);
  void take(double time_s, const Eigen::VectorXd& state);
  [[nodiscard]] const std::vector<BodyRange>& bodies() const { return bodies_; }

 private:
  const Model& model_;
  double reference_K_;
  std::size_t every_ = 1, n_taken_ = 0, n_states_;
  std::vector<int> body_of_unknown_;
  std::vector<BodyRange> bodies_;
};

/// Bodies outside of the usual temperatures, the one that goes farthest alone, and those that left the table of a property of their material.
[[nodiscard]] std::vector<std::string> unusual_temperatures(const std::vector<BodyRange>& bodies,
                                                            const MachineModel& machine, const std::string& cyclogram);

}  // namespace driftwright::scenarios
