#include <cmath>

#include "effects/doubt.hpp"

namespace driftwright::effects::creeping_glue {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kGrowth, [channel = e.place, creep_m = 1e-6 * e["creep"]](Readings& r) {
    for (Eigen::Index i = 0; i < r.n_times(); ++i)
      r.value(r.displacement(channel), i) += creep_m * std::sqrt(r.time(i) / 3600.0);
  });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Displacement& d : s.displacements) {
    list.push_back({.finding = "creeping_glue",
                    .where = d.name,
                    .law = "with the root of time",
                    .added = {make_effect("creeping_glue", Place::kDisplacement, d.name)},
                    .numbers = {doubted("creep", "um", 15.0, 1.0)},
                    .trial = 3.0});
  }
  return list;
}

EffectKind kind() {
  return {.key = "creeping_glue",
          .title = "indicator whose glue creeps",
          .law = "u = u + creep sqrt(t / 1 h)",
          .places = {Place::kDisplacement},
          .parameters = {{"creep", "um", -1e5, 1e5, {}, "in the first hour", 0.1, "creeping_glue"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .doubts = doubts};
}

}  // namespace driftwright::effects::creeping_glue
