#include "scenarios/reader/read_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "base/quantity.hpp"
#include "base/record.hpp"
#include "compensation/frames/table_frame.hpp"
#include "solver/material.hpp"

namespace driftwright::scenarios {
namespace {

TableScale read_scale(const ConfigMap& in, const std::vector<std::string>& sensors) {
  std::vector<std::string> materials;
  for (const auto& [name, material] : solver::material_library()) materials.push_back(name);
  TableScale scale;
  if (in.has("sensor") == in.has("sensors"))
    in.fail(in.has("sensor") ? "sensors" : "sensor", "one of `sensor` and `sensors` (a list, for their mean) is wanted");
  scale.sensors = in.has("sensors") ? in.texts("sensors") : std::vector{in.choice("sensor", sensors)};
  if (scale.sensors.empty()) in.fail("sensors", "the list is empty; name one thermometer at least");
  for (const std::string& name : scale.sensors) {
    if (std::find(sensors.begin(), sensors.end(), name) == sensors.end())
      in.fail("sensors", fmt::format("'{}' is no sensor; there are {}", name, fmt::join(sensors, ", ")));
  }
  scale.expansion_1_K = solver::material_library().at(in.choice("material", materials)).expansion_1_K.x;
  scale.fixed_at_m = in.quantity("fixed_at", "m", -100.0, 100.0, 0.0);
  in.reject_unknown_keys();
  return scale;
}

std::vector<TableRing> read_rings(const ConfigMap& in, const TableSettings& table) {
  std::vector<TableRing> rings;
  for (const ConfigMap& entry : in.maps("rings")) {
    rings.push_back({entry.name("name"), entry.vector3("at", "m")});
    const Eigen::Vector3d& at_m = rings.back().at_m;
    for (int axis = 0; axis < 2; ++axis) {
      if (!(at_m[axis] >= table.low_m[axis] && at_m[axis] <= table.high_m[axis]))
        entry.fail("at", "the ring lies outside the corners `low` and `high` of the table");
    }
    for (auto other = rings.begin(); other + 1 != rings.end(); ++other) {
      if (other->name == rings.back().name) entry.fail("name", "another ring has this name");
      if ((other->at_m - at_m).norm() < compensation::kLeastRingDistance_m) {
        entry.fail("at", fmt::format("identical with ring '{}': nearer than {:g} mm", other->name,
                                     1e3 * compensation::kLeastRingDistance_m));
      }
    }
    entry.reject_unknown_keys();
  }
  if (rings.size() < 2) in.fail("rings", fmt::format("{} ring(s); two are wanted, at the ends of the table", rings.size()));
  const double length_m = rings.back().at_m[0] - rings.front().at_m[0];
  if (!(std::abs(length_m) >= compensation::kLeastRingDistance_m))
    in.fail("rings", "the first and the last ring are identical along x; they tell no scale");
  if (length_m < 0.0) in.fail("rings", "the rings are swapped: list them by rising x");
  return rings;
}

compensation::ProbeStudySettings read_probe(const ConfigMap& in) {
  compensation::ProbeStudySettings s;
  compensation::ProbeSystem& p = s.system;
  p.cycle_s = in.quantity("cycle", "s", 1e-5, 1.0, p.cycle_s);
  p.latch_s = in.quantity("latch", "s", 1e-9, 1e-3, p.latch_s);
  if (in.has("lag")) {
    const std::vector<double> lag_s = in.quantities("lag", "s");
    if (lag_s.size() != 3) in.fail("lag", "three lags are wanted, of x, y and z");
    for (std::size_t a = 0; a < 3; ++a) {
      if (!(lag_s[a] >= 0.0 && lag_s[a] <= 40.0 * p.cycle_s)) in.fail("lag", "0 to 40 cycles are allowed; 50 are kept");
      p.lag_s[a] = lag_s[a];
    }
  }
  p.jitter_s = in.quantity("jitter", "s", 0.0, p.cycle_s, p.jitter_s);
  p.pretravel_m = in.quantity("pretravel", "m", 0.0, 1e-3, p.pretravel_m);
  p.encoder_step_m = in.quantity("encoder_step", "m", 1e-9, 1e-3, p.encoder_step_m);
  s.feeds_m_s = in.quantities("feeds", "m/s");
  for (double feed_m_s : s.feeds_m_s) {
    if (!(feed_m_s > 0.0 && feed_m_s <= 1.0)) in.fail("feeds", "feeds above 0 and up to 60 m/min are allowed");
  }
  if (s.feeds_m_s.size() < 2 || !std::is_sorted(s.feeds_m_s.begin(), s.feeds_m_s.end()) ||
      s.feeds_m_s.front() == s.feeds_m_s.back()) {
    in.fail("feeds", "two rising feeds at least are wanted");
  }
  s.reference_feed_m_s = in.quantity("reference_feed", "mm/min", 0.1, 30.0, 10.0) * 1e-3 / 60.0;
  s.deceleration_m_s2 = in.quantity("deceleration", "m/s^2", 1e-3, 100.0, s.deceleration_m_s2);
  s.free_diameter_m = in.quantity("free_diameter", "m", 1e-3, 1.0, s.free_diameter_m);
  in.reject_unknown_keys();
  return s;
}

TableReadings read_readings(const ConfigMap& in) {
  const auto path = std::filesystem::path(in.file()).parent_path() / in.text("csv");
  const Record record = read_record_csv(path.string());
  TableReadings readings{.time_s = record.time_s,
                         .ambient_K = record.at(in.text("ambient")).values,
                         .x_um = record.at(in.text("x")).values,
                         .y_um = record.at(in.text("y")).values,
                         .z_um = record.at(in.text("z")).values};
  for (double& T : readings.ambient_K) T += kZeroCelsius_K;
  in.reject_unknown_keys();
  return readings;
}

}  // namespace

std::vector<Eigen::Vector3d> table_points(const TableSettings& t) {
  std::vector<Eigen::Vector3d> points;
  const auto between = [](double low, double high, int i, int n) { return low + (high - low) * i / (n - 1); };
  for (int k = 0; k < t.n_y; ++k) {
    for (int i = 0; i < t.n_x; ++i) {
      points.emplace_back(between(t.low_m[0], t.high_m[0], i, t.n_x), between(t.low_m[1], t.high_m[1], k, t.n_y),
                          t.high_m[2]);
    }
  }
  for (const TableRing& ring : t.rings) points.push_back(ring.at_m);
  points.push_back(t.head_m);
  return points;
}

std::vector<DisplacementOutput> table_displacements(const TableSettings& table) {
  std::vector<DisplacementOutput> outputs;
  const std::vector<Eigen::Vector3d> points = table_points(table);
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (int axis = 0; axis < 3; ++axis) {
      const PointOnRegion tool{table.region, points[p], table.where};
      outputs.push_back({fmt::format("table_{}_{}", p + 1, "xyz"[axis]),
                         ToolAgainstTable{.axis = axis, .tool = tool, .table = std::nullopt}});
    }
  }
  return outputs;
}

TableSettings read_table(const ConfigMap& in, const std::vector<std::string>& sensors,
                         const std::vector<std::string>& cyclograms) {
  TableSettings t;
  t.where = in.where();
  t.region = in.text("region", "table");
  t.low_m = in.vector3("low", "m");
  t.high_m = in.vector3("high", "m");
  if (!(t.low_m[0] < t.high_m[0] && t.low_m[1] < t.high_m[1])) in.fail("high", "`high` must lie beyond `low` along x and y");
  if (t.low_m[2] != t.high_m[2]) in.fail("low", "`low` and `high` differ in z; what is judged is the plane between them");
  t.n_x = in.integer("points_x", 2, 101, t.n_x);
  t.n_y = in.integer("points_y", 2, 101, t.n_y);
  t.head_m = in.vector3("head", "m");
  t.scale_x = read_scale(in.map("scale_x"), sensors);
  if (const auto scale = in.optional_map("scale_y")) t.scale_y = read_scale(*scale, sensors);
  t.rings = read_rings(in, t);
  t.cyclogram = in.choice("cyclogram", cyclograms);
  t.every_s = in.quantity("measure_every", "s", 60.0, 1e7, t.every_s);
  t.probe_noise_m = in.quantity("probe_noise", "m", 0.0, 1e-3, t.probe_noise_m);
  t.tolerance_m = in.quantity("tolerance", "m", 1e-7, 1e-2, t.tolerance_m);
  t.judge_until_s = in.quantity("judge_until", "s", 60.0, 1e8);
  t.train_from_s = in.quantity("train_from", "s", 0.0, 1e8);
  if (!(t.train_from_s >= t.judge_until_s))
    in.fail("train_from", "strategies are judged on what they were not fitted on; `train_from` comes after `judge_until`");
  t.model_scatter = in.quantity("model_scatter", "1", 0.0, 1.0, t.model_scatter);
  t.seed = in.integer("seed", 0, 1'000'000, t.seed);
  t.instrument.noise_K = in.quantity("sensor_noise", "K", 0.0, 10.0, t.instrument.noise_K);
  t.instrument.resolution_K = in.quantity("sensor_resolution", "K", 0.0, 10.0, t.instrument.resolution_K);
  t.sensor_mean_s = in.quantity("sensor_mean", "s", 0.0, 86400.0, t.sensor_mean_s);
  const ConfigMap control = in.map("control");
  t.thermometer = control.choice("sensor", sensors);
  t.update_s = control.quantity("update", "s", 1.0, 1e6, t.update_s);
  t.velocity_m_s = control.quantity("velocity", "m/s", 1e-3, 10.0, t.velocity_m_s);
  t.slew = control.quantity("slew", "1", 1e-6, 1.0, t.slew);
  if (control.has("origin")) t.origin_m = control.vector3("origin", "m");
  if (!(t.origin_m.cwiseAbs().maxCoeff() <= 100.0))
    control.fail("origin", "-100 m to 100 m are allowed: where the mesh's origin is in machine coordinates");
  t.against_dk = control.choice("axis_moves", {"by_dk", "against_dk"}, "by_dk") == "against_dk";
  control.reject_unknown_keys();
  const ConfigMap probe = in.map("probe");
  t.ball_diameter_m = probe.quantity("ball_diameter", "m", 1e-4, 0.1, t.ball_diameter_m);
  t.probe = read_probe(probe);
  t.probe.ring_distance_m = t.rings.back().at_m[0] - t.rings.front().at_m[0];
  t.probe.seed = static_cast<std::uint64_t>(t.seed);
  if (const auto readings = in.optional_map("readings")) t.readings = read_readings(*readings);
  in.reject_unknown_keys();
  return t;
}

}  // namespace driftwright::scenarios
