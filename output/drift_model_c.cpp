#include "output/drift_model_c.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "compensation/control/axis_travel.h"
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
                                         "position",
                                         "waited_s",
                                         "is_started",
                                         "heartbeat_is_late",
                                         "setting_is_wrong",
                                         "probed_um",
                                         "probe_um",
                                         "probe_strobe",
                                         "probe_residual_um",
                                         "probe_sigma_um",
                                         "probe_verdict",
                                         "probe_off_um",
                                         "refused_probings",
                                         "probe_noise_um",
                                         "probe_lag_s",
                                         "probing",
                                         "processes",
                                         "prediction_um",
                                         "probe_waited_s",
                                         "strobe_was_on"};

/// A name that C and HAL allow; HAL allows no two underscores in a row.
std::string c_name(const std::string& name) {
  std::string result = name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) ? "x_" : "";
  for (char ch : name) {
    const char wanted = std::isalnum(static_cast<unsigned char>(ch)) ? ch : '_';
    if (wanted != '_' || result.empty() || result.back() != '_') result += wanted;
  }
  return result;
}

/// The target's name in C. `drift` would make a drift_state of its own beside that of drift_correction.h.
std::string target_name(const std::string& target) {
  const std::string name = c_name(target);
  return name == "drift" || name == "probe" || name == "axis_offset" ? "x_" + name : name;
}

/// HAL's names have at most 47 characters; "doubt-" and the name of the loaded component take part of them.
constexpr std::size_t kLongestPin = 28;

/// The names of the readings, in the order of the guards.
std::vector<std::string> reading_names(const std::vector<FailSafe::Guard>& guards, std::size_t longest = std::string::npos) {
  std::vector<std::string> names, taken = kTaken;
  for (const FailSafe::Guard& g : guards) {
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

/// What each filter of probings knows: of the model, then of its members if their weights move.
std::vector<compensation::ResidualProcess> processes_of(const DeployedModel& d) {
  std::vector<compensation::ResidualProcess> processes = {*d.residual};
  for (const compensation::MemberResidual& m : d.member_residuals) processes.push_back(m.process);
  return processes;
}

/// `{deviation_um, time_constant_s, noise_um, lag_s, is_known_at_start}`.
std::string process_text(const compensation::ResidualProcess& p, const std::string& noise_um, const std::string& lag_s,
                         bool is_known) {
  return fmt::format("{{{}, {}, {}, {}, {}}}", c_number(p.deviation_um), c_number(p.time_constant_s), noise_um, lag_s,
                     is_known ? 1 : 0);
}

/// How C calls the filter of probings: of one model (probe_feedback.h), or of a blend whose weights move (probe_members.h).
struct ProbeCalls {
  std::string prefix;                 ///< of the functions
  std::string arguments;              ///< settings and state
  std::string prediction, corrected;  ///< their next arguments in ..._row() and ..._corrected_um()
  std::string said;                   ///< before what is said of the last probing
  std::string refused;                ///< number of refused ones
};
ProbeCalls probe_calls(const DeployedModel& d, const std::string& settings, const std::string& state,
                       const std::string& prediction) {
  if (d.members.empty())
    return {.prefix = "probe",
            .arguments = fmt::format("&{}, &{}", settings, state),
            .prediction = prediction,
            .corrected = prediction + ", ",
            .said = state + ".",
            .refused = state + ".n_refused"};
  const std::size_t n = 1 + d.members.size();
  return {.prefix = "probe_members",
          .arguments = fmt::format("{}, {}.members, {}", settings, state, n),
          .prediction = state + ".predictions_um",
          .corrected = "",
          .said = fmt::format("probe_leading({}.members, {})->", state, n),
          .refused = state + ".members[0].n_refused"};
}

/// `static const TYPE NAME[] = {rows};`, with one row of zeros for an empty table: C has no empty arrays.
std::string table(const std::string& type, const std::string& name, std::vector<std::string> rows) {
  if (rows.empty()) rows = {"{0}"};
  return fmt::format("static const {} {}[] = {{\n  {}\n}};\n", type, name, fmt::join(rows, ",\n  "));
}

/// What the component has for a probe. @{
constexpr const char* kProbePins =
    R"(pin in float probe_um "what the probe reads on the corrected axis: by how much it is off, um; not a number: the probe missed";
pin in bit probe_strobe = 0 "turns on when a probed value is there, and off before the next one";
pin out float probe_residual_um "what probings have found beyond the model, um; correction-um contains it";
pin out float probe_sigma_um "standard deviation of what is left after probings, um";
pin out signed probe_verdict "of the last probing: 1 taken; 2 taken as a jump; refused: 3 too far from what is expected (probe again), 4 too early, 5 no number, 6 the same number too often in a row";
pin out float probe_off_um "of the last probing: read minus expected, um";
pin out signed refused_probings "how many were refused";
)";
constexpr const char* kProbeRow =
    "    {0}_row({1}, {2}, axis_offset_correction_um(&axis), probe_waited_s);\n"
    "    probe_waited_s = 0.0;\n";
constexpr const char* kProbeCycle =
    "  if (probe_strobe && !strobe_was_on) {{\n    if (is_started) {{\n{row}    }}\n"
    "    {prefix}_left({arguments}, probe_um);\n  }}\n"
    "  strobe_was_on = probe_strobe;\n"
    "  if (is_started && probe_waited_s == 0.0)\n"
    "    correction_um = {prefix}_corrected_um({arguments}, {corrected}{lowest}, {highest});\n";
constexpr const char* kProbeOutputs =
    "  probe_residual_um = {0}_expected_um({1}, 0.0);\n"
    "  probe_sigma_um = {0}_deviation_um({1}, 0.0);\n"
    "  probe_verdict = {2}verdict;\n  probe_off_um = {2}off_um;\n  refused_probings = {3};\n";
/// @}

/// The component, as halcompile reads it.
constexpr const char* kComponent =
    R"(component {name} "Correction of {target} [um], by {kind}, as external offset of an axis";
description """
{made_by}

What is judged by Driftwright runs here: {c_file} holds the tables of the model, {files} must lie beside this file when it is compiled:

  halcompile --install {name}.comp

For the axis L, with [AXIS_L]OFFSET_AV_RATIO in the INI file:

  loadrt {name} names=thermal
  addf thermal servo-thread
  net thermal-counts thermal.eoffset-counts => axis.l.eoffset-counts
  net thermal-scale thermal.eoffset-scale => axis.l.eoffset-scale
  net thermal-enable thermal.eoffset-enable => axis.l.eoffset-enable
{nets}
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
{probe_pins}pin out bit heartbeat_is_late "the watchdog has bitten";
pin out bit setting_is_wrong "a parameter is out of its range; the offset goes back to 0";
{doubts}param rw float most_rate_um_s = {rate} "slew limit of the offset, um/s; 0 or more";
param rw float most_um = {most} "largest offset by size, um; 0: no limit";
param rw float sign = -1.0 "-1: the axis moves against the drift; +1: with it. A new one waits until the offset is 0";
param rw float count_um = 0.1 "um per count, above 0. A new one waits until the offset is 0";
param rw float machine_unit_um = 1000.0 "um in one unit of the machine: 1000 for mm, 25400 for inch. A new one waits until the offset is 0";
param rw float most_age_s = {age} "the heartbeat must turn over within this time, s; above 0";
param rw float step_s = {period} "from one step of the model to the next, s: as far apart as the readings that it was judged on; 0: each cycle";
{probe_parameters}variable {state} model;
variable {axis_state} axis;
variable double waited_s;
variable int is_started;
{probe_variables}include "{c_file}";
include "drift_correction.c";
{probe_include}include "axis_offset.c";
{axis_include}function _ fp;
license "GPL";
;;
FUNCTION(_) {{
  static const {state} at_start;
{begin}  const axis_offset_settings settings = {{most_rate_um_s, sign, count_um, machine_unit_um, most_age_s, most_um}};
  const int is_late = {watch};
  waited_s += fperiod;
{wait}  if (restart) {{
    model = at_start;
    is_started = 0;
    correction_um = 0.0;
{forget}  }} else if (is_started ? !(waited_s + 0.5 * fperiod < step_s) : !is_late) {{
{step}    is_started = 1;
    waited_s = 0.0;
  }}
{probe}{apply}  eoffset_counts = axis.counts;
  eoffset_scale = axis.scale;
  eoffset_enable = axis.is_offset_enabled;
  axis_offset_um = axis.offset_um;
  model_trust = {trust};
  heartbeat_is_late = is_late;
  setting_is_wrong = {is_wrong};
{outputs}{set_doubts}}}
)";

/// The settings of the filters, for both files. @param noise_um, lag_s  as C has them
std::string processes_text(const DeployedModel& d, const std::string& noise_um, const std::string& lag_s) {
  std::vector<std::string> texts;
  for (const compensation::ResidualProcess& p : processes_of(d))
    texts.push_back(process_text(p, noise_um, lag_s, d.model.from_start));
  return d.members.empty() ? texts.front() : fmt::format("{{{}}}", fmt::join(texts, ", "));
}

std::string c_term(const drift_term& t) {
  return fmt::format("{{{}, {}, {}, {}, {}, {}, {}}}", t.input, t.is_rise, t.holds, t.is_running, t.power,
                     c_number(t.coefficient), c_number(t.lag_s));
}

/// The formulas of a blend whose weights move, and the state of its filters.
std::string member_tables(const DeployedModel& d, const std::string& name, const std::vector<std::string>& inputs) {
  std::string text = "/* The formulas of which the one above is the mean:";
  std::vector<std::string> formulas;
  for (const compensation::MemberResidual& m : d.member_residuals) text += fmt::format("\n * - {}", quoted(m.name));
  text += " */\n";
  for (std::size_t k = 0; k < d.members.size(); ++k) {
    const compensation::FormulaTable formula = compensation::formula_table(d.members[k], inputs);
    std::vector<std::string> terms;
    for (const drift_term& t : formula.terms) terms.push_back(c_term(t));
    const std::string of_member = fmt::format("{}_terms_{}", name, k + 1);
    text += table("drift_term", of_member, terms);
    formulas.push_back(fmt::format("{{{}, {}, {}}}", c_number(formula.formula.intercept_um), terms.size(), of_member));
  }
  text += table("drift_formula", name + "_members", formulas);
  text += fmt::format(
      "/* Of the mean, then of its members. All zero before the first call. */\n"
      "typedef struct {{\n  probe_member members[{0}];\n  double predictions_um[{0}];\n}} {1}_probing_state;\n\n",
      1 + d.members.size(), name);
  return text;
}

/// What the mean and its members may send to an axis.
std::string member_predictions(const DeployedModel& d, const std::string& name) {
  return fmt::format(
      "\n/* What the mean and its members may send to the axis [um], after {0}_correction_um() of the same row, which has "
      "returned\n"
      " * correction_um. predictions_um: {1} numbers. */\n"
      "static void {0}_predictions_um({0}_state *s, double correction_um, double dt_s, double *predictions_um) {{\n"
      "  drift_term_state *terms = s->member_terms;\n"
      "  int k;\n"
      "  predictions_um[0] = correction_um;\n"
      "  for (k = 0; k < {2}; ++k) {{\n"
      "    const double member_um = drift_formula_value(&{0}_members[k], terms, s->repaired, dt_s);\n"
      "    predictions_um[k + 1] = probe_member_um(correction_um, s->run.trust, s->run.prediction_um, member_um);\n"
      "    terms += {0}_members[k].n_terms;\n"
      "  }}\n}}\n",
      name, 1 + d.members.size(), d.members.size());
}

/// The second function of a model whose residual is known.
std::string probed_function(const DeployedModel& d, const std::string& name, const std::vector<std::string>& arguments,
                            const std::vector<std::string>& readings) {
  std::vector<std::string> values = readings;
  values.emplace_back("");
  const bool is_blend = !d.members.empty();
  const ProbeCalls calls = probe_calls(d, name + "_probing", "s->probing", "prediction_um");
  std::string text = is_blend ? member_predictions(d, name) : "";
  text += fmt::format(
      "\n/* deviation_um, time_constant_s, noise_um, lag_s, is_known_at_start; {0}.h says what is computed. */\n"
      "static const probe_process {1}_probing{2} = {3};\n\n",
      is_blend ? "probe_members" : "probe_feedback", name, is_blend ? "[]" : "",
      processes_text(d, c_number(d.probe.noise_um), c_number(d.probe.lag_s)));
  text += fmt::format(
      "/* The same with what probings have found, within the clamp and the slew limit. probed_um: the drift of the axis "
      "without\n"
      " * correction by a probing whose value has come since the call before [um], which is what the probe read on the "
      "corrected\n"
      " * axis plus the correction that was in force then; NAN without one. Call either this function or the one above.\n"
      " * {1}verdict says what became of the last probing, {2} how many were refused;\n"
      " * {3}_deviation_um({4}, 0.0) is the standard deviation of what is left.{5} */\n"
      "double {0}_probed_correction_um({0}_state *s, {6}double probed_um, double dt_s) {{\n",
      name, calls.said, calls.refused, calls.prefix, calls.arguments,
      is_blend ? "\n * Weights among the mean and its members move with what they expected at probings: "
                 "s->probing.members[k].weight."
               : "",
      fmt::join(arguments, ""));
  text += fmt::format(
      "  const int is_first = !{0}has_begun;\n"
      "  const double prediction_um = {1}_correction_um(s, {2}dt_s), before_um = is_first ? prediction_um : s->probed_um;\n",
      is_blend ? "s->probing.members[0].probing." : "s->probing.", name, fmt::join(values, ", "));
  if (is_blend) text += fmt::format("  {0}_predictions_um(s, prediction_um, dt_s, s->probing.predictions_um);\n", name);
  text += fmt::format(
      "  {1}_row({2}, {3}, before_um, dt_s);\n"
      "  if (!isnan(probed_um)) {1}_drift({2}, probed_um);\n"
      "  s->probed_um = {1}_corrected_um({2}, {4}{0}_safe.lowest_um,\n"
      "                                    {0}_safe.highest_um);\n"
      "  if (!is_first) s->probed_um = probe_slewed_um(before_um, s->probed_um, {0}_safe.most_rate_um_s, dt_s);\n"
      "  return s->probed_um;\n}}\n",
      name, calls.prefix, calls.arguments, calls.prediction, calls.corrected);
  return text;
}

/// The parts of a component that depend on what it runs; the defaults are those of one formula without a probe.
struct ComponentParts {
  std::string target, kind, state, files, step;
  std::string pins, doubts, values, set_doubts;  ///< of the readings
  std::string nets = "", axis_state = "axis_offset_state", axis_include = "";
  std::string watch = "axis_offset_watch(&settings, &axis, heartbeat, fperiod)";
  std::string apply = "  axis_offset_step(&settings, &axis, machine_is_on, enable, correction_um, fperiod);\n";
  std::string trust = "model.run.trust", is_wrong = "axis.is_wrong";
  std::string probe_pins, probe_parameters, probe_variables, probe_include, begin, wait, probe, outputs, forget;
};

/// With pins for the readings. @param doubted  C that says whether a reading is doubted
ComponentParts component_of(const FailSafe& safe, const std::vector<std::string>& readings,
                            const std::function<std::string(std::size_t)>& doubted) {
  ComponentParts c;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    c.pins += fmt::format("pin in float {} \"{} in {}; not a number while there is none\";\n", readings[k],
                          quoted(safe.guards[k].input), quoted(safe.guards[k].unit));
    c.doubts += fmt::format("pin out bit doubt_{} \"{} is doubted, and replaced where others allow it\";\n", readings[k],
                            quoted(safe.guards[k].input));
    c.values += fmt::format("is_late ? NAN : {}, ", readings[k]);
    c.set_doubts += fmt::format("    doubt_{} = {};\n", readings[k], doubted(k));
  }
  return c;
}

std::string component_text(const ComponentParts& c, const FailSafe& safe, const std::string& name, const std::string& c_file,
                           const std::string& made_by) {
  return fmt::format(kComponent, fmt::arg("name", name), fmt::arg("target", quoted(c.target)),
                     fmt::arg("kind", quoted(c.kind)), fmt::arg("made_by", quoted(made_by)), fmt::arg("c_file", c_file),
                     fmt::arg("nets", c.nets), fmt::arg("pins", c.pins), fmt::arg("doubts", c.doubts),
                     fmt::arg("step", c.step), fmt::arg("set_doubts", c.set_doubts), fmt::arg("state", c.state),
                     fmt::arg("files", c.files), fmt::arg("probe_pins", c.probe_pins),
                     fmt::arg("probe_parameters", c.probe_parameters), fmt::arg("probe_variables", c.probe_variables),
                     fmt::arg("probe_include", c.probe_include), fmt::arg("begin", c.begin), fmt::arg("wait", c.wait),
                     fmt::arg("probe", c.probe), fmt::arg("outputs", c.outputs), fmt::arg("is_wrong", c.is_wrong),
                     fmt::arg("forget", c.forget), fmt::arg("axis_state", c.axis_state),
                     fmt::arg("axis_include", c.axis_include), fmt::arg("watch", c.watch), fmt::arg("apply", c.apply),
                     fmt::arg("trust", c.trust), fmt::arg("rate", c_number(safe.most_rate_um_s)),
                     fmt::arg("most", c_number(std::max(-safe.lowest_um, safe.highest_um))),
                     fmt::arg("age", c_number(safe.stale_s)), fmt::arg("period", c_number(safe.period_s)));
}

/// The readings of all places, each once.
struct PlacedReadings {
  std::vector<FailSafe::Guard> guards;
  std::vector<std::string> names;                  ///< in C
  std::vector<std::vector<std::size_t>> of_place;  ///< of each place, in the order of its guards
};
PlacedReadings readings_of(std::span<const PlacedModel> places, std::size_t longest = std::string::npos) {
  PlacedReadings r;
  for (const PlacedModel& p : places) {
    r.of_place.emplace_back();
    for (const FailSafe::Guard& g : p.model.safe.guards) r.of_place.back().push_back(reading_among(r.guards, g));
  }
  r.names = reading_names(r.guards, longest);
  return r;
}

DeployedModel without_probings(DeployedModel d) {
  d.residual.reset();
  d.members.clear();
  d.member_residuals.clear();
  return d;
}

/// The places' names in C. "x_-400" and "x_400" give the same name, and so do names that differ in case alone, in macros.
std::vector<std::string> place_names(std::span<const PlacedModel> places, const std::string& of) {
  std::vector<std::string> names, taken = {upper_case(target_name(of))};
  for (const PlacedModel& p : places) {
    const std::string plain = target_name(p.model.model.target);
    std::string name = plain;
    for (int k = 2; std::find(taken.begin(), taken.end(), upper_case(name)) != taken.end(); ++k)
      name = fmt::format("{}_{}", plain, k);
    names.push_back(name);
    taken.push_back(upper_case(name));
  }
  return names;
}

std::vector<double> positions_mm(std::span<const PlacedModel> places) {
  std::vector<double> mm;
  for (const PlacedModel& p : places) mm.push_back(p.at_mm);
  return mm;
}

/// c_function() whose names in C begin with `name`.
std::string c_function_called(const std::string& name, const DeployedModel& d, const std::string& made_by) {
  const std::string capitals = upper_case(name);
  const std::vector<std::string> readings = reading_names(d.safe.guards);
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
  const char* probing_file = !d.members.empty() ? " probe_feedback.c probe_members.c"
                             : d.residual       ? " probe_feedback.c"
                                                : "";
  const char* probing_include = !d.members.empty() ? "#include \"probe_members.h\"\n"
                                : d.residual       ? "#include \"probe_feedback.h\"\n"
                                                   : "";
  text += fmt::format(
      " * Compile it with drift_correction.c, which lies beside it; drift_correction.h says what is computed, and how it "
      "must be\n"
      " * compiled to give the numbers that were judged, to the last bit: cc -std=c99 -ffp-contract=off THIS.c "
      "drift_correction.c{} -lm */\n"
      "#include \"drift_correction.h\"\n{}\n#include <math.h>\n\n",
      probing_file, probing_include);
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
  for (const drift_term& t : formula.terms) terms.push_back(c_term(t));
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

  std::string probing = d.residual ? "  probe_state probing;\n  double probed_um;\n" : "";
  if (!d.members.empty()) {
    std::size_t n_member_terms = 0;
    for (const compensation::DriftModel& m : d.members) n_member_terms += m.terms.size();
    text += member_tables(d, name, inputs);
    probing = fmt::format("  drift_term_state member_terms[{}];\n  {}_probing_state probing;\n  double probed_um;\n",
                          std::max<std::size_t>(1, n_member_terms), name);
  }
  const std::size_t room = std::max<std::size_t>(1, n), n_terms = std::max<std::size_t>(1, formula.terms.size());
  text += fmt::format(
      "/* All zero before the first call. Afterwards run.trust, inputs[k].is_doubted and repaired[k] may be read. */\n"
      "typedef struct {{\n  drift_state run;\n  drift_input_state inputs[{}];\n  drift_term_state terms[{}];\n"
      "  double repaired[{}], room[{}];\n{}}} {}_state;\n\n",
      room, n_terms, room, room * (room + 1), probing, name);
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
  if (!d.residual) return text;
  return text + probed_function(d, name, arguments, readings);
}

}  // namespace

std::string c_function(const DeployedModel& d, const std::string& made_by) {
  return c_function_called(target_name(d.model.target), d, made_by);
}

std::string c_over_travel(std::span<const PlacedModel> places, const std::string& of, const std::string& made_by) {
  if (places.size() > AXIS_TRAVEL_PLACES)
    throw InputError(fmt::format("a correction over the travel takes at most {} places, and there are {}",
                                 AXIS_TRAVEL_PLACES, places.size()));
  require_of_one_run(places);
  const std::string name = target_name(of);
  const std::vector<std::string> names = place_names(places, of);
  const PlacedReadings readings = readings_of(places);
  std::string text =
      fmt::format("/* One correction over the travel of {}, straight between its places and held beyond them. {}\n",
                  quoted(of), quoted(made_by));
  text +=
      " * Compile it with drift_correction.c, axis_travel.c and axis_offset.c, which lie beside it. */\n"
      "#include \"axis_travel.h\"\n\n";
  std::vector<std::string> at, states, steps, trusts, arguments;
  for (const std::string& r : readings.names) arguments.push_back(fmt::format("double {}, ", r));
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::string given;
    for (std::size_t r : readings.of_place[k]) given += readings.names[r] + ", ";
    text += c_function_called(names[k], without_probings(places[k].model), made_by) + "\n";
    at.push_back(c_number(places[k].at_mm));
    states.push_back(fmt::format("  {}_state place_{};\n", names[k], k));
    steps.push_back(
        fmt::format("  s->corrections_um[{0}] = {1}_correction_um(&s->place_{0}, {2}dt_s);\n", k, names[k], given));
    trusts.push_back(fmt::format("  if (s->place_{0}.run.trust < s->trust) s->trust = s->place_{0}.run.trust;\n", k));
  }
  text += fmt::format(
      "/* Positions of the axis [mm]. */\nstatic const double {0}_at_mm[] = {{{1}}};\n\n"
      "/* All zero before the first call. trust: the least of all places. */\n"
      "typedef struct {{\n{2}  double corrections_um[{3}], trust;\n}} {0}_state;\n\n"
      "/* A row for all places. Readings that are missing are NAN. dt_s: since the call before. */\n"
      "void {0}_row({0}_state *s, {4}double dt_s) {{\n{5}  s->trust = 1.0;\n{6}}}\n\n"
      "/* What to take away from the position [um] where the axis is: the axis moves by its negative. It may be called more "
      "often\n"
      " * than {0}_row(): as often as the axis moves on. */\n"
      "double {0}_correction_um(const {0}_state *s, double position_mm) {{\n"
      "  return axis_travel_value({0}_at_mm, s->corrections_um, {3}, position_mm);\n}}\n",
      name, fmt::join(at, ", "), fmt::join(states, ""), places.size(), fmt::join(arguments, ""), fmt::join(steps, ""),
      fmt::join(trusts, ""));
  return text;
}

std::string linuxcnc_over_travel(std::span<const PlacedModel> places, const std::string& of, const std::string& name,
                                 const std::string& c_file, const std::string& made_by) {
  if (name + ".c" == c_file) throw std::logic_error("halcompile would write over the model's own file");
  const std::string own = target_name(of);
  const PlacedReadings readings = readings_of(places, kLongestPin);
  std::vector<std::string> targets;
  FailSafe safe = places.front().model.safe;
  for (const PlacedModel& p : places) {
    targets.push_back(fmt::format("{} at {:g} mm", p.model.model.target, p.at_mm));
    safe.lowest_um = std::min(safe.lowest_um, p.model.safe.lowest_um);
    safe.highest_um = std::max(safe.highest_um, p.model.safe.highest_um);
    safe.most_rate_um_s = std::max(safe.most_rate_um_s, p.model.safe.most_rate_um_s);
  }
  safe.guards = readings.guards;
  ComponentParts c = component_of(safe, readings.names, [&](std::size_t r) {
    std::vector<std::string> doubts;
    for (std::size_t k = 0; k < places.size(); ++k) {
      for (std::size_t g = 0; g < readings.of_place[k].size(); ++g) {
        if (readings.of_place[k][g] == r) doubts.push_back(fmt::format("model.place_{}.inputs[{}].is_doubted", k, g));
      }
    }
    return fmt::format("{}", fmt::join(doubts, " || "));
  });
  const std::size_t n = places.size();
  c.target = fmt::format("{}", fmt::join(targets, ", "));
  c.kind = "one formula a place";
  c.state = own + "_state";
  c.files =
      "drift_correction.c, axis_offset.c and\naxis_travel.c the code. They, with drift_correction.h, axis_offset.h and "
      "axis_travel.h,";
  c.nets =
      "  net thermal-position joint.n.pos-cmd => thermal.position\n\n"
      "(The joint n of that axis. Its correction is straight between the places, and held beyond them. Slew limit and "
      "largest "
      "offset are of\neach place.)\n";
  c.pins = fmt::format(
               "pin in float position \"of the axis, in units of the machine, from the zero of the positions ({} mm)\";\n",
               fmt::join(positions_mm(places), ", ")) +
           c.pins;
  c.step = fmt::format("    {}_row(&model, {}waited_s);\n", own, c.values);
  c.axis_state = "axis_travel_state";
  c.axis_include = "include \"axis_travel.c\";\n";
  c.watch = fmt::format("axis_travel_watch(&settings, &axis, {}, heartbeat, fperiod)", n);
  c.apply = fmt::format(
      "  correction_um = {0}_correction_um(&model, 1e-3 * machine_unit_um * position);\n"
      "  axis_travel_step(&settings, &axis, {0}_at_mm, {1}, machine_is_on, enable, model.corrections_um,\n"
      "                   1e-3 * machine_unit_um * position, fperiod);\n",
      own, n);
  c.trust = "model.trust";
  return component_text(c, safe, name, c_file, made_by);
}

std::string linuxcnc_component(const DeployedModel& d, const std::string& name, const std::string& c_file,
                               const std::string& made_by) {
  if (name + ".c" == c_file) throw std::logic_error("halcompile would write over the model's own file");
  const std::string target = target_name(d.model.target);
  ComponentParts c = component_of(d.safe, reading_names(d.safe.guards, kLongestPin),
                                  [](std::size_t k) { return fmt::format("model.inputs[{}].is_doubted", k); });
  c.target = d.model.target;
  c.kind = d.model.kind;
  c.state = target + "_state";
  c.step = fmt::format("    correction_um = {}_correction_um(&model, {}waited_s);\n", target, c.values);
  c.files = "drift_correction.c the code. Both, with\ndrift_correction.h, axis_offset.h and axis_offset.c,";
  if (d.residual) {
    c.files =
        "drift_correction.c and\nprobe_feedback.c the code. They, with drift_correction.h, probe_feedback.h, axis_offset.h "
        "and "
        "axis_offset.c,";
    const bool is_blend = !d.members.empty();
    const ProbeCalls calls = probe_calls(d, is_blend ? "processes" : "process", "probing", "prediction_um");
    const std::string state_type = is_blend ? target + "_probing_state" : "probe_state";
    const std::string row = fmt::format(kProbeRow, calls.prefix, calls.arguments, calls.prediction);
    c.probe_include = "include \"probe_feedback.c\";\n";
    if (is_blend) {
      c.files =
          "drift_correction.c,\nprobe_feedback.c and probe_members.c the code. They, with drift_correction.h, "
          "probe_feedback.h, probe_members.h,\naxis_offset.h and axis_offset.c,";
      c.probe_include += "include \"probe_members.c\";\n";
    }
    c.probe_pins = kProbePins;
    c.probe_parameters = fmt::format(
        "param rw float probe_noise_um = {} \"of a probing, 1 sigma, um; above 0\";\n"
        "param rw float probe_lag_s = {} \"from the touch until probe-strobe turns on, s; 0 or more\";\n",
        c_number(d.probe.noise_um), c_number(d.probe.lag_s));
    c.probe_variables = fmt::format(
        "variable {} probing;\nvariable double prediction_um;\nvariable double probe_waited_s;\n"
        "variable int strobe_was_on;\n",
        state_type);
    c.begin = fmt::format("  static const {} unprobed;\n  const probe_process process{} = {};\n", state_type,
                          is_blend ? "es[]" : "", processes_text(d, "probe_noise_um", "probe_lag_s"));
    c.step = fmt::format("    prediction_um = {}_correction_um(&model, {}waited_s);\n", target, c.values);
    if (is_blend)
      c.step += fmt::format("    {}_predictions_um(&model, prediction_um, waited_s, probing.predictions_um);\n", target);
    c.step += row;
    c.probe = fmt::format(kProbeCycle, fmt::arg("row", row), fmt::arg("prefix", calls.prefix),
                          fmt::arg("arguments", calls.arguments), fmt::arg("corrected", calls.corrected),
                          fmt::arg("lowest", c_number(d.safe.lowest_um)), fmt::arg("highest", c_number(d.safe.highest_um)));
    c.outputs = fmt::format(kProbeOutputs, calls.prefix, calls.arguments, calls.said, calls.refused);
    c.is_wrong = fmt::format("axis.is_wrong || !probe_is_valid({})", is_blend ? "&processes[0]" : "&process");
    c.wait = "  probe_waited_s += fperiod;\n";
    c.forget = "    probing = unprobed;\n    probe_waited_s = 0.0;\n";
  }
  return component_text(c, d.safe, name, c_file, made_by);
}

}  // namespace driftwright::output
