#include "diagnosis/scatter.hpp"

#include <cmath>

namespace driftwright::diagnosis {
namespace {

constexpr double kScatter = 0.10;  // of what is not in the scenario as a number of an effect

constexpr double kHall_K = 0.3;

}  // namespace

std::vector<Knob> hall_scatter(const std::vector<MeasuredRun>& runs) {
  std::vector<Knob> knobs;
  for (const MeasuredRun& run : runs) {
    knobs.push_back(
        {.effect = "ambient",
         .where = effects::kHallName,
         .name = "offset in " + run.name,
         .unit = "K",
         .prior_sd = kHall_K,
         .step = 0.5 * kHall_K,
         .set = [name = run.name](TwinState& s, double value) {
           s.push_back(effects::make_effect("ambient", effects::Place::kHall, effects::kHallName, {{"offset", value}}));
           s.back().in = name;
         }});
  }
  return knobs;
}

std::vector<Knob> scatter(const Twin& twin) {
  std::vector<Knob> knobs;
  for (std::size_t i = 0; i < twin.n_own_effects(); ++i) {
    const effects::Effect& e = twin.as_written()[i];
    for (std::size_t p = 0; p < e.kind->parameters.size(); ++p) {
      const effects::Parameter& parameter = e.kind->parameters[p];
      if (parameter.scatter == 0.0 || std::isnan(e.values[p]) || e.values[p] == 0.0) continue;
      knobs.push_back({.effect = parameter.finding,
                       .where = effects::where_of(e),
                       .name = parameter.name,
                       .unit = parameter.unit,
                       .scale = Knob::Scale::kLog,
                       .nominal = e.values[p],
                       .prior_sd = parameter.scatter,
                       .step = 0.5 * parameter.scatter,
                       .low = parameter.low,
                       .high = parameter.high,
                       .set = [i, p](TwinState& s, double value) { s[i].values[p] = value; }});
    }
  }
  const effects::DoubtScene scene = scene_of(twin, {});
  for (const effects::EffectKind& kind : effects::catalogue()) {
    if (!kind.doubts) continue;
    for (const effects::Doubt& d : kind.doubts(scene)) {
      if (!d.scatters) continue;
      Knob size = knobs_of(d).front();
      size.prior_sd = kScatter;
      size.step = 0.5 * kScatter;
      knobs.push_back(std::move(size));
    }
  }
  return knobs;
}

}  // namespace driftwright::diagnosis
