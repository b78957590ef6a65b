#include <fmt/format.h>

#include <algorithm>

#include "effects/displacement_amount.hpp"

namespace driftwright::effects::probe_lag {

constexpr double kFeed_mm_min = 1000.0;  // default feed at which lags are given
constexpr double kNoProbe = 2.0;         // nats: a displacement without a stated probe is usually read by an indicator

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kScale, [channel = e.place, by_m = e["lag"] * e["feed"]](Readings& r) {
    r.value.row(r.displacement(channel)).array() += by_m;
  });
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  const bool probes = std::any_of(s.own.begin(), s.own.end(), [](const Effect& e) { return e.kind->key == "probe_lag"; });
  for (const DoubtScene::Displacement& d : s.displacements) {
    if (d.is_tilt) continue;
    const double ms_um = 60.0 / kFeed_mm_min;  // lag for 1 um: ms
    DoubtedNumber lag = doubted("lag", "ms", 15.0 * ms_um, ms_um);
    lag.set = [](std::span<Effect> added, double value) { added[0].set("lag", 1e-3 * value); };
    list.push_back({.finding = "probe_lag",
                    .where = d.name,
                    .law = fmt::format("a touch probe that triggers late, at {:.0f} mm/min", kFeed_mm_min),
                    .added = {make_effect("probe_lag", Place::kDisplacement, d.name, {{"feed", kFeed_mm_min / 60e3}})},
                    .numbers = {lag},
                    .trial = 3.0 * ms_um,
                    .rarity = probes ? 0.0 : kNoProbe});
  }
  return list;
}

EffectKind kind() {
  return {.key = "probe_lag",
          .title = "touch probe whose trigger comes later than assumed",
          .law = "reading = u + lag feed: the axis has gone on by as much (Wang & Jia)",
          .places = {Place::kDisplacement},
          .parameters = {{"lag", "s", -10.0, 10.0, {}, "of the trigger; < 0: the probe comes from the other side"},
                         {"feed", "m/s", 1e-6, 10.0, {}, "of the axis as it probes"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .doubts = doubts};
}

}  // namespace driftwright::effects::probe_lag
