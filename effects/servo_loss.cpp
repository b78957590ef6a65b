#include <cmath>

#include "effects/axis.hpp"
#include "effects/doubt.hpp"

namespace driftwright::effects {
namespace {

void contribute(const Effect& e, HeatBalance& balance) {
  const double idle_W = e["idle"], power_W = e["power"], v0_m_s = e["at_feed"], exponent = e["exponent"];
  const std::size_t axis = axis_of(e);
  const auto law = [=](const Inputs& u) {
    const double v_m_s = u.drive.feed_m_s[axis];
    return idle_W + (v_m_s > 0.0 ? power_W * std::pow(v_m_s / v0_m_s, exponent) : 0.0);
  };
  balance.heats.push_back({e.name(), e.body(), law});
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  if (!s.moves_axes) return {};
  const double sd_W = s.unknown_heat_W(), trial_W = 0.1 * sd_W;
  std::vector<Doubt> list;
  for (const Body& body : s.bodies) {
    Doubt d{.finding = "heat_source",
            .where = body.name,
            .law = "in proportion to the feeds",
            .added = {},
            .numbers = {doubted("power", "W", sd_W, trial_W)},
            .trial = trial_W};
    for (const char* axis : {"x", "y", "z"}) {
      d.added.push_back(make_effect("servo_loss", body, {{"at_feed", 0.1}}));
      d.added.back().words["axis"] = axis;
    }
    list.push_back(std::move(d));
  }
  return list;
}

}  // namespace

EffectKind servo_loss() {
  return {.key = "servo_loss",
          .title = "loss of an axis' servo motor",
          .law = "P = idle + power (v / at_feed)^exponent; v: mean absolute feed. A power law fitted to measured heat",
          .places = {Place::kRegion, Place::kNode},
          .parameters = {{"power", "W", -1e6, 1e6, {}, "part that grows with feed, at the stated feed", 0.1, "heat_source"},
                         {"at_feed", "m/s", 1e-6, 100.0, {}, "the stated feed"},
                         {"exponent", "1", -1.0, 4.0, 1.0, "growth with feed; friction alone: 1", 0.03, "friction_law"},
                         {"idle", "W", 0.0, 1e6, 0.0, "holding current, also at standstill", 0.1, "heat_source"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .choices = {axis_choice()},
          .doubts = doubts};
}

}  // namespace driftwright::effects
