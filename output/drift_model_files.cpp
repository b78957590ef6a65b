#include "output/drift_model_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/errors.hpp"

namespace driftwright::output {
namespace {

using compensation::DriftModel;
using compensation::FailSafe;

std::string unit_word(const std::string& unit) {
  return unit == "um" ? "um" : unit;
}

/// A term without its coefficient.
std::string term_text(const DriftModel& model, const DriftModel::Term& t) {
  const bool is_rise = model.from_start && !compensation::is_drive(t.unit);
  std::string x = is_rise ? fmt::format("({} - {} at start)", t.input, t.input) : t.input;
  if (t.is_running) x = fmt::format("ON({})", x);
  if (t.power != 1) x += fmt::format("^{}", t.power);
  if (t.lag_s > 0.0) x = fmt::format("LAG({:g} min, {})", t.lag_s / 60.0, x);
  return x;
}

}  // namespace

DeployedModel deployed_model(const compensation::DeployedPredictor& d) {
  const DriftModel* formula = d.predictor->formula();
  if (!formula)
    throw std::logic_error(
        fmt::format("'{}' has no form for a control: C and LinuxCNC take a formula of readings and their lags, which "
                    "Predictor::formula() of its class must give",
                    d.name));
  if (!d.fail_safe) throw std::logic_error(fmt::format("'{}' has no fail-safe; a control needs one", d.name));
  DeployedModel model{*formula, *d.fail_safe, d.interval_um.value_or(std::numeric_limits<double>::quiet_NaN()), d.residual,
                      d.probe};
  if (d.residual && d.predictor->members() && !d.member_residuals.empty()) {
    model.members = *d.predictor->members();
    model.member_residuals = d.member_residuals;
  }
  return model;
}

std::size_t reading_among(std::vector<FailSafe::Guard>& guards, const FailSafe::Guard& guard) {
  const auto at = std::find_if(guards.begin(), guards.end(),
                               [&](const FailSafe::Guard& g) { return g.input == guard.input && g.unit == guard.unit; });
  const auto k = static_cast<std::size_t>(at - guards.begin());
  if (at == guards.end()) guards.push_back(guard);
  return k;
}

void require_of_one_run(std::span<const PlacedModel> places) {
  const DeployedModel& first = places.front().model;
  for (const PlacedModel& p : places) {
    const FailSafe& safe = p.model.safe;
    if (safe.period_s == first.safe.period_s && safe.from_start == first.safe.from_start) continue;
    throw InputError(
        fmt::format("'{}' and '{}' cannot run in one program: {}; take models of one run of `validate`", first.model.target,
                    p.model.model.target,
                    safe.period_s != first.safe.period_s
                        ? fmt::format("their rows are {:g} s and {:g} s apart", first.safe.period_s, safe.period_s)
                        : "one of them counts temperatures from the first row"));
  }
}

std::string formula_text(const DeployedModel& d) {
  const DriftModel& m = d.model;
  std::string text = fmt::format("{} [{}] =  {:.4g}\n", m.target, unit_word(m.target_unit), m.intercept);
  for (const DriftModel::Term& t : m.terms) {
    std::string unit = unit_word(m.target_unit);
    if (!t.is_running) unit += t.power == 1 ? "/" + t.unit : fmt::format("/{}^{}", t.unit, t.power);
    text += fmt::format("    {} {:.5g} {} * {}\n", t.coefficient < 0.0 ? '-' : '+', std::abs(t.coefficient), unit,
                        term_text(m, t));
  }
  if (std::any_of(m.terms.begin(), m.terms.end(), [](const auto& t) { return t.lag_s > 0.0; })) {
    text +=
        "LAG(tau, x): y += (1 - exp(-dt / tau)) * (u - y) at each call, u the speed of the call before, or the mean of this "
        "reading and the one "
        "before; readings settled at the start, speeds from 0.\n";
  }
  if (std::any_of(m.terms.begin(), m.terms.end(), [](const auto& t) { return t.is_running; }))
    text += "ON(x): 1 while x is not 0, and else 0.\n";
  if (m.from_start) text += "Temperatures count from their first reading of the run, and so does the drift.\n";
  if (std::isfinite(d.interval_um))
    text += fmt::format("95 % of the drift within +-{:.2g} {} of it, on runs left out of the fit.\n", d.interval_um,
                        m.target_unit);
  text += "Valid for\n";
  for (const FailSafe::Guard& g : d.safe.guards) {
    text += fmt::format("    {:.5g} <= {} <= {:.5g} {}{}\n", g.low,
                        m.from_start && !compensation::is_drive(g.unit) ? g.input + " - start" : g.input, g.high, g.unit,
                        std::isfinite(g.most_jump)
                            ? fmt::format(", steps of at most {:.3g} {} in {:g} s", g.most_jump, g.unit, d.safe.period_s)
                            : "");
  }
  text += fmt::format("Correction between {:.4g} and {:.4g} um, at most {:.3g} um/min.\n", d.safe.lowest_um,
                      d.safe.highest_um, 60.0 * d.safe.most_rate_um_s);
  return text;
}

}  // namespace driftwright::output
