#include "diagnosis/candidates.hpp"

#include <algorithm>

#include "diagnosis/candidate_scene.hpp"

namespace driftwright::diagnosis {

std::vector<Candidate> candidates(const Twin& twin, const std::vector<MeasuredRun>& runs,
                                  const std::set<std::string>& without) {
  const Scene s = scene_of(twin, runs);
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
