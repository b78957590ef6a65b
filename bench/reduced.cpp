// What a cyclogram costs on reduced models: bench/reduced.sh builds and runs this.
//
//   reduced_bench SCENARIO CYCLOGRAM KEPT   one line per row of the table: processor time of a run (least of many), states,
//                                           decompositions. KEPT: folder for the reduced machine; another build of this
//                                           program that gets the same folder runs the same machine

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "bench/timing.hpp"
#include "machine/machine_key.hpp"
#include "machine/machine_store.hpp"
#include "machine/reduced_machine.hpp"
#include "machine/run_record.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_transient.hpp"

namespace {

using namespace driftwright;

/// Seven sections of 20 to 60 min at up to 2500 rpm, 300 min in all.
Cyclogram random_cyclogram(std::mt19937_64& engine) {
  const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1.0p-53; };
  Cyclogram c{.name = "random", .sections = {}};
  double left_s = 18000.0;
  for (int i = 0; i < 7; ++i) {
    const double duration_s = i == 6 ? left_s : std::floor(20 + 40 * uniform()) * 60.0;
    c.sections.push_back({std::min(duration_s, left_s), {.speed_rpm = 2500.0 * uniform()}});
    left_s -= c.sections.back().duration_s;
    if (left_s <= 0.0) break;
  }
  return c;
}

/// The least processor time of some repetitions [us].
template <class Work>
double least_us(int times, const Work& work) {
  return 1e6 * least_s(times, work, thread_s);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return fmt::print(stderr, "reduced_bench SCENARIO CYCLOGRAM KEPT\n"), 2;
  const scenarios::Scenario scenario = scenarios::read_scenario(argv[1]);
  const scenarios::MachineModel& model = *scenario.machine;
  std::vector<const Cyclogram*> cyclograms;
  for (const Cyclogram& c : scenario.cyclograms) cyclograms.push_back(&c);
  scenarios::ReductionPlan plan = scenarios::reduction_plan(scenario, cyclograms);
  plan.n_modes = 0;
  plan.with_fields = false;
  const std::string key = scenarios::machine_key(model, plan, "reduced_bench");
  auto kept = scenarios::load_machine(argv[3], key, effects::heat_balance(model.effects));
  if (!kept) {
    kept = scenarios::reduce(model, scenarios::build(model, scenarios::place(model), true, 0), plan);
    scenarios::save_machine(argv[3], key, *kept);
  }
  const scenarios::ReducedMachine& reduced = *kept;
  fmt::print("{}: {} states for {} unknowns, estimated error {:.2g} K, {:.2g} um\n", argv[1], reduced.system.size(),
             reduced.n_unknowns, reduced.error.temperature_K, 1e6 * reduced.error.displacement_m);

  const Cyclogram& cyclogram = scenario.cyclogram(argv[2]);
  const std::vector<double> times_s = scenarios::output_times_s(cyclogram, 60.0);
  if (!reduced.system.is_linear()) {
    solver::Trajectory run;
    const double with_laws_us = least_us(20, [&] {
      run = solver::simulate(reduced.system, cyclogram, model.ambient, times_s, scenario.solver.transient, reduced.start);
    });
    fmt::print("  {} with laws of temperature: {:.0f} us, {} steps\n", cyclogram.name, with_laws_us, run.n_steps);
    return 0;
  }
  const double fresh_us =
      least_us(50, [&] { (void)solver::Propagator(reduced.system).run(cyclogram, model.ambient, times_s, reduced.start); });
  solver::Propagator known(reduced.system);
  const double known_us = least_us(500, [&] { (void)known.run(cyclogram, model.ambient, times_s, reduced.start); });
  fmt::print("  {}: {:.0f} us with {} new decompositions, {:.1f} us when they are known\n", cyclogram.name, fresh_us,
             known.n_decompositions(), known_us);

  constexpr int kMany = 10000;
  std::mt19937_64 engine(1);
  double peak = 0.0;
  solver::Propagator propagator(reduced.system);
  const double many_us = least_us(1, [&] {
    for (int i = 0; i < kMany; ++i) {
      const Cyclogram random = random_cyclogram(engine);
      const auto run = propagator.run(random, model.ambient, scenarios::output_times_s(random, 60.0), reduced.start);
      peak = std::max(peak, run.outputs.row(run.outputs.rows() - 1).cwiseAbs().maxCoeff());
    }
  });
  fmt::print("  {} random cyclograms of 300 min: {:.2f} s of one core, largest value of the last output {:.3g}\n", kMany,
             1e-6 * many_us, peak);
}
