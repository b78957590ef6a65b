#include "compensation/judging/probed_run.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "compensation/predictors/member_weights.hpp"

namespace driftwright::compensation {
namespace {

constexpr std::uint64_t kNoiseOfProbings = 31;  // its own sequence

bool is_heard(const ProbeFeedback& feedback) {
  const int verdict = feedback.state().verdict;
  return verdict != PROBE_TOO_EARLY && verdict != PROBE_NO_NUMBER;
}

}  // namespace

ProbedRun probed_run(std::span<const ProbedMember> members, std::span<const double> t_s, const RunProbing& how,
                     std::vector<double>* mean_weights) {
  const std::size_t n = members.size();
  std::vector<ProbeFeedback> filters;
  for (const ProbedMember& m : members)
    filters.emplace_back(*m.predictor->residual, m.predictor->probe, m.predictor->from_start);
  MemberWeights weights(n);
  Random random(how.seed, kNoiseOfProbings);
  ProbedRun run;
  std::vector<double> left_um, losses(n), sum_weights(n, 0.0);
  std::optional<double> last_read_um;
  double next_s = t_s.front() + how.every_s, probed_s = t_s.front();
  int n_after_fault = 0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    double left = 0.0;
    for (std::size_t m = 0; m < n; ++m) {
      filters[m].row(0.0, 0.0, i > 0 ? t_s[i] - t_s[i - 1] : 0.0);
      left += weights.weights()[m] * (members[m].left_um[i] - filters[m].estimate_um());
      sum_weights[m] += weights.weights()[m];
    }
    left_um.push_back(left);
    if (t_s[i] < next_s || !std::isfinite(left)) continue;
    const bool is_failed = how.fault != ProbeFault::kNone && t_s[i] >= how.fails_at_s;
    double read_um = left + how.noise_um * random.normal();
    if (is_failed && how.fault == ProbeFault::kBiased) read_um += how.error_um;
    if (is_failed && how.fault == ProbeFault::kStuck && last_read_um) read_um = *last_read_um;
    last_read_um = read_um;
    for (std::size_t m = 0; m < n; ++m) {  // the same reading as an error of each member's own correction
      (void)filters[m].probe_drift_um(read_um + members[m].left_um[i] - left);
      losses[m] = is_heard(filters[m]) ? probing_loss(filters[m].state()) : 0.0;
    }
    const auto leading = static_cast<std::size_t>(std::max_element(weights.weights().begin(), weights.weights().end()) -
                                                  weights.weights().begin());
    const bool is_taken = filters[leading].state().verdict == PROBE_TAKEN;
    ++run.n_probings;
    if (is_failed && ++n_after_fault > 0 && !is_taken && !run.noticed_at) run.noticed_at = n_after_fault;
    weights.learn(losses, share_after(t_s[i] - probed_s));
    probed_s = t_s[i];
    next_s += how.every_s * (1.0 + std::floor((t_s[i] - next_s) / how.every_s));
  }
  for (const ProbeFeedback& f : filters) run.n_refused = std::max(run.n_refused, f.state().n_refused);
  run.left = score(left_um);
  if (mean_weights) {
    for (double& w : sum_weights) w /= static_cast<double>(t_s.size());
    *mean_weights = std::move(sum_weights);
  }
  return run;
}

}  // namespace driftwright::compensation
