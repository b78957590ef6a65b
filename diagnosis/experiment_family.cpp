#include "diagnosis/experiment_family.hpp"

#include <algorithm>

namespace driftwright::diagnosis {

std::vector<Cyclogram> experiment_family(const std::vector<MeasuredRun>& runs) {
  Drive top, feeds;
  for (const MeasuredRun& run : runs) {
    for (const auto& s : run.cyclogram.sections) {
      top.speed_rpm = std::max(top.speed_rpm, s.drive.speed_rpm);
      for (std::size_t a = 0; a < feeds.feed_m_s.size(); ++a)
        feeds.feed_m_s[a] = std::max(feeds.feed_m_s[a], s.drive.feed_m_s[a]);
    }
  }
  const auto of = [](double minutes, const Drive& drive) { return Cyclogram::Section{60.0 * minutes, drive}; };
  const auto turning = [&](double minutes, double share) { return of(minutes, {.speed_rpm = share * top.speed_rpm}); };
  const auto still = [&](double minutes) { return of(minutes, {}); };
  std::vector<Cyclogram> list = {{"standstill", {still(360)}}};
  if (top.speed_rpm > 0.0) {
    list.push_back({"steady", {turning(360, 1.0)}});
    list.push_back({"slow", {turning(360, 0.25)}});
    list.push_back({"heat_and_cool", {turning(150, 1.0), still(210)}});
    list.push_back({"rest_run_rest", {still(90), turning(150, 1.0), still(120)}});
    list.push_back({"levels", {turning(90, 0.3), turning(90, 0.6), turning(90, 1.0), still(90)}});
    Cyclogram alternating{"alternating", {}};
    for (int i = 0; i < 9; ++i) {
      alternating.sections.push_back(turning(20, 1.0));
      alternating.sections.push_back(i % 2 ? turning(20, 0.4) : still(20));
    }
    list.push_back(alternating);
  }
  if (std::any_of(feeds.feed_m_s.begin(), feeds.feed_m_s.end(), [](double f) { return f > 0.0; })) {
    list.push_back({"feeds", {of(150, feeds), still(210)}});
    if (top.speed_rpm > 0.0) list.push_back({"feeds_then_spindle", {of(150, feeds), turning(150, 1.0), still(60)}});
  }
  return list;
}

}  // namespace driftwright::diagnosis
