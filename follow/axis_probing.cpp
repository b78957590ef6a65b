#include "follow/axis_probing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/normal.hpp"

namespace driftwright::follow {
namespace {

struct Ahead {
  const char* words;
  double s;
};
constexpr Ahead kAhead[] = {{"15 min", 900.0}, {"1 h", 3600.0}, {"4 h", 14400.0}};

std::optional<std::size_t> channel_named(const std::string& name, const std::vector<Channel>& channels) {
  for (std::size_t k = 0; k < channels.size(); ++k) {
    if (is_probing(channels[k]) && channels[k].name == name) return k;
  }
  return std::nullopt;
}

}  // namespace

AxisProbing::AxisProbing(const std::string& target, std::vector<std::string> names, std::vector<probe_process> processes,
                         const std::vector<Channel>& channels)
    : names_(std::move(names)),
      feedback_(std::move(processes)),
      drift_(channel_named(kProbePrefix + target, channels)),
      left_(channel_named(kProbeLeftPrefix + target, channels)) {}

std::vector<std::string> AxisProbing::columns_of(const std::string& target, const std::vector<Channel>& channels) {
  std::vector<std::string> columns;
  for (const char* prefix : {kProbePrefix, kProbeLeftPrefix}) {
    if (channel_named(prefix + target, channels)) columns.push_back(prefix + target);
  }
  if (columns.size() > 1)
    throw InputError(fmt::format(
        "the stream has '{0}_um' and '{1}_um'; only one of them is allowed: {0} is the drift of the axis, {1} what "
        "the probe reads on the corrected axis",
        columns[0], columns[1]));
  return columns;
}

std::vector<double> AxisProbing::predicted_um() const {
  std::vector<double> um;
  for (const probe_member& m : feedback_.members()) um.push_back(m.prediction_um);
  return um;
}

void AxisProbing::wait(std::span<const double> predicted_um, double correction_um, double step_s) {
  feedback_.row(predicted_um, correction_um, step_s);
  is_probed_ = false;
}

void AxisProbing::hear(const std::vector<double>& values) {
  const bool has_drift = drift_ && std::isfinite(values[*drift_]), has_left = left_ && std::isfinite(values[*left_]);
  if (has_drift) (void)feedback_.probe_drift_um(values[*drift_]);
  if (has_left) (void)feedback_.probe_left_um(values[*left_]);
  is_probed_ = has_drift || has_left;
}

double AxisProbing::interval_um(double without_um, double ahead_s) const {
  if (feedback_.state().n_taken == 0) return without_um;
  const double deviation_um = feedback_.deviation_um(ahead_s);
  return std::max(without_um * deviation_um / feedback_.process().deviation_um, kNormal95 * deviation_um);
}

std::string AxisProbing::words() const {
  const probe_state& s = feedback_.state();
  const std::string off = fmt::format("it is {:.1f} um from what is expected ({:g} sigmas are {:.1f} um)",
                                      std::abs(s.off_um), PROBE_REFUSED, s.bound_um);
  switch (s.verdict) {
    case PROBE_TAKEN:
      return fmt::format("probing taken: {}", off);
    case PROBE_JUMP:
      return fmt::format(
          "probing taken as a jump of the axis: {}, but so was the one before it. Was the machine touched? If not, check "
          "tool "
          "and probe",
          off);
    case PROBE_TOO_EARLY:
      return "probing refused: it was touched before the first row; probe again";
    case PROBE_STUCK:
      return fmt::format(
          "probing refused: {}, and it is the same number as in the probings before; is the probe stuck, or is an old value "
          "sent again? Check probe and wiring",
          off);
    default:
      return fmt::format(
          "probing refused: {}; measured another tool, chips, or the machine was touched? Probe again: a second probing "
          "that "
          "agrees with this one is taken as a jump of the axis",
          off);
  }
}

ProbingState AxisProbing::state(std::optional<double> without_um) const {
  const probe_state& s = feedback_.state();
  ProbingState said{
      .residual_um = residual_um(), .deviation_um = feedback_.deviation_um(), .n_refused = feedback_.n_refused()};
  for (std::size_t k = 0; names_.size() > 1 && k < names_.size(); ++k)
    said.weights.emplace_back(names_[k], feedback_.members()[k].weight);
  if (!is_probed_) return said;
  ProbingAnswer answer{.is_taken = s.verdict == PROBE_TAKEN || s.verdict == PROBE_JUMP,
                       .off_um = s.off_um,
                       .bound_um = s.bound_um,
                       .words = words()};
  if (without_um && s.n_taken > 0) {
    for (const Ahead& ahead : kAhead) answer.intervals_um.emplace_back(ahead.words, interval_um(*without_um, ahead.s));
  }
  said.answer = std::move(answer);
  return said;
}

}  // namespace driftwright::follow
