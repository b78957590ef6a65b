#include "app/diagnosis_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/config_text.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/line_diff.hpp"
#include "diagnosis/judge.hpp"
#include "diagnosis/output_error.hpp"
#include "output/vtk_fields.hpp"

namespace driftwright::app {

using diagnosis::StatedChange;

namespace {

scenarios::Scenario scenario_of(const std::string& text, const std::filesystem::path& file) {
  return scenarios::read_scenario(ConfigMap::of_tree(read_config_text(text, file.string())));
}

}  // namespace

std::vector<StatedChange> stated_causes(const diagnosis::Diagnosis& d) {
  std::vector<StatedChange> changes;
  if (!d.written.keeps_numbers) return changes;
  const diagnosis::Fit& fit = d.written.fit;
  Eigen::Index first = fit.x.size();
  for (const diagnosis::Claim& c : d.written.hypothesis) first -= static_cast<Eigen::Index>(c.knobs.size());
  for (std::size_t c = 0; c < d.written.hypothesis.size(); ++c) {
    const diagnosis::Claim& claim = d.written.hypothesis[c];
    const auto n = static_cast<Eigen::Index>(claim.knobs.size());
    const diagnosis::Cause& cause = d.causes.at(d.written.causes.at(c));
    std::vector<std::string> numbers = {
        fmt::format("{}, evidence gain {:.1f} nats", diagnosis::word(cause.standing), cause.log_evidence_gain)};
    for (const diagnosis::Estimate& p : cause.parameters)
      numbers.push_back(fmt::format("{} {}, 95 %: {}", p.name, findings::value_text(p), findings::interval_text(p)));
    if (d.written.causes_alone) numbers.emplace_back("written as fitted beside the scenario's own numbers as they are");
    changes.push_back({fmt::format("{} at {}", cause.effect, cause.where),
                       fmt::format("{} at {}: {}", cause.effect, cause.where, fmt::join(numbers, "; ")),
                       diagnosis::change_of(claim, fit.x.segment(first, n))});
    first += n;
  }
  return changes;
}

std::vector<StatedChange> stated_scatter(const diagnosis::Diagnosis& d, bool causes_only) {
  constexpr double kUnmoved = 1e-4;  // standard deviations of the prior
  std::vector<StatedChange> changes;
  if (d.written.causes_alone) return changes;
  const std::vector<diagnosis::Knob>& knobs = d.scatter;
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const diagnosis::Estimate& e = d.calibrated.at(i);
    const bool is_cause = std::find(d.moved.begin(), d.moved.end(), i) != d.moved.end();
    if (std::abs(e.deviation) < kUnmoved || (causes_only && !is_cause)) continue;
    changes.push_back({e.name,
                       fmt::format("{} {}, 95 %: {}", knobs[i].name, findings::value_text(e), findings::interval_text(e)),
                       [knob = knobs[i], value = e.value](diagnosis::TwinState& state) { knob.set(state, value); },
                       is_cause ? "diagnosis" : "calibration"});
  }
  return changes;
}

diagnosis::ExtendedScenario write_scenario(const std::string& stem, const studies::MeasuredTwin& m,
                                           const std::vector<StatedChange>& changes, const std::vector<std::string>& head,
                                           output::ResultsFolder& folder, std::string* difference) {
  diagnosis::ExtendedScenario extended = diagnosis::extended_scenario(m.scenario, *m.twin, m.runs, changes, head);
  const std::string file = stem + ".yaml";
  try {
    (void)scenario_of(extended.text, folder.target() / file);
  } catch (const InputError& e) {
    extended.not_written.push_back(fmt::format("{} as a whole: it could not be read back: {}", file, e.what()));
    if (difference) difference->clear();
    return extended;
  }
  folder.write_text(file, extended.text);
  const std::string diff =
      unified_diff(read_bytes(m.scenario.path), extended.text, clean_name(m.scenario.path), stem + ".yaml");
  folder.write_text(stem + ".diff", diff);
  if (difference) *difference = diff;
  return extended;
}

diagnosis::Prediction read_as_written(const studies::MeasuredTwin& m, const diagnosis::ExtendedScenario& extended) {
  return studies::read_of(m, scenario_of(extended.text, m.scenario.path).machine->effects);
}

void simulate_written(const studies::MeasuredTwin& m, const diagnosis::ExtendedScenario& extended, diagnosis::Diagnosis& d) {
  d.extended = read_as_written(m, extended);
  const auto before = diagnosis::output_errors(m.runs, d.as_written), after = diagnosis::output_errors(m.runs, d.extended);
  for (diagnosis::ChannelGain& g : d.gain) {
    if (!before.contains(g.name)) continue;
    const double scale = diagnosis::shown_scale(g.unit == "K" ? "K" : "m");
    g.rmse_all_before = scale * before.at(g.name).rms;
    g.rmse_written = scale * after.at(g.name).rms;
  }
}

bool write_missing_heat(const mesh::Mesh& mesh, const diagnosis::Posterior& statements, output::ResultsFolder& folder) {
  if (mesh.n_nodes() == 0) return false;
  std::vector<output::RegionField> fields = {{"missing_heat_probability", std::vector<double>(mesh.regions.size(), 0.0)},
                                             {"missing_heat_W", std::vector<double>(mesh.regions.size(), 0.0)}};
  for (const diagnosis::Stated& s : statements.stated) {
    if (s.says.quantity != diagnosis::StatedQuantity::kHeat) continue;
    const auto found = std::find(mesh.regions.begin(), mesh.regions.end(), s.says.place.front());
    if (found == mesh.regions.end()) continue;
    const auto r = static_cast<std::size_t>(found - mesh.regions.begin());
    fields[0].value[r] = s.probability;
    fields[1].value[r] = s.size;
  }
  output::write_region_fields(mesh, fields, folder.path("residual_source.vtu"));
  return true;
}

}  // namespace driftwright::app
