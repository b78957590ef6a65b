#pragma once
// The lowest and highest temperature of each body in a run, and warnings about impossible ones.

#include <string>
#include <vector>

#include "machine/model.hpp"

namespace driftwright::scenarios {

/// Absolute temperatures of a region or lumped node in a run.
struct BodyRange {
  std::string body;
  double low_K = 0.0, high_K = 0.0;
};

/// Collects these from the states of a run: from all states of the full model, from some states of a reduced one with a
/// mesh, because each needs the temperatures of all nodes. A reduced model has no temperatures of its lumped nodes; one
/// opened without fields has none at all.
class BodyRangeWatch {
 public:
  /// @param n_states  number of states in the run. The model must outlive the watch.
  BodyRangeWatch(const MachineModel& machine, const Model& model, std::size_t n_states);
  void take(const Eigen::VectorXd& state);
  [[nodiscard]] const std::vector<BodyRange>& bodies() const { return bodies_; }

 private:
  const Model& model_;
  double reference_K_;
  std::size_t every_ = 1, n_taken_ = 0, n_states_;
  std::vector<int> body_of_unknown_;
  std::vector<BodyRange> bodies_;
};

/// Warnings about bodies outside of the usual temperatures (only the most extreme one) and outside of the table of a
/// material property.
[[nodiscard]] std::vector<std::string> unusual_temperatures(const std::vector<BodyRange>& bodies,
                                                            const MachineModel& machine, const std::string& cyclogram);

}  // namespace driftwright::scenarios
