#include "output/drift_model_c.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "base/characters.hpp"
#include "base/errors.hpp"
#include "compensation/control/axis_travel.h"
#include "compensation/predictors/control_tables.hpp"
#include "output/correction_in_c.hpp"

namespace driftwright::output {
namespace {

/// `static const TYPE NAME[] = {rows};`, with one row of zeros for an empty table: C has no empty arrays.
std::string table(const std::string& type, const std::string& name, std::vector<std::string> rows) {
  if (rows.empty()) rows = {"{0}"};
  return fmt::format("static const {} {}[] = {{\n  {}\n}};\n", type, name, fmt::join(rows, ",\n  "));
}

std::string c_term(const drift_term& t) {
  return fmt::format("{{{}, {}, {}, {}, {}, {}, {}}}", t.input, t.is_rise, t.holds, t.is_running, t.power,
                     c_number(t.coefficient), c_number(t.lag_s));
}

/// The formulas of a blend whose weights move, and the state of its filters.
std::string member_tables(const DeployedModel& d, const std::string& name, const std::vector<std::string>& inputs) {
  std::string text = "/* The formulas of which the one above is the mean:";
  std::vector<std::string> formulas;
  for (const compensation::MemberResidual& m : d.member_residuals) text += fmt::format("\n * - {}", quoted_in_c(m.name));
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

  std::string comment = quoted_in_c(formula_text(d));
  for (std::size_t at = 0; (at = comment.find('\n', at)) != std::string::npos && at + 1 < comment.size(); at += 4)
    comment.replace(at, 1, "\n * ");
  std::string text = fmt::format("/* Correction of {} [um], by {}. {}\n *\n * {} *\n", quoted_in_c(d.model.target),
                                 quoted_in_c(d.model.kind), quoted_in_c(made_by), comment);
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
    guards.push_back(fmt::format("/* {}: {} */ {{{}, {}, {}, {}, {}, {}, {}, {}, {}}}", k, readings[k], g.is_rise,
                                 c_number(g.low), c_number(g.high), c_number(g.most_jump), c_number(g.others_intercept),
                                 others, c_number(g.most_apart), c_number(g.start_offset), c_number(g.start_weight)));
  }
  for (const drift_term& t : formula.terms) terms.push_back(c_term(t));
  text +=
      "/* is_rise, low, high, most_jump, others_intercept, others_coefficient, most_apart, start_offset, start_weight */\n";
  text += table("drift_guard", name + "_guards", guards);
  text += fmt::format(
      "static const drift_fail_safe {0}_safe = {{\n"
      "  {1}_INPUTS, {0}_guards, /* most_replaced */ {2}, /* period_s */ {3}, /* stale_s */ {4}, /* fade_s */ {5},\n"
      "  /* back_after_s */ {6}, /* back_within */ {7}, /* most_start */ {8}, /* start_s */ {9},\n"
      "  /* lowest_um */ {10}, /* highest_um */ {11}, /* most_rate_um_s */ {12}\n}};\n",
      name, capitals, safe.most_replaced, c_number(safe.period_s), c_number(safe.stale_s), c_number(safe.fade_s),
      c_number(safe.back_after_s), c_number(safe.back_within), c_number(safe.most_start), c_number(safe.start_s),
      c_number(safe.lowest_um), c_number(safe.highest_um), c_number(safe.most_rate_um_s));
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
                  quoted_in_c(of), quoted_in_c(made_by));
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

}  // namespace driftwright::output
