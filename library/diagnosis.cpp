#include "diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include "app/diagnosis_files.hpp"
#include "diagnosis/calibration.hpp"
#include "diagnosis/extended_scenario.hpp"
#include "effects/where_in_files.hpp"
#include "library/parts.hpp"
#include "studies/measured_twin.hpp"

namespace driftwright {
namespace {

std::vector<Estimate> plain(const std::vector<diagnosis::Estimate>& estimates) {
  std::vector<Estimate> list;
  for (const diagnosis::Estimate& e : estimates) list.push_back({e.name, e.unit, e.value, e.low, e.high});
  return list;
}

Cause plain(const diagnosis::Cause& cause) {
  Cause c{.effect = cause.effect,
          .where = effects::where_in_files(cause.where),
          .law = cause.law,
          .standing = diagnosis::word(cause.standing),
          .parameters = plain(cause.parameters),
          .log_evidence_gain = cause.log_evidence_gain,
          .is_written = cause.is_written,
          .why_not_written = cause.why_not_written,
          .alternatives = {}};
  for (const diagnosis::Cause& a : cause.alternatives) c.alternatives.push_back(plain(a));
  return c;
}

Diagnosis diagnosis_of(const scenarios::Scenario& scenario, const std::vector<Record>& measured,
                       const DiagnoseOptions& options, bool looks_for_causes, const Listener& listener) {
  std::vector<ReadRecord> records;
  for (const Record& record : measured) records.push_back({.record = record, .notes = {}});
  studies::MeasuredTwin m = studies::open_measured_twin(scenario, "diagnose", records, listener);
  m.how.without = {options.without.begin(), options.without.end()};
  const diagnosis::Twin* coarse = m.on_other_mesh ? &*m.on_other_mesh : nullptr;
  const diagnosis::Diagnosis d = looks_for_causes ? diagnosis::diagnose(*m.twin, coarse, m.runs, m.how, listener)
                                                  : diagnosis::calibrate(*m.twin, coarse, m.runs, m.how, listener);
  Diagnosis result{.verdict = diagnosis::word(d.verdict),
                   .reason = d.reason,
                   .causes = {},
                   .calibrated = plain(d.calibrated),
                   .holdout = d.holdout,
                   .gain = {},
                   .extended_scenario = {},
                   .not_written = {}};
  for (const diagnosis::Cause& cause : d.causes) result.causes.push_back(plain(cause));
  for (const diagnosis::ChannelGain& g : d.gain)
    result.gain.push_back({g.name, g.unit, g.rmse_before, g.rmse_calibrated, g.rmse_after, g.noise_floor});
  std::vector<diagnosis::StatedChange> changes;
  if (d.written.keeps_numbers) changes = app::stated_scatter(d, options.causes_only);
  for (diagnosis::StatedChange& cause : app::stated_causes(d)) changes.push_back(std::move(cause));
  diagnosis::ExtendedScenario extended = diagnosis::extended_scenario(m.scenario, *m.twin, m.runs, changes, {});
  result.extended_scenario = std::move(extended.text);
  result.not_written = std::move(extended.not_written);
  return result;
}

}  // namespace

Diagnosis Machine::diagnose(const std::vector<Record>& measured, const DiagnoseOptions& options) const {
  return diagnosis_of(parts_->scenario, measured, options, true, parts_->listener);
}

Diagnosis Machine::calibrate(const std::vector<Record>& measured) const {
  return diagnosis_of(parts_->scenario, measured, {}, false, parts_->listener);
}

}  // namespace driftwright
