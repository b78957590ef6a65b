// Options of the verbs beside a machine, and of those that write a model for other programs.

#include <CLI/CLI.hpp>

#include "app/verb_options.hpp"

namespace driftwright::app {

/// The verb `inject`, a filter: it has no scenario and no folder of results.
void add_inject(CLI::App& cli, InjectOptions& options) {
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
void add_follow(CLI::App& cli, FollowVerbOptions& options) {
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
void add_export(CLI::App& cli, ExportOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "export",
      "writes the machine, an observer or a formula for other programs: a functional mock-up unit (docs/how-to/fmu.md), or "
      "files for a control or a PLC (docs/how-to/controls.md)");
  verb->add_option("scenario", options.scenario, "scenario YAML; none with --as and a formula (--model)");
  verb->add_flag("--fmu", options.fmu, "writes a functional mock-up unit (FMI) with C sources and a linux64 binary");
  verb->add_option("-o,--out", options.out,
                   "file to write, NAME.fmu [results/<name of the scenario>.fmu]; with --as a folder");
  verb->add_option("--as", options.as,
                   "files for a control: text, c (C99, also of a scenario's machine or observer), linuxcnc, st (structured "
                   "text of a PLC), siemens, heidenhain, fanuc")
      ->check(CLI::IsMember({"text", "c", "linuxcnc", "st", "siemens", "heidenhain", "fanuc"}));
  verb->add_option("--axis", options.axis, "axis that siemens, heidenhain or fanuc corrects")
      ->check(CLI::IsMember({"X", "Y", "Z", "U", "V", "W"}));
  verb->add_option("--axis-moves", options.axis_moves,
                   "siemens: the axis moves by_dk or against_dk, as a dial gauge shows it (docs/how-to/controls.md)")
      ->check(CLI::IsMember({"by_dk", "against_dk"}))
      ->capture_default_str();
  verb->add_option("--fmi", options.fmi, "version of the FMI standard: 2 or 3")
      ->check(CLI::IsMember({2, 3}))
      ->capture_default_str();
  verb->add_option("--of", options.of, "what is exported: machine, or observer (requires --model)")
      ->check(CLI::IsMember({"machine", "observer"}))
      ->capture_default_str();
  verb->add_option("--type", options.type, "interface: me (model exchange), cs (co-simulation) or both")
      ->check(CLI::IsMember({"me", "cs", "both"}))
      ->capture_default_str();
  verb->add_option(
          "--model", options.models,
          "predictor to export: a file of models/ written by `validate`; once for each place of an axis' travel, for "
          "one correction that follows its position")
      ->allow_extra_args(false);
  verb->footer(
      "Example:\n  driftwright export scenarios/fp3_spindle.yaml --fmu -o machine.fmu\n  driftwright export "
      "scenarios/fp3_spindle.yaml --fmu --fmi 3 --of observer --model results/validation/models/observer.json -o "
      "observer.fmu\n  driftwright export scenarios/fp3_spindle.yaml --as c -o machine_c");
  verb->callback([&] { app::export_model(options); });
}

/// The verb `view`, the machine in a browser: it writes one file.
void add_view(CLI::App& cli, ViewOptions& options) {
  CLI::App* verb = cli.add_subcommand(
      "view",
      "writes the machine as one HTML page that simulates any cyclogram in the browser, offline; with --pick: a page in "
      "which a click on a face gives the text for a scenario (docs/how-to/view.md)");
  verb->add_option("scenario", options.scenario,
                   "scenario YAML; with --pick also a mesh or drawing: .step, .msh, .inp, .vtu")
      ->required();
  verb->add_option("-o,--out", options.out,
                   "file to write, NAME.html [results/<name of the scenario>.html; with --pick results/<name>_pick.html]");
  CLI::Option* cyclogram = verb->add_option(
      "--cyclogram", options.cyclogram,
      "name of the cyclogram that the page shows first [the one that `study` judges by, else the first of the scenario]");
  CLI::Option* pick =
      verb->add_flag("--pick", options.pick,
                     "writes a page in which a click on the machine gives the YAML of a surface, a thermometer or a "
                     "displacement. Of a scenario it uses only `name`, `machine`, `sensors`, `displacements` and `effects`")
          ->excludes(cyclogram);
  verb->add_option("--units", options.units,
                   "with --pick, unit of length of a mesh or drawing: mm, cm, m or inch [guessed from the size]")
      ->needs(pick);
  verb->footer(
      "Example:\n  driftwright view scenarios/fp3_spindle.yaml -o twin.html\n  driftwright view --pick "
      "scenarios/parts/c_frame.step -o pick.html");
  verb->callback([&] { app::view(options); });
}

}  // namespace driftwright::app
