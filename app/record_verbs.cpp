// Options of the verbs that read records.

#include <CLI/CLI.hpp>

#include "app/common_options.hpp"
#include "app/verb_options.hpp"

namespace driftwright::app {

void add_select(CLI::App& cli, RecordOptions& options) {
  CLI::App* verb = add_verb(
      cli, "select", "ranks the temperature sensors of records by grey relational analysis (docs/how-to/validation.md)",
      "select scenarios/fp3_spindle.yaml --train scenarios/records/monday.csv --train scenarios/records/tuesday.csv -o "
      "results/sensors",
      options);
  add_records(verb, options, false);
  verb->callback([&] { app::select(options); });
}

void add_validate(CLI::App& cli, RecordOptions& options) {
  CLI::App* verb = add_verb(
      cli, "validate",
      "fits predictors and tests them on records or cyclograms that they were not fitted on; gives each a verdict "
      "(docs/how-to/validation.md)",
      "validate scenarios/fp3_spindle.yaml -o results/validation\n  driftwright validate scenarios/fp3_spindle.yaml "
      "--train scenarios/records/monday.csv --test scenarios/records/tuesday.csv -o results/two_days",
      options);
  add_records(verb, options, true);
  verb->callback([&] { app::validate(options); });
}

void add_compensate(CLI::App& cli, CompensateOptions& options) {
  CLI::App* verb = add_verb(
      cli, "compensate",
      "simulates how a predictor corrects the drift of a cyclogram through an injector, an NC program or a coordinate frame",
      "compensate scenarios/fp3_spindle.yaml --model results/validation/models/observer.json --through injector -o "
      "results/corrected",
      options);
  verb->add_option("--model", options.model,
                   "predictor: a file models/NAME.json written by `validate`, or the word modes (thermal modes of the "
                   "model); with --through frame one of the words modes, observer, regression")
      ->required();
  verb->add_option("--through", options.through,
                   "how the correction reaches the axis: injector (docs/how-to/injector.md), schedule "
                   "(docs/how-to/schedule.md), frame (docs/how-to/table.md), or none (directly, as `validate` judges it)")
      ->required()
      ->check(CLI::IsMember({"none", "injector", "schedule", "frame"}));
  verb->add_option("--cyclogram", options.cyclogram,
                   "name of the cyclogram in the scenario [the one that `study` judges by]");
  verb->add_option("--measured", options.measured,
                   "record CSV with readings and drift, used instead of a simulation; requires --through none");
  verb->add_option("--after", options.after,
                   "record CSV that ends where --measured begins; lags start from it. Without it the machine is assumed to "
                   "have been at rest before");
  CLI::Option* probe = verb->add_option("--probe", options.probe,
                                        "time between two probings of the corrected axis, such as '60 min'; shows what is "
                                        "left with them beside what is left without; requires --through none [not probed]");
  verb->add_option("--probe-noise", options.probe_noise,
                   "noise of one probing, 1 sigma, such as '1 um' [that of the model's file]")
      ->needs(probe);
  verb->callback([&] { app::compensate(options); });
}

CLI::Option* add_as_recorded(CLI::App& verb, bool& as_recorded) {
  return verb.add_flag(
      "--as-recorded", as_recorded,
      "goes on with records whose columns look wrong (a speed in 1/s, mm under um, a sign, exchanged channels, a "
      "clock in minutes, an ambient thermometer on the machine); without it they are refused");
}

void add_calibrate(CLI::App& cli, CalibrateOptions& options) {
  CLI::App* verb = add_verb(
      cli, "calibrate", "fits the uncertain numbers of the scenario to measured records and gives their 95 % intervals",
      "calibrate scenarios/fp3_spindle.yaml --measured scenarios/records/good.csv -o results/calibration", options);
  verb->add_option("--measured", options.measured, "measured record CSV (docs/reference/record.md); may be repeated")
      ->required()
      ->allow_extra_args(false);
  add_as_recorded(*verb, options.as_recorded);
  verb->callback([&] { app::calibrate(options); });
}

void add_diagnose(CLI::App& cli, DiagnoseOptions& options) {
  CLI::App* verb =
      add_verb(cli, "diagnose",
               "finds what a scenario lacks compared with measured records: which effects, where, how large and how "
               "probable (docs/start/diagnosis.md)",
               "diagnose scenarios/fp3_spindle.yaml --measured scenarios/records/monday.csv --measured "
               "scenarios/records/tuesday.csv -o results/diagnosis",
               options);
  verb->add_option("--measured", options.measured, "measured record CSV (docs/reference/record.md); may be repeated")
      ->required()
      ->allow_extra_args(false);
  verb->add_flag("--causes-only", options.causes_only,
                 "writes only the causes into extended.yaml and leaves the scenario's own numbers unchanged");
  verb->add_option("--without", options.without,
                   "key of an effect to leave out of the search, such as hidden_body; may be repeated")
      ->allow_extra_args(false);
  add_as_recorded(*verb, options.as_recorded);
  verb->callback([&] { app::diagnose(options); });
}

void add_compare(CLI::App& cli, CompareOptions& options) {
  CLI::App* verb = cli.add_subcommand("compare", "compares two records: the difference of each channel");
  verb->add_option("first", options.first, "record CSV, or a folder of results that contains record.csv")->required();
  verb->add_option("second", options.second,
                   "second record CSV or folder; its values are interpolated at the times of the first")
      ->required();
  add_results(verb, options, "comparison", "compare results/plan results/warm_plan -o results/cold_and_warm");
  verb->callback([&] { app::compare(options); });
}

CLI::Option* add_units(CLI::App* verb, std::vector<std::string>& units) {
  return verb
      ->add_option("--unit", units,
                   "unit of a column of a logger file, such as t1=degC, where the file does not say it; 1: a plain number, "
                   "none: the column is left out; may be repeated")
      ->allow_extra_args(false);
}

void add_import(CLI::App& cli, ImportOptions& options) {
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
  add_units(verb, options.units)->excludes(by);
  add_results(verb, options, "<name of the file>",
              "import scenarios/records/logger_file.csv -o results/import\n  driftwright import "
              "scenarios/records/logger_file.csv --by "
              "results/import/columns.yaml -o results/imported_again");
  verb->callback([&] { app::import_file(options); });
}

void add_identify(CLI::App& cli, IdentifyOptions& options) {
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
  add_units(verb, options.units)->excludes("--prior");
  add_as_recorded(*verb, options.as_recorded)->needs("--prior");
  add_results(verb, options, "<name of the first record>",
              "identify --record scenarios/records/monday.csv --record scenarios/records/tuesday.csv -o "
              "results/identified\n  driftwright simulate "
              "results/identified/monday.yaml -o results/identified_run\n  driftwright identify --prior "
              "scenarios/own_law.yaml --record scenarios/records/own_law.csv -o results/learned");
  verb->callback([&] { app::identify(options); });
}

}  // namespace driftwright::app
