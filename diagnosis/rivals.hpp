#pragma once
// Odds of a claim against the others that were fitted in its place: of its kind, and of its place within the kind.
//
// p_i = Z_i / sum Z_j,   Z: evidence of the hypothesis with i in the claim's place, after costs
//     odds of the kind = sum of p over the claims of its effect, at any place, and those that mean the same there;
//     odds of the place = share of these that have the claim's place
//
// Two claims of one kind at two bodies leave the place open, but not the kind. A claim with the same meaning in other
// words, such as heat in a window that lasts to the end and heat from a time on, does not reduce the odds of either. Heat
// for two minutes and a film that is weaker for two minutes are different claims, of which only one is true.

#include <string>
#include <vector>

namespace driftwright::diagnosis {

struct Rival {
  std::string effect, where;
  double log_evidence = 0.0;
  bool says_the_same = false;  ///< the same meaning as the first one, in other words
};

struct Odds {
  double kind = 1.0, place = 1.0;
};

inline constexpr double kSure = 0.9;  ///< odds from which a kind, or a place, counts as certain

/// @param rivals  at least the claim itself, which comes first
[[nodiscard]] Odds odds_of(const std::vector<Rival>& rivals);
/// The share of each in all.
[[nodiscard]] std::vector<double> shares_of(const std::vector<Rival>& rivals);
/// The rivals that leave the claim open, the likeliest first. If its kind is uncertain: the fewest that have kSure of the
/// odds together with it; if only its place is: the fewest of its kind that do. Empty: kind and place are certain.
[[nodiscard]] std::vector<std::size_t> open_rivals(const std::vector<Rival>& rivals);

}  // namespace driftwright::diagnosis
