#include "studies/measured_diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/shown_units.hpp"
#include "diagnosis/calibration.hpp"
#include "diagnosis/diagnosis_words.hpp"
#include "diagnosis/happening.hpp"
#include "diagnosis/judge.hpp"
#include "diagnosis/output_error.hpp"
#include "diagnosis/scatter.hpp"
#include "diagnosis/written_numbers.hpp"

namespace driftwright::studies {
namespace {

using diagnosis::Diagnosis, diagnosis::StatedChange;

void require_candidates(const MeasuredTwin& m, const std::vector<std::string>& without) {
  if (without.empty()) return;
  std::set<std::string> keys;
  for (const diagnosis::Candidate& c : diagnosis::candidates(*m.twin, m.runs, {})) keys.insert(c.effect);
  keys.insert(std::begin(diagnosis::kEventKeys), std::end(diagnosis::kEventKeys));
  for (const std::string& key : without) {
    if (keys.contains(key)) continue;
    throw InputError(fmt::format("without: no candidate has the key '{}'; allowed are {}", key, fmt::join(keys, ", ")));
  }
}

/// A number's interval, in the comment of its line, which has the number itself.
std::string interval_comment(const std::string& name, const diagnosis::Estimate& e) {
  return fmt::format("{} 95 %: {}{}", name, diagnosis::interval_text(e),
                     e.unit == "1" || e.unit.empty() ? "" : " " + e.unit);
}

/// The causes of a diagnosis as changes of the scenario. @param x  as diagnosis::written_x() gives it
std::vector<StatedChange> stated_causes(const Diagnosis& d, const Eigen::VectorXd& x) {
  std::vector<StatedChange> changes;
  if (!d.written.keeps_numbers) return changes;
  Eigen::Index first = x.size();
  for (const diagnosis::Claim& c : d.written.hypothesis) first -= static_cast<Eigen::Index>(c.knobs.size());
  for (std::size_t c = 0; c < d.written.hypothesis.size(); ++c) {
    const diagnosis::Claim& claim = d.written.hypothesis[c];
    const auto n = static_cast<Eigen::Index>(claim.knobs.size());
    const diagnosis::Cause& cause = d.causes.at(d.written.causes.at(c));
    std::vector<std::string> numbers = {
        fmt::format("{}, evidence gain {:.1f} nats", diagnosis::word(cause.standing), cause.log_evidence_gain)};
    for (const diagnosis::Estimate& p : cause.parameters) {
      if (p.low != p.high) numbers.push_back(interval_comment(p.name, p));
    }
    if (d.written.causes_alone) numbers.emplace_back("written as fitted beside the scenario's own numbers as they are");
    const std::string name = diagnosis::cause_name(cause);
    changes.push_back(
        {name, fmt::format("{}: {}", name, fmt::join(numbers, "; ")), diagnosis::change_of(claim, x.segment(first, n))});
    first += n;
  }
  return changes;
}

/// The scenario's own numbers as fitted, as changes of the scenario. @param x  as diagnosis::written_x() gives it
/// @param causes_only  only numbers that moved so far that the diagnosis reports them as causes
std::vector<StatedChange> stated_numbers(const Diagnosis& d, bool causes_only, const Eigen::VectorXd& x) {
  std::vector<StatedChange> changes;
  if (!d.written.keeps_numbers || d.written.causes_alone) return changes;
  const std::vector<diagnosis::Knob>& knobs = d.scatter;
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const diagnosis::Estimate& e = d.calibrated.at(i);
    const bool is_cause = std::find(d.moved.begin(), d.moved.end(), i) != d.moved.end();
    const double at = x[static_cast<Eigen::Index>(i)];
    if (at == 0.0 || (causes_only && !is_cause)) continue;  // at 0 the scenario's value is as good as the fitted one
    changes.push_back(
        {e.name, interval_comment(knobs[i].name, e),
         [knob = knobs[i], value = knobs[i].value(at)](diagnosis::TwinState& state) { knob.set(state, value); },
         is_cause ? "diagnosis" : "calibration"});
  }
  return changes;
}

void add_records(std::vector<std::string>& head, const MeasuredTwin& m) {
  for (const diagnosis::MeasuredRun& run : m.runs) head.push_back("  measured: " + name_in_comments(run.path));
}

std::vector<std::string> head_of_diagnosis(const MeasuredTwin& m, const Diagnosis& d, bool causes_only) {
  std::vector<std::string> head = {fmt::format("{} with what `driftwright diagnose` found written in; verdict: {}",
                                               name_in_comments(m.scenario.path), diagnosis::word(d.verdict))};
  for (const diagnosis::Cause& c : d.causes) {
    head.push_back(fmt::format("  {}{}: {} ({}){}{}", diagnosis::word(c.standing), c.is_written ? "" : ", not written in",
                               diagnosis::cause_name(c), c.law, c.parameters.empty() ? "" : ": ",
                               diagnosis::parameters_text(c)));
    if (!c.is_written) head.push_back(fmt::format("    not written, since {}", c.why_not_written));
    for (const diagnosis::Cause& a : c.alternatives) head.push_back("    or " + diagnosis::cause_name(a));
  }
  const bool names_lines = std::any_of(d.causes.begin(), d.causes.end(), [](const auto& c) { return !c.own.empty(); });
  if (names_lines) head.push_back(fmt::format("  lines are those of {}", name_in_comments(m.scenario.path)));
  if (!d.written.keeps_numbers) head.push_back(fmt::format("  nothing is written in: {}", d.written.why_nothing));
  if (const std::string taken_up = diagnosis::taken_up_text(d); !taken_up.empty()) head.push_back("  " + taken_up);
  add_records(head, m);
  if (d.written.keeps_numbers)
    head.emplace_back(causes_only || d.written.causes_alone
                          ? "  the scenario's own numbers are as they were"
                          : "  the scenario's own numbers are as fitted beside the causes (`calibration` in comments); "
                            "--causes-only leaves them");
  head.emplace_back("");
  return head;
}

std::vector<std::string> head_of_calibration(const MeasuredTwin& m, const Diagnosis& d) {
  std::vector<std::string> head = {
      fmt::format("{} with its numbers as `driftwright calibrate` fitted them", name_in_comments(m.scenario.path))};
  add_records(head, m);
  if (const std::string warning = diagnosis::calibration_warning(d); !warning.empty()) head.push_back("WARNING: " + warning);
  head.emplace_back("");
  return head;
}

/// What the written file says of its numbers together: nothing after a diagnosis, whose causes have numbers of their own.
/// @param x  as diagnosis::written_x() gives it
std::optional<scenarios::KnownTogether> known_after(const MeasuredTwin& m, const Diagnosis& d, const Eigen::VectorXd& x) {
  if (!d.written.keeps_numbers) return std::nullopt;
  scenarios::KnownTogether known = d.known_together;
  for (std::size_t i = 0; i < d.scatter.size() && !known.numbers.empty(); ++i) {
    const diagnosis::Knob& knob = d.scatter[i];
    if (!knob.in.empty()) continue;  // an offset of one record
    const double factor = knob.value(x[static_cast<Eigen::Index>(i)]) / knob.value(0.0);
    known.values.push_back(factor * diagnosis::written_value(*m.twin, knob));
  }
  return known;
}

/// Predicts all rows with the effects of the written scenario.
void predict_as_written(const MeasuredTwin& m, const WrittenScenario& written, Diagnosis& d) {
  if (!written.is_readable()) return;
  d.extended = read_of(m, written.effects);
  const auto before = diagnosis::output_errors(m.runs, d.as_written), after = diagnosis::output_errors(m.runs, d.extended);
  for (diagnosis::ChannelGain& g : d.gain) {
    if (!before.contains(g.name)) continue;
    const double scale = shown_scale(g.unit == "K" ? "K" : "m");
    g.rmse_all_before = scale * before.at(g.name).rms;
    g.rmse_written = scale * after.at(g.name).rms;
  }
}

}  // namespace

MeasuredDiagnosis diagnose(const MeasuredTwin& m, const DiagnosisRequest& request, const Listener& listener) {
  require_candidates(m, request.without);
  diagnosis::DiagnosisOptions how = m.how;
  how.without = {request.without.begin(), request.without.end()};
  MeasuredDiagnosis result{
      diagnosis::diagnose(*m.twin, m.on_other_mesh ? &*m.on_other_mesh : nullptr, m.runs, how, listener), {}};
  listener.begin("writing");
  if (request.causes_only) diagnosis::leave_numbers(result.found);
  const Eigen::VectorXd x = diagnosis::written_x(result.found, request.causes_only);
  std::vector<StatedChange> changes = stated_numbers(result.found, request.causes_only, x);  // the fit's order
  for (StatedChange& cause : stated_causes(result.found, x)) changes.push_back(std::move(cause));
  result.written = written_scenario(m, changes, head_of_diagnosis(m, result.found, request.causes_only), request.file,
                                    known_after(m, result.found, x));
  predict_as_written(m, result.written, result.found);
  return result;
}

MeasuredDiagnosis calibrate(const MeasuredTwin& m, const std::filesystem::path& file, const Listener& listener) {
  MeasuredDiagnosis result{
      diagnosis::calibrate(*m.twin, m.on_other_mesh ? &*m.on_other_mesh : nullptr, m.runs, m.how, listener), {}};
  listener.begin("writing");
  const Eigen::VectorXd x = diagnosis::written_x(result.found, false);
  result.written = written_scenario(m, stated_numbers(result.found, false, x), head_of_calibration(m, result.found), file,
                                    known_after(m, result.found, x));
  predict_as_written(m, result.written, result.found);
  return result;
}

}  // namespace driftwright::studies
