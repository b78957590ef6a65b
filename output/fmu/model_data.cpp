#include "output/fmu/model_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace driftwright::output {
namespace {

constexpr std::size_t kPerLine = 6;

/// `static const double NAME[] = {...};`, with one zero for an empty list: C has no empty arrays.
std::string array(const std::string& name, const std::vector<double>& values) {
  std::string text = fmt::format("static const double {}[] = {{", name);
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("{}{:a}", i % kPerLine == 0 ? "\n  " : " ", values[i]) + ",";
  if (values.empty()) text += "0.0";
  return text + "};\n";
}

void append(std::vector<double>& list, const Eigen::VectorXd& v) {
  list.insert(list.end(), v.data(), v.data() + v.size());
}
void append(std::vector<double>& list, const Eigen::MatrixXd& symmetric) {
  list.insert(list.end(), symmetric.data(), symmetric.data() + symmetric.size());
}

/// The list `static const drive_law NAME[]`, after the arrays that its laws point to.
std::string laws(const std::string& name, const std::vector<const DriveLaw*>& list) {
  std::string text, rows;
  for (std::size_t k = 0; k < list.size(); ++k) {
    std::string terms;
    for (std::size_t t = 0; t < list[k]->terms.size(); ++t) {
      const LawTerm& term = list[k]->terms[t];
      const std::string own = fmt::format("{}_{}_{}", name, k, t);
      text += array(own + "_log_x", term.log_x) + array(own + "_c", term.coefficients);
      terms += fmt::format("{}{{{}, {}, {}, {}_log_x, {}_c}}", t > 0 ? ", " : "", term.variable, term.log_x.size() - 1,
                           kLawDegree, own, own);
    }
    const std::string own = fmt::format("{}_{}", name, k);
    if (!terms.empty()) text += fmt::format("static const law_term {}_terms[] = {{{}}};\n", own, terms);
    rows +=
        fmt::format("  {{{:a}, {}, {}}},\n", list[k]->at_rest, list[k]->terms.size(), terms.empty() ? "0" : own + "_terms");
  }
  return text + fmt::format("static const drive_law {}[] = {{\n{}}};\n", name, rows.empty() ? "  {0.0, 0, 0}\n" : rows);
}

/// Text that is safe in a comment.
std::string comment(std::string text) {
  for (std::size_t at = 0; (at = text.find("*/", at)) != std::string::npos;) text.replace(at, 2, "* /");
  for (std::size_t at = 0; (at = text.find("/*", at)) != std::string::npos;) text.replace(at, 2, "/ *");
  return text;
}

std::vector<double> nominal_of(const FmuModel& model) {
  // The change of a state that changes an output by 1 K, 2 um or 20 urad, and no temperature by more than 1 K.
  std::vector<double> nominal;
  for (Eigen::Index i = 0; i < model.start.size(); ++i) {
    double per_unit = 1.0 / model.ones.norm();
    for (const FmuOutput& o : model.outputs) {
      const double scale = o.unit == "degC" ? 1.0 : o.unit == "um" ? 2e-6 : 2e-5;
      per_unit = std::max(per_unit, std::abs(o.state[i]) / scale);
    }
    nominal.push_back(1.0 / per_unit);
  }
  return nominal;
}

std::string observer_text(const FmuModel& model) {
  if (!model.observer) return "const observer_data observer = {0};\n";
  const FmuObserver& o = *model.observer;
  std::vector<double> mean, covariance;
  append(mean, o.factors.mean);
  append(covariance, o.factors.covariance);
  const compensation::ObserverSettings& s = o.settings;
  return array("factor_mean", mean) + array("factor_covariance", covariance) +
         fmt::format("static const int sensor_output[] = {{{}}};\n",
                     o.sensor_output.empty() ? "0" : fmt::format("{}", fmt::join(o.sensor_output, ", "))) +
         fmt::format(
             "const observer_data observer = {{\n  {}, sensor_output, {},\n  {:a}, {:a}, {:a}, {:a}, {:a}, {:a}, {:a}, "
             "{:a},\n"
             "  factor_mean, factor_covariance}};\n",
             o.sensors.size(), o.drift_output, s.period_s, s.reading_K, s.model_K, s.model_holds_s, s.factor, s.factor_walk,
             s.longest_step_s, s.drift_um);
}

}  // namespace

std::string model_data_c(const FmuModel& model, const std::string& identifier, const std::string& guid,
                         const std::string& made_by) {
  std::vector<double> conduction, constant, ambient, loads, exchanges, to_ambient, offsets, outputs, outputs_ambient, factor,
      offset, start, ones, most, known;
  append(conduction, model.conduction);
  append(constant, model.constant_load);
  append(ambient, model.ambient_load);
  std::vector<const DriveLaw*> powers, coefficients;
  for (const FmuSource& s : model.sources) {
    append(loads, s.load);
    powers.push_back(&s.power_W);
  }
  for (const FmuExchange& e : model.exchanges) {
    append(exchanges, e.matrix);
    append(to_ambient, e.to_ambient);
    append(offsets, e.offset);
    coefficients.push_back(&e.coefficient);
  }
  for (const FmuOutput& o : model.outputs) {
    append(outputs, o.state);
    outputs_ambient.push_back(o.ambient);
    factor.push_back(o.factor);
    offset.push_back(o.offset);
  }
  append(start, model.start);
  append(ones, model.ones);
  for (const DriveRange& r : model.drive) most.push_back(r.most);
  for (const std::vector<double>& x : model.known_drives) known.insert(known.end(), x.begin(), x.end());

  std::string text = fmt::format("/* {} {} */\n#include \"model_data.h\"\n\n", comment(model.description), comment(made_by));
  text += fmt::format("const char *const model_guid = \"{}\";\nconst char *const model_identifier = \"{}\";\n\n", guid,
                      identifier);
  text += array("conduction", conduction) + array("constant_load", constant) + array("ambient_load", ambient) +
          array("loads", loads) + laws("powers", powers) + array("exchanges", exchanges) + array("to_ambient", to_ambient) +
          array("offsets", offsets) + laws("coefficients", coefficients) + array("outputs", outputs) +
          array("outputs_ambient", outputs_ambient) + array("output_factor", factor) + array("output_offset", offset) +
          array("start", start) + array("ones", ones) + array("ambient_time_s", model.ambient.time_s) +
          array("ambient_K", model.ambient.value) + array("most_drive", most) + array("nominal", nominal_of(model)) +
          array("known_drive", known);
  text += fmt::format(
      "const thermal_data thermal = {{\n  {}, {}, {}, {}, {},\n  conduction, constant_load, ambient_load, loads, powers, "
      "exchanges, "
      "to_ambient, offsets, coefficients,\n  outputs, outputs_ambient, output_factor, output_offset, start, ones, {:a}, {}, "
      "{:a},\n  {}, "
      "ambient_time_s, ambient_K, most_drive, nominal, {}, known_drive}};\n",
      model.start.size(), model.drive.size(), model.sources.size(), model.exchanges.size(), model.outputs.size(),
      model.start_ambient_K, model.start_follows_ambient ? 1 : 0, model.reference_K - 273.15, model.ambient.time_s.size(),
      model.known_drives.size());
  return text + observer_text(model);
}

}  // namespace driftwright::output
