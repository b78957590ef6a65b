// What a run of 1,000 moves costs on a reduced model that holds over the travel: bench/travel.sh builds and runs this.
//
//   travel_bench SCENARIO AXIS POSES   8 h, 1,000 moves of the axis between POSES evenly spaced positions of its range

#include "machine/travel.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "bench/timing.hpp"
#include "machine/moving_run.hpp"
#include "machine/run_record.hpp"
#include "machine/simulated_run.hpp"

int main(int argc, char** argv) {
  using namespace driftwright;
  if (argc < 4) return fmt::print(stderr, "travel_bench SCENARIO AXIS POSES\n"), 2;
  scenarios::Scenario scenario = scenarios::read_scenario(argv[1]);
  scenario.solver.model = scenarios::ModelKind::kReduced;
  scenarios::MachineModel& machine = *scenario.machine;
  std::size_t a = 0;
  while (a < machine.axes.size() && machine.axes[a].name != argv[2]) ++a;
  if (a == machine.axes.size()) return fmt::print(stderr, "no axis {}\n", argv[2]), 2;
  const scenarios::MovingAxis& axis = machine.axes[a];
  constexpr int kMoves = 1000;
  constexpr double kEach_s = 8 * 3600.0 / kMoves;
  const int n_poses = std::atoi(argv[3]);
  Cyclogram work{.name = "moves", .sections = {}};
  work.columns.push_back({axis.column, axis.unit(), {}});
  for (int i = 0; i < kMoves; ++i) {
    work.sections.push_back({kEach_s, {.speed_rpm = i / 100 % 2 == 0 ? 6000.0 : 3000.0}});
    work.columns[0].rows.time_s.push_back(i * kEach_s);
    work.columns[0].rows.value.push_back((axis.low_SI + (axis.high_SI - axis.low_SI) * (i * 7 % n_poses + 0.5) / n_poses) /
                                         axis.unit_SI());
  }
  const scenarios::Model model =
      scenarios::open_model(scenario, {&work}, {}, false, nullptr, nullptr, scenarios::Follows::kMoves);
  const std::vector<scenarios::Pose> poses = scenarios::further_poses(machine.axes, {&work});
  const double couple_s = least_s(
      1, [&] { (void)scenarios::at_poses(machine, *model.reduced(), poses, false, {}); }, thread_s);
  const std::vector<double> times_s = scenarios::output_times_s(work, 60.0);
  const double run_s = least_s(
      3,
      [&] {
        (void)scenarios::simulate_run(machine, scenario.solver.transient, model, scenarios::start_of(machine, model), work,
                                      times_s);
      },
      thread_s);
  fmt::print("{}: {}\n  8 h, {} moves between {} poses: {:.3f} s of one core to run, {:.3f} s to couple the poses\n",
             argv[1], model.words(), kMoves, n_poses, run_s, couple_s);
}
