#include "effects/recorded_column.hpp"

namespace driftwright::effects::linear_scale {

constexpr double kShift_mm = 500.0;  // from an end of a usual travel, 0.5 to 1 m, to its middle or its other end

void change_readings(const Effect& e, ReadingChain& chain) {
  chain.add(ReadingStage::kGrowth, [e](Readings& r) {
    const std::string& position = e.words.at("position");
    const Cyclogram::Column* column = position.empty() ? nullptr : r.cyclogram.column(position);
    if (!column && !position.empty()) return;  // of a cyclogram that is only examined
    const Body& body = e.references.at("body");
    auto error_m = r.value.row(r.displacement(e.place));
    for (Eigen::Index i = 0; i < r.n_times(); ++i) {
      const double time_s = r.time(i), at_mm = column ? column->at(time_s) : e["at"],
                   rise_K = body == ambient_node() ? r.ambient.at(time_s) : r.value(r.mean_of(body.name), i);
      error_m[i] += e["expansion"] * rise_K * 1e-3 * (at_mm - e["fixed_at"]);
    }
  });
}

void check(const Effect& e, const ConfigMap& in) {
  const std::string& position = e.words.at("position");
  if (position.empty() != e.has("at"))
    in.fail("at", "exactly one of the two is required: a place of the axis, `at`, or its recorded `position`");
  if (is_drive_channel(position))
    in.fail("position", "this must be a column in mm, such as position_x; feeds and cutting power are no positions");
}

EffectKind kind() {
  return {.key = "linear_scale",
          .title = "error of an axis whose loop is closed by a linear scale that is warmer than its reference",
          .law =
              "u += expansion (T - T_reference) (x - fixed_at), T: mean of the body that the scale is as warm as, x: place "
              "of the axis. Actual - commanded: a scale that has grown sets the axis too far from where it is fixed",
          .places = {Place::kDisplacement},
          .parameters = {{"expansion",
                          "1/K",
                          -1e-4,
                          1e-4,
                          {},
                          "of the scale as mounted; glass 8e-6, steel tape 10.5e-6, or "
                          "that of what it is glued to",
                          0.1,
                          "linear_scale",
                          Doubted::kFactor},
                         {"fixed_at", "mm", -1e5, 1e5, 0.0, "position of the axis at which the scale is fixed", 0.0,
                          "linear_scale", Doubted::kShift, kShift_mm},
                         {"at", "mm", -1e5, 1e5, kNotGiven, "a place of the axis"}},
          .timing = Timing::kInRecord,
          .change_readings = change_readings,
          .references = {{"body", {BodyKind::kNode, BodyKind::kRegion}, {}, "that the scale is as warm as; `ambient`, too"}},
          .check = check,
          .mentions = {{"position", Mention::Of::kColumn, false, "or: its recorded position in mm (`position_x`)", "mm"}}};
}

}  // namespace driftwright::effects::linear_scale
