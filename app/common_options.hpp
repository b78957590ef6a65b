#pragma once
// Options that several verbs have.

#include <string>

#include "app/verbs.hpp"

namespace CLI {
class App;
}

namespace driftwright::app {

/// Adds the options that all verbs with a folder of results have; `example` ends the help.
void add_results(CLI::App* verb, CommonOptions& options, const std::string& folder, const std::string& example);
/// Adds a verb with the common options; `input` says what its file describes.
CLI::App* add_verb(CLI::App& app, const std::string& name, const std::string& what, const std::string& example,
                   CommonOptions& options, const std::string& input = "scenario");
/// Adds the options of verbs whose work several processes may share. @param parts  what the work consists of, in words
void add_shards(CLI::App* verb, ShardOptions& options, const std::string& parts);
/// @param judges  true for a verb that also tests, and that needs no records where the scenario has a programme
void add_records(CLI::App* verb, RecordOptions& options, bool judges);
/// Adds the options for the state in which a prediction begins.
void add_warm_start(CLI::App* verb, std::string& start, std::string& after_pause, std::string& model);

}  // namespace driftwright::app
