#include "scenarios/reader/validation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

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
  in.fail(key, fmt::format("there is no cyclogram '{}'; there are {}", name, fmt::join(names, ", ")));
}

Validation::Family read_family(const ConfigMap& in, const std::string& name, const std::vector<const Cyclogram*>& known,
                               int seed) {
  Validation::Family family{.name = name, .cyclograms = {}};
  if (!in.is_map(name)) {
    for (const std::string& cyclogram : in.texts(name)) family.cyclograms.push_back(named(in, name, cyclogram, known));
    return family;
  }
  const ConfigMap map = in.map(name);
  const Programme::Random random = read_random(map);
  const std::vector<double> speeds_rpm = map.quantities("speeds");
  map.reject_unknown_keys();
  family.cyclograms = random_cyclograms(random, speeds_rpm, seed);
  for (Cyclogram& c : family.cyclograms) c.name = fmt::format("{}_{}", name, c.name);
  return family;
}

}  // namespace

schema::Map validation_schema() {
  using namespace schema;
  const Validation v;
  schema::Map random = {
      .name = "validation, families", .keys = random_keys(), .about = "Random cyclograms, made by the seed."};
  random.keys.push_back(compulsory("speeds", list(quantity("rpm", 0.0), 2), "that they run at"));
  const schema::Map families = {.name = "validation, families by name",
                                .others = {schema::optional("family", Ways{list(text(), 1), schema::map(random)},
                                                            "names of cyclograms, or how random ones are made")}};
  const schema::Map season = {
      .name = "validation, seasons",
      .keys = {schema::optional("offset", quantity("K", -50.0, 50.0), 0.0, "of the ambient against the scenario's"),
               schema::optional("swing", quantity("K", 0.0, 30.0), 0.0,
                                "amplitude of a sine of 24 h that begins with each cyclogram")},
      .about = "A season of the ambient, by its name."};
  const schema::Map seasons = {.name = "validation, seasons by name",
                               .others = {schema::optional("season", schema::map(season), "how the ambient is then")}};
  return {
      .name = "validation",
      .keys =
          {compulsory("train", list(text(), 2),
                      "names of cyclograms that strategies are fitted on, two at least: what a fit leaves open is decided "
                      "on runs left out"),
           compulsory("families", schema::map(families), "cyclograms to judge on, by kind"),
           schema::optional("seasons", schema::map(seasons), Said{"the scenario's ambient alone"},
                            "the ambient to judge in, beside the scenario's own"),
           schema::optional("sensor_noise", quantity("K", 0.0, 10.0), v.noise_K, "of thermometers, white, 1 sigma"),
           schema::optional("sensor_resolution", quantity("K", 0.0, 10.0), v.resolution_K, "step of their readings"),
           schema::optional("displacement_noise", quantity("um", 0.0, 1e3), v.drift_noise_um,
                            "of the indicator in the training runs"),
           schema::optional(
               "model_scatter", quantity("1", 0.0, 1.0), v.model_scatter,
               "1 sigma of the logarithm by which the model that strategies are given is wrong in each power and exchange"),
           schema::optional("sensor_fails_at", quantity("1", 0.0, 1.0), v.fails_at,
                            "share of a cyclogram after which a sensor fails"),
           schema::optional("tolerance", quantity("um", 1e-3, 1e6), Said{"that of `study`"},
                            "that the drift is to be kept in"),
           schema::optional("seed", integer(0, 1000000), v.seed, "of noise, scatter and random cyclograms")},
      .about = "What strategies of correction are judged on by `validate` (docs/how-to/validation.md)."};
}

Validation read_validation(const ConfigMap& in, const std::vector<const Cyclogram*>& known, double tolerance_um) {
  Validation v;
  v.where = in.where();
  v.seed = in.integer("seed");
  for (const std::string& name : in.texts("train")) v.train.push_back(named(in, "train", name, known));
  for (std::size_t i = 0; i < v.train.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (drive_alike(v.train[i], v.train[k]))
        in.fail("train", fmt::format("'{}' is the same as '{}'; fitted on twice, it is never left out", v.train[i].name,
                                     v.train[k].name));
    }
  }
  const ConfigMap families = in.map("families");
  for (const std::string& name : families.keys()) {
    v.families.push_back(read_family(families, name, known, v.seed));
    for (const Cyclogram& c : v.families.back().cyclograms) {
      for (const Cyclogram& t : v.train) {
        if (drive_alike(c, t))
          families.fail(name,
                        fmt::format("'{}' is what strategies are fitted on ('{}'); it cannot judge them", c.name, t.name));
      }
    }
  }
  if (v.families.empty()) in.fail("families", "there is no family of cyclograms to judge on");
  v.seasons.push_back({.name = "as trained"});
  if (const auto seasons = in.optional_map("seasons")) {
    for (const std::string& name : seasons->keys()) {
      if (name == v.seasons.front().name)
        seasons->fail(name, "this is the scenario's own ambient, which is always judged in");
      const ConfigMap season = seasons->map(name);
      v.seasons.push_back({.name = name, .offset_K = season.quantity("offset"), .swing_K = season.quantity("swing")});
      season.reject_unknown_keys();
    }
  }
  v.noise_K = in.quantity("sensor_noise");
  v.resolution_K = in.quantity("sensor_resolution");
  v.drift_noise_um = in.quantity("displacement_noise");
  v.model_scatter = in.quantity("model_scatter");
  v.fails_at = in.quantity("sensor_fails_at");
  v.tolerance_um = in.quantity("tolerance", tolerance_um);
  in.reject_unknown_keys();
  return v;
}

Validation default_validation(const std::vector<Cyclogram>& cyclograms, double tolerance_um) {
  std::vector<Cyclogram> different;
  std::set<double> speeds_rpm;
  double longest_s = 0.0;
  for (const Cyclogram& c : cyclograms) {
    const auto is_same = [&](const Cyclogram& d) { return drive_alike(d, c); };
    const auto turns = [](const Cyclogram::Section& s) { return s.drive.speed_rpm > 0.0; };
    if (std::any_of(different.begin(), different.end(), is_same)) continue;
    if (std::none_of(c.sections.begin(), c.sections.end(), turns)) continue;
    different.push_back(c);
    longest_s = std::max(longest_s, c.duration_s());
    for (const Cyclogram::Section& s : c.sections) {
      if (s.drive.speed_rpm > 0.0) speeds_rpm.insert(s.drive.speed_rpm);
    }
  }
  if (different.size() < 2)
    throw InputError(
        "`validate` requires at least two different `cyclograms` that turn the spindle, because it fits on some and judges "
        "on "
        "the others. Add a cyclogram, or write `validation: {train: [...], families: {...}}` (docs/how-to/validation.md)");
  Validation v;
  v.seasons = {{.name = "as trained"}, {.name = "5 K cooler", .offset_K = -5.0}, {.name = "5 K warmer", .offset_K = 5.0}};
  v.noise_K = 0.1;
  v.resolution_K = 0.1;
  v.drift_noise_um = 1.0;
  v.tolerance_um = tolerance_um;
  if (different.size() > 2) {
    v.families.push_back({.name = different.back().name, .cyclograms = {different.back()}});
    different.pop_back();
  }
  v.train = std::move(different);
  v.families.push_back({.name = "random",
                        .cyclograms = random_cyclograms({.count = 2, .duration_s = longest_s},
                                                        {speeds_rpm.begin(), speeds_rpm.end()}, v.seed)});
  return v;
}

bool drive_alike(const Cyclogram& a, const Cyclogram& b) {
  const auto is_same = [](const Cyclogram::Column& x, const Cyclogram::Column& y) {
    return x.name == y.name && x.unit == y.unit && x.rows.time_s == y.rows.time_s && x.rows.value == y.rows.value;
  };
  return a.sections == b.sections &&
         std::equal(a.columns.begin(), a.columns.end(), b.columns.begin(), b.columns.end(), is_same);
}

TimeSeries ambient_in(const Validation::Season& season, const TimeSeries& ambient, double duration_s) {
  std::vector<double> times_s = {0.0, duration_s};
  for (double t_s : ambient.time_s) {
    if (t_s > 0.0 && t_s < duration_s) times_s.push_back(t_s);
  }
  if (season.swing_K > 0.0) {
    for (double t_s = kSwingKnots_s; t_s < duration_s; t_s += kSwingKnots_s) times_s.push_back(t_s);
  }
  std::sort(times_s.begin(), times_s.end());
  times_s.erase(std::unique(times_s.begin(), times_s.end()), times_s.end());
  TimeSeries result{.time_s = times_s, .value = {}};
  for (double t_s : times_s)
    result.value.push_back(ambient.at(t_s) + season.offset_K +
                           season.swing_K * std::sin(2.0 * std::numbers::pi * t_s / kDay_s));
  return result;
}

}  // namespace driftwright::scenarios
