#include <fmt/format.h>

#include <algorithm>

#include "base/quantity.hpp"
#include "effects/displacement_amount.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::effects {
namespace {

constexpr double kSensitivitySd_um_K = 5.0;  // 1 sigma; 1 m of steel on one side: 11.5 um/K

/// Temperature over the reference at each time [K]: of the body that is named, of the ambient, or of a recorded column.
Eigen::RowVectorXd followed(const Effect& e, const Readings& r) {
  const auto over_time = [&](const auto& value) {
    Eigen::RowVectorXd row(r.n_times());
    for (Eigen::Index i = 0; i < row.size(); ++i) row[i] = value(r.time(i));
    return row;
  };
  if (const auto body = e.references.find("body"); body != e.references.end()) {
    if (body->second == ambient_node()) return over_time([&](double t_s) { return r.ambient.at(t_s); });
    return r.value.row(r.mean_of(body->second.name));
  }
  const Cyclogram::Column* column = r.cyclogram.column(e.words.at("column"));
  if (!column) return Eigen::RowVectorXd::Zero(r.n_times());
  const double zero_C = e["zero"] - kZeroCelsius_K;
  return over_time([&](double t_s) { return column->at(t_s) - zero_C; });
}

void change_readings(const Effect& e, ReadingChain& chain) {
  const double per_K = amount_of(e, "sensitivity"), lag_s = e["lag"] * 60.0;
  chain.add(ReadingStage::kGrowth, [=, effect = e](Readings& r) {
    Eigen::RowVectorXd temperature_K = followed(effect, r);
    lag_behind(temperature_K, r.time_s, lag_s);
    r.value.row(r.displacement(effect.place)) += per_K * temperature_K;
  });
}

void check(const Effect& e, const ConfigMap& in) {
  check_amount(e, in, "sensitivity");
  if (e.references.contains("body") == !e.words.at("column").empty())
    in.fail("body", "one of two is wanted: the `body` that it follows, or a `column` of temperatures");
  if (is_drive_channel(e.words.at("column")))
    in.fail("column", "a column of temperatures is wanted; this one is of the drive");
}

/// At once, where the displacement has no sensitivity to it yet, and behind a lag.
void add_paths(const DoubtScene::Displacement& d, Effect path, const std::string& follows, bool at_once,
               std::vector<Doubt>& list) {
  DoubtedNumber per_K = doubted("sensitivity", fmt::format("{}/K", d.unit()), kSensitivitySd_um_K, 0.2);
  per_K.set = [key = amount_key(d, "sensitivity")](std::span<Effect> added, double value) { added[0].set(key, value); };
  path.set(amount_key(d, "sensitivity"), 0.0);
  Doubt doubt{.finding = "displacement_path",
              .where = d.name,
              .law = fmt::format("follows {}", follows),
              .added = {path},
              .numbers = {per_K},
              .trial = 1.0};
  if (at_once) list.push_back(doubt);
  DoubtedNumber lag = doubted("lag", "min", 20.0, 0.5, 20.0);
  lag.low = 1.0;
  lag.high = 240.0;
  doubt.law += " behind a lag";
  doubt.added[0].set("lag", lag.nominal);
  doubt.numbers.push_back(lag);
  doubt.grid = {{-10.0}, {20.0}};
  list.push_back(std::move(doubt));
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Displacement& d : s.displacements) {
    const Effect path = make_effect("displacement_path", Place::kDisplacement, d.name);
    const auto add = [&](const Body& body, bool at_once) {
      Effect of_body = path;
      of_body.references["body"] = body;
      add_paths(d, of_body, body.name, at_once, list);
    };
    for (const DoubtScene::Material& m : s.materials) {
      if (!m.stores || m.expands) continue;  // what bends the mesh is there already, at every place of it
      const auto& known = m.sensitivities;
      add(m.body, std::find(known.begin(), known.end(), d.name) == known.end());
    }
    add(ambient_node(), true);
    for (const DoubtScene::Column& column : s.columns) {
      if (!column.is_temperature()) continue;
      Effect of_column = path;
      of_column.words["column"] = column.header;
      of_column.set("zero", s.reference_K);
      add_paths(d, of_column, column.header, true, list);
    }
  }
  return list;
}

}  // namespace

EffectKind displacement_path() {
  return {
      .key = "displacement_path",
      .title = "displacement that follows one more body, the ambient or a recorded temperature",
      .law =
          "u += sensitivity (T - T_reference), T: mean of the body, as `sensitivities` of a displacement have it; of a "
          "column: T - zero. With a lag: lag dx/dt = T - x for T, settled at the start",
      .places = {Place::kDisplacement},
      .parameters = {{"sensitivity", "um/K", -1e5, 1e5, kNotGiven, "of a displacement", 0.1, "displacement_path",
                      Doubted::kFactor},
                     {"tilt", "urad/K", -1e5, 1e5, kNotGiven, "or: of a tilt", 0.1, "displacement_path", Doubted::kFactor},
                     {"lag", "min", 0.0, 1e5, 0.0, "first-order lag behind the temperature"},
                     {"zero", "degC", 200.0, 500.0, kZeroCelsius_K + 20.0, "of a column: where it moves nothing"}},
      .timing = Timing::kInRecord,
      .change_readings = change_readings,
      .references = {{"body", {BodyKind::kNode, BodyKind::kRegion}, "", "body that it follows; `ambient`: the ambient air"}},
      .check = check,
      .mentions = {{"column", Mention::Of::kColumn, false, "or: a recorded column of temperatures in degC"}},
      .doubts = doubts};
}

}  // namespace driftwright::effects
