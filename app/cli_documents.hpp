#pragma once
// What the command line says of itself: a manual page and completions for shells, from the same tree that parses it.

#include <CLI/CLI.hpp>
#include <string>

namespace driftwright::app {

/// A page for man(1), in roff.
[[nodiscard]] std::string man_page(const CLI::App& cli, const std::string& version);
/// To be sourced by bash, or put where it looks for completions.
[[nodiscard]] std::string bash_completion(const CLI::App& cli);
/// A file _driftwright for zsh's fpath.
[[nodiscard]] std::string zsh_completion(const CLI::App& cli);

}  // namespace driftwright::app
