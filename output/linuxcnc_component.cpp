#include "output/linuxcnc_component.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <vector>

#include "output/correction_in_c.hpp"

namespace driftwright::output {
namespace {

using compensation::FailSafe;

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
                          quoted_in_c(safe.guards[k].input), quoted_in_c(safe.guards[k].unit));
    c.doubts += fmt::format("pin out bit doubt_{} \"{} is doubted, and replaced where others allow it\";\n", readings[k],
                            quoted_in_c(safe.guards[k].input));
    c.values += fmt::format("is_late ? NAN : {}, ", readings[k]);
    c.set_doubts += fmt::format("    doubt_{} = {};\n", readings[k], doubted(k));
  }
  return c;
}

std::string component_text(const ComponentParts& c, const FailSafe& safe, const std::string& name, const std::string& c_file,
                           const std::string& made_by) {
  return fmt::format(kComponent, fmt::arg("name", name), fmt::arg("target", quoted_in_c(c.target)),
                     fmt::arg("kind", quoted_in_c(c.kind)), fmt::arg("made_by", quoted_in_c(made_by)),
                     fmt::arg("c_file", c_file), fmt::arg("nets", c.nets), fmt::arg("pins", c.pins),
                     fmt::arg("doubts", c.doubts), fmt::arg("step", c.step), fmt::arg("set_doubts", c.set_doubts),
                     fmt::arg("state", c.state), fmt::arg("files", c.files), fmt::arg("probe_pins", c.probe_pins),
                     fmt::arg("probe_parameters", c.probe_parameters), fmt::arg("probe_variables", c.probe_variables),
                     fmt::arg("probe_include", c.probe_include), fmt::arg("begin", c.begin), fmt::arg("wait", c.wait),
                     fmt::arg("probe", c.probe), fmt::arg("outputs", c.outputs), fmt::arg("is_wrong", c.is_wrong),
                     fmt::arg("forget", c.forget), fmt::arg("axis_state", c.axis_state),
                     fmt::arg("axis_include", c.axis_include), fmt::arg("watch", c.watch), fmt::arg("apply", c.apply),
                     fmt::arg("trust", c.trust), fmt::arg("rate", c_number(safe.most_rate_um_s)),
                     fmt::arg("most", c_number(std::max(-safe.lowest_um, safe.highest_um))),
                     fmt::arg("age", c_number(safe.stale_s)), fmt::arg("period", c_number(safe.period_s)));
}

std::vector<double> positions_mm(std::span<const PlacedModel> places) {
  std::vector<double> mm;
  for (const PlacedModel& p : places) mm.push_back(p.at_mm);
  return mm;
}

}  // namespace

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

}  // namespace driftwright::output
