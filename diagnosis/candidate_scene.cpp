#include "diagnosis/candidate_scene.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {

Scene scene_of(const Twin& twin, const std::vector<MeasuredRun>& runs) {
  Scene s{.twin = twin, .runs = runs};
  s.own = twin.balance(twin.as_written());
  double turning_s = 0.0, turned = 0.0;
  for (const MeasuredRun& run : runs) {
    for (const auto& section : run.cyclogram.sections) {
      s.top_rpm = std::max(s.top_rpm, section.drive.speed_rpm);
      if (section.drive.speed_rpm > 0.0) turning_s += section.duration_s;
      turned += section.duration_s * section.drive.speed_rpm;
      for (double f : section.drive.feed_m_s) s.moves_axes = s.moves_axes || f > 0.0;
    }
    for (const MeasuredChannel& c : run.channels) {
      std::vector<std::string>& names = c.unit == "K" ? s.sensors : s.displacements;
      if (std::find(names.begin(), names.end(), c.name) == names.end()) names.push_back(c.name);
    }
  }
  if (turning_s > 0.0) {  // a round number near the mean speed: where laws of speed are stated
    const double mean_rpm = turned / turning_s, decade = std::pow(10.0, std::floor(std::log10(mean_rpm)));
    s.typical_rpm = std::max(1.0, std::round(mean_rpm / decade)) * decade;
  }
  s.heat_W = 0.0;
  for (const auto& h : s.own.heats) {
    if (h.power_W.probes.empty()) s.heat_W += std::abs(h.power_W(effects::Inputs{.drive = {.speed_rpm = s.top_rpm}}));
  }
  return s;
}

Knob knob(std::string name, std::string unit, double prior_sd, double step, std::function<void(TwinState&, double)> set) {
  Knob k;
  k.name = std::move(name);
  k.unit = std::move(unit);
  k.prior_sd = prior_sd;
  k.step = step;
  k.set = std::move(set);
  return k;
}

Knob factor(std::function<void(TwinState&, double)> set) {
  Knob k = knob("factor", "1", kFactor, 0.05, std::move(set));
  k.scale = Knob::Scale::kLog;
  k.nominal = 1.0;
  return k;
}

Knob on_readings(Knob k) {
  k.reading_only = true;
  return k;
}

Knob time_knob(std::string name, double run_length_s, std::function<void(TwinState&, double)> set) {
  Knob k = knob(std::move(name), "s", run_length_s / std::sqrt(12.0), 20.0, std::move(set));
  k.nominal = 0.5 * run_length_s;
  k.low = 0.0;
  k.high = run_length_s;
  k.is_time = true;
  return k;
}
std::vector<std::vector<double>> time_grid(double run_length_s, int n) {
  std::vector<std::vector<double>> grid;
  for (int i = 1; i < n; ++i) grid.push_back({run_length_s * (static_cast<double>(i) / n - 0.5)});
  return grid;
}

double length_s(const MeasuredRun& run) {
  return run.time_s.back();
}

std::vector<effects::Body> bodies(const Scene& s) {
  std::vector<effects::Body> list;
  for (const auto& p : s.twin.machine().system.parts) {
    const bool is_node =
        std::any_of(s.own.nodes.begin(), s.own.nodes.end(), [&](const auto& n) { return n.name == p.body; });
    list.push_back(is_node ? effects::node(p.body) : effects::region(p.body));
  }
  return list;
}

}  // namespace driftwright::diagnosis
