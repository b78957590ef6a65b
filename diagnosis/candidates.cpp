#include "diagnosis/candidates.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/candidate_scene.hpp"

namespace driftwright::diagnosis {

std::vector<Candidate> candidates(const Twin& twin, const std::vector<MeasuredRun>& runs,
                                  const std::set<std::string>& without) {
  Scene s{.twin = twin, .runs = runs};
  s.own = twin.balance(twin.as_written());
  double turning_s = 0.0, turned = 0.0;
  for (const MeasuredRun& run : runs) {
    for (const auto& section : run.cyclogram.sections) {
      s.top_rpm = std::max(s.top_rpm, section.drive.speed_rpm);
      if (section.drive.speed_rpm > 0.0) turning_s += section.duration_s;
      turned += section.duration_s * section.drive.speed_rpm;
      for (double f : section.drive.feed_m_s) s.moves_axes = s.moves_axes || f > 0.0;
    }
    for (const MeasuredChannel& c : run.channels) {
      std::vector<std::string>& names = c.unit == "K" ? s.sensors : s.displacements;
      if (std::find(names.begin(), names.end(), c.name) == names.end()) names.push_back(c.name);
    }
  }
  if (turning_s > 0.0) {  // a round number near the mean speed: where laws of speed are stated
    const double mean_rpm = turned / turning_s, decade = std::pow(10.0, std::floor(std::log10(mean_rpm)));
    s.typical_rpm = std::max(1.0, std::round(mean_rpm / decade)) * decade;
  }
  s.heat_W = 0.0;
  for (const auto& h : s.own.heats) {
    if (h.power_W.probes.empty()) s.heat_W += std::abs(h.power_W(effects::Inputs{.drive = {.speed_rpm = s.top_rpm}}));
  }
  std::vector<Candidate> list;
  add_heat(s, list);
  add_friction(s, list);
  add_exchanges(s, list);
  add_materials(s, list);
  add_hall(s, list);
  add_displacements(s, list);
  add_sensors(s, list);
  add_drive(s, list);
  for (Candidate& c : list) {
    for (Variant& v : c.variants) {
      if (v.law.ends_with(" rpm")) v.at_speed_rpm = s.typical_rpm;
    }
  }
  std::erase_if(list, [&](const Candidate& c) { return without.contains(c.effect) || c.variants.empty(); });
  for (Candidate& c : list) {
    for (Variant& v : c.variants) {
      for (Knob& k : v.knobs) {
        k.effect = c.effect;
        k.where = c.where;
      }
    }
  }
  return list;
}

}  // namespace driftwright::diagnosis
