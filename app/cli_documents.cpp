#include "app/cli_documents.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace driftwright::app {
namespace {

std::vector<const CLI::App*> verbs_of(const CLI::App& cli) {
  return cli.get_subcommands([](const CLI::App* verb) { return !verb->get_name().empty(); });
}

/// The options whose name begins with a dash.
std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}
std::vector<const CLI::Option*> arguments_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& n : option.get_snames()) names.push_back("-" + n);
  for (const std::string& n : option.get_lnames()) names.push_back("--" + n);
  return names;
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

/// Text for roff, with characters escaped that would start a request or an escape.
std::string roff(const std::string& text) {
  std::string safe;
  for (char c : text) {
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else if ((c == '.' || c == '\'') && (safe.empty() || safe.back() == '\n')) {
      safe += "\\&";
      safe += c;
    } else {
      safe += c;
    }
  }
  return safe;
}

/// Text in single quotes for a shell; a backslash is put before each character of `escaped`.
std::string quoted(const std::string& text, const std::string& escaped = {}) {
  std::string q = "'";
  for (char c : text) {
    if (c == '\'') {
      q += "'\\''";
      continue;
    }
    if (escaped.find(c) != std::string::npos) q += '\\';
    q += c == '\n' ? ' ' : c;
  }
  return q + "'";
}

void add_options(std::string& text, const CLI::App& app) {
  for (const CLI::Option* o : arguments_of(app))
    text += fmt::format(".TP\n.I {}\n{}\n", roff(o->get_name(true)), roff(o->get_description()));
  for (const CLI::Option* o : options_of(app)) {
    text += fmt::format(".TP\n.B {}{}\n{}\n", roff(fmt::format("{}", fmt::join(names_of(*o), ", "))),
                        takes_value(*o) ? " \\fIVALUE\\fR" : "", roff(o->get_description()));
  }
}

}  // namespace

std::string man_page(const CLI::App& cli, const std::string& version) {
  std::string text = fmt::format(
      ".TH DRIFTWRIGHT 1 \"\" \"driftwright {}\" \"User Commands\"\n.SH NAME\ndriftwright \\- {}\n.SH SYNOPSIS\n.B "
      "driftwright\n"
      ".I VERB FILE\n[\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n{}. Most verbs read a scenario in YAML and write their results "
      "into "
      "a folder.\n.SH OPTIONS\n",
      version, roff("digital twin of a machine tool's thermal behaviour"), roff(cli.get_description()));
  add_options(text, cli);
  text += ".SH VERBS\n";
  for (const CLI::App* verb : verbs_of(cli)) {
    text += fmt::format(".SS {}\n{}\n", roff(verb->get_name()), roff(verb->get_description()));
    add_options(text, *verb);
    if (!verb->get_footer().empty()) text += fmt::format(".PP\n.nf\n{}\n.fi\n", roff(verb->get_footer()));
  }
  return text +
         ".SH EXIT STATUS\n0 done; 1 a bug in Driftwright; 2 the input is wrong, or something is missing; 3 the solver "
         "failed; "
         "130 ended by Ctrl\\-C (diagnose then writes its results so far).\n";
}

std::string bash_completion(const CLI::App& cli) {
  std::vector<std::string> verbs;
  std::string cases;
  for (const CLI::App* verb : verbs_of(cli)) {
    verbs.push_back(verb->get_name());
    std::vector<std::string> names;
    for (const CLI::Option* o : options_of(*verb)) {
      for (const std::string& n : names_of(*o)) names.push_back(n);
    }
    cases += fmt::format("    {}) options={} ;;\n", verb->get_name(), quoted(fmt::format("{}", fmt::join(names, " "))));
  }
  return fmt::format(
      R"(# bash completion of driftwright: driftwright --completion bash > ~/.local/share/bash-completion/completions/driftwright
_driftwright() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" options=''
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W '{} --help --version' -- "$word")
    return
  fi
  case "${{COMP_WORDS[1]}}" in
{}  esac
  if [[ "$word" == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}}
complete -o filenames -F _driftwright driftwright ./driftwright
)",
      fmt::join(verbs, " "), cases);
}

std::string zsh_completion(const CLI::App& cli) {
  std::string verbs, cases;
  for (const CLI::App* verb : verbs_of(cli)) {
    verbs += fmt::format("    {}\n", quoted(verb->get_name() + ":" + verb->get_description()));
    cases += fmt::format("    {})\n      _arguments", verb->get_name());
    for (const CLI::Option* o : options_of(*verb)) {
      for (const std::string& n : names_of(*o))
        cases += fmt::format(" \\\n        '*{}['{}']{}'", n, quoted(o->get_description(), "[]:"),
                             takes_value(*o) ? ":value:_files" : "");
    }
    cases += " \\\n        '*:file:_files'\n      ;;\n";
  }
  return fmt::format(R"(#compdef driftwright
# zsh completion of driftwright: driftwright --completion zsh > a folder of your fpath/_driftwright
_driftwright() {{
  local -a verbs=(
{}  )
  if (( CURRENT == 2 )); then
    _describe 'verb' verbs
    return
  fi
  local verb="$words[2]"
  shift words
  (( CURRENT-- ))
  case "$verb" in
{}  esac
}}
_driftwright "$@"
)",
                     verbs, cases);
}

}  // namespace driftwright::app
