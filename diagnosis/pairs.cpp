#include "diagnosis/pairs.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace driftwright::diagnosis {
namespace {

constexpr std::size_t kMostFirst = 40;  // candidates that a pair begins with
constexpr double kToldApart = 0.98;     // cosine: more alike than that, two causes are one
constexpr double kSeen = 1e-12;         // squares of a signature
constexpr double kNoPair = -1e200;      // nats of what is no pair

/// A signature beside the numbers that are fitted anyway.
struct Seen {
  std::size_t signature = 0;
  double square = 0.0, product = 0.0;  ///< with itself, with what is left of the readings
  Eigen::VectorXd along;               ///< its products with the slopes of those numbers
  LinearGain alone;
};

const Variant& law_of(const std::vector<Candidate>& candidates, const Signature& s) {
  return candidates[s.candidate].variants[s.variant];
}

struct TwoSizes {
  double gain = -1e300;
  std::array<double, 2> x = {};
};

/// Both fitted at once; none where one of them is out of its range.
TwoSizes together(const Variant& a, const Variant& b, const Seen& of_a, const Seen& of_b, double across) {
  const std::array<const Variant*, 2> law = {&a, &b};
  const Eigen::Vector2d sd(a.knobs[0].prior_sd, b.knobs[0].prior_sd);
  const Eigen::Array2d width(heavy_tailed_width(sd[0], of_a.alone.x), heavy_tailed_width(sd[1], of_b.alone.x));
  Eigen::Matrix2d squares;
  squares << of_a.square, across, across, of_b.square;
  const Eigen::Vector2d products(of_a.product, of_b.product);
  Eigen::Matrix2d held = squares;
  held.diagonal().array() += width.square().inverse();
  const Eigen::Vector2d x = held.inverse() * products;
  TwoSizes two{.gain = products.dot(x) - 0.5 * x.dot(squares * x), .x = {x[0], x[1]}};
  two.gain -= 0.5 * std::log(held.determinant()) + sd.array().log().sum();
  for (std::size_t i = 0; i < 2; ++i) {
    const Knob& size = law[i]->knobs[0];
    if (size.scale == Knob::Scale::kLinear && size.x(size.value(two.x[i])) != two.x[i]) return {};
    two.gain -=
        heavy_tailed_cost(size.prior_sd, two.x[i]) + law[i]->price_nats + std::log(static_cast<double>(law[i]->grid.size()));
  }
  return two;
}

}  // namespace

std::vector<ScoredPair> best_pairs(const std::vector<Candidate>& candidates, const std::vector<Signature>& signatures,
                                   const Projection& projection, std::size_t n) {
  std::vector<Seen> all(signatures.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < signatures.size(); ++i) {
    const Variant& law = law_of(candidates, signatures[i]);
    const Eigen::VectorXd& s = signatures[i].column;
    Seen& seen = all[i];
    seen = {.signature = i,
            .square = projection.square(s),
            .product = s.dot(projection.rest),
            .along = projection.slopes.transpose() * s,
            .alone = {}};
    if (!law.all_or_nothing && seen.square > kSeen) seen.alone = linear_gain(law, seen.square, seen.product);
  }
  std::erase_if(
      all, [&](const Seen& s) { return !(s.square > kSeen) || law_of(candidates, signatures[s.signature]).all_or_nothing; });
  std::stable_sort(all.begin(), all.end(), [](const Seen& a, const Seen& b) { return a.alone.gain > b.alone.gain; });

  std::vector<const Seen*> firsts;  // the best law of each candidate
  for (const Seen& s : all) {
    if (firsts.size() == kMostFirst) break;
    const bool is_known = std::any_of(firsts.begin(), firsts.end(), [&](const Seen* f) {
      return signatures[f->signature].candidate == signatures[s.signature].candidate;
    });
    if (!is_known) firsts.push_back(&s);
  }
  std::vector<std::map<std::size_t, ScoredPair>> of_first(firsts.size());  // by the other candidate
#pragma omp parallel for schedule(dynamic)
  for (std::size_t f = 0; f < firsts.size(); ++f) {
    const Seen& a = *firsts[f];
    const Signature& first = signatures[a.signature];
    const Eigen::VectorXd apart = projection.factor.solve(a.along);
    for (const Seen& b : all) {
      const Signature& second = signatures[b.signature];
      if (second.candidate == first.candidate) continue;
      const double across = first.column.dot(second.column) - b.along.dot(apart);
      if (across * across > kToldApart * kToldApart * a.square * b.square) continue;
      const TwoSizes two = together(law_of(candidates, first), law_of(candidates, second), a, b, across);
      const double gain = two.gain - law_price(candidates[first.candidate]) - law_price(candidates[second.candidate]);
      if (!(gain > kNoPair)) continue;  // one of them out of its range
      const auto scored = [&](const Signature& s, double x) {
        return Score{.candidate = s.candidate, .variant = s.variant, .start = start_at(law_of(candidates, s), s.shape, x)};
      };
      ScoredPair& best = of_first[f][second.candidate];
      if (gain > best.gain) best = {scored(first, two.x[0]), scored(second, two.x[1]), gain};
    }
  }
  std::vector<ScoredPair> pairs;
  for (auto& by_other : of_first) {
    for (auto& [other, pair] : by_other) pairs.push_back(std::move(pair));
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const ScoredPair& a, const ScoredPair& b) { return a.gain > b.gain; });
  std::vector<ScoredPair> best;
  for (ScoredPair& p : pairs) {
    if (best.size() == n) break;
    const bool is_known = std::any_of(best.begin(), best.end(), [&](const ScoredPair& b) {
      return b.first.candidate == p.second.candidate && b.second.candidate == p.first.candidate;
    });
    if (!is_known) best.push_back(std::move(p));
  }
  return best;
}

}  // namespace driftwright::diagnosis
