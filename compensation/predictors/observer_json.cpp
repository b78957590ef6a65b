// An observer in a file.

#include <fmt/format.h>

#include "base/config_map.hpp"
#include "base/config_text.hpp"
#include "base/json_value.hpp"
#include "compensation/predictors/observer.hpp"
#include "compensation/predictors/predictor_kind.hpp"
#include "effects/film_field.hpp"
#include "effects/former_words.hpp"
#include "solver/system_json.hpp"

namespace driftwright::compensation {
namespace {

using json::Json;

/// Writes the columns one after another.
Json matrix_json(const Eigen::MatrixXd& m) {
  return {{"rows", m.rows()}, {"columns", m.cols()}, {"values", std::vector<double>(m.data(), m.data() + m.size())}};
}

Eigen::MatrixXd matrix_of(const Json& j) {
  constexpr Eigen::Index kMost = 100'000;  // limit of rows or columns; a reduced model has about a hundred
  const auto rows = json::value<Eigen::Index>(j, "rows"), columns = json::value<Eigen::Index>(j, "columns");
  const auto values = json::value<std::vector<double>>(j, "values");
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
  return {.reading_K = json::positive(j, "reading_K"),
          .model_K = json::finite(j, "model_K"),
          .drift_um = json::positive(j, "drift_um"),
          .model_um = json::finite(j, "model_um"),
          .model_holds_s = json::finite(j, "model_holds_s"),
          .factor = json::finite(j, "factor"),
          .factor_walk = json::finite(j, "factor_walk"),
          .scale = json::finite(j, "scale"),
          .longest_step_s = json::positive(j, "longest_step_s"),
          .period_s = json::positive(j, "period_s"),
          .most_apart = j.contains("most_apart") ? json::positive(j, "most_apart") : 1.0};
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
  std::vector<effects::FormerWord> former;  // words of an earlier release
  const ConfigNodePtr tree = effects::in_present_words(read_config_text(yaml, "the list `effects`"), former);
  for (const ConfigMap& entry : ConfigMap::of_tree(tree).maps("effects")) effects.push_back(effects::read_effect(entry));
  return effects;
}

std::shared_ptr<const Predictor> read_observer(const Json& j, const DriftTarget&) {
  Observer::State s;
  s.sensors = json::value<std::vector<std::string>>(j, "sensors");
  s.drift = json::value<std::string>(j, "drift");
  s.start_ambient_K = json::finite(j, "start_hall_K");
  s.settings = settings_of(json::value<Json>(j, "settings"));
  const auto factors = json::value<Json>(j, "factors"), arrays = json::value<Json>(j, "arrays"),
             system = json::value<Json>(j, "system");
  s.factors.mean = matrix_of(json::value<Json>(factors, "mean")).reshaped();
  s.factors.covariance = matrix_of(json::value<Json>(factors, "covariance"));
  s.laws = effects_of(json::list(j, "effects"));
  const effects::HeatBalance balance = effects::heat_balance(s.laws);
  try {
    s.system = solver::read_system(
        system, balance, [&](const std::string& name) { return matrix_of(json::value<Json>(arrays, name.c_str())); },
        s.start);
    return std::make_shared<Observer>(Observer::of_state(std::move(s)));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("`system`: {}", e.what()));
  } catch (const std::logic_error& e) {  // the laws belong to another machine
    throw InputError(fmt::format("`effects` and `system` do not fit each other: {}", e.what()));
  }
}

}  // namespace

std::optional<Written> Observer::written() const {
  State s = state();
  s.system.parts.clear();  // properties of the bodies, which an observer does not need
  Json arrays = Json::object(), laws = Json::array();
  Json system = solver::write_system(s.system, s.start, [&](const std::string& name, const Eigen::MatrixXd& values) {
    arrays[name] = matrix_json(values);
  });
  for (const effects::Effect& e : s.laws) laws.push_back(effects::yaml_of(effects::without_its_file(e)));
  Json content = {{"sensors", s.sensors},
                  {"drift", s.drift},
                  {"start_hall_K", s.start_ambient_K},
                  {"settings", settings_json(s.settings)},
                  {"factors", {{"mean", matrix_json(s.factors.mean)}, {"covariance", matrix_json(s.factors.covariance)}}},
                  {"effects", std::move(laws)},
                  {"system", std::move(system)},
                  {"arrays", std::move(arrays)}};
  return Written{.kind = "observer", .content = std::move(content)};
}

PredictorKind observer_kind() {
  return {.key = "observer", .read = read_observer};
}

}  // namespace driftwright::compensation
