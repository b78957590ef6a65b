#include "output/fmu/model_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace driftwright::output {
namespace {

constexpr std::size_t kPerLine = 6;
constexpr const char* kNumbersMark = "DwNumber";  // the last eight bytes, as in binary/model_numbers.c

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
    for (const FmuAlong& along : model.along) {  // at the beginning of each piece
      const auto row = static_cast<std::size_t>(model.start.size()) + 1;
      for (std::size_t at = 0; at < along.cubics.size(); at += 4 * row)
        per_unit = std::max(per_unit, std::abs(along.cubics[at + static_cast<std::size_t>(i)]) / 2e-6);
    }
    nominal.push_back(1.0 / per_unit);
  }
  return nominal;
}

/// The lists of a model, in the order of thermal_data and observer_data (sources/model_data.h).
struct ModelLists {
  std::vector<double> conduction, constant, ambient, loads, exchanges, to_ambient, offsets, outputs, outputs_ambient, factor,
      offset, start, ones, most, least, known, factor_mean, factor_covariance, thermostats, switched_by, direct_output;
  std::vector<const DriveLaw*> powers, coefficients, direct;
  struct Live {
    double source, exchange;  ///< index of one, -1 for the other
    const FmuLiveLaw* law;
  };
  std::vector<Live> live;
  struct Formula {
    double source, exchange;  ///< as of Live
    const FmuFormula* steps;
  };
  std::vector<Formula> formulas;
};

ModelLists lists_of(const FmuModel& model) {
  ModelLists lists;
  append(lists.conduction, model.conduction);
  append(lists.constant, model.constant_load);
  append(lists.ambient, model.ambient_load);
  for (const FmuSource& s : model.sources) {
    append(lists.loads, s.load);
    if (s.live) lists.live.push_back({static_cast<double>(lists.powers.size()), -1.0, &*s.live});
    if (!s.formula.empty()) lists.formulas.push_back({static_cast<double>(lists.powers.size()), -1.0, &s.formula});
    lists.powers.push_back(&s.power_W);
    lists.switched_by.push_back(s.thermostat + 1);
  }
  for (const FmuExchange& e : model.exchanges) {
    append(lists.exchanges, e.matrix);
    append(lists.to_ambient, e.to_ambient);
    append(lists.offsets, e.offset);
    if (e.live) lists.live.push_back({-1.0, static_cast<double>(lists.coefficients.size()), &*e.live});
    if (!e.formula.empty()) lists.formulas.push_back({-1.0, static_cast<double>(lists.coefficients.size()), &e.formula});
    lists.coefficients.push_back(&e.coefficient);
  }
  for (const FmuOutput& o : model.outputs) {
    append(lists.outputs, o.state);
    lists.outputs_ambient.push_back(o.ambient);
    lists.factor.push_back(o.factor);
    lists.offset.push_back(o.offset);
  }
  for (const FmuOutput& o : model.first) {
    append(lists.outputs, o.state);
    lists.outputs_ambient.push_back(o.ambient);
  }
  for (const FmuThermostat& t : model.thermostats) {
    lists.thermostats.insert(lists.thermostats.end(), {t.on_above_K, t.off_below_K, t.ambient_share, t.offset_K});
    append(lists.thermostats, t.weights);
  }
  for (const FmuDirect& d : model.direct) {
    lists.direct_output.push_back(d.output);
    lists.direct.push_back(&d.law);
  }
  append(lists.start, model.start);
  append(lists.ones, model.ones);
  for (const DriveRange& r : model.drive) {
    lists.most.push_back(r.most);
    lists.least.push_back(r.least);
  }
  for (const std::vector<double>& x : model.known_drives) lists.known.insert(lists.known.end(), x.begin(), x.end());
  if (model.observer) {
    append(lists.factor_mean, model.observer->factors.mean);
    append(lists.factor_covariance, model.observer->factors.covariance);
  }
  return lists;
}

std::vector<double> columns_of(const Eigen::MatrixXd& m) {
  return {m.data(), m.data() + m.size()};
}

/// The list `static const live_law live[]`, after its arrays; nothing if no law follows temperatures.
std::string live_laws(const std::vector<ModelLists::Live>& live) {
  std::string text, rows;
  for (std::size_t k = 0; k < live.size(); ++k) {
    const FmuLiveLaw& law = *live[k].law;
    const std::string own = fmt::format("live_{}", k);
    text += array(own + "_steps", law.steps) + array(own + "_weights", columns_of(law.weights)) +
            array(own + "_share", law.ambient_share) + array(own + "_offset", law.offset_K);
    rows += fmt::format("  {{{:g}, {:g}, {}, {}_steps, {}, {}_weights, {}_share, {}_offset}},\n", live[k].source,
                        live[k].exchange, law.steps.size() / 2, own, law.weights.cols(), own, own, own);
  }
  return rows.empty() ? "" : text + fmt::format("static const live_law live[] = {{\n{}}};\n", rows);
}

/// The lists `formulas` and `along`, after their arrays; nothing for an empty one.
std::string formulas_text(const std::vector<ModelLists::Formula>& formulas) {
  std::string text, rows;
  for (std::size_t k = 0; k < formulas.size(); ++k) {
    text += array(fmt::format("formula_{}", k), *formulas[k].steps);
    rows += fmt::format("  {{{:g}, {:g}, {}, formula_{}}},\n", formulas[k].source, formulas[k].exchange,
                        formulas[k].steps->size() / 2, k);
  }
  return rows.empty() ? "" : text + fmt::format("static const drive_formula formulas[] = {{\n{}}};\n", rows);
}
std::vector<FmuAlong> all_along(const FmuModel& model) {
  std::vector<FmuAlong> all = model.along;
  all.insert(all.end(), model.along_first.begin(), model.along_first.end());
  return all;
}
std::string along_text(const std::vector<FmuAlong>& along) {
  std::string text, rows;
  for (std::size_t k = 0; k < along.size(); ++k) {
    text += array(fmt::format("along_{}_ends", k), along[k].ends_mm) + array(fmt::format("along_{}_c", k), along[k].cubics);
    rows += fmt::format("  {{{}, {}, {}, along_{}_ends, along_{}_c}},\n", along[k].output, along[k].variable,
                        along[k].ends_mm.size() - 1, k, k);
  }
  return rows.empty() ? "" : text + fmt::format("static const output_along along[] = {{\n{}}};\n", rows);
}

/// In the order of observer_settings (compensation/control/observer_filter.h).
std::vector<double> settings_of(const FmuObserver& observer) {
  const compensation::ObserverSettings& s = observer.settings;
  return {s.reading_K, s.model_K,     s.drift_um,       s.model_um, s.model_holds_s,
          s.factor,    s.factor_walk, s.longest_step_s, s.period_s, s.most_apart};
}

/// In the order of probe_process (compensation/control/probe_feedback.h), after whether there is one.
std::vector<double> probing_of(const FmuObserver& observer) {
  const probe_process p = observer.probing.value_or(probe_process{});
  return {observer.probing ? 1.0 : 0.0,
          p.deviation_um,
          p.time_constant_s,
          p.noise_um,
          p.lag_s,
          static_cast<double>(p.is_known_at_start)};
}

std::string observer_text(const FmuModel& model, const ModelLists& lists) {
  if (!model.observer) return "const observer_data observer = {0};\n";
  const FmuObserver& o = *model.observer;
  std::string settings;
  for (double value : settings_of(o)) settings += fmt::format("{}{:a}", settings.empty() ? "" : ", ", value);
  const std::vector<double> p = probing_of(o);
  return array("factor_mean", lists.factor_mean) + array("factor_covariance", lists.factor_covariance) +
         fmt::format("static const int sensor_output[] = {{{}}};\n",
                     o.sensor_output.empty() ? "0" : fmt::format("{}", fmt::join(o.sensor_output, ", "))) +
         fmt::format(
             "const observer_data observer = {{\n  {}, sensor_output, {},\n  {{{}}},\n  factor_mean, factor_covariance,\n"
             "  {:g}, {{{:a}, {:a}, {:a}, {:a}, {:g}}}}};\n",
             o.sensors.size(), o.drift_output, settings, p[0], p[1], p[2], p[3], p[4], p[5]);
}

/// A block of numbers of eight bytes each, as binary/model_numbers.c reads it.
struct NumberBlock {
  std::string bytes;

  void add(double value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }
  template <class... Count>
  void add_counts(Count... counts) {
    (add(static_cast<double>(counts)), ...);
  }
  void add(const std::vector<double>& list) {
    for (double value : list) add(value);
  }
  void add(const std::string& text) {  // its length, then its characters and zeros up to a whole number
    add_counts(text.size());
    bytes += text + std::string(sizeof(double) - text.size() % sizeof(double), '\0');
  }
  void add(const std::vector<const DriveLaw*>& laws) {
    for (const DriveLaw* law : laws) {
      add(law->at_rest);
      add_counts(law->terms.size());
      for (const LawTerm& term : law->terms) {
        add_counts(term.variable, term.log_x.size() - 1, kLawDegree);
        add(term.log_x);
        add(term.coefficients);
      }
    }
  }
};

}  // namespace

std::string model_data_c(const FmuModel& model, const std::string& guid, const std::string& made_by) {
  const ModelLists lists = lists_of(model);
  std::string text = fmt::format("/* {} {} */\n#include \"model_data.h\"\n\n", comment(model.description), comment(made_by));
  text += fmt::format("const char *const model_guid = \"{}\";\n\n", guid);
  text += array("conduction", lists.conduction) + array("constant_load", lists.constant) +
          array("ambient_load", lists.ambient) + array("loads", lists.loads) + laws("powers", lists.powers) +
          array("exchanges", lists.exchanges) + array("to_ambient", lists.to_ambient) + array("offsets", lists.offsets) +
          laws("coefficients", lists.coefficients) + array("outputs", lists.outputs) +
          array("outputs_ambient", lists.outputs_ambient) + array("output_factor", lists.factor) +
          array("output_offset", lists.offset) + array("start", lists.start) + array("ones", lists.ones) +
          array("ambient_time_s", model.ambient.time_s) + array("ambient_K", model.ambient.value) +
          array("most_drive", lists.most) + array("nominal", nominal_of(model)) + array("known_drive", lists.known) +
          live_laws(lists.live) + array("least_drive", lists.least) + formulas_text(lists.formulas) +
          along_text(all_along(model)) + array("thermostats", lists.thermostats) + array("switched_by", lists.switched_by) +
          array("direct_output", lists.direct_output) + laws("direct", lists.direct);
  text += fmt::format(
      "const thermal_data thermal = {{\n  {}, {}, {}, {}, {},\n  conduction, constant_load, ambient_load, loads, powers, "
      "exchanges, "
      "to_ambient, offsets, coefficients,\n  outputs, outputs_ambient, output_factor, output_offset, start, ones, {:a}, {}, "
      "{:a},\n  {}, "
      "ambient_time_s, ambient_K, most_drive, nominal, {}, known_drive, {}, {},\n  least_drive, {}, {}, {}, "
      "{},\n  {}, thermostats, switched_by, {}, {}, {}, direct_output, direct}};\n",
      model.start.size(), model.drive.size(), model.sources.size(), model.exchanges.size(), model.outputs.size(),
      model.start_ambient_K, model.start_follows_ambient ? 1 : 0, model.reference_K - 273.15, model.ambient.time_s.size(),
      model.known_drives.size(), lists.live.size(), lists.live.empty() ? "0" : "live", lists.formulas.size(),
      lists.formulas.empty() ? "0" : "formulas", model.along.size(), all_along(model).empty() ? "0" : "along",
      model.thermostats.size(), model.first.size(), model.along_first.size(), model.direct.size());
  return text + observer_text(model, lists);
}

std::string model_numbers(const FmuModel& model, const std::string& guid) {
  const ModelLists lists = lists_of(model);
  NumberBlock block;
  block.add(guid);
  block.add_counts(model.start.size(), model.drive.size(), model.sources.size(), model.exchanges.size(),
                   model.outputs.size(), model.first.size());
  for (const auto* list : {&lists.conduction, &lists.constant, &lists.ambient, &lists.loads}) block.add(*list);
  block.add(lists.powers);
  for (const auto* list : {&lists.exchanges, &lists.to_ambient, &lists.offsets}) block.add(*list);
  block.add(lists.coefficients);
  for (const auto* list : {&lists.outputs, &lists.outputs_ambient, &lists.factor, &lists.offset, &lists.start, &lists.ones})
    block.add(*list);
  block.add(model.start_ambient_K);
  block.add_counts(model.start_follows_ambient ? 1 : 0);
  block.add(model.reference_K - 273.15);
  block.add_counts(model.ambient.time_s.size());
  block.add(model.ambient.time_s);
  block.add(model.ambient.value);
  block.add(lists.most);
  block.add(nominal_of(model));
  block.add_counts(model.known_drives.size());
  block.add(lists.known);
  block.add_counts(lists.live.size());
  for (const ModelLists::Live& live : lists.live) {
    block.add_counts(live.source, live.exchange, live.law->steps.size() / 2);
    block.add(live.law->steps);
    block.add_counts(live.law->weights.cols());
    for (const auto& list : {columns_of(live.law->weights), live.law->ambient_share, live.law->offset_K}) block.add(list);
  }
  block.add(lists.least);
  block.add_counts(lists.formulas.size());
  for (const ModelLists::Formula& f : lists.formulas) {
    block.add_counts(f.source, f.exchange, f.steps->size() / 2);
    block.add(*f.steps);
  }
  block.add_counts(model.along.size(), model.along_first.size());
  for (const FmuAlong& a : all_along(model)) {
    block.add_counts(a.output, a.variable, a.ends_mm.size() - 1);
    block.add(a.ends_mm);
    block.add(a.cubics);
  }
  block.add_counts(model.thermostats.size());
  block.add(lists.thermostats);
  block.add(lists.switched_by);
  block.add_counts(model.direct.size());
  block.add(lists.direct_output);
  block.add(lists.direct);
  block.add_counts(model.observer ? 1 : 0);
  if (model.observer) {
    const FmuObserver& o = *model.observer;
    block.add_counts(o.sensors.size());
    for (int output : o.sensor_output) block.add_counts(output);
    block.add_counts(o.drift_output);
    block.add(settings_of(o));
    block.add(lists.factor_mean);
    block.add(lists.factor_covariance);
    block.add(probing_of(o));
  }
  block.add_counts(block.bytes.size() / sizeof(double));
  return block.bytes + kNumbersMark;
}

}  // namespace driftwright::output
