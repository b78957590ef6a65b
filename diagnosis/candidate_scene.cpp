#include "diagnosis/candidate_scene.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {

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
