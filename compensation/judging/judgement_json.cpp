#include "compensation/judging/judgement_json.hpp"

#include <nlohmann/json.hpp>

namespace driftwright::compensation {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Cyclograms by name, or records with the times of their first and last row.
Json trained_on(const StrategyMatrix& m) {
  Json cyclograms = Json::array(), records = Json::array();
  for (const MachineRun& run : m.training) {
    if (run.rows.file.empty())
      cyclograms.push_back(run.readings.source);
    else
      records.push_back({{"file", run.rows.file}, {"from_s", run.rows.first_s}, {"until_s", run.rows.last_s}});
  }
  return records.empty() ? cyclograms : records;
}

Json conditions_json(const StrategyMatrix& m) {
  const StrategySettings& how = m.settings.strategies;
  const LinearisedModel* linearised = how.physics && how.physics->linearised ? &*how.physics->linearised : nullptr;
  Json j = {{"target", how.target},
            {"screw", how.place ? Json(how.place->screw) : Json(nullptr)},
            {"position_mm", how.place ? Json(1e3 * how.place->at_m) : Json(nullptr)},
            {"not_judged", other_axes(m)},
            {"tolerance_um", m.settings.tolerance_um},
            {"count_from_start", how.count_from_start},
            {"sensors_fail_at", or_null(m.settings.fails_at)},
            {"reading_K", how.reading_K},
            {"drift_um", how.drift_um},
            {"linearised_error_um", linearised ? Json(linearised->error_um) : Json(nullptr)}};
  if (linearised) {
    j["linearised_laws"] = Json::array();
    for (const solver::LinearisedLaw& law : linearised->laws)
      j["linearised_laws"].push_back({{"law", law.name}, {"at_degC", law.at_K - 273.15}, {"spread_K", law.spread_K}});
  }
  j["trained_on"] = trained_on(m);
  for (const JudgedRunOfMachine& run : m.runs)
    j["judged_on"].push_back({{"run", run.name}, {"family", run.family}, {"season", run.season}});
  j["with_failed_sensors"] = m.settings.fails_at.has_value();
  return j;
}

}  // namespace

Json judgement_json(const StrategyMatrix& m, const JudgedStrategy& s) {
  const Worst intact = worst_of(s, [](const Case&c) { return c.failed.empty(); }),
              failed = worst_of(s, [](const Case&c) { return !c.failed.empty(); });
  const bool is_baseline = s.fitted.is_baseline;
  const auto unless_baseline = [&](Json value) { return is_baseline ? Json(nullptr) : value; };
  Json j = conditions_json(m);
  j["name"] = s.fitted.name;
  j["worst_peak_um"] = intact.peak ? Json(intact.peak->after.peak_abs) : Json(nullptr);
  j["worst_left_percent"] = 100.0 * intact.left;
  j["failed_sensor_worst_peak_um"] = failed.peak ? Json(failed.peak->after.peak_abs) : Json(nullptr);
  j["failed_sensor_worst_left_percent"] = failed.peak ? Json(100.0 * failed.left) : Json(nullptr);
  j["overall_rms_um"] = overall_rms(s);
  j["left_out_um"] = s.fitted.fold_errors.empty() ? Json(nullptr) : Json(left_out_um(s.fitted));
  j["interval_95_um"] = or_null(s.fitted.interval_um);
  j["covered_percent"] = s.fitted.interval_um ? Json(100.0 * intact.mean_covered) : Json(nullptr);
  j["verdict"] = is_baseline ? "baseline" : word(s.safety);
  j["cells_kept"] = s.cells.n_kept();
  j["cells"] = s.cells.n();
  j["model"] = s.fitted.model;
  j["beaten_by"] = is_baseline ? "" : s.beaten_by;
  j["largest_rms_um"] = intact.rms_um;
  j["baseline"] = is_baseline;
  j["worse_than_nothing"] = unless_baseline(s.is_worse_than_nothing);
  j["why"] = unless_baseline(s.why);
  j["keeps_tolerance_in"] = unless_baseline(s.limits);
  j["cells_kept_intact"] = s.cells.n_kept_intact;
  j["cells_intact"] = s.cells.n_intact;
  j["not_kept"] = s.cells.not_kept;
  j["n_not_kept"] = s.cells.n_not_kept;
  j["sensors"] = s.fitted.sensors;
  j["decided"] = s.fitted.reason;
  return j;
}

}  // namespace driftwright::compensation
