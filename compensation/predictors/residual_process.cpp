#include "compensation/predictors/residual_process.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace driftwright::compensation {
namespace {

constexpr std::size_t kLeastRows = 10;
constexpr int kTimeConstants = 25, kDeviations = 25;  // of the grid, in equal steps of the logarithm
constexpr double kLongest = 10.0;                     // longest time constant, over the longest series
constexpr double kLeastDeviation_um = 1e-3;

/// Logarithm of the likelihood of the series.
double log_likelihood(std::span<const ResidualSeries> series, const ResidualProcess& process, double reading_um) {
  const double most = process.deviation_um * process.deviation_um, noise = reading_um * reading_um;
  double log_likelihood = 0.0;
  for (const ResidualSeries& s : series) {
    double mean = 0.0, variance = most;
    for (std::size_t i = 0; i < s.time_s.size(); ++i) {
      if (i > 0) {
        const double kept = std::exp(-(s.time_s[i] - s.time_s[i - 1]) / process.time_constant_s);
        mean *= kept;
        variance = kept * kept * variance + (1.0 - kept * kept) * most;
      }
      const double total = variance + noise, off = s.off_um[i] - mean;
      log_likelihood -= 0.5 * (std::log(2.0 * std::numbers::pi * total) + off * off / total);
      mean += variance / total * off;
      variance *= noise / total;
    }
  }
  return log_likelihood;
}

double on_grid(double low, double high, int k, int n) {
  return low * std::pow(high / low, static_cast<double>(k) / (n - 1));
}

}  // namespace

std::optional<ResidualProcess> fit_residual_process(std::span<const ResidualSeries> series, double reading_um) {
  std::size_t n = 0, n_steps = 0;
  double square = 0.0, longest_s = 0.0, all_s = 0.0;
  for (const ResidualSeries& s : series) {
    n += s.time_s.size();
    for (double um : s.off_um) square += um * um;
    if (s.time_s.size() < 2) continue;
    n_steps += s.time_s.size() - 1;
    longest_s = std::max(longest_s, s.time_s.back() - s.time_s.front());
    all_s += s.time_s.back() - s.time_s.front();
  }
  if (n < kLeastRows || n_steps == 0) return std::nullopt;
  const double rms_um = std::max(std::sqrt(square / static_cast<double>(n)), 10.0 * kLeastDeviation_um);
  const double step_s = all_s / static_cast<double>(n_steps);
  ResidualProcess best;
  double most = -std::numeric_limits<double>::infinity();
  for (int t = 0; t < kTimeConstants; ++t) {
    for (int d = 0; d < kDeviations; ++d) {
      const ResidualProcess tried{on_grid(0.1 * rms_um, 3.0 * rms_um, d, kDeviations),
                                  on_grid(step_s, kLongest * longest_s, t, kTimeConstants), reading_um};
      const double log_l = log_likelihood(series, tried, std::max(reading_um, kLeastDeviation_um));
      if (log_l <= most) continue;
      most = log_l;
      best = tried;
    }
  }
  return best;
}

probe_process probe_process_of(const ResidualProcess& process, const Probe& probe, bool is_known) {
  return {process.deviation_um, process.time_constant_s, probe.noise_um, probe.lag_s, is_known ? 1 : 0};
}

namespace {

constexpr std::size_t kNumbersOfEstimate = 6, kNumbersOfPast = 3, kNumbersOfMember = 5;
constexpr std::size_t kNumbersOfProbings = 18 + 2 * PROBE_BANK * kNumbersOfEstimate + kNumbersOfPast * PROBE_PASTS;

void add_numbers_of(const probe_state& s, std::vector<double>& m) {
  m.insert(m.end(), {static_cast<double>(s.has_begun), static_cast<double>(s.has_jumped), static_cast<double>(s.n_pasts),
                     static_cast<double>(s.newest), s.time_s, static_cast<double>(s.verdict), s.off_um, s.bound_um,
                     static_cast<double>(s.n_taken), static_cast<double>(s.n_refused), static_cast<double>(s.n_jumps),
                     static_cast<double>(s.n_in_row), s.loss, static_cast<double>(s.has_read), s.read_um, s.step_um,
                     s.ln_chance, s.residual_um});
  for (const auto* bank : {&s.now, &s.jumped}) {
    for (const probe_estimate& e : *bank)
      m.insert(m.end(), {e.level_um, e.residual_um, e.level_um2, e.both_um2, e.residual_um2, e.weight});
  }
  for (const probe_past& p : s.past) m.insert(m.end(), {p.time_s, p.prediction_um, p.correction_um});
}

probe_state probe_state_of(std::span<const double> m) {
  const auto is_index = [&](std::size_t k, int most) { return m[k] >= 0.0 && m[k] <= most; };
  if (!is_index(2, PROBE_PASTS) || !is_index(3, PROBE_PASTS - 1)) throw std::logic_error("the memory of other probings");
  probe_state s{};
  s.has_begun = m[0] != 0.0;
  s.has_jumped = m[1] != 0.0;
  s.n_pasts = static_cast<int>(m[2]);
  s.newest = static_cast<int>(m[3]);
  s.time_s = m[4];
  s.verdict = static_cast<int>(m[5]);
  s.off_um = m[6];
  s.bound_um = m[7];
  s.n_taken = static_cast<int>(m[8]);
  s.n_refused = static_cast<int>(m[9]);
  s.n_jumps = static_cast<int>(m[10]);
  s.n_in_row = static_cast<int>(m[11]);
  s.loss = m[12];
  s.has_read = m[13] != 0.0;
  s.read_um = m[14];
  s.step_um = m[15];
  s.ln_chance = m[16];
  s.residual_um = m[17];
  const double* at = m.data() + 18;
  for (auto* bank : {&s.now, &s.jumped}) {
    for (probe_estimate& e : *bank) {
      e = {at[0], at[1], at[2], at[3], at[4], at[5]};
      at += kNumbersOfEstimate;
    }
  }
  for (probe_past& p : s.past) {
    p = {at[0], at[1], at[2]};
    at += kNumbersOfPast;
  }
  return s;
}

}  // namespace

void ProbeFeedback::row(std::span<const double> predictions_um, double correction_um, double step_s) {
  if (predictions_um.size() != members_.size())
    throw std::logic_error("ProbeFeedback: a prediction for each predictor is required");
  probe_members_row(processes_.data(), members_.data(), n(), predictions_um.data(), correction_um, step_s);
}

std::vector<double> ProbeFeedback::memory() const {
  std::vector<double> m;
  for (const probe_member& member : members_) {
    add_numbers_of(member.probing, m);
    if (members_.size() == 1) break;
    m.insert(m.end(), {member.prediction_um, member.weight, member.loss, static_cast<double>(member.is_leading),
                       static_cast<double>(member.n_refused)});
  }
  return m;
}

void ProbeFeedback::recall(std::span<const double> m) {
  const std::size_t each = kNumbersOfProbings + (members_.size() > 1 ? kNumbersOfMember : 0);
  if (m.size() != each * members_.size() || !std::all_of(m.begin(), m.end(), [](double x) { return std::isfinite(x); }))
    throw std::logic_error("the memory of other probings");
  std::vector<probe_member> members;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const std::span<const double> of_member = m.subspan(each * k, each), own = of_member.subspan(kNumbersOfProbings);
    probe_member member{};
    member.probing = probe_state_of(of_member);
    member.weight = 1.0;
    member.n_refused = member.probing.n_refused;
    if (members_.size() > 1) {
      member.prediction_um = own[0];
      member.weight = own[1];
      member.loss = own[2];
      member.is_leading = own[3] != 0.0;
      member.n_refused = static_cast<int>(own[4]);
    }
    members.push_back(member);
  }
  members_ = std::move(members);
}

}  // namespace driftwright::compensation
