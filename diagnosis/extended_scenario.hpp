#pragma once
// The user's scenario file with the findings written into it, ready to run.

#include <filesystem>
#include <string>
#include <vector>

#include "diagnosis/search.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::diagnosis {

/// One change to write: its effect on the twin's effects, and the reason.
struct StatedChange {
  std::string name;                      ///< its name in messages: "convection at nose"
  std::string comment;                   ///< comment after each changed line
  std::function<void(TwinState&)> make;  ///< sets numbers of the scenario's effects, or adds effects after them
  std::string by = "diagnosis";          ///< origin of the change; written before the former number
};

struct ExtendedScenario {
  std::string text;
  std::vector<std::string> written;      ///< one sentence each
  std::vector<std::string> not_written;  ///< name and reason
};

/// A claim as a change of the twin's effects. @param x  values of its knobs
[[nodiscard]] std::function<void(TwinState&)> change_of(const Claim& claim, const Eigen::VectorXd& x);

/// Makes all changes in order and edits the scenario's text: numbers in place, further effects after the others, as
/// effects::yaml_of() writes them; a factor on the capacity of a node becomes the node's capacity. Numbers have seven
/// digits at most. For a change that happened in one of several runs, a cyclogram with the run's name is added if there is
/// none, from its record and by the scenario's `columns`. If the text cannot be edited in place (an alias, an entry that
/// shares its line), the whole entry is replaced; if that is impossible, the file is written anew without its comments.
/// @param runs    runs in which the changes were found
/// @param head    comment lines for the top
/// @param folder  where the text will be written, which its paths become relative to; empty: they become absolute
/// @param known_together  takes the place of the file's `known_together`, or removes it if it has no numbers; none: as it
/// was
/// @throws InputError  if the file was removed or changed in the meantime
[[nodiscard]] ExtendedScenario extended_scenario(const scenarios::Scenario& scenario, const Twin& twin,
                                                 const std::vector<MeasuredRun>& runs,
                                                 const std::vector<StatedChange>& changes, std::vector<std::string> head,
                                                 const std::filesystem::path& folder = {},
                                                 const std::optional<scenarios::KnownTogether>& known_together = {});

}  // namespace driftwright::diagnosis
