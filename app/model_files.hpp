#pragma once
// The deployable models that `validate` writes.

#include <span>

#include "base/listener.hpp"
#include "compensation/control/control_files.hpp"
#include "compensation/judging/strategy_matrix.hpp"
#include "output/control_program.hpp"
#include "output/results_folder.hpp"

namespace driftwright::app {

/// A formula as files for a control: text, c, linuxcnc, st, siemens, heidenhain, fanuc. Those of c and linuxcnc need the
/// files of control_files() beside them.
/// @param as    one of these words
/// @param name  of the files
/// @throws InputError  for a formula that this control cannot hold (control_program())
[[nodiscard]] std::vector<compensation::ControlFile> formula_files(const output::DeployedModel& formula,
                                                                   const std::string& as, const std::string& name,
                                                                   const output::ControlAxis& axis,
                                                                   const std::string& made_by);
/// Formulas for places along the travel of an axis as one file: text, c, linuxcnc, st, siemens. Those of c and linuxcnc need
/// the files of control_files() beside them.
/// @param places  two or more, by rising position; @param name  of the files and functions
/// @throws InputError  for formulas that this control cannot hold over a travel, such as heidenhain and fanuc
[[nodiscard]] std::vector<compensation::ControlFile> travel_files(std::span<const output::PlacedModel> places,
                                                                  const std::string& as, const std::string& name,
                                                                  const output::ControlAxis& axis,
                                                                  const std::string& made_by);
/// True if control_files() belong to these files.
[[nodiscard]] bool needs_control_files(const std::string& as);

/// Writes <strategy>.json of each strategy into models_folder(), with its verdict and the conditions it was judged under,
/// and also .txt and .c of strategies that are formulas.
/// The file of an observer has the limits by which `follow` watches it, simulated here.
void write_models(const compensation::StrategyMatrix& matrix, output::ResultsFolder& folder, const Listener& listener);

}  // namespace driftwright::app
