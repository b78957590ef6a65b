#include "compensation/sensors/exchange_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/lists.hpp"
#include "base/random.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kHelps = 1e-9;  // of the remaining error: smaller improvements are rounding
constexpr std::uint64_t kSeed = 1;
constexpr int kTriedAtRandom = 400, kMostBeginnings = 20;  // candidates times random starts

/// The candidate that leaves the smallest error when added to a set; -1 if all are in it.
int best_beside(const std::vector<int>& set, const std::vector<double>& left_um) {
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < left_um.size(); ++c) {
    if (left_um[c] < least && !is_in(set, static_cast<int>(c))) {
      least = left_um[c];
      best = static_cast<int>(c);
    }
  }
  return best;
}

ThermometerSet exchanged(const DriftLeft& left, std::vector<int> members, std::size_t n_fixed, const Listener& listener) {
  double least = left.of(members);
  std::size_t n_still = 0;  // consecutive members without a helpful exchange
  for (std::size_t i = n_fixed; n_still < members.size() - n_fixed && !listener.wants_end();) {
    std::vector<int> rest = members;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    const std::vector<double> with = left.with_each(rest);
    const int best = best_beside(rest, with);
    if (best >= 0 && best != members[i] && with[static_cast<std::size_t>(best)] < (1.0 - kHelps) * least) {
      members[i] = best;
      least = with[static_cast<std::size_t>(best)];
      n_still = 0;
    }
    ++n_still;
    i = i + 1 < members.size() ? i + 1 : n_fixed;
  }
  return {members, left.of(members)};
}

/// Random sets, from size two on, one size after another.
std::vector<std::vector<int>> random_beginnings(int n_candidates, int most, int n_free, const std::vector<int>& fixed) {
  const int n_random = std::clamp(kTriedAtRandom / n_candidates, 1, kMostBeginnings);
  Random random(kSeed);
  std::vector<std::vector<int>> all;
  for (int n = 2; n <= most && n < n_free; ++n) {
    for (int r = 0; r < n_random; ++r) {
      std::vector<int> drawn = fixed;
      while (drawn.size() < fixed.size() + static_cast<std::size_t>(n)) {
        const int c = random.below(n_candidates);
        if (!is_in(drawn, c)) drawn.push_back(c);
      }
      all.push_back(std::move(drawn));
    }
  }
  return all;
}

/// A set as the numbers of a piece: members, and the remaining error.
Pieces::Numbers numbers_of(const ThermometerSet& set) {
  Pieces::Numbers numbers(set.members.begin(), set.members.end());
  numbers.push_back(set.left_um);
  return numbers;
}

ThermometerSet set_of(const Pieces::Numbers& numbers) {
  ThermometerSet set{{}, numbers.back()};
  for (std::size_t i = 0; i + 1 < numbers.size(); ++i) set.members.push_back(static_cast<int>(numbers[i]));
  return set;
}

}  // namespace

std::vector<ThermometerSet> best_sets(const DriftLeft& left, int n_most, const std::vector<int>& fixed,
                                      const Listener& listener, const Pieces& pieces) {
  const int n_free = left.n_candidates() - static_cast<int>(fixed.size());
  const int most = std::min(n_most, n_free);
  const std::vector<std::vector<int>> drawn = random_beginnings(left.n_candidates(), most, n_free, fixed);
  const auto from_drawn = [&](std::size_t b) {
    return pieces.of(
        b, [&] { return numbers_of(exchanged(left, drawn[b], fixed.size(), listener)); }, listener);
  };
  if (!pieces.shard.is_all()) {
    for (std::size_t b = 0; b < drawn.size(); ++b) {
      if (pieces.shard.has(b)) (void)from_drawn(b);
    }
  }
  std::vector<ThermometerSet> best;
  std::vector<int> members = fixed;
  std::size_t b = 0;
  for (int n = 1; n <= most && !listener.wants_end(); ++n) {
    const auto from_fewer = [&] {
      std::vector<int> begin = members;
      begin.push_back(best_beside(begin, left.with_each(begin)));
      return numbers_of(exchanged(left, begin, fixed.size(), listener));
    };
    ThermometerSet found = set_of(pieces.of(drawn.size() + static_cast<std::size_t>(n), from_fewer, listener));
    for (; b < drawn.size() && drawn[b].size() == found.members.size(); ++b) {
      const ThermometerSet other = set_of(from_drawn(b));
      if (other.left_um < (1.0 - kHelps) * found.left_um) found = other;
    }
    members = found.members;
    best.push_back(std::move(found));
    listener.share(static_cast<double>(n) / n_most);
  }
  return best;
}

}  // namespace driftwright::compensation
