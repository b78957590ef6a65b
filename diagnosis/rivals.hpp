#pragma once
// How the odds are shared between a claim and others that were fitted in its place: over kinds, and over the places of one kind.
//
//     p_i = Z_i / sum Z_j,   Z: evidence of the hypothesis with i in the claim's place, prices paid
//     odds of the kind = sum of p over the claims of its effect, wherever they sit, and those that say the same of the same bodies;
//     odds of the place = share of these that sit where the claim does
//
// Two claims of one kind at two bodies leave open where it is, and not what it is. A claim that says the same in other words, as heat in a window that lasts to the
// end and heat from a time on, takes nothing away from either; heat for two minutes and a film that is less for two minutes are two things, of which one is true.

#include <string>
#include <vector>

namespace driftwright::diagnosis {

struct Rival {
  std::string effect, where;
  double log_evidence = 0.0;
  bool says_the_same = false;  ///< as the first one, in other words
};

/// Whether one of two kinds is of heat that is released and the other of an exchange: these are no two words for one thing, even where no reading tells them apart.
[[nodiscard]] bool are_apart(const std::string& effect, const std::string& other);

struct Odds {
  double kind = 1.0, place = 1.0;
};

inline constexpr double kSure = 0.9;  ///< of the odds: from there on a kind, and a place, counts as told

/// @param rivals  the claim itself first, at least that
[[nodiscard]] Odds odds_of(const std::vector<Rival>& rivals);
/// Share of each in all.
[[nodiscard]] std::vector<double> shares_of(const std::vector<Rival>& rivals);
/// Those beside which the claim is not told, the likeliest first: where its kind is not sure the fewest of all that hold kSure of the odds with it; where only its place
/// is not, the fewest of its kind that do. Empty: kind and place are sure.
[[nodiscard]] std::vector<std::size_t> open_rivals(const std::vector<Rival>& rivals);

}  // namespace driftwright::diagnosis
