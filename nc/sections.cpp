#include "nc/sections.hpp"

namespace driftwright {
namespace {

void append(std::vector<Cyclogram::Section>& sections, const Cyclogram::Section& next) {
  if (!sections.empty() && sections.back().drive == next.drive) {
    sections.back().duration_s += next.duration_s;
  } else {
    sections.push_back(next);
  }
}

}  // namespace

std::vector<Cyclogram::Section> merged_sections(const std::vector<NcMove>& moves, double resolution_s,
                                                double cutting_power_W) {
  std::vector<Cyclogram::Section> sections;
  NcMove sum;
  double cutting_s = 0.0;
  const auto flush = [&] {
    if (!(sum.duration_s > 0.0)) return;
    Cyclogram::Section section{sum.duration_s, {.speed_rpm = sum.speed_rpm}};
    for (int axis = 0; axis < 3; ++axis) section.drive.feed_m_s[axis] = sum.travel_m[axis] / sum.duration_s;
    section.drive.cutting_power_W = cutting_power_W * (cutting_s / sum.duration_s);
    append(sections, section);
    sum = {};
    cutting_s = 0.0;
  };
  for (const NcMove& move : moves) {
    if (move.speed_rpm != sum.speed_rpm || sum.duration_s >= resolution_s || move.duration_s >= resolution_s) flush();
    sum.duration_s += move.duration_s;
    sum.speed_rpm = move.speed_rpm;
    for (int axis = 0; axis < 3; ++axis) sum.travel_m[axis] += move.travel_m[axis];
    if (move.cutting) cutting_s += move.duration_s;
  }
  flush();
  return sections;
}

std::vector<Cyclogram::Section> repeated(const std::vector<Cyclogram::Section>& sections, int times) {
  std::vector<Cyclogram::Section> all;
  for (int i = 0; i < times; ++i) {
    for (const Cyclogram::Section& section : sections) append(all, section);
  }
  return all;
}

}  // namespace driftwright
