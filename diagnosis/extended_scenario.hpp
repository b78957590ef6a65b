#pragma once
// The user's scenario file with what was found written into it, so that it runs at once.

#include <string>
#include <vector>

#include "diagnosis/search.hpp"
#include "scenarios/reader/scenario.hpp"

namespace driftwright::diagnosis {

/// One thing to write: what it does to the effects of the twin, and why.
struct StatedChange {
  std::string name;                      ///< of it, for messages: "convection at nose"
  std::string comment;                   ///< stands behind each line that it changes
  std::function<void(TwinState&)> make;  ///< sets numbers of the scenario's effects, or adds effects behind them
  std::string by = "diagnosis";          ///< whose change it is; stands before what a number was
};

struct ExtendedScenario {
  std::string text;
  std::vector<std::string> written;      ///< a sentence each
  std::vector<std::string> not_written;  ///< name and reason
};

/// A claim as a change of the twin's effects. @param x  of its knobs
[[nodiscard]] std::function<void(TwinState&)> change_of(const Claim& claim, const Eigen::VectorXd& x);

/// Makes all changes one after the other and edits the file of a scenario accordingly: numbers in place, further effects behind the others, as
/// effects::yaml_of() writes them. Numbers carry eight digits. Files that it names are given by absolute paths. For a change that happened in one
/// of several runs a cyclogram of the run's name, from its record and by the scenario's `columns`, is added where there is none. Where the text of the file leaves no room for an
/// edit (an alias, an entry that shares its line), the entry is replaced as a whole, and if that is impossible, the file is written anew
/// without its comments.
/// @param runs  that the changes were found in
/// @param head  comment lines for the top
/// @throws InputError  when the file has gone or changed since
[[nodiscard]] ExtendedScenario extended_scenario(const scenarios::Scenario& scenario, const Twin& twin,
                                                 const std::vector<MeasuredRun>& runs,
                                                 const std::vector<StatedChange>& changes, std::vector<std::string> head);

}  // namespace driftwright::diagnosis
