#include "output/observer_json.hpp"

#include "base/config_map.hpp"
#include "base/config_text.hpp"
#include "machine/reduced_files.hpp"
#include "output/json_value.hpp"
#include "scenarios/reader/former_words.hpp"

namespace driftwright::output {
namespace {

using compensation::Observer;
using compensation::ObserverSettings;

/// Writes the columns one after another.
Json matrix_json(const Eigen::MatrixXd& m) {
  return {{"rows", m.rows()}, {"columns", m.cols()}, {"values", std::vector<double>(m.data(), m.data() + m.size())}};
}

Eigen::MatrixXd matrix_of(const Json& j) {
  constexpr Eigen::Index kMost = 100'000;  // limit of rows or columns; a reduced model has about a hundred
  const auto rows = value<Eigen::Index>(j, "rows"), columns = value<Eigen::Index>(j, "columns");
  const auto values = value<std::vector<double>>(j, "values");
  if (rows < 0 || columns < 0 || rows > kMost || columns > kMost ||
      static_cast<std::size_t>(rows * columns) != values.size())
    throw InputError(fmt::format("a matrix of {} x {} has {} `values`", rows, columns, values.size()));
  return Eigen::Map<const Eigen::MatrixXd>(values.data(), rows, columns);
}

Json settings_json(const ObserverSettings& s) {
  return {{"reading_K", s.reading_K},
          {"model_K", s.model_K},
          {"drift_um", s.drift_um},
          {"model_um", s.model_um},
          {"model_holds_s", s.model_holds_s},
          {"factor", s.factor},
          {"factor_walk", s.factor_walk},
          {"scale", s.scale},
          {"longest_step_s", s.longest_step_s},
          {"period_s", s.period_s},
          {"most_apart", s.most_apart}};
}

ObserverSettings settings_of(const Json& j) {
  return {.reading_K = positive(j, "reading_K"),
          .model_K = finite(j, "model_K"),
          .drift_um = positive(j, "drift_um"),
          .model_um = finite(j, "model_um"),
          .model_holds_s = finite(j, "model_holds_s"),
          .factor = finite(j, "factor"),
          .factor_walk = finite(j, "factor_walk"),
          .scale = finite(j, "scale"),
          .longest_step_s = positive(j, "longest_step_s"),
          .period_s = positive(j, "period_s"),
          .most_apart = j.contains("most_apart") ? positive(j, "most_apart") : 1.0};
}

std::vector<effects::Effect> effects_of(const Json& list) {
  std::string yaml = "effects:\n";
  for (const Json& entry : list) {
    if (!entry.is_string())
      throw InputError(fmt::format("`effects` holds {}; it must hold entries as in a scenario", entry.dump()));
    yaml += "  - " + entry.get<std::string>() + "\n";
  }
  std::vector<effects::Effect> effects;
  if (list.empty()) return effects;
  std::vector<scenarios::FormerWord> former;  // words of an earlier release
  const ConfigNodePtr tree = scenarios::in_present_words(read_config_text(yaml, "the list `effects`"), former);
  for (const ConfigMap& entry : ConfigMap::of_tree(tree).maps("effects")) effects.push_back(effects::read_effect(entry));
  return effects;
}

}  // namespace

Json observer_json(const Observer& observer, const std::vector<effects::Effect>& effects) {
  Observer::State s = observer.state();
  s.system.parts.clear();  // properties of the bodies, which an observer does not need
  Json arrays = Json::object(), laws = Json::array();
  Json system = scenarios::write_system(s.system, s.start, [&](const std::string& name, const Eigen::MatrixXd& values) {
    arrays[name] = matrix_json(values);
  });
  for (const effects::Effect& e : effects) {
    if (e.kind->acts_on_heat()) laws.push_back(effects::yaml_of(e));
  }
  return {{"sensors", s.sensors},
          {"drift", s.drift},
          {"start_hall_K", s.start_ambient_K},
          {"settings", settings_json(s.settings)},
          {"factors", {{"mean", matrix_json(s.factors.mean)}, {"covariance", matrix_json(s.factors.covariance)}}},
          {"effects", std::move(laws)},
          {"system", std::move(system)},
          {"arrays", std::move(arrays)}};
}

Observer observer_of(const Json& j) {
  Observer::State s;
  s.sensors = value<std::vector<std::string>>(j, "sensors");
  s.drift = value<std::string>(j, "drift");
  s.start_ambient_K = finite(j, "start_hall_K");
  s.settings = settings_of(value<Json>(j, "settings"));
  const auto factors = value<Json>(j, "factors"), arrays = value<Json>(j, "arrays"), system = value<Json>(j, "system");
  s.factors.mean = matrix_of(value<Json>(factors, "mean")).reshaped();
  s.factors.covariance = matrix_of(value<Json>(factors, "covariance"));
  const effects::HeatBalance balance = effects::heat_balance(effects_of(list(j, "effects")));
  try {
    s.system = scenarios::read_system(
        system, balance, [&](const std::string& name) { return matrix_of(value<Json>(arrays, name.c_str())); }, s.start);
    return Observer::of_state(std::move(s));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("`system`: {}", e.what()));
  } catch (const std::logic_error& e) {  // the laws belong to another machine
    throw InputError(fmt::format("`effects` and `system` do not fit each other: {}", e.what()));
  }
}

}  // namespace driftwright::output
