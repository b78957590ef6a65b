#include "studies/work_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "machine/run_record.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::studies {
namespace {

using scenarios::MachineModel, scenarios::VolumeSettings;

/// The longest error vector less that of another point at the same time.
LargestError largest_less(const WorkVolume& volume, const VolumePoint& other) {
  LargestError largest;
  for (std::size_t p = 0; p < volume.points.size(); ++p) {
    for (std::size_t t = 0; t < volume.time_s.size(); ++t) {
      const double error_m = (volume.points[p].error_m[t] - other.error_m[t]).norm();
      if (error_m > largest.error_m) largest = {p, t, error_m};
    }
  }
  return largest;
}

}  // namespace

double largest_error_m(const VolumePoint& point) {
  double largest_m = 0.0;
  for (const Eigen::Vector3d& error_m : point.error_m) largest_m = std::max(largest_m, error_m.norm());
  return largest_m;
}

LargestError largest_error(const WorkVolume& volume) {
  return largest_less(volume,
                      VolumePoint{.pose = {},
                                  .place_m = {},
                                  .error_m = std::vector<Eigen::Vector3d>(volume.time_s.size(), Eigen::Vector3d::Zero()),
                                  .turn_rad = {}});
}

LargestError largest_left(const WorkVolume& volume) {
  return largest_less(volume, volume.own);
}

WorkVolume study_volume(const scenarios::Scenario& scenario, const mesh::Mesh& drawn, const scenarios::Model& model,
                        const Listener& listener) {
  const MachineModel& machine = *scenario.machine;
  const VolumeSettings& settings = *scenario.volume;
  const Cyclogram& cyclogram = scenario.cyclogram(settings.cyclogram);
  WorkVolume volume{.time_s = settings.times_s, .points = {}, .own = {}, .run = {}};
  const auto n_times = static_cast<Eigen::Index>(volume.time_s.size());
  Eigen::MatrixXd theta_K(drawn.n_nodes(), n_times);
  listener.begin(fmt::format("placing the machine at {} poses", settings.n_poses()));  // before a long run that none needs
  for (std::size_t i = 0; i < settings.n_poses(); ++i) require_pose(machine, settings, drawn, settings.pose(i));
  if (settings.r_test)
    require_poses(volume.r_test.emplace(commanded_r_test(machine.axes, settings)), machine, settings, drawn);
  if (settings.ball_bar)
    require_poses(volume.ball_bar.emplace(commanded_ball_bar(machine.axes, settings)), machine, settings, drawn);
  listener.begin(fmt::format("simulating {:.0f} min", cyclogram.duration_s() / 60.0));
  const std::vector<double> rows_s = scenarios::output_times_s(cyclogram, scenario.solver.output_interval_s, volume.time_s);
  Eigen::Index next = 0;
  const scenarios::ReducedMachine* reduced = model.reduced();
  const auto nodes_K = [&](const Eigen::VectorXd& state) -> Eigen::VectorXd {
    return reduced ? reduced->node_temperature_K(state) : state.head(drawn.n_nodes());
  };
  const auto take = [&](double time_s, const Eigen::VectorXd& state) {
    listener.share(time_s / cyclogram.duration_s());
    while (next < n_times && volume.time_s[static_cast<std::size_t>(next)] <= time_s * (1.0 + 1e-9))  // as output_times_s()
      theta_K.col(next++) = nodes_K(state);
  };
  const Eigen::VectorXd start =
      scenarios::start_of(machine, model) + scenarios::warmer_start_K(machine, cyclogram) * scenarios::ones_of(model);
  const Eigen::VectorXd from = scenarios::after_what_was_before(machine, scenario.solver.transient, model, start, cyclogram);
  volume.run = scenarios::simulate_run(machine, scenario.solver.transient, model, from, cyclogram, rows_s, take);
  if (next < n_times) throw std::logic_error("study_volume: a time has no row");
  listener.begin(fmt::format("bending the machine at {} poses", settings.n_poses() + 1));
  volume.own = errors_at(machine, settings, drawn, scenarios::pose_of(machine.axes), theta_K);
  for (std::size_t i = 0; i < settings.n_poses(); ++i) {
    listener.share(static_cast<double>(i + 1) / static_cast<double>(settings.n_poses() + 1));
    volume.points.push_back(errors_at(machine, settings, drawn, settings.pose(i), theta_K));
  }
  if (volume.r_test) take_readings(*volume.r_test, machine, settings, drawn, theta_K, listener);
  if (volume.ball_bar) take_readings(*volume.ball_bar, machine, settings, drawn, theta_K, listener);
  return volume;
}

}  // namespace driftwright::studies
