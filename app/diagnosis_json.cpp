#include "app/diagnosis_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace driftwright::app {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const diagnosis::Estimate& e) {
  return {{"name", e.name}, {"value", e.value}, {"unit", e.unit}, {"ci95", {e.low, e.high}}};
}

Json json_of(const diagnosis::Cause& c) {
  Json json = {{"effect", c.effect},
               {"standing", diagnosis::word(c.standing)},
               {"where", c.where},
               {"law", c.law},
               {"parameters", Json::array()}};
  if (!c.doubt.empty()) json["doubt"] = c.doubt;
  json["written"] = c.is_written;
  if (c.n_searched > 0) json["found_again"] = {{"searches", c.n_searched}, {"found", c.n_again}};
  for (const auto& p : c.parameters) json["parameters"].push_back(json_of(p));
  json["log_evidence_gain"] = c.log_evidence_gain;
  json["alternatives"] = Json::array();
  for (const auto& a : c.alternatives) json["alternatives"].push_back(json_of(a));
  return json;
}

Json json_of(const Cyclogram& cyclogram) {
  Json sections = Json::array();
  for (const auto& s : cyclogram.sections) {
    Json section = {{"duration_min", s.duration_s / 60.0}, {"speed_rpm", s.drive.speed_rpm}};
    for (std::size_t a = 0; a < s.drive.feed_m_s.size(); ++a) {
      if (s.drive.feed_m_s[a] > 0.0) section[std::string("feed_") + "xyz"[a] + "_mm_min"] = 60e3 * s.drive.feed_m_s[a];
    }
    sections.push_back(section);
  }
  return {{"name", cyclogram.name}, {"sections", sections}};
}

Json json_of(const diagnosis::Experiment& e) {
  Json json = {{"why", e.why},
               {"proposes", e.by_sensor ? "extra_sensor" : "cyclogram"},
               {"cyclogram", json_of(e.cyclogram)},
               {"discrimination", e.discrimination},
               {"simulated", {{"records", e.n_simulated}, {"told", e.n_told}}}};
  if (e.extra_sensor) {
    json["extra_sensor"] = {{"region", e.extra_sensor->region},
                            {"difference_K", e.extra_sensor->difference_K},
                            {"discrimination", e.extra_sensor->discrimination}};
  }
  return json;
}

Json json_of(const diagnosis::Unexplained& u) {
  Json json = {{"rms", u.channels.front().rms},    {"unit", u.channels.front().unit},
               {"where", u.channels.front().name}, {"waveform_correlates_with", u.correlates_with},
               {"correlation", u.correlation},     {"channels", Json::array()}};
  for (const auto& c : u.channels)
    json["channels"].push_back({{"name", c.name}, {"unit", c.unit}, {"rms", c.rms}, {"sigmas", c.times_noise}});
  if (!u.heat_would_sit_in.empty()) json["heat_would_sit_in"] = u.heat_would_sit_in;
  if (u.fails_held_out) json["fails_held_out"] = true;
  if (u.one_cause) {
    const char* quantity = u.one_cause->quantity == diagnosis::Unnamed::Quantity::kHeat   ? "heat"
                           : u.one_cause->quantity == diagnosis::Unnamed::Quantity::kHall ? "hall temperature"
                                                                                          : "reading";
    json["one_cause"] = {{"quantity", quantity},
                         {"where", u.one_cause->where},
                         {"follows", u.one_cause->follows},
                         {"instead_of", u.one_cause->instead_of},
                         {"log_evidence_gain", u.one_cause->log_evidence_gain}};
  }
  return json;
}

Json json_of(const diagnosis::Waveform& w) {
  using diagnosis::Shape;
  const bool is_heat = w.of == diagnosis::Waveform::Of::kHeat;
  const double scale = is_heat ? 1.0 : 1e6;
  const std::string unit = !w.to.empty() ? "W/K" : is_heat ? "W" : w.unit == "rad" ? "urad" : "um";
  Json shape = {{"class", diagnosis::word(w.shape.shape)},
                {"size", scale * w.shape.size},
                {"unit", unit},
                {"standard_deviation", scale * w.shape.size_sd},
                {"explained", w.shape.explained}};
  if (w.shape.shape == Shape::kStep || w.shape.shape == Shape::kDecay) shape["time_min"] = w.shape.time_s / 60.0;
  if (w.shape.shape == Shape::kDecay) shape["time_constant_min"] = w.shape.time_constant_s / 60.0;
  if (w.shape.shape == Shape::kPeriodic) shape["period_min"] = w.shape.period_s / 60.0;
  if (w.shape.shape == Shape::kProportional) shape["follows"] = w.shape.follows;
  if (w.shape.shape == Shape::kWindows) {
    shape["windows_min"] = Json::array();
    for (const auto& [begin_s, end_s] : w.shape.windows_s) shape["windows_min"].push_back({begin_s / 60.0, end_s / 60.0});
  }
  Json json = {{"record", w.run}, {"of", is_heat ? "heat" : "growth"}, {"where", w.where}};
  if (!w.to.empty()) json["to"] = w.to;
  if (is_heat) {
    json["log_likelihood_gain"] = w.log_likelihood_gain;
    json["explained"] = w.explained;
  }
  json["shape"] = shape;
  json["time_min"] = Json::array();
  json["value"] = Json::array();
  for (std::size_t i = 0; i < w.time_s.size(); ++i) {
    json["time_min"].push_back(w.time_s[i] / 60.0);
    json["value"].push_back(w.to.empty() ? scale * w.value[i] : w.conductance_W_K[i]);
  }
  return json;
}

}  // namespace

Json diagnosis_json(const diagnosis::Diagnosis& d) {
  Json json = {{"verdict", diagnosis::word(d.verdict)}, {"reason", d.reason}, {"causes", Json::array()}};
  for (const auto& c : d.causes) json["causes"].push_back(json_of(c));
  json["discriminating_experiment"] = d.experiment ? json_of(*d.experiment) : Json();
  json["unexplained"] = d.unexplained ? json_of(*d.unexplained) : Json();
  Json channels = Json::array();
  for (const auto& g : d.gain) {
    channels.push_back({{"name", g.name},
                        {"unit", g.unit},
                        {"rmse_before", g.rmse_before},
                        {"rmse_calibrated", g.rmse_calibrated},
                        {"rmse_after", g.rmse_after},
                        {"rmse_regression_drive", g.rmse_of_drive},
                        {"rmse_regression_readings", g.rmse_of_readings},
                        {"rmse_written", std::isnan(g.rmse_written) ? Json() : Json(g.rmse_written)},
                        {"peak_before", g.peak_before},
                        {"peak_after", g.peak_after},
                        {"noise_floor", g.noise_floor}});
  }
  json["gain"] = {{"holdout", d.holdout}, {"channels", channels}};
  json["data"] = Json::array();
  for (const auto& f : d.data)
    json["data"].push_back({{"channel", f.channel}, {"what", f.what}, {"left_out", f.leaves_out}});
  json["calibrated"] = Json::array();
  for (const auto& e : d.calibrated) {
    Json entry = json_of(e);
    entry["sigmas_of_prior"] = e.deviation;
    entry["known_to"] = e.known_to;
    entry["known_to_unit"] = e.is_share ? "of its logarithm" : e.unit;
    json["calibrated"].push_back(entry);
  }
  json["waveforms"] = Json::array();
  for (const auto& w : d.waveforms) {
    if (w.shape.shape != diagnosis::Shape::kNothing) json["waveforms"].push_back(json_of(w));
  }
  json["complete"] = d.ended_at.empty();
  json["weighed_by_model_error"] = d.weighed_by_model_error;
  json["process_noise"] = Json();
  if (d.wander) {
    Json bodies = Json::array();
    for (const auto& b : d.wander->bodies)
      bodies.push_back({{"where", b.body.name}, {"standard_deviation_W", b.sd_W}, {"share", b.share}});
    json["process_noise"] = {{"stays_alike_min", d.wander->time_s / 60.0}, {"bodies", bodies}};
  }
  json["n_candidates"] = d.n_candidates;
  // evidence that the best candidate has where nothing is wrong: at one machine in two, in a hundred, in ten thousand
  json["chance"] = {{"median", d.search.chance.gain_at(0.5)},
                    {"one_in_100", d.search.chance.gain_at(0.01)},
                    {"one_in_10000", d.search.chance.gain_at(1e-4)}};
  return json;
}

}  // namespace driftwright::app
