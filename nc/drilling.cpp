#include "nc/drilling.hpp"

#include <algorithm>

#include "nc/arc.hpp"

namespace driftwright {
namespace {

constexpr double kPeckClearance_m = 0.254e-3;  // 0.010 inch

class Drill {
 public:
  Drill(NcMotion& motion, const NcDrilling& cycle) : motion_(motion), cycle_(cycle) {}

  void rapid(double level_m) { motion_.rapid_to(at(level_m)); }
  void feed(double level_m) { motion_.feed_to(at(level_m)); }
  void rapid_across(const std::array<double, 2>& hole_m) {
    const auto [u, v] = plane_axes(cycle_.normal);
    std::array<double, 3> target_m = motion_.position_m;
    target_m[u] = hole_m[0];
    target_m[v] = hole_m[1];
    motion_.rapid_to(target_m);
  }
  double level_m() const { return motion_.position_m[cycle_.normal]; }

  void peck() {
    const int n_pecks_before_last = static_cast<int>((cycle_.retract_m - cycle_.bottom_m) / cycle_.peck_m * (1 - 1e-12));
    for (int i = 1; i <= n_pecks_before_last; ++i) {
      const double depth_m = cycle_.retract_m - i * cycle_.peck_m;
      feed(depth_m);
      if (cycle_.code == 83) rapid(cycle_.retract_m);
      rapid(std::min(depth_m + kPeckClearance_m, cycle_.retract_m));
    }
    feed(cycle_.bottom_m);
  }

 private:
  [[nodiscard]] std::array<double, 3> at(double level_m) const { return motion_.at_level(cycle_.normal, level_m); }
  NcMotion& motion_;
  const NcDrilling& cycle_;
};

}  // namespace

void drill(NcMotion& motion, const NcDrilling& cycle) {
  if (!(cycle.bottom_m <= cycle.retract_m))
    throw InputError(motion.where, "the canned cycle's bottom lies above its R level; drilling goes downward");
  if (motion.feed_mode == NcFeedMode::InverseTime)
    throw InputError(motion.where, "a canned cycle is not allowed with G93; write G94 or G95 before it");
  const bool pecks = cycle.code == 73 || cycle.code == 83;
  if (pecks && !(cycle.peck_m > 0.0 && (cycle.retract_m - cycle.bottom_m) / cycle.peck_m < 1e5))
    throw InputError(motion.where, "the depth of a peck, Q, must be above zero and at least 1e-5 of the depth of the hole");
  Drill tool(motion, cycle);
  if (tool.level_m() < cycle.retract_m) tool.rapid(cycle.retract_m);
  for (int i = 0; i < cycle.n_holes; ++i) {
    tool.rapid_across({cycle.first_m[0] + i * cycle.spacing_m[0], cycle.first_m[1] + i * cycle.spacing_m[1]});
    tool.rapid(cycle.retract_m);
    if (pecks) {
      tool.peck();
    } else {
      tool.feed(cycle.bottom_m);
    }
    motion.wait(cycle.dwell_s);
    if (cycle.code == 84) {
      tool.feed(cycle.clear_m);
    } else {
      if (cycle.code == 85) tool.feed(cycle.retract_m);
      tool.rapid(cycle.clear_m);
    }
  }
}

}  // namespace driftwright
