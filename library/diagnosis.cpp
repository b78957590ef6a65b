#include "effects/where_in_files.hpp"
#include "library/parts.hpp"
#include "studies/measured_diagnosis.hpp"

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

studies::MeasuredTwin twin_of(const scenarios::Scenario& scenario, const std::string& verb,
                              const std::vector<Record>& measured, const Listener& listener, bool as_recorded) {
  std::vector<ReadRecord> records;
  for (const Record& record : measured) records.push_back({.record = record, .notes = {}});
  return studies::open_measured_twin(scenario, verb, records, listener, as_recorded);
}

Diagnosis plain(const studies::MeasuredDiagnosis& what) {
  const auto& [d, written] = what;
  Diagnosis result{.verdict = diagnosis::word(d.verdict),
                   .reason = d.reason,
                   .causes = {},
                   .calibrated = plain(d.calibrated),
                   .holdout = d.holdout,
                   .gain = {},
                   .extended_scenario = written.is_readable() ? written.extended.text : "",
                   .not_written = written.extended.not_written};
  for (const diagnosis::Cause& cause : d.causes) result.causes.push_back(plain(cause));
  for (const diagnosis::ChannelGain& g : d.gain)
    result.gain.push_back(
        {g.name, g.unit, g.rmse_before, g.rmse_calibrated, g.rmse_after, g.noise_floor, g.rmse_all_before, g.rmse_written});
  return result;
}

}  // namespace

Diagnosis Machine::diagnose(const std::vector<Record>& measured, const DiagnoseOptions& options) const {
  const studies::MeasuredTwin m = twin_of(parts_->scenario, "diagnose", measured, parts_->listener, options.as_recorded);
  return plain(studies::diagnose(m, {.without = options.without, .causes_only = options.causes_only}, parts_->listener));
}

Diagnosis Machine::calibrate(const std::vector<Record>& measured, bool as_recorded) const {
  const studies::MeasuredTwin m = twin_of(parts_->scenario, "calibrate", measured, parts_->listener, as_recorded);
  return plain(studies::calibrate(m, "calibrated.yaml", parts_->listener));
}

}  // namespace driftwright
