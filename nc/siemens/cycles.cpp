#include "nc/siemens/cycles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "nc/tapping.hpp"

namespace driftwright {
namespace {

/// An argument, if it is given.
std::optional<double> of(const SiemensCycle& c, std::size_t i) {
  return i < c.p.size() ? c.p[i] : std::nullopt;
}

/// CYCLE83(RTP, RFP, SDIS, DP, DPR, FDEP, FDPR, DAM, DTB, DTS, FRF, VARI): each depth is smaller by DAM than the previous,
/// but at least DAM.
template <class At>
void drill_deep(NcExecution& run, const SiemensCycle& c, double reference_m, double safe_m, double bottom_m, const At& at) {
  NcMotion& motion = run.motion;
  double depth_m = reference_m;
  if (of(c, 5)) {
    depth_m = *of(c, 5) * run.unit_m;
  } else if (of(c, 6)) {
    depth_m = reference_m - std::abs(*of(c, 6)) * run.unit_m;
  } else {
    run.fail("CYCLE83 has no first depth FDEP or FDPR");
  }
  const double degression = of(c, 7).value_or(0.0);
  double bite_m = reference_m - depth_m;
  if (!(bite_m > 0.0 && (reference_m - bottom_m) / bite_m < 1e5))
    run.fail("the first depth of CYCLE83 must be below its reference plane");
  const bool clears = of(c, 11).value_or(0.0) != 0.0;
  const double modal_feed = motion.feed;
  if (of(c, 10).value_or(0.0) > 0.0) motion.feed *= *of(c, 10);
  for (int n = 0; n < 100000; ++n) {
    depth_m = std::max(depth_m, bottom_m);
    motion.feed_to(at(depth_m));
    motion.feed = modal_feed;
    motion.wait(of(c, 8).value_or(0.0));
    if (depth_m <= bottom_m) return;
    if (clears) {  // to the safe level, and back to 0.6 mm above the depth reached (for 30 mm and less)
      motion.rapid_to(at(safe_m));
      motion.wait(of(c, 9).value_or(0.0));
      const double hole_m = reference_m - bottom_m;
      motion.rapid_to(at(depth_m + (hole_m <= 0.030 ? 0.6e-3 : hole_m / 50.0)));
    } else {
      motion.feed_to(at(depth_m + 1e-3));  // breaks the chip
    }
    const double least_m = degression < 0.0 ? 0.0 : degression * run.unit_m;
    const double next_m = degression < 0.0 ? bite_m * -degression : bite_m - least_m;
    bite_m = degression > 0.0 ? std::max(next_m, std::min(bite_m, least_m)) : degression < 0.0 ? next_m : bite_m;
    if (!(bite_m > 1e-6)) run.fail("the depths of CYCLE83 shrink to nothing");
    depth_m -= bite_m;
  }
  run.fail("CYCLE83 has more than 100000 pecks");
}

}  // namespace

std::optional<int> siemens_cycle_code(const std::string& name) {
  static const std::map<std::string, int> kCycles = {
      {"CYCLE81", 81}, {"CYCLE82", 82}, {"CYCLE83", 83}, {"CYCLE84", 84}, {"CYCLE85", 85}};
  const auto found = kCycles.find(name);
  return found == kCycles.end() ? std::nullopt : std::optional(found->second);
}

void run_siemens_cycle(NcExecution& run, const SiemensCycle& c) {
  const auto need = [&](std::size_t i, const char* name) {
    const auto x = of(c, i);
    if (!x) run.fail(fmt::format("CYCLE{} has no {}", c.code, name));
    return *x * run.unit_m;
  };
  const double retract_m = need(0, "retraction plane RTP"), reference_m = need(1, "reference plane RFP"),
               safe_m = reference_m + std::abs(of(c, 2).value_or(0.0)) * run.unit_m;
  if (!of(c, 3) && !of(c, 4)) run.fail(fmt::format("CYCLE{} has no depth DP or DPR", c.code));
  const double bottom_m = of(c, 3) ? *of(c, 3) * run.unit_m : reference_m - std::abs(*of(c, 4)) * run.unit_m;
  if (!(bottom_m <= safe_m && retract_m >= bottom_m))
    run.fail(fmt::format("the depth of CYCLE{} lies above its planes; drilling goes downward", c.code));
  NcMotion& motion = run.motion;
  const auto at = [&](double level_m) { return motion.at_level(run.normal, level_m); };
  motion.rapid_to(at(safe_m));
  switch (c.code) {
    case 83:
      drill_deep(run, c, reference_m, safe_m, bottom_m, at);
      break;
    case 84: {
      const double pitch_m = std::abs(of(c, 8).value_or(0.0)) * run.unit_m;
      if (!(pitch_m > 0.0)) run.fail("CYCLE84 has no pitch PIT; threads by size (MPIT) are not looked up here");
      const double in_rpm = of(c, 10).value_or(0.0) > 0.0 ? *of(c, 10) : motion.programmed_rpm;
      tap_to(run, at(bottom_m), pitch_m, in_rpm);
      motion.wait(of(c, 5).value_or(0.0));
      tap_to(run, at(safe_m), pitch_m, of(c, 11).value_or(0.0) > 0.0 ? *of(c, 11) : in_rpm);
      motion.turning = false;
      break;
    }
    case 85: {
      const double modal_feed = motion.feed;
      if (of(c, 6).value_or(0.0) > 0.0) run.set_feed(*of(c, 6));
      motion.feed_to(at(bottom_m));
      motion.wait(of(c, 5).value_or(0.0));
      if (of(c, 7).value_or(0.0) > 0.0) run.set_feed(*of(c, 7));
      motion.feed_to(at(safe_m));
      motion.feed = modal_feed;
      break;
    }
    default:
      motion.feed_to(at(bottom_m));
      if (c.code == 82) motion.wait(of(c, 5).value_or(0.0));
  }
  motion.rapid_to(at(retract_m));
}

}  // namespace driftwright
