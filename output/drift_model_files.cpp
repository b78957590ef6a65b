#include "output/drift_model_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

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
  if (t.power != 1) x += fmt::format("^{}", t.power);
  if (t.lag_s > 0.0) x = fmt::format("LAG({:g} min, {})", t.lag_s / 60.0, x);
  return x;
}

/// A name that C allows.
std::string c_name(const std::string& name) {
  std::string result = name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) ? "x_" : "";
  for (char ch : name) result += std::isalnum(static_cast<unsigned char>(ch)) ? ch : '_';
  return result;
}

std::string c_number(double x) {
  if (std::isinf(x)) return x > 0.0 ? "HUGE_VAL" : "-HUGE_VAL";
  const std::string text = fmt::format("{:.17g}", x);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string c_array(const std::vector<double>& x) {
  std::vector<std::string> text;
  for (double v : x) text.push_back(c_number(v));
  return fmt::format("{{{}}}", fmt::join(text, ", "));
}

}  // namespace

std::string formula_text(const DeployedModel& d) {
  const DriftModel& m = d.model;
  std::string text = fmt::format("{} [{}] =  {:.4g}\n", m.target, unit_word(m.target_unit), m.intercept);
  for (const DriftModel::Term& t : m.terms) {
    const std::string per = t.power == 1 ? t.unit : fmt::format("{}^{}", t.unit, t.power);
    text += fmt::format("    {} {:.5g} {}/{} * {}\n", t.coefficient < 0.0 ? '-' : '+', std::abs(t.coefficient),
                        unit_word(m.target_unit), per, term_text(m, t));
  }
  if (std::any_of(m.terms.begin(), m.terms.end(), [](const auto& t) { return t.lag_s > 0.0; })) {
    text +=
        "LAG(tau, x): y += (1 - exp(-dt / tau)) * (u - y) at each call, u the speed of the call before, or the mean of this "
        "reading and the one "
        "before; readings settled at the start, speeds from 0.\n";
  }
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

std::string c_function(const DeployedModel& d, const std::string& made_by) {
  const DriftModel& m = d.model;
  const std::size_t n = d.safe.guards.size(), n_terms = m.terms.size();
  const std::string name = c_name(m.target);
  // terms by the index of their input's guard
  std::vector<double> low, high, jump, apart, intercept, coefficient, lag, others;
  std::vector<std::string> inputs, of, power, drive, has_others, arguments, readings;
  for (const FailSafe::Guard& g : d.safe.guards) {
    inputs.push_back(g.input);
    low.push_back(g.low);
    high.push_back(g.high);
    jump.push_back(g.most_jump);
    apart.push_back(g.most_apart);
    intercept.push_back(g.others_intercept);
    for (std::size_t k = 0; k < n; ++k) others.push_back(g.others_coefficient.empty() ? 0.0 : g.others_coefficient[k]);
    has_others.push_back(g.others_coefficient.empty() ? "0" : "1");
    drive.push_back(compensation::is_drive(g.unit) ? "1" : "0");
    std::string reading = fmt::format("{}_{}", c_name(g.input), g.unit);
    while (std::find(readings.begin(), readings.end(), reading) != readings.end()) reading += "_";  // "a b" beside "a-b"
    readings.push_back(reading);
    arguments.push_back("double " + reading);
  }
  for (const DriftModel::Term& t : m.terms) {
    coefficient.push_back(t.coefficient);
    lag.push_back(t.lag_s);
    power.push_back(std::to_string(t.power));
    const auto guard = std::find(inputs.begin(), inputs.end(), t.input);
    if (guard == inputs.end()) throw std::logic_error("an input without a guard");
    of.push_back(std::to_string(guard - inputs.begin()));
  }
  std::string comment = formula_text(d);
  for (std::size_t at = 0; (at = comment.find('\n', at)) != std::string::npos && at + 1 < comment.size(); at += 4)
    comment.replace(at, 1, "\n * ");
  const FailSafe& s = d.safe;
  return fmt::format(
      R"(/* Correction of {target} [um], by {kind}. {made_by}
 * {comment} */
#include <math.h>

#define {NAME}_INPUTS {n}
#define {NAME}_TERMS {n_terms}

/* All zero before the first call. */
typedef struct {{
  int is_running;
  double time_s;
  double start[{NAME}_INPUTS], last[{NAME}_INPUTS], last_s[{NAME}_INPUTS], doubted_until_s[{NAME}_INPUTS];
  int has_start[{NAME}_INPUTS], has_last[{NAME}_INPUTS], is_doubted[{NAME}_INPUTS];
  double used[{NAME}_INPUTS], lag[{NAME}_TERMS], before[{NAME}_TERMS];
  double trust, correction_um;
}} {name}_state;

static double {name}_by_others(double expected, const double *by, const double *x) {{
  int k;
  for (k = 0; k < {NAME}_INPUTS; ++k) {{
    if (by[k] != 0.0) expected += by[k] * x[k];
  }}
  return expected;
}}

/* Those that are out, all at once, by what the others lead to; one that only others that are out tell of is untold. */
static void {name}_replace(const double *expected_0, const double *by, const int *is_out, double *x, int *is_untold) {{
  double a[{NAME}_INPUTS][{NAME}_INPUTS + 1];
  int i, j, k;
  for (k = 0; k < {NAME}_INPUTS; ++k) {{
    is_untold[k] = 0;
    a[k][{NAME}_INPUTS] = expected_0[k];
    for (j = 0; j < {NAME}_INPUTS; ++j) {{
      const double b = by[k * {NAME}_INPUTS + j];
      a[k][j] = j == k ? 1.0 : 0.0;
      if (is_out[j]) {{
        a[k][j] -= b;
      }} else if (b != 0.0) {{
        a[k][{NAME}_INPUTS] += b * x[j];
      }}
    }}
  }}
  for (k = 0; k < {NAME}_INPUTS; ++k) {{
    if (!is_out[k]) continue;
    if (!(a[k][k] > 1e-6)) {{
      is_untold[k] = 1;
      for (j = 0; j < {NAME}_INPUTS; ++j) a[k][j] = j == k ? 1.0 : 0.0;
      a[k][{NAME}_INPUTS] = x[k];
    }}
    for (i = 0; i < {NAME}_INPUTS; ++i) {{
      double share;
      if (!is_out[i] || i == k) continue;
      share = a[i][k] / a[k][k];
      for (j = k; j <= {NAME}_INPUTS; ++j) a[i][j] -= share * a[k][j];
    }}
  }}
  for (k = 0; k < {NAME}_INPUTS; ++k) {{
    if (is_out[k]) x[k] = a[k][{NAME}_INPUTS] / a[k][k];
  }}
}}

/* What to take away from the position [um]: the axis moves by its negative. Readings that are missing are NAN.
 * dt_s: since the call before; it does not matter in the first one. */
double {name}_correction_um({name}_state *s, {arguments}, double dt_s) {{
  static const double low[] = {low}, high[] = {high}, most_jump[] = {jump}, most_apart[] = {apart};
  static const double expected_0[] = {intercept};
  static const double expected_by[] = {others};
  static const double coefficient[] = {coefficient}, lag_s[] = {lag};
  static const int power[] = {{{power}}}, input_of[] = {{{of}}}, is_drive[] = {{{drive}}}, has_others[] = {{{has_others}}};
  const double fade_s = {fade}, stale_s = {stale}, period_s = {period};
  double x[{NAME}_INPUTS] = {{{readings}}};
  double prediction = {model_intercept}, deserved = 1.0, step_s, wanted, most;
  int i, k, n_doubted = 0, is_out[{NAME}_INPUTS], is_untold[{NAME}_INPUTS] = {{0}};
  step_s = s->is_running ? dt_s : 0.0;
  s->time_s += step_s;
  for (i = 0; i < {NAME}_INPUTS; ++i) {{ /* rises, where they are wanted */
    if (!{from_start} || is_drive[i] || isnan(x[i])) continue;
    if (!s->has_start[i]) {{
      s->start[i] = x[i] - s->used[i];
      s->has_start[i] = 1;
    }}
    x[i] -= s->start[i];
  }}
  for (i = 0; i < {NAME}_INPUTS; ++i) {{ /* missing for too long, or jumping */
    int doubt = 0;
    if (isnan(x[i])) {{
      doubt = !s->has_last[i] || s->time_s - s->last_s[i] > stale_s + 1e-6 * period_s;
    }} else {{
      const double steps = fmax(1.0, (s->time_s - s->last_s[i]) / period_s);
      doubt = s->has_last[i] && fabs(x[i] - s->last[i]) > steps * most_jump[i];
      s->last[i] = x[i];
      s->last_s[i] = s->time_s;
      s->has_last[i] = 1;
    }}
    if (doubt) {{
      s->doubted_until_s[i] = s->time_s + {back} * fade_s;
      s->is_doubted[i] = 1;
    }}
    if (s->is_doubted[i] && s->time_s >= s->doubted_until_s[i] - 1e-6 * period_s) s->is_doubted[i] = 0;
    x[i] = s->has_last[i] ? s->last[i] : 0.0;
  }}
  for (k = 0; k <= {NAME}_INPUTS; ++k) {{ /* or too far from what the others say: replaced by that */
    int worst = -1;
    double furthest = 1.0;
    int n_out = 0;
    for (i = 0; i < {NAME}_INPUTS; ++i) n_out += is_out[i] = s->is_doubted[i] && has_others[i];
    if (n_out > 0) {name}_replace(expected_0, expected_by, is_out, x, is_untold);
    for (i = 0; k == 0 && i < {NAME}_INPUTS; ++i) {{
      if (is_out[i] && !(s->has_last[i] && fabs(s->last[i] - x[i]) <= {within} * most_apart[i]))
        s->doubted_until_s[i] = s->time_s + {back} * fade_s;
    }}
    for (i = 0; i < {NAME}_INPUTS; ++i) {{
      double apart;
      if (s->is_doubted[i] || !has_others[i]) continue;
      apart = fabs(x[i] - {name}_by_others(expected_0[i], &expected_by[i * {NAME}_INPUTS], x)) / most_apart[i];
      if (apart > furthest) {{
        furthest = apart;
        worst = i;
      }}
    }}
    if (worst < 0) break;
    s->doubted_until_s[worst] = s->time_s + {back} * fade_s;
    s->is_doubted[worst] = 1;
  }}
  for (i = 0; i < {NAME}_INPUTS; ++i) {{ /* what the readings deserve; outside its range each counts as the edge */
    double outside;
    if ({from_start} && !is_drive[i] && !s->is_running) x[i] = 0.0;
    outside = fmax(0.0, fmax(low[i] - x[i], x[i] - high[i]));
    if (s->is_doubted[i] && (++n_doubted > {most_replaced} || !has_others[i] || is_untold[i])) deserved = 0.0;
    if (outside > 0.0) deserved = fmin(deserved, fmax(0.0, 1.0 - outside / (high[i] - low[i])));
    s->used[i] = x[i];
    x[i] = fmax(low[i], fmin(high[i], x[i]));
  }}
  for (k = 0; k < {NAME}_TERMS; ++k) {{
    const double read = x[input_of[k]];
    double value = 1.0;
    for (i = 0; i < power[k]; ++i) value *= read;
    if (lag_s[k] > 0.0) {{
      const double towards = is_drive[input_of[k]] ? s->before[k] : 0.5 * (s->before[k] + value);
      if (s->is_running) {{
        s->lag[k] += (1.0 - exp(-step_s / lag_s[k])) * (towards - s->lag[k]);
      }} else {{
        s->lag[k] = is_drive[input_of[k]] ? 0.0 : value;
      }}
      s->before[k] = value;
      value = s->lag[k];
    }}
    prediction += coefficient[k] * value;
  }}
  s->trust = s->is_running ? s->trust + (1.0 - exp(-step_s / fade_s)) * (deserved - s->trust) : deserved;
  wanted = fmax({lowest}, fmin({highest}, s->trust * prediction));
  most = {rate} * step_s;
  s->correction_um = s->is_running ? s->correction_um + fmax(-most, fmin(most, wanted - s->correction_um)) : wanted;
  s->is_running = 1;
  return s->correction_um;
}}
)",
      fmt::arg("target", m.target), fmt::arg("kind", m.kind), fmt::arg("made_by", made_by), fmt::arg("comment", comment),
      fmt::arg("NAME", fmt::format("DRIFT_{}", name)), fmt::arg("name", name), fmt::arg("n", n),
      fmt::arg("n_terms", n_terms), fmt::arg("arguments", fmt::join(arguments, ", ")),
      fmt::arg("readings", fmt::join(readings, ", ")), fmt::arg("low", c_array(low)), fmt::arg("high", c_array(high)),
      fmt::arg("jump", c_array(jump)), fmt::arg("apart", c_array(apart)), fmt::arg("intercept", c_array(intercept)),
      fmt::arg("others", c_array(others)), fmt::arg("coefficient", c_array(coefficient)), fmt::arg("lag", c_array(lag)),
      fmt::arg("power", fmt::join(power, ", ")), fmt::arg("of", fmt::join(of, ", ")),
      fmt::arg("drive", fmt::join(drive, ", ")), fmt::arg("has_others", fmt::join(has_others, ", ")),
      fmt::arg("fade", c_number(s.fade_s)), fmt::arg("stale", c_number(s.stale_s)), fmt::arg("period", c_number(s.period_s)),
      fmt::arg("model_intercept", c_number(m.intercept)), fmt::arg("from_start", m.from_start ? 1 : 0),
      fmt::arg("most_replaced", compensation::most_replaced(d.safe.guards.size())),
      fmt::arg("within", c_number(compensation::kBackWithin)), fmt::arg("back", c_number(compensation::kBackAfter)),
      fmt::arg("lowest", c_number(s.lowest_um)), fmt::arg("highest", c_number(s.highest_um)),
      fmt::arg("rate", c_number(s.most_rate_um_s)));
}

}  // namespace driftwright::output
