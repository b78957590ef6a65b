#include "effects/doubt.hpp"

namespace driftwright::effects::scale_expansion {

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kScale, [channel = e.place, factor = e["factor"], lag_s = e["lag"] * 60.0](Readings& r) {
    const Eigen::Index row = r.displacement(channel);
    Eigen::RowVectorXd signal = factor * r.value.row(row);
    lag_behind(signal, r.time_s, lag_s);
    r.value.row(row) = signal;
  });
}

void check(const Effect&, const ConfigMap& in) {
  if (!in.has("factor") && !in.has("lag")) in.fail("factor", "`factor`, `lag` or both are required");
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Displacement& d : s.displacements) {
    const Doubt doubt{.finding = "scale_expansion",
                      .where = d.name,
                      .law = "the scale's own expansion",
                      .added = {make_effect("scale_expansion", Place::kDisplacement, d.name)},
                      .numbers = {doubted("factor", "1", 0.3, 0.02, 1.0)},
                      .trial = 0.05};
    list.push_back(doubt);
    list.push_back(doubt);
    list.back().law = "the scale's lag";
    list.back().numbers = {doubted("lag", "min", 8.0, 0.5)};
    list.back().numbers[0].low = 0.0;
    list.back().trial = 2.0;
  }
  return list;
}

EffectKind kind() {
  return {.key = "scale_expansion",
          .title = "linear scale that expands itself, and so scales what it measures, or follows late",
          .law =
              "lag du/dt = factor u_machine - u, u = factor u_machine at t = 0; a scale that takes part in the machine's "
              "expansion by the share s sees the factor 1 - s",
          .places = {Place::kDisplacement},
          .parameters = {{"factor", "1", -10.0, 10.0, 1.0, "on the displacement"},
                         {"lag", "min", 0.0, 1e5, 0.0, "time constant of the scale"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .check = check,
          .doubts = doubts};
}

}  // namespace driftwright::effects::scale_expansion
