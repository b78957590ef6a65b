#include "app/machine_predictor.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "base/errors.hpp"

namespace driftwright::app {

output::PredictorFile read_machine_predictor(const scenarios::Scenario& scenario, const std::string& path) {
  output::PredictorFile file = output::read_predictor(path);
  if (!scenario.machine) return file;
  std::vector<std::string> known;
  for (const scenarios::DisplacementOutput& d : scenario.machine->displacements) known.push_back(d.name);
  if (std::find(known.begin(), known.end(), file.predictor.target) == known.end())
    throw InputError(fmt::format("{}: its target '{}' is no displacement of {}, which has {}", path, file.predictor.target,
                                 scenario.path, known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
  return file;
}

}  // namespace driftwright::app
