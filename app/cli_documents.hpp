#pragma once
// Documents about the command line: a manual page and completions for shells, made from the CLI11 tree that parses the
// options.

#include <CLI/CLI.hpp>
#include <string>

namespace driftwright::app {

/// A page for man(1), in roff.
[[nodiscard]] std::string man_page(const CLI::App& cli, const std::string& version);
/// A script for bash, to be sourced or put into bash's folder of completions.
[[nodiscard]] std::string bash_completion(const CLI::App& cli);
/// A file _driftwright for zsh's fpath.
[[nodiscard]] std::string zsh_completion(const CLI::App& cli);

}  // namespace driftwright::app
