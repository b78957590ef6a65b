#include "studies/test_programme.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace driftwright::studies {
namespace {

constexpr int kMostSections = 10;

/// A number from 0 to n - 1; the standard library defines its engines exactly, but not its distributions.
int pick(std::mt19937_64& random, std::size_t n) {
  return static_cast<int>(random() % n);
}

/// The first slot of each section, then the end.
std::vector<int> edges_of(const TestProgramme& programme) {
  std::vector<int> edges = {0};
  for (std::size_t i = 1; i < programme.size(); ++i) {
    if (programme[i] != programme[i - 1]) edges.push_back(static_cast<int>(i));
  }
  edges.push_back(static_cast<int>(programme.size()));
  return edges;
}

void fill(TestProgramme& programme, int first, int end, int level) {
  std::fill(programme.begin() + first, programme.begin() + end, level);
}

}  // namespace

TestLevels test_levels(const scenarios::Scenario& scenario, double most_speed_rpm) {
  Drive top;
  for (const Cyclogram& c : scenario.cyclograms) {
    for (const auto& section : c.sections) {
      top.speed_rpm = std::max(top.speed_rpm, section.drive.speed_rpm);
      top.cutting_power_W = std::max(top.cutting_power_W, section.drive.cutting_power_W);
      for (std::size_t a = 0; a < top.feed_m_s.size(); ++a)
        top.feed_m_s[a] = std::max(top.feed_m_s[a], section.drive.feed_m_s[a]);
    }
  }
  if (most_speed_rpm > 0.0) top.speed_rpm = most_speed_rpm;
  const bool feeds = std::any_of(top.feed_m_s.begin(), top.feed_m_s.end(), [](double f) { return f > 0.0; });
  if (top.speed_rpm == 0.0 && top.cutting_power_W == 0.0 && !feeds)
    throw InputError(
        "no cyclogram of the scenario drives anything; `plan-test` plans with speeds, feeds and powers that some cyclogram "
        "has");
  TestLevels levels;
  levels.drives.emplace_back();
  const auto add = [&](const Drive& d) {
    if (std::find(levels.drives.begin(), levels.drives.end(), d) == levels.drives.end()) levels.drives.push_back(d);
  };
  const auto spindle = [&](double share) { return Drive{.speed_rpm = std::round(share * top.speed_rpm)}; };
  for (int quarter = 1; quarter <= 4; ++quarter) {
    Drive d = spindle(0.25 * quarter);
    d.cutting_power_W = 0.25 * quarter * top.cutting_power_W;
    for (std::size_t a = 0; a < d.feed_m_s.size(); ++a) d.feed_m_s[a] = 0.25 * quarter * top.feed_m_s[a];
    levels.steps.push_back(static_cast<int>(levels.drives.size()));
    levels.drives.push_back(d);
  }
  levels.full = levels.steps.back();
  add(spindle(0.5));
  add(spindle(1.0));
  Drive cutting = spindle(1.0);
  cutting.cutting_power_W = top.cutting_power_W;
  add(cutting);
  for (std::size_t a = 0; a < top.feed_m_s.size(); ++a) {
    Drive axis;
    axis.feed_m_s[a] = top.feed_m_s[a];
    add(axis);
  }
  return levels;
}

Cyclogram cyclogram_of(const TestProgramme& programme, const TestLevels& levels, double duration_s,
                       const std::string& name) {
  Cyclogram c{.name = name, .sections = {}};
  const std::vector<int> edges = edges_of(programme);
  const double slot_s = duration_s / static_cast<double>(programme.size());
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const int level = programme[static_cast<std::size_t>(edges[i])];
    c.sections.push_back({slot_s * (edges[i + 1] - edges[i]), levels.drives[static_cast<std::size_t>(level)]});
  }
  return c;
}

TestProgramme usual_test(const TestLevels& levels) {
  TestProgramme programme(kTestSlots, 0);
  fill(programme, 0, kTestSlots / 2, levels.full);
  return programme;
}

TestProgramme stepped_test(const TestLevels& levels) {
  TestProgramme programme(kTestSlots, 0);
  const auto n = static_cast<int>(levels.steps.size());
  for (int i = 0; i < n; ++i)
    fill(programme, i * kTestSlots / (n + 1), (i + 1) * kTestSlots / (n + 1), levels.steps[static_cast<std::size_t>(i)]);
  return programme;
}

TestProgramme random_test(const TestLevels& levels, std::mt19937_64& random) {
  TestProgramme programme(kTestSlots, 0);
  std::vector<int> edges = {0, kTestSlots};
  for (int i = pick(random, kMostSections); i > 0; --i) edges.push_back(1 + pick(random, kTestSlots - 1));
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    fill(programme, edges[i], edges[i + 1], pick(random, levels.drives.size()));
  return programme;
}

TestProgramme changed_test(TestProgramme programme, const TestLevels& levels, std::mt19937_64& random) {
  const std::vector<int> edges = edges_of(programme);
  const std::size_t n = edges.size() - 1;
  const auto section = static_cast<std::size_t>(pick(random, n));
  const int first = edges[section], end = edges[section + 1];
  switch (pick(random, 5)) {
    case 0:
      fill(programme, first, end, pick(random, levels.drives.size()));
      break;
    case 1:  // moves the border of two sections
      if (section > 0) {
        const int low = edges[section - 1] + 1, to = low + pick(random, static_cast<std::size_t>(end - low));
        const int before = programme[static_cast<std::size_t>(first - 1)],
                  after = programme[static_cast<std::size_t>(first)];
        fill(programme, edges[section - 1], to, before);
        fill(programme, to, end, after);
      }
      break;
    case 2:
      if (section + 1 < n)
        std::rotate(programme.begin() + first, programme.begin() + end, programme.begin() + edges[section + 2]);
      break;
    case 3:
      if (static_cast<int>(n) < kMostSections) {
        const int from = pick(random, kTestSlots), to = std::min(kTestSlots, from + 1 + pick(random, 8));
        fill(programme, from, to, pick(random, levels.drives.size()));
      }
      break;
    default:
      if (section > 0) fill(programme, first, end, programme[static_cast<std::size_t>(first - 1)]);
  }
  return programme;
}

std::vector<TestProgramme> with_one_section_less(const TestProgramme& programme) {
  std::vector<TestProgramme> list;
  const std::vector<int> edges = edges_of(programme);
  for (std::size_t i = 1; i + 1 < edges.size(); ++i) {
    TestProgramme before = programme, after = programme;
    fill(before, edges[i], edges[i + 1], programme[static_cast<std::size_t>(edges[i - 1])]);
    fill(after, edges[i - 1], edges[i], programme[static_cast<std::size_t>(edges[i])]);
    list.push_back(std::move(before));
    list.push_back(std::move(after));
  }
  return list;
}

}  // namespace driftwright::studies
