#include "scenarios/reader/validation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenarios/reader/programme.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kDay_s = 86400.0, kSwingKnots_s = 600.0;

Cyclogram named(const ConfigMap& in, const std::string& key, const std::string& name,
                const std::vector<const Cyclogram*>& known) {
  std::vector<std::string> names;
  for (const Cyclogram* c : known) {
    if (c->name == name) return *c;
    names.push_back(c->name);
  }
  in.fail(key, fmt::format("no cyclogram '{}'; there are {}", name, fmt::join(names, ", ")));
}

Validation::Family read_family(const ConfigMap& in, const std::string& name, const std::vector<const Cyclogram*>& known,
                               int seed) {
  Validation::Family family{.name = name, .cyclograms = {}};
  if (!in.is_map(name)) {
    for (const std::string& cyclogram : in.texts(name)) family.cyclograms.push_back(named(in, name, cyclogram, known));
    if (family.cyclograms.empty()) in.fail(name, "no cyclogram in this family");
    return family;
  }
  const ConfigMap map = in.map(name);
  const Programme::Random random = read_random(map);
  const std::vector<double> speeds_rpm = map.quantities("speeds", "rpm");
  if (speeds_rpm.size() < 2 || *std::min_element(speeds_rpm.begin(), speeds_rpm.end()) < 0.0)
    map.fail("speeds", "two speeds at least are wanted, none below 0");
  map.reject_unknown_keys();
  family.cyclograms = random_cyclograms(random, speeds_rpm, seed);
  for (Cyclogram& c : family.cyclograms) c.name = fmt::format("{}_{}", name, c.name);
  return family;
}

}  // namespace

Validation read_validation(const ConfigMap& in, const std::vector<const Cyclogram*>& known, double tolerance_um) {
  Validation v;
  v.where = in.where();
  v.seed = in.integer("seed", 0, 1000000, v.seed);
  for (const std::string& name : in.texts("train")) v.train.push_back(named(in, "train", name, known));
  if (v.train.size() < 2) in.fail("train", "two cyclograms at least: what a fit leaves open is decided on runs left out");
  for (std::size_t i = 0; i < v.train.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (v.train[i].sections == v.train[k].sections)
        in.fail("train", fmt::format("'{}' is the same as '{}'; fitted on twice, it is never left out", v.train[i].name,
                                     v.train[k].name));
    }
  }
  const ConfigMap families = in.map("families");
  for (const std::string& name : families.keys()) {
    v.families.push_back(read_family(families, name, known, v.seed));
    for (const Cyclogram& c : v.families.back().cyclograms) {
      for (const Cyclogram& t : v.train) {
        if (c.sections == t.sections)
          families.fail(name,
                        fmt::format("'{}' is what strategies are fitted on ('{}'); it cannot judge them", c.name, t.name));
      }
    }
  }
  if (v.families.empty()) in.fail("families", "no family of cyclograms to judge on");
  v.seasons.push_back({.name = "as trained"});
  if (const auto seasons = in.optional_map("seasons")) {
    for (const std::string& name : seasons->keys()) {
      if (name == v.seasons.front().name) seasons->fail(name, "this is the scenario's own hall, which is always judged in");
      const ConfigMap season = seasons->map(name);
      v.seasons.push_back({.name = name,
                           .offset_K = season.quantity("offset", "K", -50.0, 50.0, 0.0),
                           .swing_K = season.quantity("swing", "K", 0.0, 30.0, 0.0)});
      season.reject_unknown_keys();
    }
  }
  v.noise_K = in.quantity("sensor_noise", "K", 0.0, 10.0, v.noise_K);
  v.resolution_K = in.quantity("sensor_resolution", "K", 0.0, 10.0, v.resolution_K);
  v.drift_noise_um = in.quantity("displacement_noise", "um", 0.0, 1e3, v.drift_noise_um);
  v.model_scatter = in.quantity("model_scatter", "1", 0.0, 1.0, v.model_scatter);
  v.fails_at = in.quantity("sensor_fails_at", "1", 0.0, 1.0, v.fails_at);
  v.tolerance_um = in.quantity("tolerance", "um", 1e-3, 1e6, tolerance_um);
  in.reject_unknown_keys();
  return v;
}

TimeSeries hall_in(const Validation::Season& season, const TimeSeries& hall, double duration_s) {
  std::vector<double> times_s = {0.0, duration_s};
  for (double t_s : hall.time_s) {
    if (t_s > 0.0 && t_s < duration_s) times_s.push_back(t_s);
  }
  if (season.swing_K > 0.0) {
    for (double t_s = kSwingKnots_s; t_s < duration_s; t_s += kSwingKnots_s) times_s.push_back(t_s);
  }
  std::sort(times_s.begin(), times_s.end());
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  TimeSeries result{.time_s = times_s, .value = {}};
  for (double t_s : times_s)
    result.value.push_back(hall.at(t_s) + season.offset_K +
                           season.swing_K * std::sin(2.0 * std::numbers::pi * t_s / kDay_s));
  return result;
}

}  // namespace driftwright::scenarios
