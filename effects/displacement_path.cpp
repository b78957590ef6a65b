#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/quantity.hpp"
#include "effects/displacement_amount.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::effects::displacement_path {

constexpr double kSensitivitySd_um_K = 5.0;  // 1 sigma; 1 m of steel on one side: 11.5 um/K
constexpr double kShareSd = 0.1;             // share of another axis that a misaligned indicator reads
constexpr double kBentSd_um = 15.0;          // 1 sigma of the bending by a recorded force or pressure

/// The value of a column at each time, in its unit, from each row on; for a channel of the drive that of the sections. Zero
/// without such a column.
Eigen::RowVectorXd column_at(const std::string& name, const Readings& r) {
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(r.n_times());
  if (const Cyclogram::Column* column = r.cyclogram.column(name)) {
    for (Eigen::Index i = 0; i < row.size(); ++i) row[i] = column->at(r.time(i));
  } else if (is_drive_channel(name)) {
    const auto signal = signal_of(name, 0.0);
    const auto& sections = r.cyclogram.sections;
    double end_s = 0.0;
    std::size_t next = 0;
    for (Eigen::Index i = 0; i < row.size() && !sections.empty(); ++i) {
      while (next < sections.size() && r.time(i) >= end_s) end_s += sections[next++].duration_s;
      row[i] = signal(sections[std::max<std::size_t>(next, 1) - 1].drive).value_or(0.0);
    }
  }
  return row;
}

/// The followed quantity at each time: temperature above the reference [K] of the named body, the ambient, or a recorded
/// column; or a column's value.
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
  if (e.has("gain")) return column_at(e.words.at("column"), r);
  if (!r.cyclogram.column(e.words.at("column"))) return Eigen::RowVectorXd::Zero(r.n_times());
  return column_at(e.words.at("column"), r).array() - (e["zero"] - kZeroCelsius_K);
}

void change_readings(const Effect& e, ReadingChain& chain) {
  if (e.has("share")) {
    chain.add(ReadingStage::kScale,
              [place = e.place, of = e.words.at("of"), share = e["share"], lag_s = e["lag"] * 60.0](Readings& r) {
                Eigen::RowVectorXd signal = r.value.row(r.displacement(of));
                lag_behind(signal, r.time_s, lag_s);
                r.value.row(r.displacement(place)) += share * signal;
              });
    return;
  }
  const double gain = e.has("gain") ? 1e-6 * e["gain"] : amount_of(e, "sensitivity"), lag_s = e["lag"] * 60.0;
  chain.add(ReadingStage::kGrowth, [=, effect = e](Readings& r) {
    Eigen::RowVectorXd signal = followed(effect, r);
    lag_behind(signal, r.time_s, lag_s);
    r.value.row(r.displacement(effect.place)) += gain * signal;
  });
}

void check(const Effect& e, const ConfigMap& in) {
  const std::string &column = e.words.at("column"), &of = e.words.at("of");
  if ((e.references.contains("body") ? 1 : 0) + (column.empty() ? 0 : 1) + (of.empty() ? 0 : 1) != 1)
    in.fail("body",
            "exactly one of the three is required: the `body` that it follows, a `column`, or another displacement that it "
            "reads a share `of`");
  if (of.empty() == e.has("share"))
    in.fail("share", "`of` and `share` must be given together: which displacement, and how much of it");
  if (!of.empty()) {
    if (of == e.place) in.fail("of", "this must be another displacement");
    for (const char* key : {"sensitivity", "tilt", "gain"}) {
      if (e.has(key)) in.fail(key, "what reads a share of another displacement has no sensitivity, tilt or gain");
    }
    return;
  }
  if (e.has("gain")) {
    if (e.has("sensitivity") || e.has("tilt"))
      in.fail("gain", "exactly one of them is required: `gain`, or `sensitivity` or `tilt` of what follows a temperature");
    if (column.empty()) in.fail("gain", "`gain` is allowed only beside a `column`");
    if (in.has("zero"))
      in.fail("zero", "this key is allowed only beside a column of temperatures; a `gain` multiplies what the column says");
    return;
  }
  check_amount(e, in, "sensitivity");
  if (is_drive_channel(column))
    in.fail("column", "this must be a column of temperatures, but it is one of the drive; write its effect as `gain`");
}

/// Adds a path without lag, if the displacement does not follow it yet, and one with a lag.
/// @param path  its parameter `size` contains the size
void add_paths(const DoubtScene::Displacement& d, const Effect& path, const DoubtedNumber& size, const std::string& follows,
               bool at_once, std::vector<Doubt>& list) {
  Doubt doubt{.finding = "displacement_path",
              .where = d.name,
              .law = fmt::format("follows {}", follows),
              .added = {path},
              .numbers = {size},
              .trial = 0.2 * size.prior_sd};
  if (at_once) list.push_back(doubt);
  DoubtedNumber lag = doubted("lag", "min", 20.0, 0.5, 20.0);
  lag.low = 1.0;
  lag.high = 240.0;
  doubt.law += " with a lag";
  doubt.added[0].set("lag", lag.nominal);
  doubt.numbers.push_back(lag);
  doubt.grid = {{-10.0}, {20.0}};
  list.push_back(std::move(doubt));
}

/// Displacements defined by sensitivities; others may read a share of them.
std::set<std::string> of_sensitivities(const DoubtScene& s) {
  std::set<std::string> names;
  for (const DoubtScene::Material& m : s.materials) names.insert(m.sensitivities.begin(), m.sensitivities.end());
  return names;
}

/// A misaligned indicator.
void add_shares(const DoubtScene& s, const DoubtScene::Displacement& d, std::vector<Doubt>& list) {
  if (d.is_tilt) return;
  const std::set<std::string> others = of_sensitivities(s);
  for (const DoubtScene::Displacement& other : s.displacements) {
    if (other.name == d.name || other.is_tilt || !others.contains(other.name)) continue;
    Effect share = make_effect("displacement_path", Place::kDisplacement, d.name, {{"share", 0.0}});
    share.words["of"] = other.name;
    list.push_back({.finding = "displacement_path",
                    .where = d.name,
                    .law = "reads a share of " + other.name,
                    .added = {share},
                    .numbers = {doubted("share", "1", kShareSd, 0.05 * kShareSd)},
                    .trial = 0.5 * kShareSd});
  }
}

std::vector<Doubt> doubts(const DoubtScene& s) {
  std::vector<Doubt> list;
  for (const DoubtScene::Displacement& d : s.displacements) {
    Effect path = make_effect("displacement_path", Place::kDisplacement, d.name);
    Effect of_gain = path;
    of_gain.set("gain", 0.0);
    DoubtedNumber per_K = doubted("sensitivity", fmt::format("{}/K", d.unit()), kSensitivitySd_um_K, 0.2);
    const std::string key = amount_key(d, "sensitivity");
    per_K.set = [key](std::span<Effect> added, double value) { added[0].set(key, value); };
    path.set(key, 0.0);
    const auto add = [&](const Body& body, bool at_once) {
      Effect of_body = path;
      of_body.references["body"] = body;
      add_paths(d, of_body, per_K, body.name, at_once, list);
    };
    for (const DoubtScene::Material& m : s.materials) {
      if (!m.stores || m.expands) continue;  // a body that deforms the mesh already acts everywhere
      const auto& known = m.sensitivities;
      add(m.body, std::find(known.begin(), known.end(), d.name) == known.end());
    }
    add(ambient_node(), true);
    add_shares(s, d, list);
    for (const DoubtScene::Column& column : s.columns) {
      Effect of_column = column.is_temperature() ? path : of_gain;
      of_column.words["column"] = column.header;
      if (column.is_temperature()) {
        of_column.set("zero", s.reference_K);
        add_paths(d, of_column, per_K, column.header, true, list);
      } else {  // a bending force, a clamp, a pressure
        const double sd = kBentSd_um / column.span;
        add_paths(d, of_column, doubted("gain", fmt::format("{} per {}", d.unit(), column.unit), sd, 0.05 * sd),
                  column.header, true, list);
      }
    }
  }
  return list;
}

EffectKind kind() {
  return {
      .key = "displacement_path",
      .title = "displacement that follows one more body, the ambient or a recorded column, or reads a share of another one",
      .law =
          "u += sensitivity (T - T_reference), T: mean of the body, as `sensitivities` of a displacement have it; of a "
          "column of temperatures: T - zero; of another one: u += gain c. With a lag: lag dx/dt = T - x for T, or c, "
          "settled "
          "at the start. Of another displacement, as its indicator would read it but for its own errors: u += share u_of",
      .places = {Place::kDisplacement},
      .parameters =
          {{"sensitivity", "um/K", -1e5, 1e5, kNotGiven, "of a displacement", 0.1, "displacement_path", Doubted::kFactor},
           {"tilt", "urad/K", -1e5, 1e5, kNotGiven, "or: of a tilt", 0.1, "displacement_path", Doubted::kFactor},
           {"gain", "1", -1e9, 1e9, kNotGiven,
            "or: um (of a tilt: urad) per unit of a column that is no temperature: a force, a pressure", 0.1,
            "displacement_path", Doubted::kFactor},
           {"share", "1", -10.0, 10.0, kNotGiven, "or: of another displacement, of an indicator that is mounted askew"},
           {"lag", "min", 0.0, 1e5, 0.0, "first-order lag to what it follows"},
           {"zero", "degC", 200.0, 500.0, kZeroCelsius_K + 20.0, "of a column of temperatures: where it moves nothing"}},
      .timing = Timing::kInRecord,
      .change_readings = change_readings,
      .references = {{"body", {BodyKind::kNode, BodyKind::kRegion}, "", "body that it follows; `ambient`: the ambient air"}},
      .check = check,
      .mentions = {{"column", Mention::Of::kColumn, false, "or: a recorded column; cutting_power and feed_x, _y, _z, too"},
                   {"of", Mention::Of::kDisplacement, false,
                    "or: another displacement of sensitivities that it reads a share of"}},
      .doubts = doubts};
}

}  // namespace driftwright::effects::displacement_path
