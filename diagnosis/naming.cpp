#include "diagnosis/naming.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "base/lists.hpp"
#include "diagnosis/happening.hpp"
#include "diagnosis/visit.hpp"
#include "effects/lasting.hpp"

namespace driftwright::diagnosis {
namespace {

using Words = std::set<std::string>;

constexpr double kAlways = 0.9;  // share of its records' time: a longer window is no window, and its pauses were not chosen

/// The quantities that a key of the catalogue can mean.
const std::map<std::string, std::vector<StatedQuantity>>& quantities() {
  using enum StatedQuantity;
  static const std::map<std::string, std::vector<StatedQuantity>> map = {{"heat_source", {kHeat}},
                                                                         {"friction_law", {kHeat}},
                                                                         {"heat_window", {kHeat, kSpeed}},
                                                                         {"recorded_drive", {kHeat, kExchange}},
                                                                         {"coolant", {kHeat, kExchange}},
                                                                         {"radiation", {kHeat, kExchange}},
                                                                         {"convection", {kExchange}},
                                                                         {"natural_convection", {kExchange}},
                                                                         {"forced_convection", {kExchange}},
                                                                         {"contact", {kExchange}},
                                                                         {"conductivity", {kExchange}},
                                                                         {"link", {kExchange}},
                                                                         {"exchange_window", {kExchange}},
                                                                         {"heat_capacity", {kCapacity}},
                                                                         {"hidden_body", {kCapacity, kExchange, kHeat}},
                                                                         {"sensor_bias", {kReading}},
                                                                         {"sensor_lag", {kReading}},
                                                                         {"sensor_drift", {kReading}},
                                                                         {"sensor_detached", {kReading}},
                                                                         {"sensor_swap", {kReading}},
                                                                         {"sensor_place", {kReading}},
                                                                         {"mount_shift", {kDisplacement}},
                                                                         {"expansion", {kDisplacement}},
                                                                         {"spindle_growth", {kDisplacement}},
                                                                         {"centrifugal", {kDisplacement}},
                                                                         {"displacement_path", {kDisplacement}},
                                                                         {"scale_expansion", {kDisplacement}},
                                                                         {"probe_lag", {kDisplacement}},
                                                                         {"linear_scale", {kDisplacement}},
                                                                         {"feed_axis", {kHeat}},
                                                                         {"ambient", {kAmbient}},
                                                                         {"stratification", {kAmbient}},
                                                                         {"speed_override", {kSpeed, kHeat}},
                                                                         {"missing_stop", {kSpeed}},
                                                                         {"clock_offset", {kClock}},
                                                                         {"run_state", {kHeat, kExchange, kSpeed}}};
  return map;
}

Words words_of(const std::string& where) {
  Words words;
  std::istringstream list(where);
  for (std::string name; std::getline(list, name, ',');) {
    if (name != effects::kAmbientName) words.insert(name);
  }
  return words;
}

bool has_common(const Words& a, const Words& b) {
  return std::any_of(a.begin(), a.end(), [&](const std::string& w) { return b.contains(w); });
}

/// The body with this name; none if it is a surface or an instrument.
std::optional<effects::Body> body_called(const effects::DoubtScene& scene, const std::string& name) {
  if (name == effects::kAmbientName) return effects::ambient_node();
  const auto body =
      std::find_if(scene.bodies.begin(), scene.bodies.end(), [&](const effects::Body& b) { return b.name == name; });
  if (body == scene.bodies.end()) return std::nullopt;
  return *body;
}

/// The windows of a statement as heat, an exchange or another speed of the catalogue.
std::optional<Happening> happening_of(const Stated::Windows& stated, const effects::DoubtScene& scene,
                                      const std::vector<MeasuredRun>& runs) {
  const Statement& s = stated.says;
  if (s.windows.empty()) return std::nullopt;
  Happening h;
  h.is_speed = s.quantity == StatedQuantity::kSpeed;
  if (s.quantity != StatedQuantity::kHeat && s.quantity != StatedQuantity::kExchange && !h.is_speed) return std::nullopt;
  if (!h.is_speed) {
    const auto body = s.at.empty() ? body_called(scene, s.place.front()) : effects::surface(s.at);
    if (!body) return std::nullopt;
    h.body = *body;
    if (s.quantity == StatedQuantity::kExchange) {
      const auto other = s.place.size() > 1 ? body_called(scene, s.place[1]) : effects::ambient_node();
      if (!other) return std::nullopt;
      h.other = *other;
    }
  }
  h.size = stated.size;
  double rows = 0.0;
  for (const StatedWindow& w : s.windows) {
    const MeasuredRun& run = runs[w.run];
    if (h.in.empty() || h.in.back().first != &run) h.in.push_back({&run, {}});
    h.in.back().second.emplace_back(w.begin_s, w.end_s);
    h.wide_s.emplace_back(w.wide_s, w.wide_s);
    rows += static_cast<double>(run.time_s.size());
  }
  const auto n = static_cast<double>(s.windows.size());
  h.price_nats = 2.0 * n * std::log(rows / n) - std::lgamma(n + 1.0);  // the order does not matter
  return h;
}

/// Limits laws that hold in all records to those of a statement. The inclusion of each record is one choice of two.
void add_of_records(const Statement& s, Candidate& candidate) {
  std::vector<std::string> names;
  for (std::size_t r = 0; r < s.in_run.size(); ++r) {
    if (s.in_run[r]) names.push_back(s.record[r]);
  }
  if (names.empty() || names.size() == s.in_run.size()) return;
  const Words in(names.begin(), names.end());
  const std::size_t n_laws = candidate.variants.size();
  for (std::size_t v = 0; v < n_laws; ++v) {
    const Variant& law = candidate.variants[v];
    if (!law.of_some_runs || !law.in.empty()) continue;
    const bool is_known = std::any_of(candidate.variants.begin(), candidate.variants.end(), [&](const Variant& other) {
      return other.of_some_runs && other.of_some_runs->law == law.of_some_runs->law &&
             effects::runs_of(*other.of_some_runs) == in;
    });
    if (is_known) continue;
    Variant chosen = law_of(effects::of_runs(*law.of_some_runs, names));
    chosen.price_nats += std::numbers::ln2 * static_cast<double>(s.in_run.size());
    chosen.of_chosen_records = true;
    chosen.seen = true;
    candidate.variants.push_back(std::move(chosen));
  }
}

/// Laws that begin in a record, or hold for a while, are also tried at the times of a statement's windows.
void try_at(const std::vector<StatedWindow>& windows, const std::vector<MeasuredRun>& runs, Candidate& candidate) {
  for (Variant& law : candidate.variants) {
    for (const StatedWindow& w : windows) {
      if (law.in != runs[w.run].name) continue;
      std::vector<double> shape = law.grid.empty() ? std::vector<double>() : law.grid.front();
      shape.resize(law.knobs.size() - 1, 0.0);
      bool begins = false;
      for (std::size_t k = 1; k < law.knobs.size(); ++k) {
        if (!law.knobs[k].is_time) continue;
        shape[k - 1] = law.knobs[k].x(begins ? w.end_s - w.begin_s : w.begin_s);
        begins = true;
      }
      if (begins) law.grid.push_back(std::move(shape));
    }
  }
}

/// The effect of a delay is not linear: such a law is tried at the delay at which the statement's column was computed.
void try_size(const Stated& stated, Candidate& candidate) {
  if (stated.says.unit != "s") return;
  const double delay_min = std::copysign(stated.says.unit_size, stated.size) / 60.0;
  for (Variant& law : candidate.variants) {
    const Knob& size = law.knobs.front();
    if (size.unit == "min" && delay_min > size.low && delay_min < size.high) law.trial_x = size.x(delay_min);
  }
}

}  // namespace

bool says(const Statement& s, const std::string& effect, const std::string& where) {
  const auto of = quantities().find(effect);
  const Words claimed = words_of(where);
  Words stated(s.place.begin(), s.place.end());
  stated.erase(effects::kAmbientName);
  if (!s.at.empty()) stated.insert(s.at);
  if (of == quantities().end()) return has_common(claimed, stated);
  if (!is_in(of->second, s.quantity)) return false;
  const bool is_of_speed = is_in(of->second, StatedQuantity::kSpeed);
  if (s.place.front() == "all") return effect == "run_state" || is_of_speed;
  switch (s.quantity) {
    case StatedQuantity::kAmbient:
    case StatedQuantity::kClock:
    case StatedQuantity::kSpeed:
      return true;
    case StatedQuantity::kHeat:
      if (effect == "hidden_body" && (s.windows.empty() || claimed.size() > 1))
        return false;  // the heat uptake by a visiting body is a window that fades
      return effect != "run_state" && !(is_of_speed && effect != "heat_window") && has_common(claimed, stated);
    case StatedQuantity::kExchange:
      if (effect == "run_state") return false;
      return std::includes(stated.begin(), stated.end(), claimed.begin(), claimed.end()) ||
             (effect == "hidden_body" && std::includes(claimed.begin(), claimed.end(), stated.begin(), stated.end()));
    default:
      return s.follows == "exchanged" ? std::includes(stated.begin(), stated.end(), claimed.begin(), claimed.end())
                                      : has_common(claimed, stated);
  }
}

std::optional<StatedQuantity> quantity_of(const std::string& effect) {
  const auto of = quantities().find(effect);
  if (of == quantities().end()) return std::nullopt;
  return of->second.front();
}

const Stated* stated_as(const Posterior& posterior, const std::string& effect, const std::string& where) {
  for (const Stated& s : posterior.stated) {
    if (says(s.says, effect, where) || (s.windows && says(s.windows->says, effect, where))) return &s;
  }
  return nullptr;
}

std::vector<Candidate> named_by(const Posterior& posterior, std::vector<Candidate> catalogue, const Twin& twin,
                                const std::vector<MeasuredRun>& runs, const std::set<std::string>& without) {
  std::erase_if(catalogue, [&](const Candidate& c) { return !stated_as(posterior, c.effect, c.where); });
  const effects::DoubtScene scene = scene_of(twin, runs);
  std::vector<Event> events;
  for (const Stated& stated : posterior.stated) {
    for (Candidate& c : catalogue) {
      if (!says(stated.says, c.effect, c.where)) continue;
      add_of_records(stated.says, c);
      try_size(stated, c);
      if (!stated.windows) continue;
      add_of_records(stated.windows->says, c);
      try_at(stated.windows->says.windows, runs, c);
    }
    if (!stated.windows) continue;
    const std::optional<Happening> h = happening_of(*stated.windows, scene, runs);
    if (!h || is_unseen(*h) || share_of_time(*h) > kAlways) continue;
    if (auto event = event_of(twin, scene, *h)) events.push_back(*std::move(event));
    for (Event& visit : visits_of(scene, *h)) events.push_back(std::move(visit));
  }
  add_events(catalogue, events, without);
  return catalogue;
}

}  // namespace driftwright::diagnosis
