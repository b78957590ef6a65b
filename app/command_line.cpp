#include "app/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>

#include "app/cli_documents.hpp"
#include "app/exit_code.hpp"
#include "app/follow.hpp"
#include "app/verbs.hpp"
#include "base/config_map.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/version.hpp"
#include "scenarios/reader/read_cyclogram.hpp"
#include "scenarios/reader/read_schedule.hpp"

namespace {

using namespace driftwright;

using app::kDone, app::kWrongInput;

/// Adds the options that all verbs with a folder of results have; `example` ends the help.
void add_results(CLI::App* verb, app::CommonOptions& options, const std::string& folder, const std::string& example) {
  verb->add_option("-o,--out", options.out, "folder of results [results/" + folder + "]");
  verb->add_flag("--force", options.force, "replace the folder of results even if it holds other files");
  CLI::Option* json =
      verb->add_flag("--json", options.json, "print the results as JSON, as in summary.json, in place of text");
  CLI::Option* quiet = verb->add_flag("--quiet", options.quiet, "print neither results nor progress");
  verb->add_flag("--details", options.details, "print all tables of the report")->excludes(json)->excludes(quiet);
  json->excludes(quiet);
  verb->add_option_function<int>(
          "--threads", [](int n) { omp_set_num_threads(n); }, "threads to compute with [OMP_NUM_THREADS, else all cores]")
      ->check(CLI::Range(1, 1024));
  verb->footer("Example:\n  driftwright " + example);
}

/// Adds a verb with the common options; `input` says what its file describes.
CLI::App* add_verb(CLI::App& app, const std::string& name, const std::string& what, const std::string& example,
                   app::CommonOptions& options, const std::string& input = "scenario") {
  CLI::App* verb = app.add_subcommand(name, what);
  verb->add_option(input, options.scenario, input + " YAML")->required();
  add_results(verb, options, "<name of the " + input + ">", example);
  verb->add_flag("--strict", options.strict,
                 "refuse implausible values instead of warning about them (docs/reference/scenario.md, Plausibility)");
  return verb;
}

/// Adds the options of verbs whose work several processes may share. @param parts  what the work consists of, in words
void add_shards(CLI::App* verb, app::ShardOptions& options, const std::string& parts) {
  verb->add_option("--shard", options.shard,
                   "i/n: do the i-th of n parts of " + parts + " alone, as a task of a job array does");
  verb->add_flag("--merge", options.merge, "put together what all shards have done");
}

/// @param judges  true for a verb that also tests, and that needs no records where the scenario has a programme
void add_records(CLI::App* verb, app::RecordOptions& options, bool judges) {
  verb->add_option("--train", options.train, "record to fit on, or a part of it: run.csv:0h..20h; may be repeated")
      ->required(!judges)
      ->allow_extra_args(false);
  if (!judges) return;
  verb->add_option("--test", options.test, "record to judge on, or a part of it: run.csv:20h..28h; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--target", options.target, "displacement of the records to predict, for a scenario without `study`");
}

/// Adds the options for the state in which a prediction begins.
void add_warm_start(CLI::App* verb, std::string& start, std::string& after_pause, std::string& model) {
  CLI::Option* record = verb->add_option("--start", start,
                                         "what the machine did before, a record CSV as `simulate` writes it or a cyclogram "
                                         "of the scenario: the model runs it first [cold]");
  verb->add_option("--after-pause", after_pause, "time at rest after it, such as '30 min' [none]")->needs(record);
  verb->add_option("--model", model, "reduced or full [reduced; full for lumped nodes alone where the scenario has it]")
      ->check(CLI::IsMember({"reduced", "full"}));
}

/// The verb `inject`, a filter: it has no scenario and no folder of results.
void add_inject(CLI::App& cli, app::InjectOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "inject", "encoder rows \"A B\" from standard input, with a correction inserted, to standard output");
  verb->add_option("--correction", options.correction,
                   "CSV by row or time, or a FIFO with one number a line: the tool's error (actual - commanded)")
      ->required();
  verb->add_option("--period", options.period, "travel of one signal period, such as '4 um'; for corrections in um");
  verb->add_option("--row-time", options.row_time, "time of one row, such as '1 ms'; for corrections by time");
  verb->add_option("--unit", options.unit, "of numbers from a FIFO")
      ->check(CLI::IsMember({"um", "count"}))
      ->capture_default_str();
  verb->add_option("--counts", options.counts, "how the control counts: a cycle is 4, 2 or 1 counts")
      ->check(CLI::IsMember({"x4", "x2", "x1"}))
      ->capture_default_str();
  verb->add_option("--insert", options.insert, "what is inserted at once; less than a cycle shifts the phase")
      ->check(CLI::IsMember({"cycle", "half", "quarter"}))
      ->capture_default_str();
  verb->add_flag("--anywhere", options.anywhere, "insert also while a line is high");
  verb->add_option("--column", options.column,
                   "of a table of several columns [predicted_um], or axis of lines that `follow` writes [the only one]");
  CLI::Option* on_fault =
      verb->add_option("--on-fault", options.on_fault,
                       "what happens at an invalid row, or at an invalid correction from a FIFO: hold (the value before it "
                       "holds) or bypass (the correction is withdrawn until the next good one)")
          ->check(CLI::IsMember({"hold", "bypass"}))
          ->capture_default_str();
  verb->add_flag("--strict", options.strict, "an invalid row or correction ends the run, with exit code 2")
      ->excludes(on_fault);
  verb->add_flag("--bypass", options.bypass, "pass all bytes on as they are");
  verb->add_flag("--clocked", options.clocked,
                 "one row out for each row in, as in a running simulation; else inserted rows are added");
  verb->add_option("--separation", options.separation, "with --clocked: least rows from edge to edge")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  verb->add_option("--interval", options.interval, "with --clocked: least rows from insertion to insertion (the slew)")
      ->check(CLI::Range(1, 1000000000))
      ->capture_default_str();
  verb->add_option("--vcd", options.vcd, "value change dump of the lines before and after");
  verb->add_option("--halstream", options.halstream, "rows for LinuxCNC's halstreamer");
  verb->add_option("--hal", options.hal, "HAL file that plays them into LinuxCNC's encoder");
  verb->add_option("--log", options.log, "CSV of counts in, inserted and out");
  verb->footer(
      "Example:\n  driftwright inject --correction scenarios/records/drift.csv --period '4 um' --row-time '1 ms' < "
      "scenarios/records/encoder_rows.txt > injected_rows.txt\n"
      "  with drift.csv: 'time_s,drift_um', then '0,0', '0.5,6', ... (docs/how-to/injector.md)");
  verb->callback([&] { app::inject(options); });
}

/// The verb `follow`, beside a running machine: it has no folder of results.
void add_follow(CLI::App& cli, app::FollowVerbOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "follow",
      "rows of a running machine from standard input, its correction after each to standard output (docs/how-to/follow.md)");
  verb->add_option("model", options.models,
                   "a file models/NAME.json that `validate` has written, or a scenario; several for several axes")
      ->required();
  verb->add_flag("--despite-verdict", options.despite_verdict,
                 "follow a model that `validate` calls unsafe, too; never on a machine that cuts");
  verb->add_option(
      "--columns", options.columns,
      "scenario whose key `columns` says how the rows are written [as records], or `topics` where they come from");
  CLI::Option* replay = verb->add_option("--replay", options.replay, "rows from a file in place of standard input");
  verb->add_option("--pace", options.pace,
                   "speed of the replay, as a multiple of the pace of its rows [as fast as possible]")
      ->needs(replay);
  CLI::Option* mqtt =
      verb->add_option("--mqtt", options.mqtt, "MQTT broker HOST or HOST:PORT in place of standard input")->excludes(replay);
  CLI::Option* from =
      verb->add_option("--from", options.from, "topic whose messages are rows, such as {\"time_s\": 60, \"t01_degC\": 21.5}")
          ->needs(mqtt);
  verb->add_option(
          "--sparkplug", options.sparkplug,
          "edge node of Sparkplug B at the broker, GROUP/NODE or GROUP/NODE/DEVICE; --topic then says metrics by name")
      ->needs(mqtt)
      ->excludes(from);
  CLI::Option* agent =
      verb->add_option("--mtconnect", options.mtconnect,
                       "address of an MTConnect agent in place of standard input, such as http://10.0.0.7:5000")
          ->excludes(replay)
          ->excludes(mqtt);
  verb->add_flag("--sample", options.sample,
                 "read all observations of the agent (/sample) at their own times, not only the latest ones")
      ->needs(agent);
  verb->add_option("--topic", options.topics,
                   "channel and its topic, such as t01_degC=shop/mill/t01, whose messages are numbers, the id or name of "
                   "the agent's data item, or the metric of the node; may be repeated [the scenario's key `topics`]")
      ->excludes(from)
      ->allow_extra_args(false);
  verb->add_option("--every", options.every, "time from row to row that is made of --topic")->capture_default_str();
  verb->add_option("--to", options.to, "topic that lines go to beside standard output")->needs(mqtt);
  verb->add_option("--state", options.state,
                   "file in which the state is saved every second, and from which a restart continues");
  verb->add_option("--record", options.record, "record CSV into which the rows that were used are written");
  CLI::Option* serve =
      verb->add_option("--serve", options.serve,
                       "port of a page for browsers: machine, drift, correction, trust, alarms; 0: any that is free");
  verb->add_option("--bind", options.bind, "address that the page is served at; beyond loopback --token is required")
      ->needs(serve)
      ->capture_default_str();
  verb->add_option("--token", options.token,
                   "token that each request for the page must contain, or @FILE, whose first line is the token")
      ->needs(serve);
  verb->add_option("--slew", options.slew,
                   "how fast a correction may change, such as '0.5 um/s' [as the model was fitted, else 1 um/s]");
  verb->add_option(
      "--hold", options.hold,
      "time for which a correction holds without a new row, such as '5 min' [as the model was fitted, else 5 min]");
  verb->add_option("--fade", options.fade,
                   "time constant with which it fades afterwards [as the model was fitted, else 10 min]");
  CLI::Option* watch = verb->add_option(
      "--watch", options.watch,
      "limits of a watch, which reports during the run that the machine is not as modelled; for an observer");
  CLI::Option* calibrate = verb->add_option("--calibrate-watch", options.calibrate_watch,
                                            "compute such limits by simulation and write them; nothing is followed")
                               ->excludes(watch)
                               ->excludes(replay);
  verb->add_option("--top-speed", options.top_speed, "top speed of the spindle in these simulations, such as '2500 rpm'")
      ->needs(calibrate);
  verb->footer(
      "Example:\n  driftwright follow scenarios/fp3_spindle.yaml --replay scenarios/records/monday.csv > lines.txt\n  "
      "driftwright "
      "follow results/validation/models/observer.json --state axis.state < scenarios/records/monday.csv > lines.txt");
  verb->callback([&] { app::follow_stream(options); });
}

/// The verb `export`, a model for other programs: it writes one file.
void add_export(CLI::App& cli, app::ExportOptions& options) {
  CLI::App* verb =
      cli.add_subcommand("export", "the reduced machine or an observer as a functional mock-up unit (docs/how-to/fmu.md)");
  verb->add_option("scenario", options.scenario, "scenario YAML")->required();
  verb->add_flag("--fmu", options.fmu, "as a functional mock-up unit (FMI), C sources and linux64 binary inside");
  verb->add_option("-o,--out", options.out, "file NAME.fmu [results/<name of the scenario>.fmu]");
  verb->add_option("--fmi", options.fmi, "version of the standard: 2 or 3")
      ->check(CLI::IsMember({2, 3}))
      ->capture_default_str();
  verb->add_option("--of", options.of, "machine, or observer with --model")
      ->check(CLI::IsMember({"machine", "observer"}))
      ->capture_default_str();
  verb->add_option("--type", options.type, "me (model exchange), cs (co-simulation) or both")
      ->check(CLI::IsMember({"me", "cs", "both"}))
      ->capture_default_str();
  verb->add_option("--model", options.model, "file of an observer that `validate` has written, models/observer.json");
  verb->footer(
      "Example:\n  driftwright export scenarios/fp3_spindle.yaml --fmu -o machine.fmu\n  driftwright export "
      "scenarios/fp3_spindle.yaml --fmu --fmi 3 --of observer --model results/validation/models/observer.json -o "
      "observer.fmu");
  verb->callback([&] { app::export_model(options); });
}

void add_identify(CLI::App& cli, app::IdentifyOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "identify",
      "a network of bodies from records alone, as a scenario that every verb runs (docs/how-to/identification.md)");
  verb->add_option("--record", options.records,
                   "record CSV or logger's file with what drives the machine (rpm, W, V, %), its ambient and readings "
                   "(degC, um); may be repeated")
      ->required()
      ->allow_extra_args(false);
  verb->add_option("--ambient", options.ambient, "channel of the ambient temperature [by its name, else guessed, and said]");
  verb->add_option(
          "--drive", options.drives,
          "channel that drives the machine though its unit does not say so, such as a bed's temperature; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--prior", options.prior,
                   "a scenario to start from: what it does not explain of the records is learned in addition to its physics "
                   "and written as extended.yaml, where rows that were kept out confirm it; --ambient and --drive are then "
                   "those of the scenario")
      ->excludes("--ambient")
      ->excludes("--drive");
  add_results(verb, options, "<name of the first record>",
              "identify --record scenarios/records/monday.csv --record scenarios/records/tuesday.csv -o "
              "results/identified\n  driftwright simulate "
              "results/identified/monday.yaml -o results/identified_run\n  driftwright identify --prior "
              "scenarios/fp3_spindle.yaml --record scenarios/records/monday.csv --record scenarios/records/tuesday.csv -o "
              "results/learned");
  verb->callback([&] { app::identify(options); });
}

void add_import(CLI::App& cli, app::ImportOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "import",
      "a logger's file as a record CSV of the same name, with what was understood of it (docs/reference/record.md)");
  verb->add_option("file", options.scenario,
                   "of a logger or a control: text with cells, in any of the forms of docs/reference/record.md")
      ->required();
  CLI::Option* by = verb->add_option(
      "--by", options.by,
      "YAML with the key `columns`: a scenario, or the columns.yaml of an import before [guessed from the file]");
  verb->add_option("--zone", options.zone, "time zone of its stamps, such as Europe/Berlin [a clock that is never set]")
      ->excludes(by);
  verb->add_option("--interval", options.interval, "from row to row, such as '10 s', where no column holds the time")
      ->excludes(by);
  verb->add_option("--every", options.every,
                   "from row to row of the record, such as '10 s', of a log with a tag in each row [at each time]")
      ->excludes(by);
  add_results(verb, options, "<name of the file>",
              "import scenarios/records/logger_file.csv -o results/import\n  driftwright import "
              "scenarios/records/logger_file.csv --by "
              "results/import/columns.yaml -o results/imported_again");
  verb->callback([&] { app::import_file(options); });
}

/// The verb `view`, the machine in a browser: it writes one file.
void add_view(CLI::App& cli, app::ViewOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "view", "the machine as one HTML page in which it turns, warms, bends and runs any cyclogram (docs/how-to/view.md)");
  verb->add_option("scenario", options.scenario, "scenario YAML")->required();
  verb->add_option("-o,--out", options.out, "file NAME.html [results/<name of the scenario>.html]");
  verb->add_option("--cyclogram", options.cyclogram,
                   "that the page begins with [the one that `study` judges by, else the first]");
  verb->footer("Example:\n  driftwright view scenarios/fp3_spindle.yaml -o twin.html");
  verb->callback([&] { app::view(options); });
}

void add_compare(CLI::App& cli, app::CompareOptions& options) {
  CLI::App* verb = cli.add_subcommand("compare", "two records beside each other: how far each channel is apart");
  verb->add_option("first", options.first, "record CSV, or a folder of results that holds a record.csv")->required();
  verb->add_option("second", options.second, "the same; it is shown at the rows of the first")->required();
  add_results(verb, options, "comparison", "compare results/plan results/warm_plan -o results/cold_and_warm");
  verb->callback([&] { app::compare(options); });
}

/// The verb `init`, a first scenario: it makes a folder of its own.
void add_init(CLI::App& cli, app::InitOptions& options) {
  CLI::App* verb =
      cli.add_subcommand("init", "a first scenario, commented, that runs: of a mesh or drawing, or of lumped nodes");
  verb->add_option("folder", options.folder, "that is made; its name is that of the scenario")->required();
  verb->add_option("--from", options.from, "a drawing or mesh (.step, .msh, .inp, .vtu), which is copied, or lumped")
      ->capture_default_str();
  verb->add_option("--units", options.units,
                   "unit of a mesh, or of a drawing whose stated unit is wrong: mm, cm, m or inch [by its size]");
  verb->footer(
      "Example:\n  driftwright init results/mill --from scenarios/parts/vertical_mill.step\n  driftwright init "
      "results/two_nodes");
  verb->callback([&] { app::init(options); });
}

void add_list(CLI::App& cli, app::ListOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "list",
      "what there is to choose from: effects, materials, scenarios, joints, cyclograms; the ranges of what machines have");
  verb->add_option("what", options.what, "effects, materials, scenarios, joints, cyclograms or ranges")
      ->check(CLI::IsMember({"effects", "materials", "scenarios", "joints", "cyclograms", "ranges"}))
      ->capture_default_str();
  verb->add_option("of", options.of, "scenario YAML, of joints and cyclograms; folder, of scenarios [scenarios]");
  verb->add_flag("--markdown", options.markdown,
                 "effects with their places, keys, units and laws, or ranges with their sources, as a table");
  verb->footer("Example:\n  driftwright list effects --markdown\n  driftwright list joints scenarios/c_frame.yaml");
  verb->callback([&] { app::list(options); });
}

/// Names of files are written into results and messages, where a line break could start a forged line.
void refuse_control_characters(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    if (has_control_character(argv[i]))
      throw InputError(fmt::format("argument {} holds a line break or another control character: '{}'; rename the file", i,
                                   clean_name(argv[i])));
  }
}

/// A better message than CLI11's, which would only say that a subcommand is required.
void reject_unknown_verb(const CLI::App& cli, const std::string& word) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : cli.get_subcommands([](const CLI::App*) { return true; })) verbs.push_back(verb->get_name());
  if (word.empty() || word[0] == '-' || std::find(verbs.begin(), verbs.end(), word) != verbs.end()) return;
  const std::string near = nearest_word(word, verbs);
  throw InputError(fmt::format("unknown verb '{}'; there are {}.{}", word, fmt::join(verbs, ", "),
                               near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
}

/// The message for wrong words after a verb; it names a similar option if there is one.
std::string wrong_words(const CLI::App& cli, const CLI::ParseError& e) {
  const std::vector<CLI::App*> verbs = cli.get_subcommands();
  const CLI::App& verb = verbs.empty() ? cli : *verbs.front();
  std::vector<std::string> options;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  const std::string command = verbs.empty() ? "driftwright" : "driftwright " + verb.get_name();
  const std::string help =
      fmt::format("`{} --help` shows what it takes{}", command, verbs.empty() ? "" : ", with an example");
  for (const std::string& word : verb.remaining()) {
    if (word.rfind("--", 0) != 0) continue;
    const std::string option = word.substr(0, word.find('='));
    return fmt::format("{} has no option {}.{}\n{}", command, option, did_you_mean(option, options), help);
  }
  if (verbs.empty()) return fmt::format("a verb is required, such as `driftwright run scenario.yaml`\n{}", help);
  return fmt::format("{}: {}\n{}", command, e.what(), help);
}

/// Adds `driftwright help VERB`.
void add_help(CLI::App& cli, std::string& of) {
  CLI::App* verb = cli.add_subcommand("help", "the help of a verb");
  verb->add_option("verb", of, "its name");
  verb->footer("Example:\n  driftwright help diagnose");
  verb->callback([&] {
    if (!of.empty()) reject_unknown_verb(cli, of);
    fmt::print("{}", of.empty() ? cli.help() : cli.get_subcommand(of)->help("driftwright"));
  });
}

}  // namespace

int app::command_line(int argc, const char* const* argv) {
  CLI::App cli{"Driftwright: digital twin of a machine tool's thermal behaviour"};
  cli.set_version_flag("--version", kVersion);
  cli.require_subcommand(1);
  cli.add_flag_callback(
         "--man",
         [&] {
           fmt::print("{}", app::man_page(cli, kVersion));
           throw CLI::Success();
         },
         "print the manual page: driftwright --man | man -l -")
      ->trigger_on_parse();
  cli.add_option_function<std::string>(
         "--completion",
         [&](const std::string& shell) {
           fmt::print("{}", shell == "zsh" ? app::zsh_completion(cli) : app::bash_completion(cli));
           throw CLI::Success();
         },
         "print completions for a shell: bash or zsh")
      ->check(CLI::IsMember({"bash", "zsh"}))
      ->trigger_on_parse();
  cli.footer(
      "Exit codes: 0 done, 2 the input is wrong, 3 the numerics gave up, 130 ended by Ctrl-C, 1 a bug of ours.\nExample:\n  "
      "driftwright run scenarios/fp3_spindle.yaml");

  app::CommonOptions run, check;
  app::MeshOptions mesh;
  app::InitOptions init;
  app::SimulateOptions simulate;
  app::PredictOptions predict;
  app::WarmUpVerbOptions warmup;
  app::PlaceOptions place;
  app::PlanTestOptions plan_test;
  app::ScheduleVerbOptions schedule;
  app::InjectOptions inject;
  app::RecordOptions select, validate;
  app::SweepOptions sweep;
  app::CompensateOptions compensate;
  app::DiagnoseOptions diagnose;
  app::CalibrateOptions calibrate;
  app::ListOptions list;
  app::ExportOptions exported;
  app::FollowVerbOptions followed;
  app::ViewOptions viewed;
  add_verb(cli, "run", "the whole chain: simulate, fit on the training cyclograms, correct and judge on another",
           "run scenarios/fp3_spindle.yaml", run)
      ->callback([&] { app::run(run); });
  add_verb(cli, "check",
           "read and mesh a scenario, place its sensors, report implausible values; lumped nodes are run, a mesh is not",
           "check scenarios/fp3_spindle.yaml", check)
      ->callback([&] { app::check(check); });
  CLI::App* verb =
      cli.add_subcommand("mesh", "build or read a mesh, report its quality, picture its named surfaces, write mesh.vtu");
  verb->add_option(
          "scenario", mesh.scenario,
          "scenario YAML, of which the mesh is looked at alone, or a mesh or drawing itself: .step, .msh, .inp, .vtu")
      ->required();
  verb->add_option("--units", mesh.units, "of a mesh or drawing itself: mm, cm, m or inch [by its size]");
  add_results(verb, mesh, "<name of the scenario>",
              "mesh scenarios/fp3_spindle.yaml -o results/mesh\n  driftwright mesh scenarios/parts/vertical_mill.step -o "
              "results/drawing");
  verb->callback([&] { app::mesh(mesh); });
  add_init(cli, init);
  verb = add_verb(cli, "simulate", "temperatures and drift of cyclograms; fields too where one is named",
                  "simulate scenarios/fp3_spindle.yaml --cyclogram warm_up_2000 -o results/warm_up", simulate);
  verb->add_option("--cyclogram", simulate.cyclograms,
                   "name in the scenario, or a record CSV with the column speed_rpm; may be repeated [all of the scenario]")
      ->allow_extra_args(false);
  verb->callback([&] { app::simulate(simulate); });
  verb = add_verb(cli, "predict",
                  "drift of a cyclogram ahead of its run, by the reduced model; warm after another run where one is given",
                  "predict scenarios/fp3_spindle.yaml --cyclogram scenarios/records/plan.csv -o results/plan", predict);
  verb->add_option("--cyclogram", predict.cyclogram,
                   "name in the scenario, or a record CSV with the column speed_rpm (docs/how-to/cyclograms.md)")
      ->required();
  add_warm_start(verb, predict.start, predict.after_pause, predict.model);
  verb->callback([&] { app::predict(predict); });
  verb = add_verb(cli, "warmup", "the shortest warm-up after which a job keeps its tolerance (docs/how-to/warmup.md)",
                  "warmup scenarios/fp3_spindle.yaml --then chaotic --tolerance '12 um' -o results/warmup", warmup);
  verb->add_option("--then", warmup.then, "the job: a cyclogram of the scenario, a record CSV or an NC program")->required();
  verb->add_option("--tolerance", warmup.tolerance, "of the job's drift, such as '10 um' [the study's, else 10 um]");
  CLI::Option* margin =
      verb->add_option("--margin", warmup.margin,
                       "share of the tolerance that is kept free for what the model does not know, such as '20 %' [none]");
  verb->add_option("--model-error", warmup.model_error,
                   "of each source, film, joint and link, such as '20 %': the margin is then so large that 95 of 100 such "
                   "machines keep the tolerance")
      ->excludes(margin);
  verb->add_option("--speed-limit", warmup.speed_limit,
                   "of the warm-up, such as '3000 rpm' [the fastest of the scenario and the job]");
  verb->add_option("--power-limit", warmup.power_limit,
                   "of the heat that a speed of the warm-up brings into the machine, such as '150 W' [none]");
  verb->add_option("--time-limit", warmup.time_limit, "of the warm-up, such as '2 h' [4 h]");
  verb->add_option("--channel", warmup.channels, "displacement that counts; may be repeated [all]")->allow_extra_args(false);
  add_warm_start(verb, warmup.start, warmup.after_pause, warmup.model);
  verb->callback([&] { app::warmup(warmup); });
  verb = add_verb(cli, "place", "where to mount thermometers, how many and which test they need (docs/how-to/placement.md)",
                  "place scenarios/fp3_spindle.yaml --count 4 --exclude table -o results/place", place);
  verb->add_option("--count", place.count, "thermometers to place, 1 to 12 [the study's, else 4]");
  verb->add_option("--region", place.regions,
                   "that may carry them; may be repeated [all but those that turn, flow or hang by their names]")
      ->allow_extra_args(false);
  verb->add_option("--exclude", place.excluded, "region that may not carry them; may be repeated")->allow_extra_args(false);
  verb->add_option("--mounted", place.mounted,
                   "sensor of the scenario that is there already and does not fail; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--channel", place.channels, "displacement that counts; may be repeated [the study's target, else all]")
      ->allow_extra_args(false);
  verb->add_option("--for", place.placed_for, "both, observer or regression [both]")
      ->check(CLI::IsMember({"both", "observer", "regression"}));
  verb->add_flag("--none-fails", place.none_fails, "count only the case in which all thermometers work");
  verb->add_option("--train", place.train,
                   "cyclogram to choose on; may be repeated [those that `validation` trains on, else all]")
      ->allow_extra_args(false);
  verb->add_option("--test", place.test, "cyclogram to judge by; may be repeated [those of `validation`, else made ones]")
      ->allow_extra_args(false);
  verb->add_option("--noise", place.noise, "of a reading, 1 sigma, such as '0.1 K' [that of `validation`, else 0.1 K]");
  verb->add_option("--points", place.points, "of a mesh that are tried, 50 to 3000 [400]");
  add_shards(verb, place, "the work");
  verb->callback([&] { app::place(place); });
  verb =
      add_verb(cli, "plan-test",
               "before anything is measured: the test after which most faults would be named (docs/how-to/test_planning.md)",
               "plan-test scenarios/first_machine.yaml --time '8 h' -o results/plan_test", plan_test);
  verb->add_option("--time", plan_test.time, "length of the test, such as '4 h' [8 h]");
  verb->add_option("--speed-limit", plan_test.speed_limit, "of the test, such as '3000 rpm' [the fastest of the scenario]");
  verb->add_option("--interval", plan_test.interval,
                   "of the rows that are read, such as '30 s' [the scenario's output_interval]");
  verb->add_option("--noise-temperature", plan_test.noise_K, "standard deviation of a thermometer's reading ['0.05 K']");
  verb->add_option("--noise-displacement", plan_test.noise_um, "standard deviation of a displacement's reading ['0.5 um']");
  verb->add_option("--programmes", plan_test.n_programmes, "how many are tried [10000, fewer for large machines]")
      ->check(CLI::Range(10, 10000000));
  verb->add_option("--seed", plan_test.seed, "of the search [1]");
  add_shards(verb, plan_test, "the work");
  verb->callback([&] { app::plan_test(plan_test); });
  verb = add_verb(cli, "schedule", "corrections of the drift that an NC program will cause, written into the program",
                  "schedule scenarios/fp3_spindle.yaml --program scenarios/parts/fp3_part.ngc -o results/part", schedule);
  verb->add_option("--program", schedule.program, "NC program for LinuxCNC, Siemens or Heidenhain (docs/how-to/schedule.md)")
      ->required();
  verb->add_option("--policy", schedule.policy,
                   "paper (steps of the tolerance) or minimal (fewest changes) [the scenario's, else minimal]")
      ->check(CLI::IsMember(scenarios::kSchedulePolicies));
  verb->add_option("--dialect", schedule.dialect,
                   "of the program: linuxcnc, siemens or heidenhain [the scenario's, else linuxcnc]")
      ->check(CLI::IsMember(scenarios::kDialects));
  verb->add_flag("--beyond", schedule.beyond, "plan for speeds above those that the scenario says anything of, too");
  verb->add_flag("--split", schedule.split, "divide straight blocks that cannot keep the tolerance in one piece");
  add_warm_start(verb, schedule.start, schedule.after_pause, schedule.model);
  verb->add_option("--parts", schedule.parts, "how many parts the program makes one after another [the scenario's, else 1]")
      ->check(CLI::Range(1, 1000));
  verb->add_option("--between", schedule.between,
                   "time at rest between two parts, such as '2 min' [the scenario's, else none]");
  verb->callback([&] { app::schedule(schedule); });
  add_inject(cli, inject);
  verb = add_verb(
      cli, "select", "rank the temperature sensors of records by grey relational analysis",
      "select scenarios/fp3_spindle.yaml --train scenarios/records/monday.csv --train scenarios/records/tuesday.csv -o "
      "results/sensors",
      select);
  add_records(verb, select, false);
  verb->callback([&] { app::select(select); });
  verb = add_verb(
      cli, "validate",
      "judge predictors: a regression on records it was not fitted on, or those of the scenario's programme",
      "validate scenarios/fp3_spindle.yaml -o results/validation\n  driftwright validate scenarios/fp3_spindle.yaml "
      "--train scenarios/records/monday.csv --test scenarios/records/tuesday.csv -o results/two_days",
      validate);
  add_records(verb, validate, true);
  verb->callback([&] { app::validate(validate); });
  verb =
      add_verb(cli, "compensate", "a cyclogram with its drift corrected by a predictor through an actuator",
               "compensate scenarios/fp3_spindle.yaml --model results/validation/models/observer.json --through injector -o "
               "results/corrected",
               compensate);
  verb->add_option("--model", compensate.model,
                   "a file models/NAME.json that `validate` has written, or modes; through the frame modes, observer, "
                   "regression")
      ->required();
  verb->add_option("--through", compensate.through,
                   "injector (docs/how-to/injector.md), schedule, frame (docs/how-to/table.md), or none: the correction as "
                   "`validate` judges it")
      ->required()
      ->check(CLI::IsMember({"none", "injector", "schedule", "frame"}));
  verb->add_option("--cyclogram", compensate.cyclogram, "name in the scenario [the one that `study` judges by]");
  verb->add_option("--measured", compensate.measured,
                   "record CSV with readings and drift, in place of a simulation; with --through none");
  verb->add_option("--after", compensate.after,
                   "record CSV that --measured continues, which lags begin with; without it the machine counts as at rest "
                   "before");
  verb->callback([&] { app::compensate(compensate); });
  verb = add_verb(cli, "calibrate", "the scenario's uncertain numbers, fitted to measured records, with intervals",
                  "calibrate scenarios/fp3_spindle.yaml --measured scenarios/records/good.csv -o results/calibration",
                  calibrate);
  verb->add_option("--measured", calibrate.measured, "record CSV (docs/reference/record.md); may be repeated")
      ->required()
      ->allow_extra_args(false);
  verb->callback([&] { app::calibrate(calibrate); });
  verb = add_verb(cli, "diagnose", "what a simulation gets wrong against measured records, why, and what mending it gains",
                  "diagnose scenarios/fp3_spindle.yaml --measured scenarios/records/monday.csv --measured "
                  "scenarios/records/tuesday.csv -o results/diagnosis",
                  diagnose);
  verb->add_option("--measured", diagnose.measured, "record CSV (docs/reference/record.md); may be repeated")
      ->required()
      ->allow_extra_args(false);
  verb->add_flag("--causes-only", diagnose.causes_only,
                 "write the causes alone into extended.yaml, not the scenario's own numbers as fitted beside them");
  verb->add_option("--without", diagnose.without, "key of an effect that is not looked for; may be repeated")
      ->allow_extra_args(false);
  verb->callback([&] { app::diagnose(diagnose); });
  verb = add_verb(
      cli, "sweep", "many variants of one scenario, one table (docs/how-to/sweep.md)",
      "sweep scenarios/lumped_sweep.yaml\n  driftwright sweep scenarios/lumped_sweep.yaml --shard 1/2 -o results/shards\n  "
      "driftwright sweep scenarios/lumped_sweep.yaml --shard 2/2 -o results/shards\n  "
      "driftwright sweep scenarios/lumped_sweep.yaml --merge -o results/shards",
      sweep, "study");
  add_shards(verb, sweep, "the members");
  verb->callback([&] { app::sweep(sweep); });
  app::CompareOptions compared;
  add_compare(cli, compared);
  app::ImportOptions imported;
  add_import(cli, imported);
  app::IdentifyOptions identified;
  add_identify(cli, identified);
  add_follow(cli, followed);
  add_export(cli, exported);
  add_list(cli, list);
  add_view(cli, viewed);
  std::string help_of;
  add_help(cli, help_of);
  app::SchemaOptions schema;
  verb = cli.add_subcommand("schema", "what a file may hold, as JSON Schema for editors and validators");
  verb->add_option("what", schema.what, "scenario; sweep: its study; diagnosis or calibration: their JSON")
      ->check(CLI::IsMember({"scenario", "sweep", "diagnosis", "calibration"}))
      ->capture_default_str();
  verb->add_flag(
      "--markdown", schema.markdown,
      "as tables, which docs/reference/scenario.md, docs/reference/sweep.md and docs/reference/diagnosis.md hold");
  verb->footer("Example:\n  driftwright schema scenario > scenario.schema.json");
  verb->callback([&] { app::schema(schema); });

  try {
    refuse_control_characters(argc, argv);
    reject_unknown_verb(cli, argc > 1 ? argv[1] : "");
    try {
      cli.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
      if (e.get_exit_code() != 0) throw InputError(wrong_words(cli, e));
      (void)cli.exit(e);  // prints what was asked for: help, version
    }
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
      throw InputError("what the program says cannot be written to standard output; is it full?");
    return kDone;
  } catch (...) {
    return app::exit_code_of(std::current_exception());
  }
}
