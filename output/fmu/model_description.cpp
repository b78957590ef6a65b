#include "output/fmu/model_description.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "base/errors.hpp"
#include "base/quantity.hpp"
#include "effects/law_steps.hpp"
#include "output/markup.hpp"

namespace driftwright::output {
namespace {

constexpr unsigned kInputs = 1000, kStartWarmer = 2000, kAmbientFromInput = 3000, kOutputs = 4000, kStates = 10000,
                   kDerivatives = 20000, kIsOn = 30000, kIndicators = 40000;

struct Unit {
  const char* name;
  const char* base;  ///< attributes of BaseUnit
};
constexpr Unit kUnits[] = {{"s", "s=\"1\""},
                           {"rpm", "rad=\"1\" s=\"-1\" factor=\"0.10471975511965977\""},
                           {"mm/min", "m=\"1\" s=\"-1\" factor=\"1.6666666666666667e-05\""},
                           {"mm", "m=\"1\" factor=\"0.001\""},
                           {"W", "kg=\"1\" m=\"2\" s=\"-3\""},
                           {"K", "K=\"1\""},
                           {"K/s", "K=\"1\" s=\"-1\""},
                           {"degC", "K=\"1\" offset=\"273.15\""},
                           {"um", "m=\"1\" factor=\"1e-06\""},
                           {"urad", "rad=\"1\" factor=\"1e-06\""}};

/// XML allows no control characters: they become blanks.
std::string xml_text(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return escaped(text);
}

std::string attribute(const char* name, const std::string& value) {
  return value.empty() ? "" : fmt::format(" {}=\"{}\"", name, xml_text(value));
}
std::string attribute(const char* name, const std::optional<double>& value) {
  return value ? fmt::format(" {}=\"{}\"", name, std::isnan(*value) ? "NaN" : fmt::format("{:.17g}", *value)) : "";
}

FmuVariable drive_input(const DriveRange& range, unsigned reference) {
  FmuVariable v{.reference = reference,
                .causality = "input",
                .variability = "discrete",
                .start = std::clamp(0.0, range.least, range.most),
                .min = range.least,
                .max = range.most};
  const auto named = [&](const char* name, const char* unit, const char* what) {
    v.name = name;
    v.unit = unit;
    v.description = what;
  };
  switch (range.variable) {
    case DriveVariable::kSpeed:
      named("spindle_speed", "rpm", "speed of the spindle, piecewise constant");
      break;
    case DriveVariable::kFeedX:
      named("feed_x", "mm/min", "mean magnitude of the velocity of axis x, piecewise constant");
      break;
    case DriveVariable::kFeedY:
      named("feed_y", "mm/min", "mean magnitude of the velocity of axis y, piecewise constant");
      break;
    case DriveVariable::kFeedZ:
      named("feed_z", "mm/min", "mean magnitude of the velocity of axis z, piecewise constant");
      break;
    case DriveVariable::kCuttingPower:
      named("cutting_power", "W", "power at the cutting edge, piecewise constant");
      break;
  }
  if (is_place(range.variable)) {
    const std::string name = effects::kPlaceNames[place_of(range.variable)];
    named(name.c_str(), "mm",
          name.starts_with("stroke") ? "way over which the nut moves about the position, piecewise constant"
                                     : "position of the axis, piecewise constant");
  }
  return v;
}

std::string words_of(const std::string& unit) {
  return unit == "degC" ? "temperature" : unit == "um" ? "displacement, actual - commanded" : "tilt";
}

void add_machine(std::vector<FmuVariable>& list, const FmuModel& model) {
  unsigned reference = kOutputs;
  for (const FmuOutput& o : model.outputs)
    list.push_back({.name = o.name,
                    .reference = reference++,
                    .description = words_of(o.unit),
                    .causality = "output",
                    .variability = "continuous",
                    .initial = "calculated",
                    .unit = o.unit});
  for (unsigned i = 0; i < static_cast<unsigned>(model.start.size()); ++i)
    list.push_back({.name = fmt::format("z[{}]", i + 1),
                    .reference = kStates + i,
                    .description = "reduced temperature state",
                    .causality = "local",
                    .variability = "continuous",
                    .initial = "calculated"});
  for (unsigned i = 0; i < static_cast<unsigned>(model.start.size()); ++i)
    list.push_back({.name = fmt::format("der(z[{}])", i + 1),
                    .reference = kDerivatives + i,
                    .description = "its rate of change",
                    .causality = "local",
                    .variability = "continuous",
                    .initial = "calculated",
                    .derivative_of = kStates + i});
  for (unsigned i = 0; i < static_cast<unsigned>(model.thermostats.size()); ++i) {
    const std::string& name = model.thermostats[i].name;
    list.push_back({.name = "on." + name,
                    .reference = kIsOn + i,
                    .description = "1 while this thermostat is on",
                    .causality = "local",
                    .variability = "discrete",
                    .initial = "calculated"});
    list.push_back({.name = "beyond." + name,
                    .reference = kIndicators + i,
                    .description = "its temperature over the one at which it switches next: an event where the sign changes",
                    .causality = "local",
                    .variability = "continuous",
                    .initial = "calculated",
                    .unit = "K"});
  }
}

void add_observer(std::vector<FmuVariable>& list, const FmuModel& model) {
  const FmuObserver& o = *model.observer;
  unsigned reference = kOutputs;
  const auto add = [&](const std::string& name, const std::string& what, const std::string& unit) {
    list.push_back({.name = name,
                    .reference = reference++,
                    .description = what,
                    .causality = "output",
                    .variability = "discrete",
                    .initial = "calculated",
                    .unit = unit});
  };
  const std::string& drift = model.outputs[static_cast<std::size_t>(o.drift_output)].name;
  add(drift, "drift since the start, actual - commanded, as observed at the last sample", "um");
  add(drift + "_deviation", "its standard deviation by the filter", "um");
  for (const FmuOutput& out : model.outputs)
    add("model." + out.name, words_of(out.unit) + " of the model in the state that is believed", out.unit);
  for (const std::string& sensor : o.sensors) add("doubted." + sensor, "1 while the thermometer is not believed", "");
  add("doubted.ambient_temperature", "1 while the ambient thermometer is not believed", "");
  add("trust", "0 to 1: trust in the model that its thermometers justify; a correction is the drift times it", "");
  if (!o.probing) return;
  add("correction", "the drift times trust, and what probings have found beyond it", "um");
  add("probe_residual", "what probings have found beyond the drift times trust; correction contains it", "um");
  add("probe_deviation", "standard deviation of what is left after probings", "um");
  add("probe_verdict",
      "of the last probing: 1 taken; 2 taken as a jump; refused: 3 too far from what is expected (probe again), 4 too "
      "early, 5 no number, 6 the same number too often in a row",
      "");
  add("probe_off", "of the last probing: read minus expected", "um");
  add("refused_probings", "how many were refused", "");
}

std::string interface_attributes(FmiVersion version, const FmuModel& model, bool is_co_simulation,
                                 const std::string& identifier) {
  const bool derivatives = !model.observer;
  std::string text = fmt::format(" modelIdentifier=\"{}\"", identifier);
  if (version == FmiVersion::k2) {
    text += is_co_simulation
                ? fmt::format(" canHandleVariableCommunicationStepSize=\"true\" canInterpolateInputs=\"{}\"", derivatives)
                : " completedIntegratorStepNotNeeded=\"true\"";
    return text +
           fmt::format(" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" providesDirectionalDerivative=\"{}\"",
                       derivatives);
  }
  text += fmt::format(" canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" providesDirectionalDerivatives=\"{}\"",
                      derivatives);
  return text + (is_co_simulation ? " canHandleVariableCommunicationStepSize=\"true\""
                                  : " providesEvaluateDiscreteStates=\"true\"");
}

std::string variable_xml2(const FmuVariable& v, const std::vector<FmuVariable>& all) {
  std::string text = fmt::format(
      "    <ScalarVariable name=\"{}\" valueReference=\"{}\"{} causality=\"{}\" variability=\"{}\"{}>", xml_text(v.name),
      v.reference, attribute("description", v.description), v.causality, v.variability, attribute("initial", v.initial));
  if (v.is_boolean) return text + fmt::format("<Boolean start=\"{}\"/></ScalarVariable>\n", v.start.value_or(0.0) != 0.0);
  std::string derivative;
  for (std::size_t i = 0; i < all.size() && v.derivative_of; ++i) {
    if (all[i].reference == *v.derivative_of) derivative = fmt::format(" derivative=\"{}\"", i + 1);
  }
  return text + fmt::format("<Real{}{}{}{}{}{}/></ScalarVariable>\n", attribute("unit", v.unit), attribute("min", v.min),
                            attribute("max", v.max), attribute("nominal", v.nominal), attribute("start", v.start),
                            derivative);
}

std::string variable_xml3(const FmuVariable& v) {
  std::string text =
      fmt::format("    <{} name=\"{}\" valueReference=\"{}\"{} causality=\"{}\" variability=\"{}\"{}",
                  v.is_boolean ? "Boolean" : "Float64", xml_text(v.name), v.reference,
                  attribute("description", v.description), v.causality, v.variability,
                  attribute("initial", v.causality == "independent" || v.causality == "input" ? "" : v.initial));
  if (v.is_boolean) return text + fmt::format(" start=\"{}\"/>\n", v.start.value_or(0.0) != 0.0);
  return text + fmt::format("{}{}{}{}{}{}/>\n", attribute("unit", v.unit), attribute("min", v.min), attribute("max", v.max),
                            attribute("nominal", v.nominal), attribute("start", v.start),
                            v.derivative_of ? fmt::format(" derivative=\"{}\"", *v.derivative_of) : "");
}

bool is_state(const FmuVariable& v) {
  return v.reference >= kStates && v.reference < kDerivatives;
}

/// The dependencies of an output of the machine: the states that it reads, and the ambient.
std::vector<std::size_t> dependencies(const FmuModel& model, const std::vector<FmuVariable>& variables,
                                      const FmuVariable& output) {
  std::vector<std::size_t> list;
  const FmuOutput& o = model.outputs[output.reference - kOutputs];
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const FmuVariable& v = variables[i];
    const bool is_ambient =
        v.name == "ambient_temperature" || v.name == "ambient_temperature_rate" || v.causality == "independent";
    const bool has_along = std::any_of(model.along.begin(), model.along.end(), [&](const FmuAlong& a) {
      const bool is_own = a.output == static_cast<int>(output.reference - kOutputs);
      return is_own && (is_state(v) || is_ambient || v.reference == kInputs + static_cast<unsigned>(a.variable));
    });
    const bool has_direct = std::any_of(model.direct.begin(), model.direct.end(), [&](const FmuDirect& d) {
      return d.output == static_cast<int>(output.reference - kOutputs) &&
             std::any_of(d.law.terms.begin(), d.law.terms.end(),
                         [&](const LawTerm& term) { return v.reference == kInputs + static_cast<unsigned>(term.variable); });
    });
    if (has_along || has_direct || (is_ambient && o.ambient != 0.0) ||
        (is_state(v) && o.state[v.reference - kStates] != 0.0))
      list.push_back(i);
  }
  return list;
}

/// Lines of ModelStructure: the outputs, the derivatives, the unknowns of the start.
std::string structure_xml(const FmuModel& model, const std::vector<FmuVariable>& variables, FmiVersion version) {
  const bool is_2 = version == FmiVersion::k2;
  const auto unknown = [&](const char* tag, std::size_t i, const std::optional<std::vector<std::size_t>>& of) {
    std::string text = is_2 ? fmt::format("      <Unknown index=\"{}\"", i + 1)
                            : fmt::format("    <{} valueReference=\"{}\"", tag, variables[i].reference);
    if (of) {
      std::vector<unsigned> ids;
      for (std::size_t k : *of) ids.push_back(is_2 ? static_cast<unsigned>(k + 1) : variables[k].reference);
      text += fmt::format(" dependencies=\"{}\"", fmt::join(ids, " "));
    }
    return text + "/>\n";
  };
  std::string outputs, derivatives, start, indicators;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const FmuVariable& v = variables[i];
    if (v.causality == "output")
      outputs += unknown("Output", i, model.observer ? std::vector<std::size_t>{} : dependencies(model, variables, v));
    if (v.derivative_of) derivatives += unknown("ContinuousStateDerivative", i, std::nullopt);
    if (v.reference >= kIndicators) indicators += unknown("EventIndicator", i, std::nullopt);
    if (v.initial == "calculated" && v.reference < kIsOn) start += unknown("InitialUnknown", i, std::nullopt);
  }
  const auto list = [](const char* tag, const std::string& lines) {
    return lines.empty() ? "" : fmt::format("    <{0}>\n{1}    </{0}>\n", tag, lines);
  };
  const std::string all = is_2 ? list("Outputs", outputs) + list("Derivatives", derivatives) + list("InitialUnknowns", start)
                               : outputs + derivatives + start + indicators;
  return "  <ModelStructure>\n" + all + "  </ModelStructure>\n";
}

}  // namespace

std::vector<FmuVariable> variables_of(const FmuModel& model) {
  const double ambient_degC = model.start_ambient_K + model.reference_K - kZeroCelsius_K;
  std::vector<FmuVariable> list = {{.name = "time",
                                    .reference = 0,
                                    .description = "since the start of the scenario",
                                    .causality = "independent",
                                    .variability = "continuous",
                                    .unit = "s"}};
  unsigned reference = kInputs;
  for (const DriveRange& range : model.drive) list.push_back(drive_input(range, reference++));
  const bool is_observer = model.observer.has_value();
  list.push_back({.name = "ambient_temperature",
                  .reference = reference++,
                  .description = is_observer ? "of the ambient, at each sample" : "of the ambient, where ambient_from_input",
                  .causality = "input",
                  .variability = is_observer ? "discrete" : "continuous",
                  .unit = "degC",
                  .start = ambient_degC});
  if (is_observer) {
    for (const std::string& sensor : model.observer->sensors)
      list.push_back({.name = sensor,
                      .reference = reference++,
                      .description = "reading of this thermometer at each sample; NaN while there is none",
                      .causality = "input",
                      .variability = "discrete",
                      .unit = "degC",
                      .start = ambient_degC});
    if (model.observer->probing) {
      const std::string& drift = model.outputs[static_cast<std::size_t>(model.observer->drift_output)].name;
      list.push_back({.name = "probe_" + drift,
                      .reference = reference++,
                      .description =
                          "drift since the start by a probing: what the probe reads on the corrected axis, plus the "
                          "correction in force; it counts at the first sample after probe_strobe has turned on",
                      .causality = "input",
                      .variability = "discrete",
                      .unit = "um",
                      .start = 0.0});
      list.push_back({.name = "probe_strobe",
                      .reference = reference++,
                      .description = "turns from 0 to 1 when a probed value is there, and back to 0 before the next one",
                      .causality = "input",
                      .variability = "discrete",
                      .start = 0.0});
    }
    add_observer(list, model);
  } else {
    list.push_back(
        {.name = "ambient_temperature_rate",
         .reference = reference++,
         .description = "by which ambient_temperature goes on changing after it was set, where ambient_from_input",
         .causality = "input",
         .variability = "continuous",
         .unit = "K/s",
         .start = 0.0});
    list.push_back({.name = "start_warmer",
                    .reference = kStartWarmer,
                    .description = "everything starts as much warmer than the scenario says",
                    .causality = "parameter",
                    .variability = "fixed",
                    .initial = "exact",
                    .unit = "K",
                    .start = 0.0});
    list.push_back({.name = "ambient_from_input",
                    .reference = kAmbientFromInput,
                    .description = "true: the ambient is the input ambient_temperature; false: the ambient of the scenario",
                    .causality = "parameter",
                    .variability = "fixed",
                    .initial = "exact",
                    .is_boolean = true,
                    .start = 0.0});
    add_machine(list, model);
  }
  std::set<std::string> names;
  for (const FmuVariable& v : list) {
    if (!names.insert(v.name).second)
      throw InputError(fmt::format(
          "two variables of the FMU would be called '{}': rename the sensor or displacement of this name", v.name));
  }
  return list;
}

std::string model_description(const FmuModel& model, const std::vector<FmuVariable>& variables, FmiVersion version,
                              FmiInterfaces interfaces, const std::string& identifier, const std::string& guid,
                              const std::string& tool, const std::vector<std::string>& source_files, double step_s) {
  const bool is_2 = version == FmiVersion::k2;
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"{}\" modelName=\"{}\" {}=\"{}\"{} "
      "generationTool=\"{}\" "
      "license=\"as the model that it was made of; its C sources: GPL-3.0-or-later\" variableNamingConvention=\"flat\"{}>\n",
      is_2 ? "2.0" : "3.0", xml_text(model.name), is_2 ? "guid" : "instantiationToken", guid,
      attribute("description", model.description), xml_text(tool),
      is_2 ? fmt::format(" numberOfEventIndicators=\"{}\"", model.thermostats.size()) : "");
  std::string sources;
  for (const std::string& file : source_files) sources += fmt::format("      <File name=\"{}\"/>\n", file);
  const auto interface = [&](const char* tag, bool is_co_simulation) {
    const std::string attributes = interface_attributes(version, model, is_co_simulation, identifier);
    text += is_2 ? fmt::format("  <{0}{1}>\n    <SourceFiles>\n{2}    </SourceFiles>\n  </{0}>\n", tag, attributes, sources)
                 : fmt::format("  <{}{}/>\n", tag, attributes);
  };
  if (interfaces.model_exchange) interface("ModelExchange", false);
  if (interfaces.co_simulation) interface("CoSimulation", true);
  text += "  <UnitDefinitions>\n";
  for (const Unit& unit : kUnits) text += fmt::format("    <Unit name=\"{}\"><BaseUnit {}/></Unit>\n", unit.name, unit.base);
  text +=
      "  </UnitDefinitions>\n  <LogCategories>\n    <Category name=\"logStatusError\"/>\n    <Category "
      "name=\"logStatusWarning\"/>\n  </LogCategories>\n";
  text += fmt::format("  <DefaultExperiment startTime=\"0\" stopTime=\"{:g}\" tolerance=\"1e-6\" stepSize=\"{:g}\"/>\n",
                      model.duration_s, step_s);
  text += "  <ModelVariables>\n";
  for (const FmuVariable& v : variables) text += is_2 ? variable_xml2(v, variables) : variable_xml3(v);
  return text + "  </ModelVariables>\n" + structure_xml(model, variables, version) + "</fmiModelDescription>\n";
}

std::string build_description(const std::string& identifier, const std::vector<std::string>& source_files) {
  std::string files;
  for (const std::string& file : source_files) files += fmt::format("      <SourceFile name=\"{}\"/>\n", file);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n  <BuildConfiguration "
      "modelIdentifier=\"{}\">\n"
      "    <SourceFileSet language=\"C99\">\n{}    </SourceFileSet>\n    <Library name=\"m\"/>\n  "
      "</BuildConfiguration>\n</fmiBuildDescription>\n",
      identifier, files);
}

}  // namespace driftwright::output
