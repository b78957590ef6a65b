#include "diagnosis/experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "diagnosis/experiment_check.hpp"
#include "diagnosis/experiment_family.hpp"
#include "diagnosis/foresight.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kRows_s = 60.0;
/// Uncertainty [nats] at which the likeliest explanation is right with kSure: of an entropy H it is wrong with at most
/// H / (2 ln 2). Source: Hellman and Raviv, IEEE Trans. Inf. Theory 16 (1970) 368-372.
const double kDecided = 2.0 * (1.0 - kSure) * std::numbers::ln2;
constexpr double kWorthIt = 0.5;  // share of what a cyclogram leaves that a thermometer must remove: it costs mounting
constexpr NoiseModel kThermometer = {0.05, 0.0, 0.0};  // K, if no thermometer was measured
constexpr const char* kMeanOf = "mean of ";
constexpr const char* kNothingInItsPlace = "nothing in its place";
constexpr double kLeastOpen = 0.01;  // probability that no open explanation is below, as of a statement that is listed

/// Without linear columns, which belong to the present runs.
Explanation explanation_of(const Fitter& fitter, Hypothesis hypothesis, const Fit& fit) {
  const auto n_scatter = static_cast<Eigen::Index>(fitter.scatter().size());
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < fit.x.size(); ++i) {
    if (i < n_scatter || i >= fitter.n_nuisance()) kept.push_back(i);
  }
  Explanation e{std::move(hypothesis), fit.x(kept), fit.covariance(kept, kept), fit.log_evidence};
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
  std::vector<OpenQuestion> questions;
  std::vector<const Claim*> claims;  ///< in dispute, one per explanation; for the first, the first finding's
  std::vector<std::string> names;    ///< of each question: its finding and what may be in its place, in words
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

struct Weighed {
  std::size_t of = 0;
  StatedPlace place = {};
  double probability = 0.0;  ///< of its statement
  double share = 0.0;        ///< of the odds
};

/// Names of one statement share its probability by their odds.
OpenQuestion weighed(const std::vector<Weighed>& list) {
  OpenQuestion q;
  std::vector<StatedPlace> places;
  double sum = 0.0;
  for (const Weighed& w : list) {
    double n = 0.0, shares = 0.0;
    for (const Weighed& other : list) {
      if (other.place != w.place) continue;
      n += 1.0;
      shares += other.share;
    }
    const auto place = std::find(places.begin(), places.end(), w.place);
    q.of.push_back(w.of);
    q.place.push_back(static_cast<std::size_t>(place - places.begin()));
    if (place == places.end()) places.push_back(w.place);
    q.weight.push_back(std::max(kLeastOpen, w.probability * (shares > 0.0 ? w.share / shares : 1.0 / n)));
    sum += q.weight.back();
  }
  for (double& w : q.weight) w /= sum;
  return q;
}

Open open_questions(const Fitter& fitter, const SearchResult& result, const std::vector<char>& in_doubt) {
  Open open;
  open.explanations.push_back(explanation_of(fitter, result.hypothesis, result.fit));
  for (std::size_t f = 0; f < result.findings.size(); ++f) {
    const Finding& finding = result.findings[f];
    const bool may_be_none = f < in_doubt.size() && in_doubt[f];
    if (finding.alternatives.empty() && !may_be_none) continue;
    if (open.claims.empty()) open.claims.push_back(&finding.claim);
    std::vector<std::string> names = {words(finding.claim)};
    std::vector<Weighed> list = {{0, result.names.at(finding.claim.candidate), finding.probability, finding.share}};
    for (const Finding::Alternative& a : finding.alternatives) {
      Hypothesis other = result.hypothesis;
      other.erase(other.begin() + static_cast<std::ptrdiff_t>(f));
      other.push_back(a.claim);
      list.push_back({open.explanations.size(), result.names.at(a.claim.candidate), a.probability, a.share});
      open.explanations.push_back(explanation_of(fitter, std::move(other), a.fit));
      open.claims.push_back(&a.claim);
      names.push_back(words(a.claim));
    }
    if (may_be_none) {
      if (auto without = without_finding(fitter, result, f)) {
        double stated = 0.0;  // probability of the places listed
        std::set<StatedPlace> places;
        for (const Weighed& w : list) stated += places.insert(w.place).second ? w.probability : 0.0;
        list.push_back(
            {open.explanations.size(), {StatedQuantity::kHeat, {kNothingInItsPlace}}, 1.0 - std::min(1.0, stated), 1.0});
        open.explanations.push_back(std::move(*without));
        open.claims.push_back(&finding.claim);
        names.emplace_back(kNothingInItsPlace);
      }
    }
    if (list.size() < 2) continue;
    open.questions.push_back(weighed(list));
    open.names.push_back(fmt::format("{}", fmt::join(names, " and ")));
  }
  return open;
}

/// What is not known [nats], of all questions.
double uncertainty(const Open& open) {
  double sum = 0.0;
  for (const OpenQuestion& q : open.questions) {
    for (double w : q.weight) sum -= w * std::log(w);
  }
  return sum;
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
  std::optional<OutlookProducts> outlooks;

  /// What the record is expected to tell [nats], seen by some channels. @param of_place  of quantity and place alone
  [[nodiscard]] double informs(const Open& open, double power, const std::set<std::string>& channels,
                               bool of_place = false) const {
    const Eigen::MatrixXd all = outlooks->affinities(channels, power);
    double sum = 0.0;
    for (const OpenQuestion& q : open.questions) {
      std::vector<std::size_t> each(q.of.size());
      std::iota(each.begin(), each.end(), std::size_t{0});
      const std::vector<Eigen::Index> of(q.of.begin(), q.of.end());
      sum += expected_information(q.weight, of_place ? q.place : each, all(of, of));
    }
    return sum;
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
    std::vector<Outlook> outlooks;
    for (const Explanation& e : explanations) outlooks.push_back(outlook(*ahead->fitter, e, workspace));
    ahead->outlooks.emplace(outlooks, ahead->fitter->comparison());
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
  return planned_run(cyclogram, kRows_s, {{0.0}, {mean_ambient(runs)}}, runs.front().has_ambient, channels);
}

/// The largest difference of an explanation from the first one in an output [K].
double largest_difference_K(const Ahead& ahead, const Open& open, int output) {
  Twin::Workspace workspace(ahead.fitter->twin());
  std::vector<Eigen::VectorXd> rows;
  for (const Explanation& e : open.explanations)
    rows.push_back(ahead.fitter->predict(e.hypothesis, e.x, workspace).front().row(output).transpose());
  double most_K = 0.0;
  for (const OpenQuestion& q : open.questions) {
    for (std::size_t i : q.of) most_K = std::max(most_K, (rows[i] - rows[q.of.front()]).cwiseAbs().maxCoeff());
  }
  return most_K;
}

std::string why_of(const Experiment& e, const Open& open, const std::string& of_place, bool once_only) {
  const std::string of = fmt::format("{}", fmt::join(open.names, ", and "));
  if (once_only) {
    return fmt::format("{} each happened in one record only, which a new one does not show again; {}", of,
                       e.extra_sensor && e.extra_sensor->decides > kWorthIt
                           ? fmt::format("if it happens again, a thermometer on {} removes {:.0f} % of what is uncertain",
                                         e.extra_sensor->region, 100.0 * e.extra_sensor->decides)
                           : "no further thermometer would distinguish them either");
  }
  const std::string check =
      e.n_simulated > 0 ? fmt::format("; of {} such records simulated, {} showed which it was", e.n_simulated, e.n_told)
                        : "";
  const double leaves = (1.0 - (e.by_sensor ? e.extra_sensor->decides : e.decides)) * uncertainty(open);
  const std::string gain =
      e.by_sensor ? fmt::format(
                        "the best record is expected to remove {:.0f} % of what is uncertain, and {:.0f} % with a "
                        "thermometer on {}",
                        100.0 * e.decides, 100.0 * e.extra_sensor->decides, e.extra_sensor->region)
                  : fmt::format("this record is expected to remove {:.0f} % of what is uncertain", 100.0 * e.decides);
  return fmt::format("to distinguish {}: {}{}{}{}", of, gain, of_place,
                     leaves > kDecided ? "; it may leave the question open" : "", check);
}

/// " (of quantity and place 95 %)", if more than one is open.
std::string of_place_text(const Ahead& ahead, const Open& open, double power, const std::set<std::string>& channels) {
  double uncertain = 0.0;
  for (const OpenQuestion& q : open.questions) {
    const auto n = static_cast<Eigen::Index>(q.of.size());
    uncertain += expected_information(q.weight, q.place, Eigen::MatrixXd::Identity(n, n));
  }
  if (!(uncertain > kLeastOpen)) return "";
  return fmt::format(" (of quantity and place {:.0f} %)", 100.0 * ahead.informs(open, power, channels, true) / uncertain);
}

}  // namespace

std::optional<Experiment> propose_experiment(const Fitter& fitter, const SearchResult& result,
                                             const std::vector<char>& in_doubt) {
  const Open open = open_questions(fitter, result, in_doubt);
  if (open.questions.empty()) return std::nullopt;
  const double power = result.statements.power, whole = uncertainty(open);
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
  const auto with = [&](const std::string& thermometer) {
    std::set<std::string> seen = measured;
    seen.insert(thermometer);
    return seen;
  };

  Experiment best;
  best.decides = -1.0;
  std::shared_ptr<Ahead> alone, aided;  // those that tell most, by the channels measured and by one more
  const auto take = [&](const std::shared_ptr<Ahead>& ahead) {
    const Cyclogram& cyclogram = ahead->runs.front().cyclogram;
    if (const double decides = ahead->informs(open, power, measured) / whole; decides > best.decides) {
      best.decides = decides;
      best.cyclogram = cyclogram;
      alone = ahead;
    }
    for (const MeasuredChannel& c : channels) {
      if (measured.contains(c.name)) continue;
      const double decides = ahead->informs(open, power, with(c.name)) / whole;
      if (best.extra_sensor && decides <= best.extra_sensor->decides) continue;
      best.extra_sensor = Experiment::Sensor{.region = c.name.substr(std::string(kMeanOf).size()),
                                             .difference_K = largest_difference_K(*ahead, open, c.output),
                                             .decides = decides,
                                             .cyclogram = cyclogram};
      aided = ahead;
    }
  };
  bool once_only = true;
  for (const Cyclogram& cyclogram : experiment_family(runs)) {
    const std::shared_ptr<Ahead> ahead = look_ahead(fitter, run_of(runs, cyclogram, channels), noise, open.explanations);
    if (!ahead) continue;
    for (std::size_t e = 0; e < open.explanations.size() && once_only; ++e)
      once_only = is_silent(*ahead, open.explanations[e], *open.claims[e]);
    take(ahead);
  }
  if (!alone) return std::nullopt;
  if (once_only) {  // repeats the record, and its event with it
    best = {};
    best.decides = -1.0;
    for (const MeasuredRun& run : runs) {
      MeasuredRun repeated = run_of(runs, run.cyclogram, channels);
      repeated.ambient = run.ambient;
      if (const std::shared_ptr<Ahead> ahead = look_ahead(fitter, repeated, noise, open.explanations)) take(ahead);
    }
    if (best.decides < 0.0) return std::nullopt;
    best.decides = 0.0;  // an event does not happen again in a new record
  }
  const auto leaves = [&](double decides) { return (1.0 - decides) * whole; };
  best.by_sensor = best.extra_sensor && leaves(best.decides) > kDecided &&
                   leaves(best.extra_sensor->decides) < kWorthIt * leaves(best.decides);
  const Ahead& chosen = best.by_sensor ? *aided : *alone;
  const std::set<std::string> seen = best.by_sensor ? with(kMeanOf + best.extra_sensor->region) : measured;
  if (best.by_sensor) best.cyclogram = best.extra_sensor->cyclogram;
  if (!once_only) {
    MeasuredRun run = chosen.runs.front();
    std::erase_if(run.channels, [&](const MeasuredChannel& c) { return !seen.contains(c.name); });
    const Check check = check_by_simulation(fitter, run, noise, open.explanations, open.questions, power);
    best.n_simulated = check.n;
    best.n_told = check.n_told;
  }
  best.why = why_of(best, open, of_place_text(chosen, open, power, seen), once_only);
  return best;
}

}  // namespace driftwright::diagnosis
