#include "compensation/judging/probed_run.hpp"

#include <cmath>
#include <limits>

#include "base/random.hpp"

namespace driftwright::compensation {
namespace {

constexpr std::uint64_t kNoiseOfProbings = 31;  // its own sequence

}  // namespace

ProbedRun probed_run(std::span<const ProbedMember> members, std::span<const double> t_s, const RunProbing& how) {
  const std::size_t n = members.size();
  std::vector<probe_process> processes;
  for (const ProbedMember& m : members) processes.push_back(m.process);
  ProbeFeedback feedback(processes);
  Random random(how.seed, kNoiseOfProbings);
  ProbedRun run;
  std::vector<double> left_um, predictions_um(n);
  std::optional<double> last_read_um;
  double next_s = t_s.front() + how.every_s, in_force_um = 0.0;
  int n_after_fault = 0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    bool is_known = true;
    for (std::size_t m = 0; m < n; ++m) {
      predictions_um[m] = -members[m].left_um[i];  // as if there were no drift
      is_known = is_known && std::isfinite(predictions_um[m]);
    }
    feedback.row(predictions_um, in_force_um, i > 0 ? t_s[i] - t_s[i - 1] : 0.0);
    const double correction_um = predictions_um.front() + feedback.estimate_um();
    left_um.push_back(is_known ? -correction_um : std::numeric_limits<double>::quiet_NaN());
    const double before_um = in_force_um;
    if (is_known) in_force_um = correction_um;
    if (t_s[i] < next_s || !is_known) continue;
    const bool is_failed = how.fault != ProbeFault::kNone && t_s[i] >= how.fails_at_s;
    double read_um = how.noise_um * random.normal() - before_um;  // of the axis as it was corrected until now
    if (is_failed && how.fault == ProbeFault::kBiased) read_um += how.error_um;
    if (is_failed && how.fault == ProbeFault::kStuck && last_read_um) read_um = *last_read_um;
    last_read_um = read_um;
    (void)feedback.probe_left_um(read_um);
    ++run.n_probings;
    const bool is_taken = feedback.state().verdict == PROBE_TAKEN;
    if (is_failed && ++n_after_fault > 0 && !is_taken && !run.noticed_at) run.noticed_at = n_after_fault;
    next_s += how.every_s * (1.0 + std::floor((t_s[i] - next_s) / how.every_s));
  }
  run.n_refused = feedback.n_refused();
  run.left = score(left_um);
  if (how.keeps_rows) run.left_um = std::move(left_um);
  return run;
}

}  // namespace driftwright::compensation
