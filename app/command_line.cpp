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
#include "nc/controls.hpp"
#include "scenarios/reader/read_schedule.hpp"

namespace {

using namespace driftwright;

using app::kDone, app::kWrongInput;

/// Adds the options that all verbs with a folder of results have; `example` ends the help.
void add_results(CLI::App* verb, app::CommonOptions& options, const std::string& folder, const std::string& example) {
  verb->add_option("-o,--out", options.out, "folder into which the results are written [results/" + folder + "]");
  verb->add_flag("--force", options.force, "replaces the folder of results even if it contains other files");
  CLI::Option* json =
      verb->add_flag("--json", options.json, "prints the results as JSON (the content of summary.json) instead of text");
  CLI::Option* quiet = verb->add_flag("--quiet", options.quiet, "prints neither results nor progress; errors still appear");
  verb->add_flag("--details", options.details, "prints all tables of the report, not only the most important ones")
      ->excludes(json)
      ->excludes(quiet);
  json->excludes(quiet);
  verb->add_option_function<int>(
          "--threads", [](int n) { omp_set_num_threads(n); },
          "number of threads for the computation [OMP_NUM_THREADS, else all cores]")
      ->check(CLI::Range(1, 1024));
  verb->footer("Example:\n  driftwright " + example);
}

/// Adds a verb with the common options; `input` says what its file describes.
CLI::App* add_verb(CLI::App& app, const std::string& name, const std::string& what, const std::string& example,
                   app::CommonOptions& options, const std::string& input = "scenario") {
  CLI::App* verb = app.add_subcommand(name, what);
  verb->add_option(input, options.scenario, input + " file (YAML)")->required();
  add_results(verb, options, "<name of the " + input + ">", example);
  verb->add_flag("--strict", options.strict,
                 "stops with exit code 2 at an implausible value instead of printing a warning (docs/reference/scenario.md, "
                 "Plausibility)");
  return verb;
}

/// Adds the options of verbs whose work several processes may share. @param parts  what the work consists of, in words
void add_shards(CLI::App* verb, app::ShardOptions& options, const std::string& parts) {
  verb->add_option("--shard", options.shard,
                   "i/n: computes only part i of n of " + parts + ", for example as one task of a job array");
  verb->add_flag("--merge", options.merge, "combines the results of all shards into one folder of results");
}

/// @param judges  true for a verb that also tests, and that needs no records where the scenario has a programme
void add_records(CLI::App* verb, app::RecordOptions& options, bool judges) {
  verb->add_option("--train", options.train,
                   "record CSV for the fit, or a part of one, such as run.csv:0h..20h; may be repeated")
      ->required(!judges)
      ->allow_extra_args(false);
  if (!judges) return;
  verb->add_option("--test", options.test,
                   "record CSV for the test, or a part of one, such as run.csv:20h..28h; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--target", options.target,
                   "displacement (a column of the records) to predict; only needed if the scenario has no block `study`");
  CLI::Option* probe = verb->add_option("--probe", options.probe,
                                        "time between two probings of the corrected axis, such as '60 min'; shows what each "
                                        "strategy then leaves [not probed]");
  verb->add_option("--probe-noise", options.probe_noise, "noise of one probing, 1 sigma")
      ->needs(probe)
      ->capture_default_str();
}

/// Adds the options for the state in which a prediction begins.
void add_warm_start(CLI::App* verb, std::string& start, std::string& after_pause, std::string& model) {
  CLI::Option* record = verb->add_option("--start", start,
                                         "what the machine did before: a record CSV (as `simulate` writes it) or the name "
                                         "of a cyclogram. The model runs it first, so the machine starts warm [cold start]");
  verb->add_option("--after-pause", after_pause, "time at rest between --start and the prediction, such as '30 min' [none]")
      ->needs(record);
  verb->add_option("--model", model, "model that predicts: reduced or full [reduced; full if a lumped machine asks for it]")
      ->check(CLI::IsMember({"reduced", "full"}));
}

/// The verb `inject`, a filter: it has no scenario and no folder of results.
void add_inject(CLI::App& cli, app::InjectOptions& options) {
  CLI::App* verb =
      cli.add_subcommand("inject",
                         "simulates a pulse injector: reads encoder rows \"A B\" from standard input, inserts counts that "
                         "correct the error, and writes the rows to standard output (docs/how-to/injector.md)");
  verb->add_option("--correction", options.correction,
                   "file with the tool's error (actual - commanded): a CSV with the column row, time_s or time_min, or a "
                   "FIFO that delivers one number per line")
      ->required();
  verb->add_option("--period", options.period,
                   "travel of the axis during one signal period, such as '4 um'; required for corrections in um");
  verb->add_option("--row-time", options.row_time,
                   "time from row to row, such as '1 ms'; required for corrections over time");
  verb->add_option("--limit", options.limit,
                   "largest correction by size, such as '50 um' (`correction` of the scenario's `limits`); a larger one is "
                   "held at the limit [none]");
  verb->add_option("--unit", options.unit, "unit of the numbers from a FIFO: um or count")
      ->check(CLI::IsMember({"um", "count"}))
      ->capture_default_str();
  verb->add_option("--counts", options.counts, "counts per signal period in the control: x4, x2 or x1 means 4, 2 or 1")
      ->check(CLI::IsMember({"x4", "x2", "x1"}))
      ->capture_default_str();
  verb->add_option("--insert", options.insert,
                   "smallest step that is inserted: a whole signal cycle, half or a quarter; less than a cycle shifts the "
                   "phase of the output")
      ->check(CLI::IsMember({"cycle", "half", "quarter"}))
      ->capture_default_str();
  verb->add_flag("--anywhere", options.anywhere,
                 "allows insertions also while line A or B is high, not only while both are low");
  verb->add_option("--column", options.column,
                   "column of a table with several columns [predicted_um]; or axis, if the FIFO delivers lines of `follow` "
                   "[the only axis]");
  CLI::Option* on_fault =
      verb->add_option("--on-fault", options.on_fault,
                       "what happens after an invalid row, or an invalid correction from a FIFO. hold: the last valid value "
                       "remains. bypass: the correction is withdrawn until the next valid one")
          ->check(CLI::IsMember({"hold", "bypass"}))
          ->capture_default_str();
  verb->add_flag("--strict", options.strict, "ends the run with exit code 2 at an invalid row or correction")
      ->excludes(on_fault);
  verb->add_flag("--bypass", options.bypass, "writes the input unchanged and inserts nothing");
  verb->add_flag("--clocked", options.clocked,
                 "writes exactly one row for each row of input, for signals sampled at a fixed clock; without it, inserted "
                 "rows are additional");
  verb->add_option("--separation", options.separation,
                   "with --clocked: smallest number of rows between two edges of the output")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  verb->add_option(
          "--interval", options.interval,
          "with --clocked: smallest number of rows between two insertions; it limits how fast the correction changes")
      ->check(CLI::Range(1, 1000000000))
      ->capture_default_str();
  verb->add_option("--vcd", options.vcd,
                   "file to write: the lines A and B before and after the injector, as value change dump (VCD)");
  verb->add_option("--halstream", options.halstream, "file to write: the corrected rows, for LinuxCNC's halstreamer");
  verb->add_option("--hal", options.hal,
                   "file to write: a HAL file that plays the rows of --halstream into LinuxCNC's encoder");
  verb->add_option("--log", options.log, "file to write: a CSV of the counts read, inserted and written");
  verb->footer(
      "Example:\n  driftwright inject --correction scenarios/records/drift.csv --period '4 um' --row-time '1 ms' < "
      "scenarios/records/encoder_rows.txt > injected_rows.txt\n"
      "  with drift.csv: 'time_s,drift_um', then '0,0', '0.5,6', ... (docs/how-to/injector.md)");
  verb->callback([&] { app::inject(options); });
}

/// The verb `follow`, beside a running machine: it has no folder of results.
void add_follow(CLI::App& cli, app::FollowVerbOptions& options) {
  CLI::App* verb = cli.add_subcommand("follow",
                                      "runs beside a machine: reads rows of speed and temperatures from standard input and "
                                      "writes one correction for each row (docs/how-to/follow.md)");
  verb->add_option(
          "model", options.models,
          "predictor file models/NAME.json written by `validate`, or a scenario; give several files for several axes")
      ->required();
  verb->add_flag("--despite-verdict", options.despite_verdict,
                 "accepts a model that `validate` calls unsafe; for trials only, never on a machine that cuts");
  verb->add_option("--columns", options.columns,
                   "scenario whose key `columns` gives the names and units of the rows [names of record CSVs], or whose key "
                   "`topics` gives the topics to read");
  CLI::Option* replay = verb->add_option("--replay", options.replay, "file with the rows, read instead of standard input");
  verb->add_option("--pace", options.pace,
                   "speed of the replay as a multiple of real time, such as 60 [as fast as possible]")
      ->needs(replay);
  CLI::Option* mqtt =
      verb->add_option("--mqtt", options.mqtt, "MQTT broker to read instead of standard input: HOST or HOST:PORT")
          ->excludes(replay);
  CLI::Option* from =
      verb->add_option("--from", options.from,
                       "MQTT topic whose messages are whole rows in JSON, such as {\"time_s\": 60, \"t01_degC\": 21.5}")
          ->needs(mqtt);
  verb->add_option(
          "--sparkplug", options.sparkplug,
          "Sparkplug B edge node to read from the broker: GROUP/NODE or GROUP/NODE/DEVICE; --topic then names its metrics")
      ->needs(mqtt)
      ->excludes(from);
  CLI::Option* agent =
      verb->add_option("--mtconnect", options.mtconnect,
                       "address of an MTConnect agent to read instead of standard input, such as http://10.0.0.7:5000")
          ->excludes(replay)
          ->excludes(mqtt);
  verb->add_flag("--sample", options.sample,
                 "reads all observations of the agent (/sample) at their own times, not only the latest values")
      ->needs(agent);
  verb->add_option(
          "--topic", options.topics,
          "source of one channel, such as t01_degC=shop/mill/t01: an MQTT topic whose messages are numbers, the id or name "
          "of a data item of the agent, or a Sparkplug metric; may be repeated [the scenario's key `topics`]")
      ->excludes(from)
      ->allow_extra_args(false);
  verb->add_option("--every", options.every,
                   "interval of the rows that `follow` builds from the sources given by --topic, such as '1 s'")
      ->capture_default_str();
  verb->add_option("--to", options.to, "MQTT topic to which the output lines are published as well")->needs(mqtt);
  verb->add_option("--state", options.state, "file in which the state is saved every second; a restart continues from it");
  verb->add_option("--record", options.record, "record CSV to write: all rows that were used");
  CLI::Option* serve = verb->add_option("--serve", options.serve,
                                        "port at which a page for browsers is served (machine, drift, correction, trust, "
                                        "alarms), such as 8080; 0 takes any free port");
  verb->add_option("--bind", options.bind,
                   "address at which the page is served; an address that other computers can reach requires --token")
      ->needs(serve)
      ->capture_default_str();
  verb->add_option("--token", options.token,
                   "secret word that each request for the page must contain (16 characters or more), or @FILE to read it "
                   "from the first line of FILE")
      ->needs(serve);
  verb->add_option(
      "--slew", options.slew,
      "largest rate at which a correction changes, such as '0.5 um/s' [the value in the model's file, else 1 um/s]");
  verb->add_option("--hold", options.hold,
                   "time for which the last correction is held if no row comes, such as '5 min' [the value in the model's "
                   "file, else 5 min]");
  verb->add_option("--fade", options.fade,
                   "time constant with which the correction then decreases to 0, such as '10 min' [the value in the model's "
                   "file, else 10 min]");
  verb->add_option("--probe-noise", options.probe_noise,
                   "noise of one probing, 1 sigma, such as '1 um'; for rows with a column probe_AXIS_um or "
                   "probe_left_AXIS_um [the value in the model's file]");
  verb->add_option("--probe-lag", options.probe_lag,
                   "time from the touch until its value is in a row, such as '20 s' [the value in the model's file]");
  verb->add_option("--tolerance", options.tolerance,
                   "asks for a probing as soon as the interval passes half of this, such as '10 um' [never]");
  CLI::Option* watch = verb->add_option(
      "--watch", options.watch,
      "file of limits written by --calibrate-watch; `follow` raises an alarm if the machine no longer behaves like the "
      "model (observer only) [the limits in the model's file, which `validate` computes]");
  verb->add_flag("--no-watch", options.no_watch, "raises no alarms; an observer is not watched")->excludes(watch);
  CLI::Option* calibrate = verb->add_option("--calibrate-watch", options.calibrate_watch,
                                            "file to write: limits for --watch, computed by simulation; no rows are read")
                               ->excludes(watch)
                               ->excludes(replay);
  verb->add_option("--top-speed", options.top_speed,
                   "highest spindle speed in the simulations of --calibrate-watch, such as '2500 rpm'")
      ->needs(calibrate);
  verb->footer(
      "Example:\n  driftwright follow scenarios/fp3_spindle.yaml --replay scenarios/records/monday.csv > lines.txt\n  "
      "driftwright "
      "follow results/validation/models/observer.json --state axis.state < scenarios/records/monday.csv > lines.txt");
  verb->callback([&] { app::follow_stream(options); });
}

/// The verb `export`, a model for other programs: it writes one file.
void add_export(CLI::App& cli, app::ExportOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "export",
      "writes the reduced machine or an observer as a functional mock-up unit for other simulators (docs/how-to/fmu.md)");
  verb->add_option("scenario", options.scenario, "scenario YAML")->required();
  verb->add_flag("--fmu", options.fmu, "writes a functional mock-up unit (FMI) with C sources and a linux64 binary");
  verb->add_option("-o,--out", options.out, "file to write, NAME.fmu [results/<name of the scenario>.fmu]");
  verb->add_option("--fmi", options.fmi, "version of the FMI standard: 2 or 3")
      ->check(CLI::IsMember({2, 3}))
      ->capture_default_str();
  verb->add_option("--of", options.of, "what is exported: machine, or observer (requires --model)")
      ->check(CLI::IsMember({"machine", "observer"}))
      ->capture_default_str();
  verb->add_option("--type", options.type, "interface: me (model exchange), cs (co-simulation) or both")
      ->check(CLI::IsMember({"me", "cs", "both"}))
      ->capture_default_str();
  verb->add_option("--model", options.model, "observer to export: the file models/observer.json written by `validate`");
  verb->footer(
      "Example:\n  driftwright export scenarios/fp3_spindle.yaml --fmu -o machine.fmu\n  driftwright export "
      "scenarios/fp3_spindle.yaml --fmu --fmi 3 --of observer --model results/validation/models/observer.json -o "
      "observer.fmu");
  verb->callback([&] { app::export_model(options); });
}

void add_identify(CLI::App& cli, app::IdentifyOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "identify",
      "builds a network of bodies from records alone and writes it as a scenario (docs/how-to/identification.md)");
  verb->add_option("--record", options.records,
                   "record CSV or logger file that contains the drives of the machine (rpm, W, V, %), the ambient "
                   "temperature and the readings (degC, um); may be repeated")
      ->required()
      ->allow_extra_args(false);
  verb->add_option("--ambient", options.ambient,
                   "channel of the ambient temperature [the one with such a name; else a guess, which the report names]");
  verb->add_option("--drive", options.drives,
                   "further channel that drives the machine, such as the temperature of a heated bed. Channels in rpm, W, V "
                   "and % are drives without this option; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--prior", options.prior,
                   "scenario to start from. What its physics do not explain of the records is learned and, if kept-out rows "
                   "confirm it, written to extended.yaml. Ambient and drives are then those of the scenario")
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
  CLI::App* verb = cli.add_subcommand("import",
                                      "converts a logger file into a record CSV of the same name and reports how each "
                                      "column was read (docs/reference/record.md)");
  verb->add_option("file", options.scenario,
                   "file of a logger or control: text with cells, in one of the forms of docs/reference/record.md")
      ->required();
  CLI::Option* by = verb->add_option("--by", options.by,
                                     "YAML file whose key `columns` describes the columns: a scenario, or the columns.yaml "
                                     "of an earlier import [the program guesses them from the file]");
  verb->add_option("--zone", options.zone,
                   "time zone of the time stamps, such as Europe/Berlin; it matters where the clock changes between winter "
                   "and summer time [a clock that never changes]")
      ->excludes(by);
  verb->add_option("--interval", options.interval,
                   "time from row to row, such as '10 s'; for files without a column of times")
      ->excludes(by);
  verb->add_option("--every", options.every,
                   "time from row to row of the record, such as '10 s'; for logs in which each row has one tag and its "
                   "value [one row for each time in the log]")
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
      "view",
      "writes the machine as one HTML page that simulates any cyclogram in the browser, offline (docs/how-to/view.md)");
  verb->add_option("scenario", options.scenario, "scenario YAML")->required();
  verb->add_option("-o,--out", options.out, "file to write, NAME.html [results/<name of the scenario>.html]");
  verb->add_option(
      "--cyclogram", options.cyclogram,
      "name of the cyclogram that the page shows first [the one that `study` judges by, else the first of the scenario]");
  verb->footer("Example:\n  driftwright view scenarios/fp3_spindle.yaml -o twin.html");
  verb->callback([&] { app::view(options); });
}

void add_compare(CLI::App& cli, app::CompareOptions& options) {
  CLI::App* verb = cli.add_subcommand("compare", "compares two records: the difference of each channel");
  verb->add_option("first", options.first, "record CSV, or a folder of results that contains record.csv")->required();
  verb->add_option("second", options.second,
                   "second record CSV or folder; its values are interpolated at the times of the first")
      ->required();
  add_results(verb, options, "comparison", "compare results/plan results/warm_plan -o results/cold_and_warm");
  verb->callback([&] { app::compare(options); });
}

/// The verb `init`, a first scenario: it makes a folder of its own.
void add_init(CLI::App& cli, app::InitOptions& options) {
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

void add_list(CLI::App& cli, app::ListOptions& options) {
  CLI::App* verb = cli.add_subcommand("list",
                                      "prints what a scenario can contain: effects, materials, joints, cyclograms, usual "
                                      "ranges of values; or the scenarios in a folder");
  verb->add_option("what", options.what, "what to list: effects, materials, scenarios, joints, cyclograms or ranges")
      ->check(CLI::IsMember({"effects", "materials", "scenarios", "joints", "cyclograms", "ranges"}))
      ->capture_default_str();
  verb->add_option("of", options.of, "for joints and cyclograms: the scenario file; for scenarios: the folder [scenarios]");
  verb->add_flag("--markdown", options.markdown,
                 "prints effects (with places, keys, units and laws) or ranges (with sources) as a table in Markdown");
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
  CLI::App* verb = cli.add_subcommand("help", "prints the help of a verb");
  verb->add_option("verb", of, "name of the verb, such as diagnose");
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
         "prints the manual page: driftwright --man | man -l -")
      ->trigger_on_parse();
  cli.add_option_function<std::string>(
         "--completion",
         [&](const std::string& shell) {
           fmt::print("{}", shell == "zsh" ? app::zsh_completion(cli) : app::bash_completion(cli));
           throw CLI::Success();
         },
         "prints completions for a shell: bash or zsh")
      ->check(CLI::IsMember({"bash", "zsh"}))
      ->trigger_on_parse();
  cli.footer(
      "Exit codes: 0 done, 2 the input is wrong, 3 the solver failed, 130 ended by Ctrl-C, 1 a bug in Driftwright.\nIn the "
      "help of a command, [square brackets] give the value without the option.\nExample:\n  driftwright run "
      "scenarios/fp3_spindle.yaml");

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
  add_verb(
      cli, "run",
      "simulates the machine, fits predictors on the training cyclograms, and judges their corrections on another cyclogram",
      "run scenarios/fp3_spindle.yaml", run)
      ->callback([&] { app::run(run); });
  add_verb(
      cli, "check",
      "reads and meshes a scenario, places its sensors and reports implausible values; lumped machines are also simulated",
      "check scenarios/fp3_spindle.yaml", check)
      ->callback([&] { app::check(check); });
  CLI::App* verb = cli.add_subcommand(
      "mesh",
      "builds or reads a mesh, reports its quality, draws its named surfaces and writes mesh.vtu; with --convergence: says "
      "whether it is fine enough (docs/how-to/meshes.md)");
  verb->add_option(
          "scenario", mesh.scenario,
          "scenario file (only its mesh is used, unless --convergence), or a mesh or drawing: .step, .msh, .inp, .vtu")
      ->required();
  verb->add_option("--units", mesh.units, "unit of length of a mesh or drawing: mm, cm, m or inch [guessed from the size]");
  CLI::Option* convergence = verb->add_flag(
      "--convergence", mesh.convergence,
      "runs one cyclogram on three mesh sizes and estimates the error that the mesh causes in each displacement and "
      "thermometer");
  verb->add_option(
          "--cyclogram", mesh.cyclogram,
          "cyclogram for --convergence: a name in the scenario, or a record CSV with the column speed_rpm [the first "
          "of the scenario]")
      ->needs(convergence);
  verb->add_option(
          "--most-elements", mesh.most_elements,
          "largest number of elements of a mesh that --convergence makes finer than the scenario's own; if it would "
          "have more, two coarser meshes are made instead")
      ->needs(convergence)
      ->check(CLI::Range(1, 5000000))
      ->capture_default_str();
  add_results(verb, mesh, "<name of the scenario>",
              "mesh scenarios/fp3_spindle.yaml -o results/mesh\n  driftwright mesh scenarios/parts/vertical_mill.step -o "
              "results/drawing");
  verb->callback([&] { app::mesh(mesh); });
  add_init(cli, init);
  verb = add_verb(cli, "simulate",
                  "simulates cyclograms: temperatures, drift and heat flows; for a single cyclogram also fields",
                  "simulate scenarios/fp3_spindle.yaml --cyclogram warm_up_2000 -o results/warm_up", simulate);
  verb->add_option("--cyclogram", simulate.cyclograms,
                   "cyclogram to simulate: a name in the scenario, or a record CSV with the column speed_rpm; may be "
                   "repeated [all of the scenario]")
      ->allow_extra_args(false);
  verb->callback([&] { app::simulate(simulate); });
  verb = add_verb(cli, "predict",
                  "predicts the drift of a cyclogram before it runs, with the reduced model, from a cold or a warm machine",
                  "predict scenarios/fp3_spindle.yaml --cyclogram scenarios/records/plan.csv -o results/plan", predict);
  verb->add_option("--cyclogram", predict.cyclogram,
                   "cyclogram to predict: a name in the scenario, or a record CSV with the column speed_rpm "
                   "(docs/how-to/cyclograms.md)")
      ->required();
  add_warm_start(verb, predict.start, predict.after_pause, predict.model);
  verb->callback([&] { app::predict(predict); });
  verb = add_verb(cli, "warmup",
                  "finds the shortest warm-up after which a job stays within its tolerance (docs/how-to/warmup.md)",
                  "warmup scenarios/fp3_spindle.yaml --then chaotic --tolerance '12 um' -o results/warmup", warmup);
  verb->add_option("--then", warmup.then,
                   "the job after the warm-up: a cyclogram of the scenario, a record CSV or an NC program")
      ->required();
  verb->add_option("--tolerance", warmup.tolerance,
                   "largest drift allowed during the job, such as '10 um' [the study's tolerance, else 10 um]");
  CLI::Option* margin =
      verb->add_option("--margin", warmup.margin,
                       "share of the tolerance that is kept in reserve for errors of the model, such as '20 %' [none]");
  verb->add_option("--model-error", warmup.model_error,
                   "how wrong each heat source, film, joint and link of the model may be (one sigma), such as '20 %'. The "
                   "program then chooses the margin so that 95 of 100 such machines keep the tolerance")
      ->excludes(margin);
  verb->add_option("--speed-limit", warmup.speed_limit,
                   "highest speed of the warm-up, such as '3000 rpm' [the highest of the scenario and the job]");
  verb->add_option("--power-limit", warmup.power_limit,
                   "largest heat input of the warm-up by the spindle speed, such as '150 W' [none]");
  verb->add_option("--time-limit", warmup.time_limit, "longest warm-up that is tried, such as '2 h' [4 h]");
  verb->add_option("--channel", warmup.channels, "displacement that must keep the tolerance; may be repeated [all]")
      ->allow_extra_args(false);
  add_warm_start(verb, warmup.start, warmup.after_pause, warmup.model);
  verb->callback([&] { app::warmup(warmup); });
  verb = add_verb(cli, "place",
                  "finds where to mount thermometers, how many, and which test they need (docs/how-to/placement.md)",
                  "place scenarios/fp3_spindle.yaml --count 4 --exclude table -o results/place", place);
  verb->add_option("--count", place.count,
                   "number of thermometers to place, 1 to 12 [`sensors_to_choose` of the study, else 4]");
  verb->add_option("--region", place.regions,
                   "region that may carry thermometers; may be repeated [all, except those whose names say that they turn, "
                   "flow or hang]")
      ->allow_extra_args(false);
  verb->add_option("--exclude", place.excluded, "region that may not carry thermometers; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--mounted", place.mounted,
                   "sensor of the scenario that is already mounted; it is used as well and never fails; may be repeated")
      ->allow_extra_args(false);
  verb->add_option("--channel", place.channels,
                   "displacement that the thermometers must predict; may be repeated [the study's target, else all]")
      ->allow_extra_args(false);
  verb->add_option("--for", place.placed_for, "predictor that uses the thermometers: observer, regression or both [both]")
      ->check(CLI::IsMember({"both", "observer", "regression"}));
  verb->add_flag("--none-fails", place.none_fails,
                 "assumes that all thermometers work; without it, any one of them may fail");
  verb->add_option("--train", place.train,
                   "cyclogram by which places are chosen; may be repeated [those that `validation` trains on, else all]")
      ->allow_extra_args(false);
  verb->add_option("--test", place.test,
                   "cyclogram by which the choice is judged; may be repeated [those of `validation`, else random ones]")
      ->allow_extra_args(false);
  verb->add_option("--noise", place.noise,
                   "noise of one reading (1 sigma), such as '0.1 K' [that of `validation`, else 0.1 K]");
  verb->add_option("--points", place.points, "number of points of a mesh that are tried, 50 to 3000 [400]");
  add_shards(verb, place, "the work");
  verb->callback([&] { app::place(place); });
  verb = add_verb(cli, "plan-test",
                  "plans a test before anything is measured, so that `diagnose` can name as many faults as possible "
                  "(docs/how-to/test_planning.md)",
                  "plan-test scenarios/first_machine.yaml --time '8 h' -o results/plan_test", plan_test);
  verb->add_option("--time", plan_test.time, "length of the test, such as '4 h' [8 h]");
  verb->add_option("--speed-limit", plan_test.speed_limit,
                   "highest speed of the test, such as '3000 rpm' [the highest of the scenario's cyclograms]");
  verb->add_option("--interval", plan_test.interval,
                   "time from reading to reading during the test, such as '30 s' [the scenario's output_interval]");
  verb->add_option("--noise-temperature", plan_test.noise_K,
                   "standard deviation of one reading of a thermometer, such as '0.1 K' [0.05 K]");
  verb->add_option("--noise-displacement", plan_test.noise_um,
                   "standard deviation of one reading of a displacement, such as '1 um' [0.5 um]");
  verb->add_option("--programmes", plan_test.n_programmes,
                   "number of test programmes that are tried [10000, fewer for large machines]")
      ->check(CLI::Range(10, 10000000));
  verb->add_option("--seed", plan_test.seed, "seed of the random search; the same seed gives the same plan [1]");
  add_shards(verb, plan_test, "the work");
  verb->callback([&] { app::plan_test(plan_test); });
  verb = add_verb(
      cli, "schedule",
      "predicts the drift that an NC program will cause and writes corrections into the program (docs/how-to/schedule.md)",
      "schedule scenarios/fp3_spindle.yaml --program scenarios/parts/fp3_part.ngc -o results/part", schedule);
  verb->add_option("--program", schedule.program, "NC program for " + enumerated(of_each_control(&NcControl::title), " or "))
      ->required();
  verb->add_option("--policy", schedule.policy,
                   "when offsets change: paper (by steps of the tolerance) or minimal (as few changes as possible) [the "
                   "scenario's, else minimal]")
      ->check(CLI::IsMember(scenarios::kSchedulePolicies));
  verb->add_option("--dialect", schedule.dialect,
                   fmt::format("language of the program: {} [the scenario's, else {}]",
                               enumerated(of_each_control(&NcControl::key), " or "), nc_controls().front().key))
      ->check(CLI::IsMember(of_each_control(&NcControl::key)));
  verb->add_flag("--beyond", schedule.beyond,
                 "also accepts blocks beyond the limits of the machine; corrections are not changed there");
  verb->add_flag("--split", schedule.split, "divides straight blocks in which one offset cannot keep the tolerance");
  add_warm_start(verb, schedule.start, schedule.after_pause, schedule.model);
  verb->add_option("--parts", schedule.parts, "number of parts that are made one after another [the scenario's, else 1]")
      ->check(CLI::Range(1, 1000));
  verb->add_option("--between", schedule.between,
                   "time at rest between two parts, such as '2 min' [the scenario's, else none]");
  verb->callback([&] { app::schedule(schedule); });
  add_inject(cli, inject);
  verb = add_verb(
      cli, "select", "ranks the temperature sensors of records by grey relational analysis (docs/how-to/validation.md)",
      "select scenarios/fp3_spindle.yaml --train scenarios/records/monday.csv --train scenarios/records/tuesday.csv -o "
      "results/sensors",
      select);
  add_records(verb, select, false);
  verb->callback([&] { app::select(select); });
  verb = add_verb(
      cli, "validate",
      "fits predictors and tests them on records or cyclograms that they were not fitted on; gives each a verdict "
      "(docs/how-to/validation.md)",
      "validate scenarios/fp3_spindle.yaml -o results/validation\n  driftwright validate scenarios/fp3_spindle.yaml "
      "--train scenarios/records/monday.csv --test scenarios/records/tuesday.csv -o results/two_days",
      validate);
  add_records(verb, validate, true);
  verb->callback([&] { app::validate(validate); });
  verb = add_verb(
      cli, "compensate",
      "simulates how a predictor corrects the drift of a cyclogram through an injector, an NC program or a coordinate frame",
      "compensate scenarios/fp3_spindle.yaml --model results/validation/models/observer.json --through injector -o "
      "results/corrected",
      compensate);
  verb->add_option("--model", compensate.model,
                   "predictor: a file models/NAME.json written by `validate`, or the word modes (thermal modes of the "
                   "model); with --through frame one of the words modes, observer, regression")
      ->required();
  verb->add_option("--through", compensate.through,
                   "how the correction reaches the axis: injector (docs/how-to/injector.md), schedule "
                   "(docs/how-to/schedule.md), frame (docs/how-to/table.md), or none (directly, as `validate` judges it)")
      ->required()
      ->check(CLI::IsMember({"none", "injector", "schedule", "frame"}));
  verb->add_option("--cyclogram", compensate.cyclogram,
                   "name of the cyclogram in the scenario [the one that `study` judges by]");
  verb->add_option("--measured", compensate.measured,
                   "record CSV with readings and drift, used instead of a simulation; requires --through none");
  verb->add_option("--after", compensate.after,
                   "record CSV that ends where --measured begins; lags start from it. Without it the machine is assumed to "
                   "have been at rest before");
  verb->callback([&] { app::compensate(compensate); });
  verb = add_verb(
      cli, "calibrate", "fits the uncertain numbers of the scenario to measured records and gives their 95 % intervals",
      "calibrate scenarios/fp3_spindle.yaml --measured scenarios/records/good.csv -o results/calibration", calibrate);
  verb->add_option("--measured", calibrate.measured, "measured record CSV (docs/reference/record.md); may be repeated")
      ->required()
      ->allow_extra_args(false);
  verb->callback([&] { app::calibrate(calibrate); });
  verb = add_verb(cli, "diagnose",
                  "finds what a scenario lacks compared with measured records: which effects, where, how large and how "
                  "probable (docs/start/diagnosis.md)",
                  "diagnose scenarios/fp3_spindle.yaml --measured scenarios/records/monday.csv --measured "
                  "scenarios/records/tuesday.csv -o results/diagnosis",
                  diagnose);
  verb->add_option("--measured", diagnose.measured, "measured record CSV (docs/reference/record.md); may be repeated")
      ->required()
      ->allow_extra_args(false);
  verb->add_flag("--causes-only", diagnose.causes_only,
                 "writes only the causes into extended.yaml and leaves the scenario's own numbers unchanged");
  verb->add_option("--without", diagnose.without,
                   "key of an effect to leave out of the search, such as hidden_body; may be repeated")
      ->allow_extra_args(false);
  verb->callback([&] { app::diagnose(diagnose); });
  verb = add_verb(
      cli, "sweep", "simulates many variants of one scenario and writes one table of results (docs/how-to/sweep.md)",
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
  verb = cli.add_subcommand("schema", "prints all keys that a file may contain, as JSON Schema for editors and validators");
  verb->add_option("what", schema.what, "kind of file: scenario, sweep (its study), diagnosis or calibration (their JSON)")
      ->check(CLI::IsMember({"scenario", "sweep", "diagnosis", "calibration"}))
      ->capture_default_str();
  verb->add_flag("--markdown", schema.markdown,
                 "prints tables in Markdown, as in docs/reference/scenario.md, sweep.md and diagnosis.md");
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
