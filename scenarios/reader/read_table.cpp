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

constexpr double kLeastFeed_m_s = 1e-9;  // smallest feed above 0

TableScale read_scale(const ConfigMap& in, const std::vector<std::string>& sensors) {
  TableScale scale;
  scale.sensors = in.has("sensors") ? in.texts("sensors") : std::vector{in.choice("sensor", sensors)};
  for (const std::string& name : scale.sensors) {
    if (std::find(sensors.begin(), sensors.end(), name) == sensors.end())
      in.fail("sensors", fmt::format("'{}' is no sensor; there are {}", name, fmt::join(sensors, ", ")));
  }
  scale.expansion_1_K = solver::material_library().at(in.choice("material")).expansion_1_K.x;
  scale.fixed_at_m = in.quantity("fixed_at");
  in.reject_unknown_keys();
  return scale;
}

std::vector<TableRing> read_rings(const ConfigMap& in, const TableSettings& table) {
  std::vector<TableRing> rings;
  for (const ConfigMap& entry : in.maps("rings")) {
    rings.push_back({entry.name("name"), entry.vector3("at")});
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
  const double length_m = rings.back().at_m[0] - rings.front().at_m[0];
  if (!(std::abs(length_m) >= compensation::kLeastRingDistance_m))
    in.fail("rings", "the first and the last ring are identical along x; they give no scale");
  if (length_m < 0.0) in.fail("rings", "the rings are swapped: list them by rising x");
  return rings;
}

compensation::ProbeStudySettings read_probe(const ConfigMap& in) {
  compensation::ProbeStudySettings s;
  compensation::ProbeSystem& p = s.system;
  p.cycle_s = in.quantity("cycle");
  p.latch_s = in.quantity("latch");
  if (in.has("lag")) {
    const Eigen::Vector3d lag_s = in.vector3("lag");
    for (int a = 0; a < 3; ++a) {
      if (!(lag_s[a] <= 40.0 * p.cycle_s)) in.fail("lag", "0 to 40 cycles are allowed; 50 are kept");
      p.lag_s[static_cast<std::size_t>(a)] = lag_s[a];
    }
  }
  p.jitter_s = in.quantity("jitter");
  if (!(p.jitter_s <= p.cycle_s)) in.fail("jitter", fmt::format("at most a cycle, {:g} s, is allowed", p.cycle_s));
  p.pretravel_m = in.quantity("pretravel");
  p.encoder_step_m = in.quantity("encoder_step");
  s.feeds_m_s = in.quantities("feeds");
  if (!std::is_sorted(s.feeds_m_s.begin(), s.feeds_m_s.end()) || s.feeds_m_s.front() == s.feeds_m_s.back()) {
    in.fail("feeds", "at least two rising feeds are required");
  }
  s.reference_feed_m_s = in.quantity("reference_feed") * 1e-3 / 60.0;
  s.deceleration_m_s2 = in.quantity("deceleration");
  s.free_diameter_m = in.quantity("free_diameter");
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

schema::Map table_schema() {
  using namespace schema;
  const TableSettings t;
  const compensation::ProbeStudySettings study;
  const compensation::ProbeSystem& p = study.system;
  std::vector<std::string> materials;
  for (const auto& [name, material] : solver::material_library()) materials.push_back(name);
  const schema::Map scale = {
      .name = "table, scales",
      .keys = {schema::optional("sensor", text(), "thermometer on the scale, or on what stretches it"),
               schema::optional("sensors", list(text(), 1), "or: several; their mean is its temperature"),
               compulsory("material", choice(materials), "of the library, which says how it expands"),
               schema::optional("fixed_at", quantity("m", -100.0, 100.0), 0.0,
                                "where along the axis scale and table coordinates are the same")},
      .groups = {{Group::Rule::kExactlyOne,
                  {"sensor", "sensors"},
                  "exactly one of `sensor` and `sensors` (a list, for their mean) is required"}},
      .about = "A linear scale: what the control takes for length."};
  const schema::Map ring = {.name = "table, rings",
                            .keys = {compulsory("name", schema::name(), "of the ring"),
                                     compulsory("at", schema::vector3("m"), "its middle, between `low` and `high`")},
                            .about = "Reference rings on the table, by rising x."};
  const schema::Map control = {.name = "table, control",
                               .keys = {compulsory("sensor", text(), "thermometer of the control's own compensation"),
                                        schema::optional("update", quantity("s", 1.0, 1e6), t.update_s,
                                                         "of its setting data, and between readings of every thermometer"),
                                        schema::optional("velocity", quantity("m/s", 1e-3, 10.0), t.velocity_m_s, "MD32000"),
                                        schema::optional("slew", quantity("1", 1e-6, 1.0), t.slew, "MD32760"),
                                        schema::optional("origin", schema::vector3("m", -100.0, 100.0), Said{"0"},
                                                         "of the mesh, in the machine's coordinates"),
                                        schema::optional("axis_moves", choice({"by_dk", "against_dk"}), "by_dk",
                                                         "which way the control moves the axis")}};
  const schema::Map probe = {
      .name = "table, probe",
      .keys = {
          schema::optional("ball_diameter", quantity("m", 1e-4, 0.1), t.ball_diameter_m, "of the stylus"),
          schema::optional("tool", integer(1, 99'999), t.probe_tool, "number of the probe in the tool table of LinuxCNC"),
          schema::optional("cycle", quantity("s", 1e-5, 1.0), p.cycle_s, "of the control"),
          schema::optional("latch", quantity("s", 1e-9, 1e-3), p.latch_s, "step of the latched time"),
          schema::optional(
              "lag", schema::vector3("s", 0.0),
              Said{fmt::format("{:g} ms, {:g} ms, {:g} ms", 1e3 * p.lag_s[0], 1e3 * p.lag_s[1], 1e3 * p.lag_s[2])},
              "from trigger to arrival, of x, y and z; 40 cycles at most"),
          schema::optional("jitter", quantity("s", 0.0), p.jitter_s, "1 sigma of each arrival; a cycle at most"),
          schema::optional("pretravel", quantity("m", 0.0, 1e-3), p.pretravel_m,
                           "the stylus gives way by it before the probe triggers"),
          schema::optional("encoder_step", quantity("m", 1e-9, 1e-3), p.encoder_step_m, "of the axes"),
          compulsory("feeds", list(quantity("m/s", kLeastFeed_m_s, 1.0), 2), "of the touches, rising"),
          schema::optional("reference_feed", quantity("mm/min", 0.1, 30.0), 60e3 * study.reference_feed_m_s,
                           "of the calibration's slow touches"),
          schema::optional("deceleration", quantity("m/s^2", 1e-3, 100.0), study.deceleration_m_s2, "of the braking axis"),
          schema::optional("free_diameter", quantity("m", 1e-3, 1.0), study.free_diameter_m,
                           "within which the probe may move")}};
  const schema::Map readings = {.name = "table, readings",
                                .keys = {compulsory("csv", text(), "a record, relative to the scenario"),
                                         compulsory("ambient", text(), "its channel of the ambient"),
                                         compulsory("x", text(), "its channel of the table along x"),
                                         compulsory("y", text(), "along y"), compulsory("z", text(), "along z")},
                                .about = "Readings of others to compare the computed table with."};
  return {.name = "table",
          .keys = {schema::optional("region", text(), "table", "of the mesh that the table is"),
                   compulsory("low", schema::vector3("m"), "corner of what is judged"),
                   compulsory("high", schema::vector3("m"), "the other, beyond `low` along x and y, at the same z"),
                   schema::optional("points_x", integer(2, 101), t.n_x, "points that are judged, along x"),
                   schema::optional("points_y", integer(2, 101), t.n_y, "along y"),
                   compulsory("head", schema::vector3("m"), "where the table is held along x and y: reading head or nut"),
                   compulsory("scale_x", schema::map(scale), "the scale along x"),
                   schema::optional("scale_y", schema::map(scale), Said{"none"}, "and along y"),
                   compulsory("rings", list(schema::map(ring), 2), "reference rings, two at least"),
                   compulsory("cyclogram", text(), "that the table is run through"),
                   schema::optional("measure_every", quantity("s", 60.0, 1e7), t.every_s,
                                    "between two measurements of the rings"),
                   schema::optional("probe_noise", quantity("m", 0.0, 1e-3), t.probe_noise_m, "of a ring's coordinate"),
                   schema::optional("tolerance", quantity("m", 1e-7, 1e-2), t.tolerance_m, "what an interval is looked for"),
                   compulsory("judge_until", quantity("s", 60.0, 1e8), "the shift ends here"),
                   compulsory("train_from", quantity("s", 0.0, 1e8),
                              "rings measured from here on teach the strategies by temperature"),
                   schema::optional("model_scatter", quantity("1", 0.0, 1.0), t.model_scatter,
                                    "of the model between measurements, in each power and coefficient"),
                   schema::optional("seed", integer(0, 1'000'000), t.seed, "of noise and scatter"),
                   schema::optional("sensor_noise", quantity("K", 0.0, 10.0), t.instrument.noise_K,
                                    "of all thermometers, white, 1 sigma"),
                   schema::optional("sensor_resolution", quantity("K", 0.0, 10.0), t.instrument.resolution_K,
                                    "step of their readings"),
                   schema::optional("sensor_mean", quantity("s", 0.0, 86400.0), t.sensor_mean_s,
                                    "over which readings are averaged, backwards; 0: the last one alone"),
                   compulsory("control", schema::map(control), "the control's own compensation"),
                   compulsory("probe", schema::map(probe), "the touch probe"),
                   schema::optional("readings", schema::map(readings), "of others to compare with")},
          .about = "A long table with scale, rings and probe; `run` is that study then (docs/how-to/table.md)."};
}

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
  t.region = in.text("region");
  t.low_m = in.vector3("low");
  t.high_m = in.vector3("high");
  if (!(t.low_m[0] < t.high_m[0] && t.low_m[1] < t.high_m[1])) in.fail("high", "`high` must lie beyond `low` along x and y");
  if (t.low_m[2] != t.high_m[2]) in.fail("low", "`low` and `high` differ in z; what is judged is the plane between them");
  t.n_x = in.integer("points_x");
  t.n_y = in.integer("points_y");
  t.head_m = in.vector3("head");
  t.scale_x = read_scale(in.map("scale_x"), sensors);
  if (const auto scale = in.optional_map("scale_y")) t.scale_y = read_scale(*scale, sensors);
  t.rings = read_rings(in, t);
  t.cyclogram = in.choice("cyclogram", cyclograms);
  t.every_s = in.quantity("measure_every");
  t.probe_noise_m = in.quantity("probe_noise");
  t.tolerance_m = in.quantity("tolerance");
  t.judge_until_s = in.quantity("judge_until");
  t.train_from_s = in.quantity("train_from");
  if (!(t.train_from_s >= t.judge_until_s))
    in.fail("train_from", "strategies are judged on what they were not fitted on; `train_from` comes after `judge_until`");
  t.model_scatter = in.quantity("model_scatter");
  t.seed = in.integer("seed");
  t.instrument.noise_K = in.quantity("sensor_noise");
  t.instrument.resolution_K = in.quantity("sensor_resolution");
  t.sensor_mean_s = in.quantity("sensor_mean");
  const ConfigMap control = in.map("control");
  t.thermometer = control.choice("sensor", sensors);
  t.update_s = control.quantity("update");
  t.velocity_m_s = control.quantity("velocity");
  t.slew = control.quantity("slew");
  if (control.has("origin")) t.origin_m = control.vector3("origin");
  t.against_dk = control.choice("axis_moves") == "against_dk";
  control.reject_unknown_keys();
  const ConfigMap probe = in.map("probe");
  t.ball_diameter_m = probe.quantity("ball_diameter");
  t.probe_tool = probe.integer("tool");
  t.probe = read_probe(probe);
  t.probe.ring_distance_m = t.rings.back().at_m[0] - t.rings.front().at_m[0];
  t.probe.seed = static_cast<std::uint64_t>(t.seed);
  if (const auto readings = in.optional_map("readings")) t.readings = read_readings(*readings);
  in.reject_unknown_keys();
  return t;
}

}  // namespace driftwright::scenarios
