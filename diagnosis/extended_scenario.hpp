#pragma once
// The user's scenario file with what was found written into it, so that it runs at once.

#include <string>
#include <vector>

#include "diagnosis/search.hpp"
#include "scenarios/scenario.hpp"

namespace driftwright::diagnosis {

/// One thing to write: what the twin would have to be told, and why.
struct StatedChange {
  std::string name;              ///< of it, for messages: "convection at nose"
  std::string comment;           ///< stands behind each line that it changes
  TwinState state;               ///< the twin as written, with this change alone
  std::string by = "diagnosis";  ///< whose change it is; stands before what a number was
};

struct ExtendedScenario {
  std::string text;
  std::vector<std::string> written;      ///< a sentence each
  std::vector<std::string> not_written;  ///< name and reason; stands at the top of the text, too
};

/// A claim's effect on the twin. @param x  of its knobs
[[nodiscard]] TwinState state_of(const Twin& twin, const Claim& claim, const Eigen::VectorXd& x);

/// Edits the file of a scenario: numbers in place, whatever has no number yet as a further effect. Numbers carry five digits. Files that
/// it names are given by absolute paths. A change that happened in one of several runs is written with `in` where its effect has that
/// key; a cyclogram of the run's name, from its record, is added where there is none.
/// @param runs  that the changes were found in
/// @param head  comment lines for the top
/// @throws InputError  when the file has gone or changed since
[[nodiscard]] ExtendedScenario extended_scenario(const scenarios::Scenario& scenario, const Twin& twin,
                                                 const std::vector<MeasuredRun>& runs,
                                                 const std::vector<StatedChange>& changes, std::vector<std::string> head);

}  // namespace driftwright::diagnosis
