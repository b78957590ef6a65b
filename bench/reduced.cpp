// What a cyclogram costs on reduced models: bench/reduced.sh builds and runs this.
//
//   reduced_bench SCENARIO CYCLOGRAM   one line per row of the table: the time of a run (least of many), states,
//                                      decompositions

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <random>

#include "bench/timing.hpp"
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

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return fmt::print(stderr, "reduced_bench SCENARIO CYCLOGRAM\n"), 2;
  const scenarios::Scenario scenario = scenarios::read_scenario(argv[1]);
  const scenarios::MachineModel& model = *scenario.machine;
  std::vector<const Cyclogram*> cyclograms;
  for (const Cyclogram& c : scenario.cyclograms) cyclograms.push_back(&c);
  scenarios::ReductionPlan plan = scenarios::reduction_plan(scenario, cyclograms);
  plan.n_modes = 0;
  plan.with_fields = false;
  scenarios::PlacedMachine placed = scenarios::place(model);
  const scenarios::Machine machine = scenarios::build(model, std::move(placed), true, 0);
  const double begin_s = now_s();
  const scenarios::ReducedMachine reduced = scenarios::reduce(model, machine, plan);
  fmt::print("{}: {} states for {} unknowns, reduced in {:.2f} s, estimated error {:.2g} K, {:.2g} um\n", argv[1],
             reduced.system.size(), reduced.n_unknowns, now_s() - begin_s, reduced.error.temperature_K,
             1e6 * reduced.error.displacement_m);

  const Cyclogram& cyclogram = scenario.cyclogram(argv[2]);
  const std::vector<double> times_s = scenarios::output_times_s(cyclogram, 60.0);
  if (!reduced.system.is_linear()) {
    solver::Trajectory run;
    const double with_laws_s = least_s(20, [&] {
      run = solver::simulate(reduced.system, cyclogram, model.ambient, times_s, scenario.solver.transient, reduced.start);
    });
    fmt::print("  {} with laws of temperature, by SUNDIALS: {:.0f} us, {} steps\n", cyclogram.name, 1e6 * with_laws_s,
               run.n_steps);
    return 0;
  }
  const double fresh_s =
      least_s(50, [&] { (void)solver::Propagator(reduced.system).run(cyclogram, model.ambient, times_s, reduced.start); });
  solver::Propagator known(reduced.system);
  const double known_s = least_s(500, [&] { (void)known.run(cyclogram, model.ambient, times_s, reduced.start); });
  fmt::print("  {}: {:.0f} us with {} new decompositions, {:.1f} us when they are known\n", cyclogram.name, 1e6 * fresh_s,
             known.n_decompositions(), 1e6 * known_s);

  constexpr int kMany = 10000;
  std::mt19937_64 engine(1);
  std::vector<Cyclogram> many;
  for (int i = 0; i < kMany; ++i) many.push_back(random_cyclogram(engine));
  std::vector<double> peak(kMany);
  const double many_begin_s = now_s();
#pragma omp parallel
  {
    solver::Propagator propagator(reduced.system);
#pragma omp for schedule(dynamic, 16)
    for (int i = 0; i < kMany; ++i) {
      const auto run = propagator.run(many[static_cast<std::size_t>(i)], model.ambient,
                                      scenarios::output_times_s(many[static_cast<std::size_t>(i)], 60.0), reduced.start);
      peak[static_cast<std::size_t>(i)] = run.outputs.row(run.outputs.rows() - 1).cwiseAbs().maxCoeff();
    }
  }
  fmt::print("  {} random cyclograms of 300 min on {} threads: {:.2f} s, largest value of the last output {:.3g}\n", kMany,
             omp_get_max_threads(), now_s() - many_begin_s, *std::max_element(peak.begin(), peak.end()));
}
