#include "diagnosis/experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "diagnosis/experiment_check.hpp"
#include "diagnosis/experiment_family.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kRows_s = 60.0;
constexpr double kTells = 5.0;   // d' above which fewer than 1 record in 40 supports the wrong explanation
constexpr double kHardly = 2.0;  // d' below which another thermometer is worth its price; above, a cyclogram is free
constexpr NoiseModel kThermometer = {0.05, 0.0, 0.0};  // K, if no thermometer was measured
constexpr const char* kMeanOf = "mean of ";

/// Without linear columns, which belong to the present runs.
Explanation explanation_of(const Fitter& fitter, Hypothesis hypothesis, const Fit& fit) {
  const auto n_scatter = static_cast<Eigen::Index>(fitter.scatter().size());
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    if (i < n_scatter || i >= fitter.n_nuisance()) kept.push_back(i);
  }
  Explanation e{std::move(hypothesis), fit.x(kept), fit.covariance(kept, kept)};
  Eigen::Index at = n_scatter;
  for (const Claim& c : e.hypothesis) {  // numbers without slope have no covariance: they keep the value from the search
    for (const Knob& k : c.knobs) {
      if (c.all_or_nothing || k.is_jump()) {
        e.covariance.row(at).setZero();
        e.covariance.col(at).setZero();
        e.covariance(at, at) = 1e-12;
      }
      ++at;
    }
  }
  return e;
}

/// The open explanations: the search's hypothesis first, then those with another claim in the place of a finding.
struct Open {
  std::vector<Explanation> explanations;
  std::vector<Pair> pairs;
  std::vector<const Claim*> claims;  ///< in dispute, one per explanation; for the first, the first finding's
  std::vector<std::string> names;    ///< of these claims, in words
};

std::string words(const Claim& c) {
  return fmt::format("{} at {}", c.knobs.front().effect, c.knobs.front().where);
}

/// The search's hypothesis without one of its findings, fitted anew; none if the machine then has no solution.
std::optional<Explanation> without_finding(const Fitter& fitter, const SearchResult& result, std::size_t finding) {
  const Remainder rest = without_claims(result.hypothesis, {finding}, fitter.n_nuisance());
  if (rest.hypothesis.empty()) return explanation_of(fitter, {}, result.without);
  const Eigen::VectorXd x = result.fit.x(rest.x);
  Twin::Workspace workspace(fitter.twin());
  Fit fit;
  if (!has_solution([&] { fit = fitter.fit(rest.hypothesis, x.tail(x.size() - fitter.n_nuisance()), workspace); }))
    return std::nullopt;
  return explanation_of(fitter, rest.hypothesis, fit);
}

Open open_questions(const Fitter& fitter, const SearchResult& result, const std::vector<char>& in_doubt) {
  Open open;
  open.explanations.push_back(explanation_of(fitter, result.hypothesis, result.fit));
  for (std::size_t f = 0; f < result.findings.size(); ++f) {
    const Finding& finding = result.findings[f];
    const bool may_be_none = f < in_doubt.size() && in_doubt[f];
    if (finding.alternatives.empty() && !may_be_none) continue;
    const auto name = [&](const Claim& claim, std::string words) {
      open.claims.push_back(&claim);
      open.names.push_back(std::move(words));
    };
    if (open.claims.empty()) name(finding.claim, words(finding.claim));
    std::vector<std::size_t> rivals = {0};
    if (may_be_none) {
      if (auto without = without_finding(fitter, result, f)) {
        open.pairs.push_back({0, open.explanations.size()});
        rivals.push_back(open.explanations.size());
        open.explanations.push_back(std::move(*without));
        name(finding.claim, "nothing in its place");
      }
    }
    for (const Finding::Alternative& a : finding.alternatives) {
      Hypothesis other = result.hypothesis;
      other.erase(other.begin() + static_cast<std::ptrdiff_t>(f));
      other.push_back(a.claim);
      for (std::size_t r : rivals) open.pairs.push_back({r, open.explanations.size()});
      rivals.push_back(open.explanations.size());
      open.explanations.push_back(explanation_of(fitter, std::move(other), a.fit));
      name(a.claim, words(a.claim));
    }
  }
  return open;
}

/// Channels of all runs, without readings.
std::vector<MeasuredChannel> channels_of(const std::vector<MeasuredRun>& runs) {
  std::vector<MeasuredChannel> list;
  for (const MeasuredRun& run : runs) {
    for (const MeasuredChannel& c : run.channels) {
      if (std::none_of(list.begin(), list.end(), [&](const MeasuredChannel& l) { return l.name == c.name; }))
        list.push_back(c);
    }
  }
  return list;
}

/// The noise of the median thermometer.
NoiseModel thermometer_noise(const std::vector<MeasuredChannel>& channels, const std::map<std::string, NoiseModel>& noise) {
  std::vector<NoiseModel> list;
  for (const MeasuredChannel& c : channels) {
    if (c.unit == "K") list.push_back(noise.at(c.name));
  }
  if (list.empty()) return kThermometer;
  const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
  std::nth_element(list.begin(), middle, list.end(),
                   [](const NoiseModel& a, const NoiseModel& b) { return a.total() < b.total(); });
  return *middle;
}

/// A future record, and the prediction of each explanation for it.
struct Ahead {
  std::vector<MeasuredRun> runs;  ///< a single one
  std::unique_ptr<Fitter> fitter;
  std::vector<Outlook> outlooks;

  /// The least d' of all pairs, seen by some channels.
  [[nodiscard]] double least(const std::vector<Pair>& pairs, const std::set<std::string>& channels) const {
    std::vector<Outlook> seen;
    for (const Outlook& o : outlooks) seen.push_back(only(o, fitter->comparison(), channels));
    double d = std::numeric_limits<double>::infinity();
    for (const Pair& p : pairs) d = std::min(d, discrimination(seen[p.first], seen[p.second]));
    return d;
  }
};

/// @return null if an explanation has no solution there
std::unique_ptr<Ahead> look_ahead(const Fitter& fitter, const MeasuredRun& run,
                                  const std::map<std::string, NoiseModel>& noise,
                                  const std::vector<Explanation>& explanations) {
  auto ahead = std::make_unique<Ahead>();
  ahead->runs = {run};
  const bool is_solved = has_solution([&] {
    ahead->fitter = std::make_unique<Fitter>(fitter.twin(), ahead->runs, fitter.scatter(), std::vector<Prediction>{});
    ahead->fitter->set_noise(noise);
    Fit at;
    at.x = explanations.front().x;
    ahead->fitter->settle(explanations.front().hypothesis, at);
    Twin::Workspace workspace(fitter.twin());
    for (const Explanation& e : explanations) ahead->outlooks.push_back(outlook(*ahead->fitter, e, workspace));
  });
  if (!is_solved) return nullptr;
  return ahead;
}

/// Whether a claim has no effect in a future record, since it happened only once.
bool is_silent(const Ahead& ahead, const Explanation& of, const Claim& claim) {
  Hypothesis others;
  Eigen::VectorXd x = of.x.head(ahead.fitter->n_nuisance());
  Eigen::Index at = x.size();
  for (const Claim& c : of.hypothesis) {
    const auto n = static_cast<Eigen::Index>(c.knobs.size());
    if (c.candidate != claim.candidate) {
      others.push_back(c);
      x.conservativeResize(x.size() + n);
      x.tail(n) = of.x.segment(at, n);
    }
    at += n;
  }
  Twin::Workspace workspace(ahead.fitter->twin());
  return ahead.fitter->predict(of.hypothesis, of.x, workspace) == ahead.fitter->predict(others, x, workspace);
}

double mean_ambient(const std::vector<MeasuredRun>& runs) {
  double sum = 0.0;
  Eigen::Index n = 0;
  for (const MeasuredRun& run : runs) {
    for (double t_s : run.time_s) sum += run.ambient.at(t_s);
    n += static_cast<Eigen::Index>(run.time_s.size());
  }
  return sum / static_cast<double>(n);
}

MeasuredRun run_of(const std::vector<MeasuredRun>& runs, const Cyclogram& cyclogram,
                   const std::vector<MeasuredChannel>& channels) {
  MeasuredRun run;
  run.name = cyclogram.name;
  run.cyclogram = cyclogram;
  run.ambient = {{0.0}, {mean_ambient(runs)}};
  run.has_ambient = runs.front().has_ambient;
  for (double t_s = 0.0; t_s <= cyclogram.duration_s() + 1e-6; t_s += kRows_s) run.time_s.push_back(t_s);
  set_grid(run);
  run.channels = channels;
  for (MeasuredChannel& c : run.channels) c.value = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(run.time_s.size()));
  return run;
}

/// The largest difference of any pair of explanations in an output [K].
double largest_difference_K(const Ahead& ahead, const Open& open, int output) {
  Twin::Workspace workspace(ahead.fitter->twin());
  std::vector<Eigen::VectorXd> rows;
  for (const Explanation& e : open.explanations)
    rows.push_back(ahead.fitter->predict(e.hypothesis, e.x, workspace).front().row(output).transpose());
  double most_K = 0.0;
  for (const Pair& p : open.pairs) most_K = std::max(most_K, (rows[p.first] - rows[p.second]).cwiseAbs().maxCoeff());
  return most_K;
}

std::string why_of(const Experiment& e, const Open& open, bool once_only) {
  const std::string of = fmt::format("{}", fmt::join(open.names, " and "));
  if (once_only) {
    return fmt::format(
        "{} each happened in one record only, which a new one does not show again; {}", of,
        e.extra_sensor && e.extra_sensor->discrimination >= kTells
            ? fmt::format("if it happens again, a thermometer on {} distinguishes them ({:.0f} times the noise)",
                          e.extra_sensor->region, e.extra_sensor->discrimination)
            : "no further thermometer would distinguish them either");
  }
  const std::string check =
      e.n_simulated > 0 ? fmt::format("; of {} such records simulated, {} showed which it was", e.n_simulated, e.n_told)
                        : "";
  if (e.by_sensor) {
    return fmt::format(
        "{} differ by {:.1f} times the noise in the best cyclogram of the family, and by {:.1f} with a "
        "thermometer on {}, what is not known of their numbers taken off{}",
        of, e.discrimination, e.extra_sensor->discrimination, e.extra_sensor->region, check);
  }
  if (e.discrimination < kTells) {
    return fmt::format("no cyclogram of the family surely distinguishes {} (at best {:.1f} times the noise){}", of,
                       e.discrimination, check);
  }
  return fmt::format("{} then differ by {:.0f} times the noise, what is not known of their numbers taken off{}", of,
                     e.discrimination, check);
}

}  // namespace

std::optional<Experiment> propose_experiment(const Fitter& fitter, const SearchResult& result,
                                             const std::vector<char>& in_doubt) {
  const Open open = open_questions(fitter, result, in_doubt);
  if (open.pairs.empty()) return std::nullopt;
  const std::vector<MeasuredRun>& runs = fitter.runs();
  std::vector<MeasuredChannel> channels = channels_of(runs);
  std::map<std::string, NoiseModel> noise = fitter.noise();
  const NoiseModel further = thermometer_noise(channels, noise);
  std::set<std::string> measured;
  for (const MeasuredChannel& c : channels) measured.insert(c.name);
  const auto& names = fitter.twin().outputs().name;
  for (std::size_t o = 0; o < names.size(); ++o) {  // as if each part had a thermometer
    if (!names[o].starts_with(kMeanOf) || measured.contains(names[o])) continue;
    channels.push_back({names[o], static_cast<int>(o), "K", {}});
    noise[names[o]] = further;
  }

  Experiment best;
  best.discrimination = -1.0;
  std::unique_ptr<Ahead> chosen;
  bool once_only = true;
  for (const Cyclogram& cyclogram : experiment_family(runs)) {
    auto ahead = look_ahead(fitter, run_of(runs, cyclogram, channels), noise, open.explanations);
    if (!ahead) continue;
    for (std::size_t e = 0; e < open.explanations.size() && once_only; ++e)
      once_only = is_silent(*ahead, open.explanations[e], *open.claims[e]);
    const double d = ahead->least(open.pairs, measured);
    if (d <= best.discrimination) continue;
    best.discrimination = d;
    best.cyclogram = cyclogram;
    chosen = std::move(ahead);
  }
  if (!chosen) return std::nullopt;
  if (once_only) {  // repeats the record, and its event with it
    double most_d = -1.0;
    for (const MeasuredRun& run : runs) {
      MeasuredRun repeated = run_of(runs, run.cyclogram, channels);
      repeated.ambient = run.ambient;
      auto ahead = look_ahead(fitter, repeated, noise, open.explanations);
      if (!ahead) continue;
      const double d = ahead->least(open.pairs, measured);
      if (d > most_d) {
        most_d = d;
        best.cyclogram = run.cyclogram;
        chosen = std::move(ahead);
      }
    }
    best.discrimination = 0.0;  // an event does not happen again in a new record
  }
  for (const MeasuredChannel& c : channels) {
    if (measured.contains(c.name)) continue;
    std::set<std::string> seen = measured;
    seen.insert(c.name);
    const double d = chosen->least(open.pairs, seen);
    if (best.extra_sensor && d <= best.extra_sensor->discrimination) continue;
    best.extra_sensor = Experiment::Sensor{c.name.substr(std::string(kMeanOf).size()),
                                           largest_difference_K(*chosen, open, c.output), d, best.cyclogram};
  }
  best.by_sensor =
      best.extra_sensor && best.discrimination < kHardly && best.extra_sensor->discrimination > best.discrimination + 1.0;
  if (!once_only) {
    MeasuredRun run = chosen->runs.front();
    std::erase_if(run.channels, [&](const MeasuredChannel& c) {
      return !measured.contains(c.name) && !(best.by_sensor && c.name == kMeanOf + best.extra_sensor->region);
    });
    const Check check = check_by_simulation(fitter, run, noise, open.explanations, open.pairs);
    best.n_simulated = check.n;
    best.n_told = check.n_told;
  }
  best.why = why_of(best, open, once_only);
  return best;
}

}  // namespace driftwright::diagnosis
