#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "effects/axis.hpp"
#include "effects/doubt.hpp"

namespace driftwright::effects::servo_loss {

void contribute(const Effect& e, HeatBalance& balance) {
  const double idle_W = e["idle"], holding_W = e["holding"], power_W = e["power"], v0_m_s = e["at_feed"],
               exponent = e["exponent"];
  const std::size_t axis = axis_of(e);
  const auto law = [=](const Inputs& u) {
    const double v_m_s = u.drive.feed_m_s[axis];
    return idle_W + (v_m_s > 0.0 ? power_W * std::pow(v_m_s / v0_m_s, exponent) : holding_W);
  };
  balance.heats.push_back({e.name(), e.body(), law});
}

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

Effect loss(const Body& body, std::size_t axis, double at_feed_m_s, double exponent) {
  Effect e = make_effect("servo_loss", body, {{"power", 0.0}, {"at_feed", at_feed_m_s}, {"exponent", exponent}});
  e.words["axis"] = kAxes[axis];
  return e;
}

/// Heat of a screw, a nut, a guideway or a motor that the scenario lacks: equal on all axes, on one axis, and on one that
/// holds a weight at rest.
std::vector<Doubt> doubts(const DoubtScene& s) {
  constexpr double kUsualExponent = 1.5;  // between dry friction and viscous drag
  const auto n_moving = std::count_if(s.top_feed_m_s.begin(), s.top_feed_m_s.end(), [](double v) { return v > 0.0; });
  if (n_moving == 0) return {};
  const double sd_W = s.unknown_heat_W(), trial_W = 0.1 * sd_W;
  std::vector<Doubt> list;
  for (const Body& body : s.bodies) {
    Doubt d{.finding = "heat_source",
            .where = body.name,
            .law = "in proportion to the feeds",
            .added = {},
            .numbers = {doubted("power", "W", sd_W, trial_W)},
            .trial = trial_W};
    for (std::size_t axis = 0; axis < kAxes.size(); ++axis) d.added.push_back(loss(body, axis, 0.1, 1.0));
    list.push_back(d);
    for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
      const double top_m_s = s.top_feed_m_s[axis];
      if (!(top_m_s > 0.0)) continue;
      Doubt one = d;
      one.law = fmt::format("power law of the feed of {}, at {:.3g} m/min", kAxes[axis], 60.0 * top_m_s);
      one.added = {loss(body, axis, top_m_s, kUsualExponent)};
      one.numbers.push_back(doubted("exponent", "1", 0.7, 0.05, kUsualExponent));
      one.numbers.back().low = 0.1;
      one.numbers.back().high = 4.0;
      one.grid = {{-0.5}, {0.3}};
      list.push_back(one);
      if (!s.axis_rests[axis]) continue;
      one.law = fmt::format("constant heat while the axis {} is at rest", kAxes[axis]);
      one.numbers = {doubted("holding", "W", sd_W, trial_W)};
      one.numbers[0].low = 0.0;
      one.grid = {{}};
      list.push_back(std::move(one));
    }
  }
  return list;
}

EffectKind kind() {
  return {.key = "servo_loss",
          .title = "loss of an axis' servo motor",
          .law =
              "P = idle + power (v / at_feed)^exponent; v: mean absolute feed; at standstill idle + holding. A power law "
              "fitted to "
              "measured heat",
          .places = {Place::kRegion, Place::kNode},
          .parameters = {{"power", "W", -1e6, 1e6, {}, "part that grows with feed, at the stated feed", 0.1, "heat_source"},
                         {"at_feed", "m/s", 1e-6, 100.0, {}, "the stated feed"},
                         {"exponent", "1", -1.0, 4.0, 1.0, "growth with feed; friction alone: 1", 0.03, "friction_law"},
                         {"idle", "W", 0.0, 1e6, 0.0, "holding current, also at standstill", 0.1, "heat_source"},
                         {"holding", "W", 0.0, 1e6, 0.0, "at standstill alone: of an axis that holds a weight", 0.1,
                          "heat_source"}},
          .timing = Timing::kInTime,
          .contribute = contribute,
          .choices = {axis_choice()},
          .doubts = doubts};
}

}  // namespace driftwright::effects::servo_loss
