#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "effects/doubted_laws.hpp"
#include "effects/law_steps.hpp"

namespace driftwright::effects::changed_law {

constexpr double kLeastDifference_K = 0.05;

/// True if it acts at that time. Before a record, where time is negative, only effects without begin and end act.
bool acts(const Effect& e, const Inputs& u) {
  if (e.in.empty() && e.from_s == 0.0 && e.until_s == kNever_s) return true;
  return u.time_s >= e.from_s && u.time_s < e.until_s && (e.in.empty() || u.run == e.in);
}

/// What a law is multiplied by, as a formula of the speed and of the probes that change() adds after the first ones; ""
/// for changes that depend on time or bend the law beyond a speed.
std::string formula_of(const Effect& e, std::size_t n_first, bool is_over, bool follows_difference) {
  if (!e.in.empty() || e.from_s != 0.0 || e.until_s != kNever_s || e["growth_beyond"] != 1.0) return "";
  const std::string n = fmt::format("(n/{})", written(e["at_speed"]));
  std::string text = fmt::format("{}*(", written(e["factor"]));
  text += e["exponent"] != 0.0 ? fmt::format("if(n > 0, {}^{}, 1)", n, written(e["exponent"])) : "1";
  if (e["growth"] != 0.0) text += fmt::format(" + {}*{}^{}", written(e["growth"]), n, written(e["growth_exponent"]));
  text += ")";
  if (e["factor_below"] != 1.0)
    text += fmt::format("*if(n > 0, if(n < {}, {}, 1), 1)", written(e["below"]), written(e["factor_below"]));
  std::size_t next = n_first;
  if (is_over) {
    text += fmt::format("*max(0, 1 - {}*(T{} - T{}))", written(e["decay"]), next, next + 1);
    next += 2;
  } else if (e["decay"] != 0.0) {
    text += fmt::format("*exp({}*(T{} - {}))", written(-e["decay"]), next++, written(e["at_temperature"]));
  }
  if (follows_difference)
    text += fmt::format("*(max({}, abs(T{} - T{}))/{})^{}", kLeastDifference_K, next, next + 1, written(e["at_difference"]),
                        written(e["difference_exponent"]));
  return text;
}

/// @param other  body at the other end of an exchange; nullptr for a heat, or for an exchange with a medium or across a
///               joint
void change(const Effect& e, const Body& body, const Body* other, Law& law) {
  const double factor = e["factor"], exponent = e["exponent"], n0_rpm = e["at_speed"];
  const double growth = e["growth"], growth_exponent = e["growth_exponent"];
  const double decay_1_K = e["decay"], t0_K = e["at_temperature"];
  const double beyond_rpm = e["beyond"], growth_beyond = e["growth_beyond"];
  const double below_rpm = e["below"], factor_below = e["factor_below"];
  const double of_difference = e["difference_exponent"], at_difference_K = e["at_difference"];
  const bool thins = decay_1_K != 0.0, follows_difference = of_difference != 0.0 && other;
  const auto over = e.references.find("over");
  const bool is_over = thins && over != e.references.end();  // another body's temperature, not a given one
  const std::string by = law.steps ? formula_of(e, law.probes.size(), is_over, follows_difference) : "";
  if (thins) law.probes.push_back(body);
  if (is_over) law.probes.push_back(over->second);
  if (follows_difference) {
    law.probes.push_back(body);
    law.probes.push_back(*other);
  }
  if (by.empty()) {
    law.steps = nullptr;
  } else {
    law.steps = [by, own = law.steps, n_probes = law.probes.size()] {
      std::vector<Expression::Step> steps = own();
      for (const Expression::Step& s : law_steps(by, n_probes)) steps.push_back(s);
      steps.push_back({.op = Op::kMultiply});
      return steps;
    };
  }
  law.value = [=, value = law.value](const Inputs& u) {
    Inputs own;
    const Inputs* inputs = &u;
    const std::size_t n_probes = u.probe_K.size() - (thins ? 1 : 0) - (is_over ? 1 : 0) - (follows_difference ? 2 : 0);
    if (thins || follows_difference) {  // the last probes belong to this effect
      own = u;
      own.probe_K.resize(n_probes);
      inputs = &own;
    }
    double as_written = value(*inputs);
    if (!acts(e, u)) return as_written;
    if (growth_beyond != 1.0 && u.drive.speed_rpm > beyond_rpm) {
      Inputs at_bend = *inputs;
      at_bend.drive.speed_rpm = beyond_rpm;
      const double there = value(at_bend);
      const double bent = there + growth_beyond * (as_written - there);
      as_written = bent * as_written < 0.0 ? 0.0 : bent;  // it decreases to zero, but never turns heat into cooling
    }
    if (u.drive.speed_rpm > 0.0 && u.drive.speed_rpm < below_rpm) as_written *= factor_below;
    const double n = u.drive.speed_rpm / n0_rpm;
    const double by_speed = (n > 0.0 && exponent != 0.0 ? std::pow(n, exponent) : 1.0) +
                            (growth != 0.0 ? growth * std::pow(n, growth_exponent) : 0.0);
    const double by_temperature = is_over ? std::max(0.0, 1.0 - decay_1_K * (u.probe_K[n_probes] - u.probe_K[n_probes + 1]))
                                  : thins ? std::exp(-decay_1_K * (u.probe_K[n_probes] - t0_K))
                                          : 1.0;
    const double difference_K =
        follows_difference ? std::max(kLeastDifference_K, std::abs(u.probe_K.end()[-2] - u.probe_K.back())) : 1.0;
    const double by_difference = follows_difference ? std::pow(difference_K / at_difference_K, of_difference) : 1.0;
    return factor * by_speed * as_written * by_temperature * by_difference;
  };
}

/// The additional heat that a warmer medium brings with the same exchange.
HeatInput of_warmer_medium(const Effect& e, const Exchange& x) {
  Law heat = x.coefficient;
  heat.steps = nullptr;
  heat.value = [coefficient = x.coefficient.value, warmer_K = e["warmer"], e](const Inputs& u) {
    return acts(e, u) ? warmer_K * coefficient(u) : 0.0;
  };
  return {of_medium(x.name), x.body, std::move(heat)};
}

void change_laws(const Effect& e, HeatBalance& balance) {
  for (HeatInput& h : balance.heats) {
    if (h.name == e.place || h.name == of_medium(e.place)) change(e, h.body, nullptr, h.power_W);
  }
  for (Exchange& x : balance.exchanges) {
    if (x.name != e.place) continue;
    const Body other = node(x.surrounding);
    change(e, x.body, x.medium_K || x.body.kind == BodyKind::kJoint ? nullptr : &other, x.coefficient);
    if (e["warmer"] != 0.0 && x.medium_K) balance.heats.push_back(of_warmer_medium(e, x));
  }
  if (e.from_s > 0.0) balance.change_times_s.push_back(e.from_s);
  if (e.until_s < kNever_s) balance.change_times_s.push_back(e.until_s);
}

void check(const Effect& e, const ConfigMap& in) {
  if (e["factor"] == 1.0 && e["exponent"] == 0.0 && e["growth"] == 0.0 && e["decay"] == 0.0 && e["warmer"] == 0.0 &&
      e["growth_beyond"] == 1.0 && e["factor_below"] == 1.0 && e["difference_exponent"] == 0.0)
    in.fail("factor",
            "the entry changes nothing; give one of `factor`, `exponent`, `growth`, `growth_beyond`, `factor_below`, "
            "`decay`, `difference_exponent`, `warmer` another value");
  if (e.references.contains("over") && e["decay"] == 0.0)
    in.fail("over", "`over` is allowed only where there is a `decay`; it names the body that the temperature counts over");
  if (e.references.contains("over") && in.has("at_temperature"))
    in.fail("at_temperature",
            "with `over` it is the other body's temperature that the law's body counts over; leave this out");
  if (in.has("beyond") != in.has("growth_beyond"))
    in.fail("beyond",
            "`beyond`, a speed, and `growth_beyond`, the share of the growth that is left there, must be given together");
  if (in.has("below") != in.has("factor_below"))
    in.fail("below", "`below`, a speed, and `factor_below`, the factor on the law below it, must be given together");
}

EffectKind kind() {
  return {
      .key = "changed_law",
      .title = "another size, growth with speed or decay of what another effect does",
      .law =
          "c' = factor ((n / at_speed)^exponent + growth (n / at_speed)^growth_exponent) exp(-decay (T - "
          "at_temperature)) (|T - T_other| / at_difference)^difference_exponent c, "
          "c: a power or a coefficient of another effect, T of its own body; with `over` 1 - decay (T - T_over), at least "
          "0, "
          "in place of the exponential; at standstill the exponent does nothing; "
          "beyond a speed c grows by growth_beyond times as much, and falls to nothing at the most; it is times "
          "factor_below while the spindle turns more slowly than `below`; a "
          "medium that is `warmer` brings that times c'",
      .places = {Place::kLaw},
      .parameters = {{"factor", "1", 0.0, 1e4, 1.0, "on the law"},
                     {"exponent", "1", -5.0, 5.0, 0.0, "further growth with speed, beside the law's own"},
                     {"growth", "1", 0.0, 1e4, 0.0, "added at the stated speed, as a share of the law itself"},
                     {"growth_exponent", "1", 0.1, 5.0, 2.0 / 3.0, "of the speed, by which that grows"},
                     {"at_speed", "rpm", 1.0, 1e6, 1000.0, "the stated speed; there the exponent changes nothing"},
                     {"growth_beyond", "1", -10.0, 10.0, 1.0,
                      "share of the growth with speed that is left beyond a speed; 0: the law levels off, < 0: it falls"},
                     {"beyond", "rpm", 1.0, 1e6, 1000.0, "that speed"},
                     {"factor_below", "1", 0.0, 1e4, 1.0, "on the law below a speed: another gear, another winding"},
                     {"below", "rpm", 1.0, 1e6, 1000.0, "that speed"},
                     {"decay", "1/K", -0.5, 0.5, 0.0, "share lost a kelvin; a thinning oil: 0.01 to 0.05"},
                     {"at_temperature", "degC", 200.0, 500.0, 293.15, "where that decay changes nothing"},
                     {"difference_exponent", "1", -1.0, 3.0, 0.0,
                      "of an exchange: of the temperature difference, by which it grows; free convection: 0.25 to 0.33"},
                     {"at_difference", "K", 0.1, 1e3, 10.0, "where that changes nothing"},
                     {"warmer", "K", -200.0, 200.0, 0.0,
                      "of an exchange with a medium of stated temperature, a coolant's set point: so much more"}},
      .timing = Timing::kInTime,
      .change_laws = change_laws,
      .references = {{"over",
                      {BodyKind::kNode, BodyKind::kRegion},
                      "",
                      "body (or `ambient`) whose temperature T counts over, in place of `at_temperature`: a bearing's "
                      "preload follows what its inner "
                      "ring is warmer than its housing"}},
      .check = check,
      .doubts = doubts};
}

}  // namespace driftwright::effects::changed_law
