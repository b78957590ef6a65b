#include <fmt/format.h>

#include <algorithm>

#include "diagnosis/judge.hpp"
#include "diagnosis/no_solution.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kMostWorse = 1.1;    // largest ratio of the squares
constexpr double kWorseOfOne = 1.05;  // largest ratio of the RMSE of one channel
constexpr double kStrong = 20.0;      // nats of a cause that may be written alone

}  // namespace

std::optional<CausesAlone> causes_alone(const Fitter& fitter, const SearchResult& result,
                                        const std::map<std::string, NoiseModel>& noise) {
  if (fitter.runs().size() != 1) return std::nullopt;
  std::vector<std::size_t> strong;  // the strongest first
  for (std::size_t c = 0; c < result.findings.size(); ++c) {
    // An event of this record says nothing about another one.
    if (result.findings[c].log_evidence_gain >= kStrong && !has_time(result.hypothesis[c])) strong.push_back(c);
  }
  std::stable_sort(strong.begin(), strong.end(), [&](std::size_t a, std::size_t b) {
    return result.findings[a].log_evidence_gain > result.findings[b].log_evidence_gain;
  });
  Fold ahead = ahead_of(fitter.runs());
  Fitter whole(fitter.twin(), fitter.runs(), {}, {});
  whole.set_noise(fitter.noise(), fitter.shared_noise());
  const Fitter part(whole, ahead.fitted);
  Judge judge(fitter, result, noise, {ahead});
  const std::vector<Prediction> written = judge.written();
  Twin::Workspace workspace(fitter.twin());
  for (const std::size_t n : {strong.size(), std::size_t{1}}) {
    if (n == 0 || n > strong.size()) continue;
    std::vector<std::size_t> kept(strong.begin(), strong.begin() + static_cast<std::ptrdiff_t>(n)), left_out;
    std::sort(kept.begin(), kept.end());
    for (std::size_t c = 0; c < result.hypothesis.size(); ++c) {
      if (std::find(kept.begin(), kept.end(), c) == kept.end()) left_out.push_back(c);
    }
    const Remainder rest = without_claims(result.hypothesis, left_out, fitter.n_nuisance());
    const Eigen::VectorXd x = result.fit.x(rest.x);
    CausesAlone alone{.claims = std::move(kept), .hypothesis = rest.hypothesis, .fit = {}, .how = {}, .channels = {}};
    Fit before;
    const bool is_solved = has_solution([&] {
      before = part.fit(alone.hypothesis, x.tail(x.size() - fitter.n_nuisance()), workspace);
      alone.fit = whole.fit(alone.hypothesis, before.x, workspace);
    });
    if (!is_solved) continue;
    const std::vector<Prediction> extended = {before.prediction};
    if (judge.squares_over_noise(extended) * kMostWorse > judge.squares_over_noise(written)) continue;
    const Models models{.written = written, .calibrated = judge.filed(0), .extended = extended};
    alone.misses = misses_of(judge, models);
    alone.channels = channel_gains(fitter.runs(), noise, judge, models);
    const bool harms_one = std::any_of(alone.channels.begin(), alone.channels.end(), [](const ChannelGain& g) {
      return g.rmse_after > kWorseOfOne * g.rmse_before && g.rmse_after > g.noise_floor;
    });
    if (harms_one) continue;
    alone.how = fmt::format("{}; causes alone, the scenario's own numbers as they are written", kAheadWords);
    return alone;
  }
  return std::nullopt;
}

}  // namespace driftwright::diagnosis
