#include "output/predictor_file.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "base/bounded_json.hpp"
#include "base/file_bytes.hpp"
#include "base/hashed_json.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/past_drift.hpp"
#include "output/formula_json.hpp"
#include "output/json_value.hpp"
#include "output/observer_json.hpp"

namespace driftwright::output {
namespace {

using namespace compensation;

constexpr const char* kFormat = "driftwright predictor 1";

/// Requires that the predictor in the file is complete and unchanged since it was judged.
void require_whole(const Json& file) {
  if (!is_whole(file))
    throw InputError(
        "key `hash` does not fit what the file holds: it was damaged or changed, and is not what was judged; `validate` "
        "writes it anew");
}

Json earlier_runs_json(const EarlierRunsPredictor& p) {
  Json runs = Json::array();
  for (const Record& run : p.runs()) {
    Json drift = Json::array();
    for (double v : run.channels.front().values) drift.push_back(number(v));
    runs.push_back({{"name", run.source}, {"time_s", run.time_s}, {"drift_um", std::move(drift)}});
  }
  return {{"runs", std::move(runs)}};
}

std::shared_ptr<const Predictor> earlier_runs_of(const Json& j, const std::string& target) {
  std::vector<Record> runs;
  for (const Json& run : list(j, "runs")) {
    Record r{.source = value<std::string>(run, "name"),
             .time_s = value<std::vector<double>>(run, "time_s"),
             .channels = {{target, "um", {}}}};
    for (const Json& v : list(run, "drift_um")) r.channels[0].values.push_back(v.is_number() ? v.get<double>() : NAN);
    if (r.time_s.empty() || r.time_s.size() != r.channels[0].values.size() ||
        std::adjacent_find(r.time_s.begin(), r.time_s.end(), std::greater_equal<>()) != r.time_s.end())
      throw InputError(fmt::format("run '{}' must have as many `drift_um` as `time_s`, which rise", r.source));
    runs.push_back(std::move(r));
  }
  if (runs.empty()) throw InputError("`runs` is empty; at least one run is required");
  return std::make_shared<EarlierRunsPredictor>(runs, target);
}

/// The content of the predictor, and the name of its kind.
std::pair<std::string, Json> made_of(const Predictor& p, const std::vector<effects::Effect>& effects) {
  if (const DriftModel* formula = as_formula(p)) return {"formula", formula_json(*formula)};
  if (const auto* observer = dynamic_cast<const Observer*>(&p)) return {"observer", observer_json(*observer, effects)};
  if (const auto* constant = dynamic_cast<const ConstantPredictor*>(&p))
    return {"constant", {{"drift_um", constant->drift_um()}}};
  if (const auto* runs = dynamic_cast<const EarlierRunsPredictor*>(&p)) return {"earlier_runs", earlier_runs_json(*runs)};
  throw std::logic_error("a predictor of a kind that no file holds");
}

/// @param file  holds the predictor's content under the name of its kind
std::shared_ptr<const Predictor> predictor_of(const Json& file, const DeployedPredictor& d) {
  const std::vector<std::string> kinds = {"formula", "observer", "constant", "earlier_runs"};
  const auto kind = value<std::string>(file, "predictor");
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw InputError(fmt::format("key `predictor` is '{}'; {} are known", kind, fmt::join(kinds, ", ")));
  const auto j = value<Json>(file, kind.c_str());
  if (kind == "formula") {
    DriftModel model = formula_of(j);
    model.target = d.target;
    model.target_unit = "um";
    model.from_start = d.from_start;
    return std::make_shared<FormulaPredictor>(std::move(model));
  }
  if (kind == "observer") return std::make_shared<Observer>(observer_of(j));
  if (kind == "constant") return std::make_shared<ConstantPredictor>(finite(j, "drift_um"));
  return earlier_runs_of(j, d.target);
}

/// Requires that the fail-safe guards every input of a formula.
void require_guards(const DeployedPredictor& d) {
  if (!d.fail_safe) return;
  if (d.fail_safe->from_start != d.from_start)
    throw InputError("`from_start` of the predictor and of its `fail_safe` differ; they must say the same");
  if (!as_formula(*d.predictor)) return;
  for (const Input& input : d.predictor->inputs()) {
    if (std::none_of(d.fail_safe->guards.begin(), d.fail_safe->guards.end(),
                     [&](const FailSafe::Guard& g) { return g.input == input.name && g.unit == input.unit; }))
      throw InputError(fmt::format("term '{}' in {} has no guard among `guards`", input.name, input.unit));
  }
}

PredictorFile file_of(const Json& j) {
  if (!j.is_object() || value<std::string>(j, "format") != kFormat)
    throw InputError(
        fmt::format("this file holds no predictor (key `format` must be \"{}\"); `validate` writes them", kFormat));
  PredictorFile file;
  DeployedPredictor& d = file.predictor;
  d.name = value<std::string>(j, "name");
  d.target = value<std::string>(j, "target");
  if (value<std::string>(j, "target_unit") != "um")
    throw InputError(fmt::format("key `target_unit` is {}; drift must be in um", j.at("target_unit").dump()));
  d.from_start = value<bool>(j, "from_start");
  d.is_baseline = value<bool>(j, "baseline");
  d.sensors = value<std::vector<std::string>>(j, "sensors");
  d.ambient = value<std::string>(j, "hall");
  d.reason = value<std::string>(j, "decided");
  if (const double half = number_or(j, "interval_95_um", NAN); std::isfinite(half)) d.interval_um = half;
  d.predictor = predictor_of(j, d);
  if (const auto safe = value<Json>(j, "fail_safe"); !safe.is_null()) d.fail_safe = fail_safe_of(safe);
  require_guards(d);
  file.judged = value<Json>(j, "judged");
  if (j.contains("watch")) file.watch = j["watch"];
  if (j.contains("covered") && !j["covered"].is_null()) {
    const Json& c = j["covered"];
    file.covered = {finite(c, "most_rpm"), finite(c, "low_degC"), finite(c, "high_degC")};
  }
  require_whole(j);
  return file;
}

}  // namespace

Json predictor_json(const PredictorFile& file, const std::vector<effects::Effect>& effects, const Provenance& made_by) {
  const DeployedPredictor& d = file.predictor;
  auto [kind, made] = made_of(*d.predictor, effects);
  Json j = {{"format", kFormat},
            {"program", "driftwright"},
            {"version", made_by.version},
            {"scenario", made_by.scenario},
            {"name", d.name},
            {"target", d.target},
            {"target_unit", "um"},
            {"from_start", d.from_start},
            {"baseline", d.is_baseline},
            {"sensors", d.sensors},
            {"hall", d.ambient},
            {"decided", d.reason},
            {"interval_95_um", d.interval_um ? Json(*d.interval_um) : Json(nullptr)},
            {"judged", file.judged},
            {"watch", file.watch},
            {"covered", file.covered ? Json{{"most_rpm", file.covered->most_rpm},
                                            {"low_degC", file.covered->low_degC},
                                            {"high_degC", file.covered->high_degC}}
                                     : Json(nullptr)},
            {"fail_safe", d.fail_safe ? fail_safe_json(*d.fail_safe) : Json(nullptr)},
            {"predictor", kind}};
  j[kind] = std::move(made);
  return with_hash(std::move(j));
}

PredictorFile read_predictor(const std::string& path) {
  if (!std::filesystem::is_regular_file(path))
    throw InputError(fmt::format("{}: there is no such file; it must be a predictor of `validate`, models/NAME.json", path));
  const std::string text = read_bytes(path);
  try {
    return file_of(parse_json(text));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(fmt::format("{}: {}", path, e.what()));
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", path, e.what()));
  }
}

}  // namespace driftwright::output
