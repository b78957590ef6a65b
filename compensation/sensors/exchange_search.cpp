#include "compensation/sensors/exchange_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.hpp"
#include "compensation/sensors/sensor_selection.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kHelps = 1e-9;  // of what is left: less is rounding
constexpr std::uint64_t kSeed = 1;
constexpr int kTriedAtRandom = 400, kMostBeginnings = 20;  // candidates times random beginnings

bool holds(const std::vector<int>& set, int candidate) {
  return std::find(set.begin(), set.end(), candidate) != set.end();
}

/// The candidate that leaves least beside a set; -1 where all are in it.
int best_beside(const std::vector<int>& set, const std::vector<double>& left_um) {
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < left_um.size(); ++c) {
    if (left_um[c] < least && !holds(set, static_cast<int>(c))) {
      least = left_um[c];
      best = static_cast<int>(c);
    }
  }
  return best;
}

ThermometerSet exchanged(const DriftLeft& left, std::vector<int> members, std::size_t n_fixed, const Listener& listener) {
  double least = left.of(members);
  std::size_t n_still = 0;  // members in a row that no exchange helped
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

}  // namespace

std::vector<ThermometerSet> best_sets(const DriftLeft& left, int n_most, const std::vector<int>& fixed, const Listener& listener) {
  const int n_free = left.n_candidates() - static_cast<int>(fixed.size());
  const int n_random = std::clamp(kTriedAtRandom / left.n_candidates(), 1, kMostBeginnings);
  Random random(kSeed);
  std::vector<ThermometerSet> best;
  std::vector<int> members = fixed;
  for (int n = 1; n <= std::min(n_most, n_free) && !listener.wants_end(); ++n) {
    members.push_back(best_beside(members, left.with_each(members)));
    ThermometerSet found = exchanged(left, members, fixed.size(), listener);
    for (int r = 0; r < n_random && n < n_free && n > 1; ++r) {
      std::vector<int> drawn = fixed;
      while (drawn.size() < members.size()) {
        const int c = random.below(left.n_candidates());
        if (!holds(drawn, c)) drawn.push_back(c);
      }
      const ThermometerSet other = exchanged(left, drawn, fixed.size(), listener);
      if (other.left_um < (1.0 - kHelps) * found.left_um) found = other;
    }
    members = found.members;
    best.push_back(std::move(found));
    listener.share(static_cast<double>(n) / n_most);
  }
  return best;
}

ThermometerSet best_of_all_sets(const DriftLeft& left, int n, const std::vector<int>& fixed) {
  std::vector<int> free;
  for (int c = 0; c < left.n_candidates(); ++c) {
    if (!holds(fixed, c)) free.push_back(c);
  }
  ThermometerSet best{{}, std::numeric_limits<double>::infinity()};
  for_each_set(static_cast<int>(free.size()), n, [&](std::span<const int> set) {
    std::vector<int> members = fixed;
    for (int i : set) members.push_back(free[static_cast<std::size_t>(i)]);
    const double um = left.of(members);
    if (um < best.left_um) best = {members, um};
  });
  return best;
}

}  // namespace driftwright::compensation
