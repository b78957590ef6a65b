// Options of the verbs that compute on a scenario.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "app/common_options.hpp"
#include "app/verb_options.hpp"
#include "nc/controls.hpp"
#include "scenarios/reader/read_schedule.hpp"

namespace driftwright::app {

void add_run(CLI::App& cli, CommonOptions& options) {
  add_verb(
      cli, "run",
      "simulates the machine, fits predictors on the training cyclograms, and judges their corrections on another cyclogram",
      "run scenarios/fp3_spindle.yaml", options)
      ->callback([&] { app::run(options); });
}

void add_check(CLI::App& cli, CommonOptions& options) {
  add_verb(
      cli, "check",
      "reads and meshes a scenario, places its sensors and reports implausible values; lumped machines are also simulated",
      "check scenarios/fp3_spindle.yaml", options)
      ->callback([&] { app::check(options); });
}

void add_mesh(CLI::App& cli, MeshOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "mesh",
      "builds or reads a mesh, reports its quality, draws its named surfaces and writes mesh.vtu; with --convergence: says "
      "whether it is fine enough (docs/how-to/meshes.md)");
  verb->add_option(
          "scenario", options.scenario,
          "scenario file (only its mesh is used, unless --convergence), or a mesh or drawing: .step, .msh, .inp, .vtu")
      ->required();
  verb->add_option("--units", options.units,
                   "unit of length of a mesh or drawing: mm, cm, m or inch [guessed from the size]");
  CLI::Option* convergence = verb->add_flag(
      "--convergence", options.convergence,
      "runs one cyclogram on three mesh sizes and estimates the error that the mesh causes in each displacement and "
      "thermometer");
  verb->add_option(
          "--cyclogram", options.cyclogram,
          "cyclogram for --convergence: a name in the scenario, or a record CSV with the column speed_rpm [the first "
          "of the scenario]")
      ->needs(convergence);
  verb->add_option(
          "--most-elements", options.most_elements,
          "largest number of elements of a mesh that --convergence makes finer than the scenario's own; if it would "
          "have more, two coarser meshes are made instead")
      ->needs(convergence)
      ->check(CLI::Range(1, 5000000))
      ->capture_default_str();
  add_results(verb, options, "<name of the scenario>",
              "mesh scenarios/fp3_spindle.yaml -o results/mesh\n  driftwright mesh scenarios/parts/vertical_mill.step -o "
              "results/drawing");
  verb->callback([&] { app::mesh(options); });
}

/// The verb `init`, a first scenario: it makes a folder of its own.
void add_init(CLI::App& cli, InitOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "init", "writes a first scenario with comments that runs at once, from a drawing, a mesh, or as two lumped nodes");
  verb->add_option("folder", options.folder, "folder to create; the scenario gets its name")->required();
  verb->add_option("--from", options.from,
                   "drawing or mesh (.step, .msh, .inp, .vtu), which is copied into the folder; or lumped, for bodies "
                   "without geometry")
      ->capture_default_str();
  verb->add_option(
      "--units", options.units,
      "unit of length of the mesh, or of a drawing that states a wrong one: mm, cm, m or inch [guessed from the size]");
  verb->footer(
      "Example:\n  driftwright init results/mill --from scenarios/parts/vertical_mill.step\n  driftwright init "
      "results/two_nodes");
  verb->callback([&] { app::init(options); });
}

void add_simulate(CLI::App& cli, SimulateOptions& options) {
  CLI::App* verb = add_verb(cli, "simulate",
                            "simulates cyclograms: temperatures, drift and heat flows; for a single cyclogram also fields",
                            "simulate scenarios/fp3_spindle.yaml --cyclogram warm_up_2000 -o results/warm_up", options);
  verb->add_option("--cyclogram", options.cyclograms,
                   "cyclogram to simulate: a name in the scenario, or a record CSV with the column speed_rpm; may be "
                   "repeated [all of the scenario]")
      ->allow_extra_args(false);
  verb->add_option("--pose", options.pose,
                   "position of an axis of the scenario, such as x=200mm or c=30deg; may be repeated [`at` of `axes`]")
      ->allow_extra_args(false);
  verb->add_flag("--distributed", options.distributed,
                 "the finite elements over the processes of mpirun, in a build with MPI (docs/how-to/distributed.md)");
  verb->callback([&] { app::simulate(options); });
}

void add_predict(CLI::App& cli, PredictOptions& options) {
  CLI::App* verb =
      add_verb(cli, "predict",
               "predicts the drift of a cyclogram before it runs, with the reduced model, from a cold or a warm machine",
               "predict scenarios/fp3_spindle.yaml --cyclogram scenarios/records/plan.csv -o results/plan", options);
  verb->add_option("--cyclogram", options.cyclogram,
                   "cyclogram to predict: a name in the scenario, or a record CSV with the column speed_rpm "
                   "(docs/how-to/cyclograms.md)")
      ->required();
  add_warm_start(verb, options.start, options.after_pause, options.model);
  verb->callback([&] { app::predict(options); });
}

void add_warmup(CLI::App& cli, WarmUpVerbOptions& options) {
  CLI::App* verb = add_verb(
      cli, "warmup", "finds the shortest warm-up after which a job stays within its tolerance (docs/how-to/warmup.md)",
      "warmup scenarios/fp3_spindle.yaml --then chaotic --tolerance '12 um' -o results/warmup", options);
  verb->add_option("--then", options.then,
                   "the job after the warm-up: a cyclogram of the scenario, a record CSV or an NC program")
      ->required();
  verb->add_option("--tolerance", options.tolerance,
                   "largest drift allowed during the job, such as '10 um' [the study's tolerance, else 10 um]");
  CLI::Option* margin =
      verb->add_option("--margin", options.margin,
                       "share of the tolerance that is kept in reserve for errors of the model, such as '20 %' [none]");
  verb->add_option("--model-error", options.model_error,
                   "how wrong each heat source, film, joint and link of the model may be (one sigma), such as '20 %'. The "
                   "program then chooses the margin so that 95 of 100 such machines keep the tolerance")
      ->excludes(margin);
  verb->add_option("--speed-limit", options.speed_limit,
                   "highest speed of the warm-up, such as '3000 rpm' [the highest of the scenario and the job]");
  verb->add_option("--power-limit", options.power_limit,
                   "largest heat input of the warm-up by the spindle speed, such as '150 W' [none]");
  verb->add_option("--time-limit", options.time_limit, "longest warm-up that is tried, such as '2 h' [4 h]");
  verb->add_option("--channel", options.channels, "displacement that must keep the tolerance; may be repeated [all]")
      ->allow_extra_args(false);
  add_warm_start(verb, options.start, options.after_pause, options.model);
  verb->callback([&] { app::warmup(options); });
}

void add_place(CLI::App& cli, PlaceOptions& options) {
  CLI::App* verb = add_verb(
      cli, "place", "finds where to mount thermometers, how many, and which test they need (docs/how-to/placement.md)",
      "place scenarios/fp3_spindle.yaml --count 4 --exclude table -o results/place", options);
  verb->add_option("--count", options.count,
                   "number of thermometers to place, 1 to 12 [`sensors_to_choose` of the study, else 4]");
  verb->add_option("--region", options.regions,
                   "region that may carry thermometers; may be repeated [all, except those whose names say that they turn, "
                   "flow or hang]")
      ->allow_extra_args(false);
  verb->add_option("--exclude", options.excluded, "region that may not carry thermometers; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--mounted", options.mounted,
                   "sensor of the scenario that is already mounted; it is used as well and never fails; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--channel", options.channels,
                   "displacement that the thermometers must predict; may be repeated [the study's target, else all]")
      ->allow_extra_args(false);
  verb->add_option("--for", options.placed_for, "predictor that uses the thermometers: observer, regression or both [both]")
      ->check(CLI::IsMember({"both", "observer", "regression"}));
  verb->add_flag("--none-fails", options.none_fails,
                 "assumes that all thermometers work; without it, any one of them may fail");
  verb->add_option("--train", options.train,
                   "cyclogram by which places are chosen; may be repeated [those that `validation` trains on, else all]")
      ->allow_extra_args(false);
  verb->add_option("--test", options.test,
                   "cyclogram by which the choice is judged; may be repeated [those of `validation`, else random ones]")
      ->allow_extra_args(false);
  verb->add_option("--noise", options.noise,
                   "noise of one reading (1 sigma), such as '0.1 K' [that of `validation`, else 0.1 K]");
  verb->add_option("--points", options.points, "number of points of a mesh that are tried, 50 to 3000 [400]");
  add_shards(verb, options, "the work");
  verb->callback([&] { app::place(options); });
}

void add_plan_test(CLI::App& cli, PlanTestOptions& options) {
  CLI::App* verb =
      add_verb(cli, "plan-test",
               "plans a test before anything is measured, so that `diagnose` can name as many faults as possible "
               "(docs/how-to/test_planning.md)",
               "plan-test scenarios/first_machine.yaml --time '8 h' -o results/plan_test", options);
  verb->add_option("--time", options.time, "length of the test, such as '4 h' [8 h]");
  verb->add_option("--speed-limit", options.speed_limit,
                   "highest speed of the test, such as '3000 rpm' [the highest of the scenario's cyclograms]");
  verb->add_option("--interval", options.interval,
                   "time from reading to reading during the test, such as '30 s' [the scenario's output_interval]");
  verb->add_option("--noise-temperature", options.noise_K,
                   "standard deviation of one reading of a thermometer, such as '0.1 K' [0.05 K]");
  verb->add_option("--noise-displacement", options.noise_um,
                   "standard deviation of one reading of a displacement, such as '1 um' [0.5 um]");
  verb->add_option("--programmes", options.n_programmes,
                   "number of test programmes that are tried [10000, fewer for large machines]")
      ->check(CLI::Range(10, 10000000));
  verb->add_option("--seed", options.seed, "seed of the random search; the same seed gives the same plan [1]");
  add_shards(verb, options, "the work");
  verb->callback([&] { app::plan_test(options); });
}

void add_probe_plan(CLI::App& cli, ProbePlanOptions& options) {
  CLI::App* verb =
      add_verb(cli, "probe-plan",
               "plans the fewest probings that keep a corrected axis within its tolerance during a job, at tool "
               "changes, halts, rests and between parts (docs/how-to/probing.md)",
               "probe-plan scenarios/fp3_spindle.yaml --job scenarios/parts/fp3_part.ngc --parts 4 --between '5 "
               "min' --model results/probed/models/no_correction.json --tolerance '12 um' -o results/probe_plan",
               options);
  verb->add_option("--job", options.job,
                   "the job: a cyclogram of the scenario, a record CSV with the column speed_rpm, or an NC program")
      ->required();
  verb->add_option(
          "--model", options.model,
          "predictor that corrects the axis: a file models/NAME.json written by `validate`; no_correction.json: the "
          "last probing alone corrects it")
      ->required();
  verb->add_option("--tolerance", options.tolerance,
                   "what the corrected axis may be off at each moment of the work with 95 %, such as '10 um' [the study's "
                   "tolerance, else 10 um]");
  verb->add_option(
      "--margin", options.margin,
      "share of the tolerance that is kept free for all that is not thermal, such as '50 %'; `follow` asks for a "
      "probing at 50 % [none]");
  verb->add_option("--probe-noise", options.noise,
                   "standard deviation of a probing, such as '1 um' [that of the model's file]");
  verb->add_option("--probe-lag", options.lag,
                   "time from the touch until the correction has its value, such as '20 s' [that of the model's file]");
  verb->add_option("--probing-time", options.probing_time, "time that a probing takes, such as '90 s' [2 min]");
  verb->add_option("--parts", options.parts, "number of parts that are made one after another")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb->add_option("--between", options.between, "time at rest between two parts, such as '2 min' [none]");
  CLI::Option* gauge = verb->add_option(
      "--gauge", options.gauge,
      "also writes the touch cycle of the axis for each control: X, Y and Z of the probe's tip in machine coordinates as it "
      "touches a fixed gauge, such as '400 mm, 250 mm, -310 mm'; the offset that it finds is added, within limits");
  verb->add_option("--touch", options.touch, "axis and direction of this touch; z is touched downward")
      ->check(CLI::IsMember({"z", "x+", "x-", "y+", "y-"}))
      ->capture_default_str()
      ->needs(gauge);
  verb->add_option(
          "--probe-tool", options.probe_tool,
          "number of the probe in the tool table of LinuxCNC; with any other tool in the spindle nothing is touched")
      ->check(CLI::Range(1, 99999))
      ->needs(gauge);
  CLI::Option* points =
      verb->add_option(
              "--points", options.points,
              "record CSV with errors of several points (rings, spheres, the spindle nose) as displacements in um, of "
              "`simulate` or measured; also says which of the points to probe. Of a scenario with `table`: its record.csv, "
              "which says what its rings do; may be repeated")
          ->allow_extra_args(false);
  verb->add_option("--may-probe", options.may_probe,
                   "displacement of these records that can be probed; may be repeated [all that they share]")
      ->needs(points)
      ->allow_extra_args(false);
  verb->add_option("--counts", options.counting,
                   "displacement of these records whose error must be known; may be repeated [all that they share]")
      ->needs(points)
      ->allow_extra_args(false);
  verb->callback([&] { app::probe_plan(options); });
}

void add_schedule(CLI::App& cli, ScheduleVerbOptions& options) {
  CLI::App* verb = add_verb(
      cli, "schedule",
      "predicts the drift that an NC program will cause and writes corrections into the program (docs/how-to/schedule.md)",
      "schedule scenarios/fp3_spindle.yaml --program scenarios/parts/fp3_part.ngc -o results/part", options);
  verb->add_option("--program", options.program, "NC program for " + enumerated(of_each_control(&NcControl::title), " or "))
      ->required();
  verb->add_option("--policy", options.policy,
                   "when offsets change: paper (by steps of the tolerance) or minimal (as few changes as possible) [the "
                   "scenario's, else minimal]")
      ->check(CLI::IsMember(scenarios::kSchedulePolicies));
  verb->add_option("--dialect", options.dialect,
                   fmt::format("language of the program: {} [the scenario's, else {}]",
                               enumerated(of_each_control(&NcControl::key), " or "), nc_controls().front().key))
      ->check(CLI::IsMember(of_each_control(&NcControl::key)));
  verb->add_flag("--beyond", options.beyond,
                 "also accepts blocks beyond the limits of the machine; corrections are not changed there");
  verb->add_flag("--split", options.split, "divides straight blocks in which one offset cannot keep the tolerance");
  add_warm_start(verb, options.start, options.after_pause, options.model);
  verb->add_option("--parts", options.parts, "number of parts that are made one after another [the scenario's, else 1]")
      ->check(CLI::Range(1, 1000));
  verb->add_option("--between", options.between,
                   "time at rest between two parts, such as '2 min' [the scenario's, else none]");
  verb->callback([&] { app::schedule(options); });
}

void add_sweep(CLI::App& cli, SweepOptions& options) {
  CLI::App* verb = add_verb(
      cli, "sweep", "simulates many variants of one scenario and writes one table of results (docs/how-to/sweep.md)",
      "sweep scenarios/lumped_sweep.yaml\n  driftwright sweep scenarios/lumped_sweep.yaml --shard 1/2 -o results/shards\n  "
      "driftwright sweep scenarios/lumped_sweep.yaml --shard 2/2 -o results/shards\n  "
      "driftwright sweep scenarios/lumped_sweep.yaml --merge -o results/shards",
      options, "study");
  add_shards(verb, options, "the members");
  verb->callback([&] { app::sweep(options); });
}

}  // namespace driftwright::app
