#include "app/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>

#include "app/cli_documents.hpp"
#include "app/exit_code.hpp"
#include "app/verb_options.hpp"
#include "base/config_map.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/version.hpp"

namespace {

using namespace driftwright;

using app::kDone, app::kWrongInput;

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

void add_schema(CLI::App& cli, app::SchemaOptions& options) {
  CLI::App* verb =
      cli.add_subcommand("schema", "prints all keys that a file may contain, as JSON Schema for editors and validators");
  verb->add_option("what", options.what, "kind of file: scenario, sweep (its study), diagnosis or calibration (their JSON)")
      ->check(CLI::IsMember({"scenario", "sweep", "diagnosis", "calibration"}))
      ->capture_default_str();
  verb->add_flag("--markdown", options.markdown,
                 "prints tables in Markdown, as in docs/reference/scenario.md, sweep.md and diagnosis.md");
  verb->footer("Example:\n  driftwright schema scenario > scenario.schema.json");
  verb->callback([&] { app::schema(options); });
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
  app::ProbePlanOptions probe_plan;
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
  app::add_run(cli, run);
  app::add_check(cli, check);
  app::add_mesh(cli, mesh);
  app::add_init(cli, init);
  app::add_simulate(cli, simulate);
  app::add_predict(cli, predict);
  app::add_warmup(cli, warmup);
  app::add_place(cli, place);
  app::add_plan_test(cli, plan_test);
  app::add_probe_plan(cli, probe_plan);
  app::add_schedule(cli, schedule);
  app::add_inject(cli, inject);
  app::add_select(cli, select);
  app::add_validate(cli, validate);
  app::add_compensate(cli, compensate);
  app::add_calibrate(cli, calibrate);
  app::add_diagnose(cli, diagnose);
  app::add_sweep(cli, sweep);
  app::CompareOptions compared;
  app::add_compare(cli, compared);
  app::ImportOptions imported;
  app::add_import(cli, imported);
  app::IdentifyOptions identified;
  app::add_identify(cli, identified);
  app::add_follow(cli, followed);
  app::add_export(cli, exported);
  add_list(cli, list);
  app::add_view(cli, viewed);
  std::string help_of;
  add_help(cli, help_of);
  app::SchemaOptions schema;
  add_schema(cli, schema);

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
