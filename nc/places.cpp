#include "nc/places.hpp"

namespace driftwright {
namespace {

constexpr std::array<NcEntry, 3> kNowhere = {NcEntry::kNever, NcEntry::kNever, NcEntry::kNever};

/// @param next_motion  the block itself or the next one after it that moves
std::array<NcEntry, 3> entries(const NcStep& step, const NcStep* next_motion) {
  std::array<NcEntry, 3> result = kNowhere;
  if (step.no_place || step.deletable || step.before.compensated || step.compensated || step.before.drilling())
    return result;
  const std::optional<int>& motion = step.before.motion;
  const bool straight = motion && (*motion == 0 || *motion == 10), arc = motion && (*motion == 20 || *motion == 30);
  // An inserted line leaves G0 or G1 in force, so the next motion block must name its motion word.
  const bool restores = straight || (next_motion && next_motion->motion_word);
  const bool in_feed = (straight && *motion == 10) || arc;
  const bool feeds = step.before.feed_mode == NcFeedMode::PerMinute && step.before.has_feed;
  for (int axis = 0; axis < 3; ++axis) {
    if (step.kind == NcStepKind::kRapid && step.absolute && step.named[axis]) {
      result[axis] = NcEntry::kAlongRapid;
    } else if (step.known[axis] && restores && !in_feed) {
      result[axis] = NcEntry::kStepAfterRapid;
    } else if (step.known[axis] && restores && feeds) {
      result[axis] = NcEntry::kStepInFeed;
    }
  }
  return result;
}

}  // namespace

std::array<NcEntry, 3> nc_entries(const std::vector<NcStep>& steps, std::size_t step) {
  std::size_t next = step;
  while (next < steps.size() && steps[next].kind == NcStepKind::kNone) ++next;
  return entries(steps[step], next < steps.size() ? &steps[next] : nullptr);
}

std::vector<std::array<NcEntry, 3>> nc_entries(const std::vector<NcStep>& steps) {
  std::vector<std::array<NcEntry, 3>> result(steps.size(), kNowhere);
  const NcStep* next_motion = nullptr;
  for (std::size_t i = steps.size(); i-- > 0;) {
    if (steps[i].kind != NcStepKind::kNone) next_motion = &steps[i];
    if (steps[i].duration_s() > 0.0) result[i] = entries(steps[i], next_motion);
  }
  return result;
}

std::string why_not_divisible(const NcStep& step) {
  if (step.kind == NcStepKind::kNone) return "the axes are at rest";
  if (step.kind == NcStepKind::kArc) return "an arc";
  if (step.kind == NcStepKind::kDrilling) return "a canned cycle";
  if (step.kind == NcStepKind::kMachine) return "in machine coordinates";
  if (step.before.compensated || step.compensated) return "cutter compensation";
  if (step.no_place) return step.n_runs > 1 ? "it is run more than once" : "mirrored, turned, or within a modal cycle";
  if (step.deletable) return "a block that '/' may leave out";
  if (step.before.drilling()) return "it ends a canned cycle";
  if (!step.absolute || !step.before.absolute) return "G91";
  if (step.before.feed_mode == NcFeedMode::InverseTime) return "G93";
  if (!step.plain) return "it has more words than N, G0, G1, X, Y, Z, F";
  for (int axis = 0; axis < 3; ++axis) {
    if (step.named[axis] && !step.known[axis]) return "its starting point is not stated";
  }
  return "";
}

}  // namespace driftwright
