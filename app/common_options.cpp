#include "app/common_options.hpp"

#include <omp.h>

#include <CLI/CLI.hpp>

namespace driftwright::app {

void add_results(CLI::App* verb, CommonOptions& options, const std::string& folder, const std::string& example) {
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

CLI::App* add_verb(CLI::App& app, const std::string& name, const std::string& what, const std::string& example,
                   CommonOptions& options, const std::string& input) {
  CLI::App* verb = app.add_subcommand(name, what);
  verb->add_option(input, options.scenario, input + " file (YAML)")->required();
  add_results(verb, options, "<name of the " + input + ">", example);
  verb->add_flag("--strict", options.strict,
                 "stops with exit code 2 at an implausible value instead of printing a warning (docs/reference/scenario.md, "
                 "Plausibility)");
  return verb;
}

void add_shards(CLI::App* verb, ShardOptions& options, const std::string& parts) {
  verb->add_option("--shard", options.shard,
                   "i/n: computes only part i of n of " + parts + ", for example as one task of a job array");
  verb->add_flag("--merge", options.merge, "combines the results of all shards into one folder of results");
}

void add_records(CLI::App* verb, RecordOptions& options, bool judges) {
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
  CLI::Option* probe =
      verb->add_option("--probe", options.probe,
                       "time between two probings of the corrected axis, such as '60 min', or several, such "
                       "as '30 min, 60 min, 4 h'; shows what each strategy then leaves [not probed]");
  verb->add_option("--probe-noise", options.probe_noise, "noise of one probing, 1 sigma")
      ->needs(probe)
      ->capture_default_str();
  verb->add_option("--probing-time", options.probing_time, "time that one probing takes; the table of intervals counts it")
      ->needs(probe)
      ->capture_default_str();
}

void add_warm_start(CLI::App* verb, std::string& start, std::string& after_pause, std::string& model) {
  CLI::Option* record = verb->add_option("--start", start,
                                         "what the machine did before: a record CSV (as `simulate` writes it) or the name "
                                         "of a cyclogram. The model runs it first, so the machine starts warm [cold start]");
  verb->add_option("--after-pause", after_pause, "time at rest between --start and the prediction, such as '30 min' [none]")
      ->needs(record);
  verb->add_option("--model", model, "model that predicts: reduced or full [reduced; full if a lumped machine asks for it]")
      ->check(CLI::IsMember({"reduced", "full"}));
}

}  // namespace driftwright::app
