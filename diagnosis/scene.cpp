#include "diagnosis/scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/usual_step.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kLeastOfSpeed = 0.05;  // least share of the turning time on either side of a step of speed
constexpr std::size_t kMostSpeedSteps = 6;
constexpr double kLeastRatio = 1.1;  // least ratio of two speeds; closer ones are one speed measured twice

/// The material of a part: numbers that scatter and may be wrong.
effects::DoubtScene::Material material_of(const Twin& twin, const solver::BodyPart<Eigen::MatrixXd>& part) {
  const scenarios::MachineModel& model = twin.augmented().model;
  effects::DoubtScene::Material m;
  m.body = twin.body_of(part.body);
  m.conducts = part.conduction.cwiseAbs().maxCoeff() > 0.0;
  m.stores = part.mass.cwiseAbs().maxCoeff() > 0.0;
  m.capacity_J_K = twin.machine().system.ones.dot(part.mass * twin.machine().system.ones);  // ones: the state 1 K everywhere
  for (std::size_t o = model.sensors.size(); o < static_cast<std::size_t>(part.outputs.cols()); ++o) {
    if (!(part.outputs.col(static_cast<Eigen::Index>(o)).cwiseAbs().maxCoeff() > 0.0)) continue;
    const std::size_t d = o - model.sensors.size();
    // A sensitivity is a separate number, except for a region that also bends the mesh: both are one expansion.
    const bool bends =
        m.body.kind == effects::BodyKind::kRegion && (d >= model.displacements.size() || model.displacements[d].points);
    if (bends) {
      m.expands = true;
    } else {
      m.sensitivities.push_back(model.displacements[d].name);
    }
  }
  return m;
}

/// The largest increase of a heat by recorded quantities other than speed and feeds.
double most_of_record_W(const effects::HeatInput& heat, const std::vector<MeasuredRun>& runs, const TwinState& own) {
  const double at_rest_W = heat.power_W(effects::Inputs{});
  double most_W = 0.0;
  for (const MeasuredRun& run : runs) {
    const Cyclogram felt = effects::true_cyclogram(effects::drive_change(own, run.name), run.cyclogram);
    for (const auto& section : felt.sections) {
      const Drive& d = section.drive;
      const effects::Inputs at{.drive = {.cutting_power_W = d.cutting_power_W, .signals = d.signals}};
      most_W = std::max(most_W, std::abs(heat.power_W(at) - at_rest_W));
    }
  }
  return most_W;
}

/// The quantities that every record has besides the drive and that change, or are a cutting power.
std::vector<effects::DoubtScene::Column> columns_of(const std::vector<MeasuredRun>& runs, const TwinState& own) {
  std::vector<effects::DoubtScene::Column> columns;
  const auto add = [&](const std::string& name, const std::string& unit, const auto& values_of) {
    std::set<double> values;
    for (const MeasuredRun& run : runs) {
      const std::vector<double> of_run = values_of(run);
      if (of_run.empty()) return;
      values.insert(of_run.begin(), of_run.end());
    }
    if (values.size() < 2) return;
    effects::DoubtScene::Column c{.header = name + "_" + unit,
                                  .unit = unit,
                                  .span = *values.rbegin() - *values.begin(),
                                  .top = std::max(std::abs(*values.rbegin()), std::abs(*values.begin())),
                                  .n_levels = 0,
                                  .drives = {},
                                  .heats = {}};
    std::set<double> sizes;
    for (double v : values) sizes.insert(std::abs(v));
    c.n_levels = static_cast<int>(std::min<std::size_t>(3, sizes.size()));
    for (const effects::Effect& e : own) {
      const auto word = e.words.find("column");
      const bool cuts = name == "cutting_power" && e.kind->key == "cutting_heat";
      if (e.kind->contribute && (cuts || (word != e.words.end() && (word->second == name || word->second == c.header)))) {
        c.drives.push_back(e.body());
        if (cuts || e.has("gain")) c.heats.push_back(e.body());
      }
    }
    columns.push_back(c);
  };
  if (runs.empty()) return columns;
  add("cutting_power", "W", [](const MeasuredRun& run) {
    std::vector<double> values;
    for (const auto& section : run.cyclogram.sections) values.push_back(section.drive.cutting_power_W);
    return values;
  });
  for (const Cyclogram::Column& column : runs.front().cyclogram.columns) {
    add(column.name, column.unit, [&](const MeasuredRun& run) {
      const Cyclogram::Column* there = run.cyclogram.column(column.header());
      return there ? there->rows.value : std::vector<double>{};
    });
  }
  return columns;
}

/// Speeds between two speeds of the records, with enough time on either side; of many, those between the speeds furthest
/// apart.
std::vector<double> speed_steps_rpm(const std::vector<MeasuredRun>& runs) {
  std::map<double, double> time_s;  // by speed
  double turning_s = 0.0;
  for (const MeasuredRun& run : runs) {
    for (const auto& section : run.cyclogram.sections) {
      if (!(section.drive.speed_rpm > 0.0)) continue;
      time_s[section.drive.speed_rpm] += section.duration_s;
      turning_s += section.duration_s;
    }
  }
  std::vector<std::pair<double, double>> gaps;  // ratio of the two speeds, and the speed between them
  double slower_s = 0.0, slower_rpm = 0.0;
  for (const auto& [rpm, of_speed_s] : time_s) {
    if (std::min(slower_s, turning_s - slower_s) > kLeastOfSpeed * turning_s && rpm > kLeastRatio * slower_rpm)
      gaps.emplace_back(rpm / slower_rpm, 0.5 * (rpm + slower_rpm));
    slower_s += of_speed_s;
    slower_rpm = rpm;
  }
  std::sort(gaps.begin(), gaps.end(), std::greater<>());
  std::vector<double> steps_rpm;
  for (std::size_t i = 0; i < std::min(kMostSpeedSteps, gaps.size()); ++i) steps_rpm.push_back(gaps[i].second);
  return steps_rpm;
}

}  // namespace

double top_speed_rpm(const std::vector<MeasuredRun>& runs) {
  double top_rpm = 1.0;
  for (const MeasuredRun& run : runs) {
    for (const auto& section : run.cyclogram.sections) top_rpm = std::max(top_rpm, section.drive.speed_rpm);
  }
  return top_rpm;
}

effects::DoubtScene scene_of(const Twin& twin, const std::vector<MeasuredRun>& runs) {
  effects::DoubtScene s;
  s.reference_K = twin.reference_K();
  s.own = twin.as_written();
  s.balance = twin.balance(s.own);
  double turning_s = 0.0, turned = 0.0;
  for (const MeasuredRun& run : runs) {
    s.runs.push_back({run.name, run.time_s.back(), run.has_ambient, usual_step_s(run.time_s), run.start_K.size() > 0});
    const auto turns = [](const auto& section) { return section.drive.speed_rpm > 0.0; };
    const auto n_turning = std::count_if(run.cyclogram.sections.begin(), run.cyclogram.sections.end(), turns);
    if (n_turning > 0 && n_turning < static_cast<std::ptrdiff_t>(run.cyclogram.sections.size())) s.starts_and_stops = true;
    for (const auto& section : run.cyclogram.sections) {
      if (section.drive.speed_rpm > 0.0) turning_s += section.duration_s;
      turned += section.duration_s * section.drive.speed_rpm;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double feed_m_s = section.drive.feed_m_s[axis];
        s.top_feed_m_s[axis] = std::max(s.top_feed_m_s[axis], feed_m_s);
        s.axis_rests[axis] = s.axis_rests[axis] || feed_m_s == 0.0;
      }
    }
    for (const MeasuredChannel& c : run.channels) {
      if (c.unit == "K") {
        if (std::find(s.sensors.begin(), s.sensors.end(), c.name) == s.sensors.end()) s.sensors.push_back(c.name);
      } else if (std::none_of(s.displacements.begin(), s.displacements.end(),
                              [&](const auto& d) { return d.name == c.name; })) {
        s.displacements.push_back({c.name, c.unit == "rad"});
      }
    }
  }
  s.turns = turning_s > 0.0;
  s.speed_steps_rpm = speed_steps_rpm(runs);
  if (s.turns) {  // a round number near the mean speed, at which laws of speed are stated
    const double mean_rpm = turned / turning_s, decade = std::pow(10.0, std::floor(std::log10(mean_rpm)));
    s.typical_rpm = std::max(1.0, std::round(mean_rpm / decade)) * decade;
  }
  for (const MeasuredRun& run : runs) {  // of the real drive, as written
    for (const auto& section : effects::true_cyclogram(effects::drive_change(s.own, run.name), run.cyclogram).sections)
      s.top_rpm = std::max(s.top_rpm, section.drive.speed_rpm);
  }
  s.heat_W = 0.0;
  const effects::Inputs top{.drive = {.speed_rpm = top_speed_rpm(runs)}};
  for (const auto& h : s.balance.heats) {
    if (h.power_W.probes.empty()) s.heat_W += std::abs(h.power_W(top)) + most_of_record_W(h, runs, s.own);
  }
  s.columns = columns_of(runs, s.own);
  for (const scenarios::Sensor& sensor : twin.augmented().model.sensors) {
    if (const auto* on_node = std::get_if<std::string>(&sensor.place))
      s.sensor_bodies[sensor.name] = *on_node == effects::kAmbientName ? effects::ambient_node() : effects::node(*on_node);
  }
  const auto& system = twin.machine().system;
  for (const auto& part : system.parts) {
    const effects::Body body = twin.body_of(part.body);
    s.materials.push_back(material_of(twin, part));
    if (body.kind != effects::BodyKind::kSurface) s.bodies.push_back(body);
  }
  for (const auto& source : system.sources) {
    const bool is_listed = std::find(s.surfaces.begin(), s.surfaces.end(), source.body.name) != s.surfaces.end();
    if (source.body.kind == effects::BodyKind::kSurface && !is_listed) s.surfaces.push_back(source.body.name);
  }
  return s;
}

}  // namespace driftwright::diagnosis
