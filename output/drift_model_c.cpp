#include "output/drift_model_c.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "compensation/predictors/control_tables.hpp"

namespace driftwright::output {
namespace {

using compensation::FailSafe;

/// Names that readings must not have: other arguments, and the component's pins, parameters and variables.
const std::vector<std::string> kTaken = {"s",
                                         "dt_s",
                                         "enable",
                                         "machine_is_on",
                                         "heartbeat",
                                         "restart",
                                         "period",
                                         "fperiod",
                                         "eoffset_counts",
                                         "eoffset_scale",
                                         "eoffset_enable",
                                         "correction_um",
                                         "axis_offset_um",
                                         "model_trust",
                                         "most_rate_um_s",
                                         "sign",
                                         "count_um",
                                         "machine_unit_um",
                                         "most_age_s",
                                         "step_s",
                                         "model",
                                         "axis",
                                         "waited_s",
                                         "is_started",
                                         "heartbeat_is_late",
                                         "setting_is_wrong"};

/// A name that C and HAL allow; HAL allows no two underscores in a row.
std::string c_name(const std::string& name) {
  std::string result = name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) ? "x_" : "";
  for (char ch : name) {
    const char wanted = std::isalnum(static_cast<unsigned char>(ch)) ? ch : '_';
    if (wanted != '_' || result.empty() || result.back() != '_') result += wanted;
  }
  return result;
}

/// HAL's names have at most 47 characters; "doubt-" and the name of the loaded component take part of them.
constexpr std::size_t kLongestPin = 28;

/// The names of the readings, in the order of the guards.
std::vector<std::string> reading_names(const FailSafe& safe, std::size_t longest = std::string::npos) {
  std::vector<std::string> names, taken = kTaken;
  for (const FailSafe::Guard& g : safe.guards) {
    const std::string plain = c_name(fmt::format("{}_{}", g.input, g.unit)).substr(0, longest);
    std::string name = plain;
    for (int k = 2; std::find(taken.begin(), taken.end(), name) != taken.end(); ++k)  // "a b" and "a-b" give the same name
      name = fmt::format("{}_{}", plain, k);
    names.push_back(name);
    taken.push_back(name);
  }
  return names;
}

std::string c_number(double x) {
  if (std::isinf(x)) return x > 0.0 ? "HUGE_VAL" : "-HUGE_VAL";
  const std::string text = fmt::format("{:.17g}", x);  // reads back exactly
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

/// Text that is safe in a C comment or in a string of a component.
std::string quoted(std::string text) {
  for (char& ch : text) {
    if (ch == '"' || ch == '\\') ch = '\'';
  }
  for (std::size_t at = 0; (at = text.find("*/")) != std::string::npos;) text.replace(at, 2, "* /");
  for (std::size_t at = 0; (at = text.find("/*")) != std::string::npos;) text.replace(at, 2, "/ *");
  return text;
}

std::string upper(std::string text) {
  for (char& ch : text) ch = static_cast<char>(std::toupper(static_cast<unsigned char>(ch)));
  return text;
}

/// `static const TYPE NAME[] = {rows};`, with one row of zeros for an empty table: C has no empty arrays.
std::string table(const std::string& type, const std::string& name, std::vector<std::string> rows) {
  if (rows.empty()) rows = {"{0}"};
  return fmt::format("static const {} {}[] = {{\n  {}\n}};\n", type, name, fmt::join(rows, ",\n  "));
}

}  // namespace

std::string c_function(const DeployedModel& d, const std::string& made_by) {
  const std::string name = c_name(d.model.target), capitals = upper(name);
  const std::vector<std::string> readings = reading_names(d.safe);
  const std::size_t n = d.safe.guards.size();
  std::vector<std::string> inputs, arguments, guards, terms;
  for (std::size_t k = 0; k < n; ++k) {
    inputs.push_back(d.safe.guards[k].input);
    arguments.push_back(fmt::format("double {}, ", readings[k]));
  }
  const compensation::FailSafeTable safe_table = compensation::fail_safe_table(d.safe);
  const compensation::FormulaTable formula = compensation::formula_table(d.model, inputs);
  const drift_fail_safe& safe = safe_table.safe;

  std::string comment = quoted(formula_text(d));
  for (std::size_t at = 0; (at = comment.find('\n', at)) != std::string::npos && at + 1 < comment.size(); at += 4)
    comment.replace(at, 1, "\n * ");
  std::string text = fmt::format("/* Correction of {} [um], by {}. {}\n *\n * {} *\n", quoted(d.model.target),
                                 quoted(d.model.kind), quoted(made_by), comment);
  text +=
      " * Compile it with drift_correction.c, which lies beside it; drift_correction.h says what is computed, and how it "
      "must be\n"
      " * compiled to give the numbers that were judged, to the last bit: cc -std=c99 -ffp-contract=off THIS.c "
      "drift_correction.c -lm */\n"
      "#include \"drift_correction.h\"\n\n#include <math.h>\n\n";
  text += fmt::format("#define {}_INPUTS {}\n#define {}_TERMS {}\n\n", capitals, n, capitals, formula.terms.size());

  for (std::size_t k = 0; k < n; ++k) {
    const drift_guard& g = safe.guards[k];
    std::string others = "0";
    if (g.others_coefficient) {
      others = fmt::format("{}_others_{}", name, k);
      std::vector<std::string> numbers;
      for (std::size_t j = 0; j < n; ++j) numbers.push_back(c_number(g.others_coefficient[j]));
      text += fmt::format("static const double {}[] = {{{}}};\n", others, fmt::join(numbers, ", "));
    }
    guards.push_back(fmt::format("/* {}: {} */ {{{}, {}, {}, {}, {}, {}, {}}}", k, readings[k], g.is_rise, c_number(g.low),
                                 c_number(g.high), c_number(g.most_jump), c_number(g.others_intercept), others,
                                 c_number(g.most_apart)));
  }
  for (const drift_term& t : formula.terms) {
    terms.push_back(fmt::format("{{{}, {}, {}, {}, {}, {}, {}}}", t.input, t.is_rise, t.holds, t.is_running, t.power,
                                c_number(t.coefficient), c_number(t.lag_s)));
  }
  text += "/* is_rise, low, high, most_jump, others_intercept, others_coefficient, most_apart */\n";
  text += table("drift_guard", name + "_guards", guards);
  text += fmt::format(
      "static const drift_fail_safe {0}_safe = {{\n"
      "  {1}_INPUTS, {0}_guards, /* most_replaced */ {2}, /* period_s */ {3}, /* stale_s */ {4}, /* fade_s */ {5},\n"
      "  /* back_after_s */ {6}, /* back_within */ {7}, /* lowest_um */ {8}, /* highest_um */ {9},\n"
      "  /* most_rate_um_s */ {10}\n}};\n",
      name, capitals, safe.most_replaced, c_number(safe.period_s), c_number(safe.stale_s), c_number(safe.fade_s),
      c_number(safe.back_after_s), c_number(safe.back_within), c_number(safe.lowest_um), c_number(safe.highest_um),
      c_number(safe.most_rate_um_s));
  text += "/* input, is_rise, holds, is_running, power, coefficient, lag_s */\n";
  text += table("drift_term", name + "_terms", terms);
  text += fmt::format("static const drift_formula {0}_formula = {{{2}, {1}_TERMS, {0}_terms}};\n\n", name, capitals,
                      c_number(formula.formula.intercept_um));

  const std::size_t room = std::max<std::size_t>(1, n), n_terms = std::max<std::size_t>(1, formula.terms.size());
  text += fmt::format(
      "/* All zero before the first call. Afterwards run.trust, inputs[k].is_doubted and repaired[k] may be read. */\n"
      "typedef struct {{\n  drift_state run;\n  drift_input_state inputs[{}];\n  drift_term_state terms[{}];\n"
      "  double repaired[{}], room[{}];\n}} {}_state;\n\n",
      room, n_terms, room, room * (room + 1), name);
  text += fmt::format(
      "/* What to take away from the position [um]: the axis moves by its negative. Readings that are missing are NAN.\n"
      " * dt_s: since the call before; it does not matter in the first one. */\n"
      "double {0}_correction_um({0}_state *s, {1}double dt_s) {{\n",
      name, fmt::join(arguments, ""));
  text += n > 0 ? fmt::format("  const double readings[] = {{{}}};\n", fmt::join(readings, ", "))
                : std::string("  const double readings[] = {0.0};\n");
  text += fmt::format(
      "  drift_arrays arrays;\n"
      "  arrays.inputs = s->inputs;\n  arrays.terms = s->terms;\n"
      "  arrays.repaired = s->repaired;\n  arrays.room = s->room;\n"
      "  return drift_correction_step(&{0}_safe, &{0}_formula, &s->run, &arrays, readings, dt_s);\n}}\n",
      name);
  return text;
}

std::string linuxcnc_component(const DeployedModel& d, const std::string& name, const std::string& c_file,
                               const std::string& made_by) {
  if (name + ".c" == c_file) throw std::logic_error("halcompile would write over the model's own file");
  const std::string target = c_name(d.model.target);
  const std::vector<std::string> readings = reading_names(d.safe, kLongestPin);
  std::string pins, doubts, values, set_doubts;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    pins += fmt::format("pin in float {} \"{} in {}; not a number while there is none\";\n", readings[k],
                        quoted(d.safe.guards[k].input), quoted(d.safe.guards[k].unit));
    doubts += fmt::format("pin out bit doubt_{} \"{} is doubted, and replaced where others allow it\";\n", readings[k],
                          quoted(d.safe.guards[k].input));
    values += fmt::format("is_late ? NAN : {}, ", readings[k]);
    set_doubts += fmt::format("    doubt_{} = model.inputs[{}].is_doubted;\n", readings[k], k);
  }
  return fmt::format(
      R"(component {name} "Correction of {target} [um], by {kind}, as external offset of an axis";
description """
{made_by}

What is judged by Driftwright runs here: {c_file} holds the tables of the model, drift_correction.c the code. Both, with
drift_correction.h, axis_offset.h and axis_offset.c, must lie beside this file when it is compiled:

  halcompile --install {name}.comp

For the axis L, with [AXIS_L]OFFSET_AV_RATIO in the INI file:

  loadrt {name} names=thermal
  addf thermal servo-thread
  net thermal-counts thermal.eoffset-counts => axis.l.eoffset-counts
  net thermal-scale thermal.eoffset-scale => axis.l.eoffset-scale
  net thermal-enable thermal.eoffset-enable => axis.l.eoffset-enable

LinuxCNC adds up changes of the counts, drops them before all joints are homed, and forgets them when the machine is switched off.
machine-is-on must therefore be the and of motion.motion-enabled and motion.is-all-homed.
""";
{pins}pin in bit enable = 0 "the offset follows the correction; else it goes back to 0 at the slew limit";
pin in bit machine_is_on = 0 "while it is off, counts and offset are 0 at once";
pin in bit heartbeat = 0 "turns over while the readings are fresh; until it first does, and when it has not for most-age-s, the offset goes back to 0 and the readings count as missing";
pin in bit restart = 0 "forgets everything: rises, lags and trust begin anew when it goes back to 0";
pin out signed eoffset_counts "to axis.L.eoffset-counts";
pin out float eoffset_scale "to axis.L.eoffset-scale: units of the machine per count";
pin out bit eoffset_enable "to axis.L.eoffset-enable";
pin out float correction_um "of the model: what is to be taken away from the position";
pin out float axis_offset_um "of the axis, in force";
pin out float model_trust "0 to 1, that the prediction was multiplied by";
pin out bit heartbeat_is_late "the watchdog has bitten";
pin out bit setting_is_wrong "a parameter is out of its range; the offset goes back to 0";
{doubts}param rw float most_rate_um_s = {rate} "slew limit of the offset, um/s; 0 or more";
param rw float most_um = {most} "largest offset by size, um; 0: no limit";
param rw float sign = -1.0 "-1: the axis moves against the drift; +1: with it. A new one waits until the offset is 0";
param rw float count_um = 0.1 "um per count, above 0. A new one waits until the offset is 0";
param rw float machine_unit_um = 1000.0 "um in one unit of the machine: 1000 for mm, 25400 for inch. A new one waits until the offset is 0";
param rw float most_age_s = {age} "the heartbeat must turn over within this time, s; above 0";
param rw float step_s = {period} "from one step of the model to the next, s: as far apart as the readings that it was judged on; 0: each cycle";
variable {state} model;
variable axis_offset_state axis;
variable double waited_s;
variable int is_started;
include "{c_file}";
include "drift_correction.c";
include "axis_offset.c";
function _ fp;
license "GPL";
;;
FUNCTION(_) {{
  static const {state} at_start;
  const axis_offset_settings settings = {{most_rate_um_s, sign, count_um, machine_unit_um, most_age_s, most_um}};
  const int is_late = axis_offset_watch(&settings, &axis, heartbeat, fperiod);
  waited_s += fperiod;
  if (restart) {{
    model = at_start;
    is_started = 0;
    correction_um = 0.0;
  }} else if (is_started ? !(waited_s + 0.5 * fperiod < step_s) : !is_late) {{
    correction_um = {function}(&model, {values}waited_s);
    is_started = 1;
    waited_s = 0.0;
  }}
  axis_offset_step(&settings, &axis, machine_is_on, enable, correction_um, fperiod);
  eoffset_counts = axis.counts;
  eoffset_scale = axis.scale;
  eoffset_enable = axis.is_offset_enabled;
  axis_offset_um = axis.offset_um;
  model_trust = model.run.trust;
  heartbeat_is_late = is_late;
  setting_is_wrong = axis.is_wrong;
{set_doubts}}}
)",
      fmt::arg("name", name), fmt::arg("target", quoted(d.model.target)), fmt::arg("kind", quoted(d.model.kind)),
      fmt::arg("made_by", quoted(made_by)), fmt::arg("c_file", c_file), fmt::arg("pins", pins), fmt::arg("doubts", doubts),
      fmt::arg("values", values), fmt::arg("set_doubts", set_doubts), fmt::arg("state", target + "_state"),
      fmt::arg("function", target + "_correction_um"), fmt::arg("rate", c_number(d.safe.most_rate_um_s)),
      fmt::arg("most", c_number(std::max(-d.safe.lowest_um, d.safe.highest_um))), fmt::arg("age", c_number(d.safe.stale_s)),
      fmt::arg("period", c_number(d.safe.period_s)));
}

}  // namespace driftwright::output
