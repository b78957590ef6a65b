#include "studies/placement_tests.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace driftwright::studies {
namespace {

constexpr double kRow_s = 300.0;
constexpr double kEnough = 1.1;  // ratio to the least drift that any test leaves
constexpr int kOnAndOff = 4;     // number of times

std::string words(const Drive& drive) {
  if (drive == Drive{}) return "rest";
  std::vector<std::string> parts;
  if (drive.speed_rpm > 0.0) parts.push_back(fmt::format("{:.0f} rpm", drive.speed_rpm));
  for (std::size_t a = 0; a < 3; ++a) {
    if (drive.feed_m_s[a] > 0.0) parts.push_back(fmt::format("{} {:.4g} m/min", "xyz"[a], 60.0 * drive.feed_m_s[a]));
  }
  if (drive.cutting_power_W > 0.0) parts.push_back(fmt::format("{:.0f} W of cutting", drive.cutting_power_W));
  return fmt::format("{}", fmt::join(parts, " with "));
}

}  // namespace

std::vector<Cyclogram> possible_tests(const std::vector<Drive>& drives) {
  std::vector<Cyclogram> tests;
  if (drives.empty()) return tests;
  const Drive top = drives.back(), middle = drives[drives.size() / 2], rest;
  const bool has_two = !(top == middle);
  for (double hours : {1.0, 2.0, 4.0, 8.0}) {
    const auto add = [&](const std::vector<Drive>& parts, const char* how = "") {
      Cyclogram test;
      for (const Drive& drive : parts) {
        test.sections.push_back({3600.0 * hours / static_cast<double>(parts.size()), drive});
        if (!*how)
          test.name += fmt::format("{}{:.3g} h {}", test.name.empty() ? "" : ", ", hours / static_cast<double>(parts.size()),
                                   words(drive));
      }
      if (*how) test.name = fmt::format("{:.3g} h {} {}", hours, words(parts.front()), how);
      tests.push_back(std::move(test));
    };
    add({top});
    add({top, rest});
    if (has_two) {
      add({middle, rest});
      add({middle, top, rest});
      add({top, middle, rest});
    }
    std::vector<Drive> on_and_off;
    for (int i = 0; i < kOnAndOff; ++i) on_and_off.insert(on_and_off.end(), {top, rest});
    add(on_and_off, "on and off");
  }
  return tests;
}

std::vector<TriedTest> tried_tests(const scenarios::Scenario& scenario, const std::function<const PlacementJudge&()>& judge,
                                   const std::vector<int>& set, const Pieces& pieces, const Listener& listener) {
  const std::vector<Cyclogram> programmes = possible_tests(drives_of(scenario));
  const std::vector<MachineRun> runs =
      runs_in_turn(scenario, programmes, {scenarios::Validation::Season{"as it is", 0.0, 0.0}}, kRow_s);
  const std::vector<Pieces::Numbers> left = pieces.of_shard(
      0, runs.size(), [&] { (void)judge(); },
      [&](std::size_t i) {
        const Residual r = judge().behind_test(set, runs[i]);
        return Pieces::Numbers{r.observer_um, r.regression_um};
      },
      listener);
  std::vector<TriedTest> tests;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!left[i].empty()) tests.push_back({programmes[i].name, programmes[i].duration_s(), {left[i][0], left[i][1]}});
  }
  return tests;
}

int least_test(const std::vector<TriedTest>& tests, double Residual::*of) {
  if (tests.empty()) return -1;
  const auto less = [&](const TriedTest& a, const TriedTest& b) { return a.left.*of < b.left.*of; };
  const double enough_um = kEnough * (std::min_element(tests.begin(), tests.end(), less)->left.*of);
  int least = -1;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (tests[i].left.*of > enough_um) continue;
    const bool is_better = least < 0 || tests[i].duration_s < tests[static_cast<std::size_t>(least)].duration_s ||
                           (tests[i].duration_s == tests[static_cast<std::size_t>(least)].duration_s &&
                            less(tests[i], tests[static_cast<std::size_t>(least)]));
    if (is_better) least = static_cast<int>(i);
  }
  return least;
}

}  // namespace driftwright::studies
