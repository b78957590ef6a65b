#include "scenarios/reader/programme.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/random.hpp"
#include "scenarios/reader/read_cyclogram.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kStopShare = 0.15;                          // share of stops among a random cyclogram's sections
constexpr std::size_t kFewestSpeeds = 3;                     // needed to fit a curve over speed, in addition to standstill
constexpr double kShortestShare = 0.5, kLongestShare = 1.5;  // relative to a section's mean length

}  // namespace

std::vector<schema::Key> random_keys() {
  using namespace schema;
  return {compulsory("count", integer(1, 1000), "how many"),
          schema::optional("sections", integer(2, 100), Programme::Random{}.sections,
                           "of each, of random length, no speed twice in a row, now and then a stop"),
          compulsory("duration", quantity("s", 60.0, 1e6), "of each")};
}

schema::Map programme_schema() {
  using namespace schema;
  const Programme p;
  const schema::Map tests = {
      .name = "programme, tests",
      .keys = {compulsory("speeds", list(quantity("rpm", 1.0, 1e6), kFewestSpeeds), "one test at each"),
               compulsory("heating", quantity("s", 60.0, 1e7), "time at the speed, from the start on"),
               compulsory("cooling", quantity("s", 60.0, 1e7), "time at standstill after it"),
               schema::optional("temperature_noise", quantity("K", 0.0, 10.0), p.temperature_noise_K,
                                "of the tests' readings, white, 1 sigma"),
               schema::optional("displacement_noise", quantity("um", 0.0, 1e3), p.displacement_noise_um,
                                "the same; tilts: per 100 mm"),
               schema::optional("seed", integer(0, 1000000), p.seed, "of noise and random cyclograms")}};
  return {
      .name = "programme",
      .keys = {compulsory("tests", schema::map(tests), "runs at fixed speeds that predictors learn from"),
               schema::optional("cyclograms", schema::map(cyclograms_schema()), "to predict"),
               schema::optional("random", schema::map({.name = "programme, random", .keys = random_keys()}),
                                "cyclograms to predict, at the tests' speeds"),
               schema::optional("most_modes", integer(1, 8), p.most_modes, "that may be identified from tests"),
               schema::optional("model_scatter", quantity("1", 0.0, 1.0), p.model_scatter,
                                "1 sigma of the logarithm by which a hybrid's model is wrong in each power and coefficient"),
               schema::optional("extrapolate", flag(), "false", "true: cyclograms may run outside the tested speeds"),
               schema::optional("tolerance", quantity("um", 1e-3, 1e6), p.tolerance_um, "of scheduled corrections")},
      .groups = {{Group::Rule::kAtLeastOne,
                  {"cyclograms", "random"},
                  "`cyclograms` or `random` is required, to judge predictors on"}},
      .about = "What predictors of drift are judged on by `validate` (docs/how-to/prediction.md)."};
}

Programme::Random read_random(const ConfigMap& in) {
  Programme::Random random;
  random.count = in.integer("count");
  random.sections = in.integer("sections");
  random.duration_s = in.quantity("duration");
  return random;
}

Programme read_programme(const ConfigMap& in) {
  Programme p;
  p.where = in.where();
  const ConfigMap tests = in.map("tests");
  p.test_rpm = tests.quantities("speeds");
  std::sort(p.test_rpm.begin(), p.test_rpm.end());
  if (std::adjacent_find(p.test_rpm.begin(), p.test_rpm.end()) != p.test_rpm.end())
    tests.fail("speeds", "a speed is listed twice");
  p.heating_s = tests.quantity("heating");
  p.cooling_s = tests.quantity("cooling");
  p.temperature_noise_K = tests.quantity("temperature_noise");
  p.displacement_noise_um = tests.quantity("displacement_noise");
  p.seed = tests.integer("seed");
  tests.reject_unknown_keys();
  if (const auto cyclograms = in.optional_map("cyclograms")) {
    for (const std::string& name : cyclograms->keys()) {
      p.cyclograms.push_back(read_cyclogram(*cyclograms, name));
      for (const auto& s : p.cyclograms.back().sections) {
        if (s.drive != Drive{.speed_rpm = s.drive.speed_rpm})
          cyclograms->fail(name, "it has feeds or cutting power, which tests at fixed speeds say nothing about");
      }
    }
  }
  if (const auto random = in.optional_map("random")) {
    p.random = read_random(*random);
    random->reject_unknown_keys();
  }
  if (p.cyclograms.empty() && p.random.count == 0)
    in.fail("cyclograms", "`cyclograms` or `random` is required, to judge predictors on");
  p.most_modes = in.integer("most_modes");
  p.model_scatter = in.quantity("model_scatter");
  p.extrapolate = in.flag("extrapolate");
  for (const Cyclogram& c : p.cyclograms) {
    for (const auto& s : c.sections) {
      const double rpm = s.drive.speed_rpm;
      if (p.extrapolate || rpm == 0.0 || (rpm >= p.test_rpm.front() - 1e-9 && rpm <= p.test_rpm.back() + 1e-9)) continue;
      in.map("cyclograms")
          .fail(c.name, fmt::format("it runs at {:g} rpm, but the tests at {:g} to {:g} rpm; add a test there, or write "
                                    "`extrapolate: true` in the programme",
                                    rpm, p.test_rpm.front(), p.test_rpm.back()));
    }
  }
  p.tolerance_um = in.quantity("tolerance");
  in.reject_unknown_keys();
  return p;
}

std::vector<Cyclogram> random_cyclograms(const Programme::Random& wanted, const std::vector<double>& speeds_rpm, int seed) {
  std::vector<Cyclogram> list;
  Random random(static_cast<std::uint64_t>(seed), 1);
  for (int i = 0; i < wanted.count; ++i) {
    Cyclogram c{fmt::format("random_{:02d}", i + 1), {}};
    double total = 0.0, before_rpm = -1.0;
    for (int s = 0; s < wanted.sections; ++s) {
      double rpm = before_rpm;
      while (rpm == before_rpm) rpm = random.chance(kStopShare) ? 0.0 : random.one_of(speeds_rpm);
      before_rpm = rpm;
      c.sections.push_back({random.uniform(kShortestShare, kLongestShare), {.speed_rpm = rpm}});
      total += c.sections.back().duration_s;
    }
    for (auto& s : c.sections) s.duration_s *= wanted.duration_s / total;
    list.push_back(std::move(c));
  }
  return list;
}

std::vector<Cyclogram> random_cyclograms(const Programme& programme) {
  return random_cyclograms(programme.random, programme.test_rpm, programme.seed);
}

std::vector<Cyclogram> test_cyclograms(const Programme& programme) {
  std::vector<Cyclogram> list;
  for (double rpm : programme.test_rpm)
    list.push_back({fmt::format("test_{:g}", rpm), {{programme.heating_s, {.speed_rpm = rpm}}, {programme.cooling_s, {}}}});
  return list;
}

}  // namespace driftwright::scenarios
