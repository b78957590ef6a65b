#include "scenarios/reader/programme.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/random.hpp"
#include "scenarios/reader/read_cyclogram.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kStopShare = 0.15;                          // of a random cyclogram's sections
constexpr std::size_t kFewestSpeeds = 3;                     // levels that curve with speed want them, standstill beside
constexpr double kShortestShare = 0.5, kLongestShare = 1.5;  // of a section's mean length

}  // namespace

Programme::Random read_random(const ConfigMap& in) {
  Programme::Random random;
  random.count = in.integer("count", 1, 1000);
  random.sections = in.integer("sections", 2, 100, random.sections);
  random.duration_s = in.quantity("duration", "s", 60.0, 1e6);
  return random;
}

Programme read_programme(const ConfigMap& in) {
  Programme p;
  p.where = in.where();
  const ConfigMap tests = in.map("tests");
  p.test_rpm = tests.quantities("speeds", "rpm");
  std::sort(p.test_rpm.begin(), p.test_rpm.end());
  if (!(p.test_rpm.front() >= 1.0 && p.test_rpm.back() <= 1e6))
    tests.fail("speeds", "speeds between 1 and 1e6 rpm are wanted");
  if (std::adjacent_find(p.test_rpm.begin(), p.test_rpm.end()) != p.test_rpm.end())
    tests.fail("speeds", "a speed stands there twice");
  if (p.test_rpm.size() < kFewestSpeeds)
    tests.fail("speeds", fmt::format("{} speeds at least are wanted; there are {}", kFewestSpeeds, p.test_rpm.size()));
  p.heating_s = tests.quantity("heating", "s", 60.0, 1e7);
  p.cooling_s = tests.quantity("cooling", "s", 60.0, 1e7);
  p.temperature_noise_K = tests.quantity("temperature_noise", "K", 0.0, 10.0, 0.0);
  p.displacement_noise_um = tests.quantity("displacement_noise", "um", 0.0, 1e3, 0.0);
  p.seed = tests.integer("seed", 0, 1000000, 1);
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
    in.fail("cyclograms", "neither `cyclograms` nor `random` to judge predictors on");
  p.most_modes = in.integer("most_modes", 1, 8, p.most_modes);
  p.model_scatter = in.quantity("model_scatter", "1", 0.0, 1.0, 0.0);
  p.extrapolate = in.choice("extrapolate", {"true", "false"}, "false") == "true";
  for (const Cyclogram& c : p.cyclograms) {
    for (const auto& s : c.sections) {
      const double rpm = s.drive.speed_rpm;
      if (p.extrapolate || rpm == 0.0 || (rpm >= p.test_rpm.front() - 1e-9 && rpm <= p.test_rpm.back() + 1e-9)) continue;
      in.map("cyclograms")
          .fail(
              c.name,
              fmt::format("it runs at {:g} rpm, but the tests at {:g} to {:g} rpm; a test there, or `extrapolate: true` in "
                          "the programme, is wanted",
                          rpm, p.test_rpm.front(), p.test_rpm.back()));
    }
  }
  p.tolerance_um = in.quantity("tolerance", "um", 1e-3, 1e6, p.tolerance_um);
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
