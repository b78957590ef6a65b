#include "compensation/predictors/deployed_follower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/normal.hpp"
#include "base/record_channel.hpp"

namespace driftwright::compensation {
namespace {

constexpr std::size_t kNumbersOfState = 8, kNumbersOfInput = 15;
constexpr double kForgotten = 5.0;  // time constants: 1 % of the start is left

std::array<double, kNumbersOfState> numbers_of(const drift_state& s) {
  return {static_cast<double>(s.has_repaired),
          static_cast<double>(s.has_guarded),
          static_cast<double>(s.is_strange),
          s.time_s,
          s.deserved,
          s.trust,
          s.prediction_um,
          s.correction_um};
}
drift_state state_of(const double* n) {
  return {n[0] != 0.0, n[1] != 0.0, n[2] != 0.0, n[3], n[4], n[5], n[6], n[7]};
}

std::array<double, kNumbersOfInput> numbers_of(const drift_input_state& s) {
  return {static_cast<double>(s.is_doubted),
          static_cast<double>(s.doubt),
          s.doubt_size,
          static_cast<double>(s.has_start),
          static_cast<double>(s.has_last),
          static_cast<double>(s.is_out),
          static_cast<double>(s.is_untold),
          s.base,
          s.start,
          s.used,
          s.last,
          s.last_s,
          s.doubted_until_s,
          static_cast<double>(s.has_first),
          s.first};
}
drift_input_state input_of(const double* n) {
  drift_input_state s{};
  s.is_doubted = n[0] != 0.0;
  s.doubt = static_cast<int>(n[1]);
  s.doubt_size = n[2];
  s.has_start = n[3] != 0.0;
  s.has_last = n[4] != 0.0;
  s.is_out = n[5] != 0.0;
  s.is_untold = n[6] != 0.0;
  s.base = n[7];
  s.start = n[8];
  s.used = n[9];
  s.last = n[10];
  s.last_s = n[11];
  s.doubted_until_s = n[12];
  s.has_first = n[13] != 0.0;
  s.first = n[14];
  return s;
}

}  // namespace

DeployedFollower::DeployedFollower(const DeployedPredictor& deployed)
    : deployed_(deployed), follower_(deployed.predictor->follow()) {
  if (!deployed.fail_safe) return;
  table_.emplace(fail_safe_table(*deployed.fail_safe));
  const std::size_t n = deployed.fail_safe->guards.size();
  inputs_.resize(n);
  room_.resize(n * (n + 1));
  read_.resize(n);
  repaired_.resize(n);
}

FollowedCorrection DeployedFollower::next(MachineRun& run) {
  Record& readings = run.readings;
  const std::size_t last = readings.n_samples() - 1;
  const double dt_s = last > 0 ? readings.time_s[last] - readings.time_s[last - 1] : 0.0;
  if (!table_) {
    const double drift_um = follower_->next(run);
    return {.prediction_um = drift_um,
            .correction_um = std::isfinite(drift_um) ? drift_um : 0.0,
            .trust = 1.0,
            .interval_um = deployed_.interval_um,
            .half_width_um = deployed_.interval_um};
  }
  if (channel_.empty()) {
    for (const FailSafe::Guard& g : deployed_.fail_safe->guards) channel_.push_back(channel_index(readings, g.input));
  }
  for (std::size_t k = 0; k < channel_.size(); ++k) read_[k] = readings.channels[channel_[k]].values[last];
  const double deserved =
      drift_repair(&table_->safe, &repair_, inputs_.data(), room_.data(), read_.data(), dt_s, repaired_.data());
  for (std::size_t k = 0; k < channel_.size(); ++k) readings.channels[channel_[k]].values[last] = repaired_[k];
  const double drift_um = follower_->next(run);
  const double now = std::min(deserved, follower_->deserved_trust());
  const double correction_um = drift_guarded_um(&table_->safe, &guard_, now, drift_um, dt_s);
  least_trust_ = std::min({now, guard_.trust, 1.0 + (least_trust_ - 1.0) * std::exp(-dt_s / kRemembersDoubt_s)});
  std::optional<double> interval_um = interval_in_force_um(deployed_, least_trust_, follower_->deviation_um());
  const std::optional<double> half_width_um = interval_um;
  if (interval_um) *interval_um += std::abs(guard_.prediction_um - correction_um);
  FollowedCorrection c{.prediction_um = drift_um,
                       .correction_um = correction_um,
                       .trust = guard_.trust,
                       .interval_um = interval_um,
                       .half_width_um = half_width_um};
  if (deployed_.member_residuals.empty()) return c;
  for (double member_um : follower_->members_um())
    c.members_um.push_back(probe_member_um(correction_um, guard_.trust, drift_um, member_um));
  return c;
}

std::vector<std::string> DeployedFollower::doubted() const {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < inputs_.size(); ++k) {
    if (inputs_[k].is_doubted) names.push_back(deployed_.fail_safe->guards[k].input);
  }
  for (std::string& name : follower_->given_up()) names.push_back(std::move(name));
  if (repair_.is_strange && !(repair_.time_s > kForgotten * deployed_.fail_safe->start_s))
    names.emplace_back(fmt::format("the start: {}", kStrangeStart));
  if (follower_->deserved_trust() < 1.0) names.emplace_back("the model: its thermometers keep away from what it expects");
  return names;
}

std::vector<double> DeployedFollower::memory() const {
  std::vector<double> m = {least_trust_};
  const auto add = [&](const auto& numbers) {
    for (double x : numbers) m.push_back(x);
  };
  add(numbers_of(repair_));
  add(numbers_of(guard_));
  for (const drift_input_state& in : inputs_) add(numbers_of(in));
  add(follower_->memory());
  return m;
}

void DeployedFollower::recall(std::span<const double> memory) {
  const std::size_t own = 1 + 2 * kNumbersOfState + kNumbersOfInput * inputs_.size();
  if (memory.size() < own) throw std::logic_error("the memory of another predictor");
  least_trust_ = memory[0];
  const std::span<const double> rest = memory.subspan(1);
  repair_ = state_of(rest.data());
  guard_ = state_of(rest.data() + kNumbersOfState);
  for (std::size_t k = 0; k < inputs_.size(); ++k)
    inputs_[k] = input_of(rest.data() + 2 * kNumbersOfState + kNumbersOfInput * k);
  follower_->recall(memory.subspan(own));
}

}  // namespace driftwright::compensation
