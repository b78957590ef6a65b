#include "studies/placement_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/random.hpp"
#include "studies/prediction.hpp"

namespace driftwright::studies {
namespace {

using scenarios::Validation;

constexpr std::size_t kLeastToChooseOn = 3, kMadeToJudgeBy = 4, kMostToJudgeBy = 8;
constexpr double kMade_s = 5 * 3600.0, kShortest_s = 600.0, kLongest_s = 3600.0;
constexpr std::uint64_t kSeedOfRuns = 7;

Cyclogram known(const scenarios::Scenario& scenario, const std::string& name) {
  if (scenario.validation) {
    for (const Cyclogram& c : scenario.validation->train) {
      if (c.name == name) return c;
    }
    for (const Validation::Family& family : scenario.validation->families) {
      for (const Cyclogram& c : family.cyclograms) {
        if (c.name == name) return c;
      }
    }
  }
  return named_cyclogram(scenario, name);
}

bool holds(const std::vector<Cyclogram>& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const Cyclogram& c) { return c.name == name; });
}

/// Drives in random order, with no repetition.
Cyclogram made(const std::vector<Drive>& drives, const std::string& name, std::uint64_t purpose) {
  std::vector<Drive> choices = drives;
  choices.emplace_back();  // rest
  Random random(kSeedOfRuns, purpose);
  Cyclogram c{.name = name, .sections = {}};
  double left_s = kMade_s;
  while (left_s > 0.0) {
    const double duration_s = std::min(left_s, 60.0 * std::round(random.uniform(kShortest_s, kLongest_s) / 60.0));
    const Drive& drive = random.one_of(choices);
    if (!c.sections.empty() && c.sections.back().drive == drive) continue;
    c.sections.push_back({duration_s, drive});
    left_s -= duration_s;
  }
  return c;
}

MachineRun run_of(const scenarios::Scenario& scenario, const Cyclogram& cyclogram, const Validation::Season& season,
                  double step_s) {
  scenarios::MachineModel machine = *scenario.machine;
  machine.ambient = scenarios::ambient_in(season, machine.ambient, cyclogram.duration_s());
  MachineRun run = scenarios::felt_run(machine, cyclogram);
  run.readings.source = cyclogram.name + ", " + season.name;
  for (double t_s = 0.0; t_s < cyclogram.duration_s() + 1e-6; t_s += step_s)
    run.readings.time_s.push_back(std::min(t_s, cyclogram.duration_s()));
  return run;
}

}  // namespace

std::vector<Drive> drives_of(const scenarios::Scenario& scenario) {
  std::vector<Drive> drives;
  for (const Cyclogram& c : scenario.cyclograms) {
    for (const auto& section : c.sections) {
      if (!section.drive.signals.empty() || section.drive == Drive{}) continue;
      if (std::find(drives.begin(), drives.end(), section.drive) == drives.end()) drives.push_back(section.drive);
    }
  }
  const auto strength = [](const Drive& d) {
    return std::make_tuple(d.speed_rpm, d.feed_m_s[0] + d.feed_m_s[1] + d.feed_m_s[2], d.cutting_power_W);
  };
  std::stable_sort(drives.begin(), drives.end(), [&](const Drive& a, const Drive& b) { return strength(a) < strength(b); });
  return drives;
}

PlacementFamilies placement_families(const scenarios::Scenario& scenario, const std::vector<std::string>& train,
                                     const std::vector<std::string>& test) {
  PlacementFamilies families;
  const std::vector<Drive> drives = drives_of(scenario);
  for (const std::string& name : train) families.chosen_on.push_back(known(scenario, name));
  for (const std::string& name : test) families.judged_on.push_back(known(scenario, name));
  if (train.empty()) families.chosen_on = scenario.validation ? scenario.validation->train : scenario.cyclograms;
  std::erase_if(families.chosen_on, [&](const Cyclogram& c) { return train.empty() && holds(families.judged_on, c.name); });
  for (const Cyclogram& c : families.judged_on) {
    if (holds(families.chosen_on, c.name))
      throw InputError(fmt::format(
          "'{}' is to be chosen on (--train) and judged by (--test); what was chosen on it has seen it", c.name));
  }
  if (test.empty() && scenario.validation) {
    for (const Validation::Family& family : scenario.validation->families) {
      for (const Cyclogram* c : {&family.cyclograms.front(), &family.cyclograms.back()}) {
        if (families.judged_on.size() < kMostToJudgeBy && !holds(families.chosen_on, c->name) &&
            !holds(families.judged_on, c->name))
          families.judged_on.push_back(*c);
      }
    }
  }
  const auto make = [&](std::vector<Cyclogram>& list, std::size_t n, const char* name, std::uint64_t purpose) {
    for (int i = 1; list.size() < n; ++i) {
      if (drives.empty())
        throw InputError("no cyclogram of the scenario drives the machine; there is nothing that would warm it");
      list.push_back(made(drives, fmt::format("{}_{}", name, i), purpose + static_cast<std::uint64_t>(i)));
      families.made.push_back(list.back().name);
    }
  };
  make(families.chosen_on, kLeastToChooseOn, "made", 100);
  if (families.judged_on.empty()) make(families.judged_on, kMadeToJudgeBy, "unseen", 200);
  families.ambients = scenario.validation
                          ? scenario.validation->seasons
                          : std::vector<Validation::Season>{
                                {"as it is", 0.0, 0.0}, {"a day of ±3 K", 0.0, 3.0}, {"5 K colder, ±2 K", -5.0, 2.0}};
  return families;
}

std::vector<MachineRun> runs_in_all_ambients(const scenarios::Scenario& scenario, const std::vector<Cyclogram>& cyclograms,
                                             const std::vector<Validation::Season>& ambients, int rows) {
  std::vector<MachineRun> runs;
  for (const Cyclogram& cyclogram : cyclograms) {
    const double step_s = std::max(60.0, 60.0 * std::floor(cyclogram.duration_s() / rows / 60.0));
    for (const Validation::Season& ambient : ambients) runs.push_back(run_of(scenario, cyclogram, ambient, step_s));
  }
  return runs;
}

std::vector<MachineRun> runs_in_turn(const scenarios::Scenario& scenario, const std::vector<Cyclogram>& cyclograms,
                                     const std::vector<Validation::Season>& ambients, double row_s) {
  std::vector<MachineRun> runs;
  for (std::size_t c = 0; c < cyclograms.size(); ++c)
    runs.push_back(run_of(scenario, cyclograms[c], ambients[c % ambients.size()], row_s));
  return runs;
}

}  // namespace driftwright::studies
