#pragma once
// Which effects do the data want? Forward, with exchange and pruning, by evidence.

#include <optional>
#include <set>

#include "diagnosis/rivals.hpp"
#include "diagnosis/signatures.hpp"

namespace driftwright::diagnosis {

/// Evidence [nats, the price of the number of candidates paid] that the best candidate has by chance where nothing is wrong: Gumbel's distribution.
struct Chance {
  double mode = -4.0, spread = 1.0;
  int n_simulated =
      0;  ///< sets of readings with nothing wrong that say so; 0: nobody simulated any, as where there is no candidate
  /// Share of machines without fault at which the best candidate has as much evidence or more.
  [[nodiscard]] double share_above(double gain) const;
  /// The evidence that this share of them reaches.
  [[nodiscard]] double gain_at(double share) const;
};

struct SearchOptions {
  int most_effects = 3;
  /// Share of faultless machines at which a cause may be suspected, and named.
  double wrongly_suspected = 0.01, wrongly_named = 1e-4;
  double wrongly_suspected_faint = 0.005;  ///< the same for a cause whose evidence is too little
  /// Evidence [nats] that a second, third, ... claim must bring at least, beyond the logarithm of how many candidates there are: chance is judged for machines
  /// without fault, a fault that is not quite of a law of the catalogue leaves something, and few machines are wrong in three ways.
  std::vector<double> least_gain = {0.5, 3.0, 12.0};
  double least_named = 4.0;         ///< nor anything below, however little chance has to offer: it is even odds
  double least_named_beside = 8.0;  ///< one of several is not named below, nor one whose windows were chosen to make it
  double least_named_timed =
      12.0;  ///< nor one that begins or ends at a time of its own, unless it is an instrument's: it bends to what it is not
  int refits = 16;                     ///< candidates of each round that are fitted in full
  std::set<std::string> without = {};  ///< keys of effects that are not looked for
};

/// What the evidence of a claim must reach [nats, the price of the number of candidates paid]: what chance has to offer, or what is asked for at least.
struct Bars {
  std::vector<double> suspected;           ///< the first claim, a second one beside it, a third
  double named = 0.0, named_beside = 0.0;  ///< the only claim; one of several, or one whose windows were chosen to make it
  double named_timed = 0.0;                ///< one that begins or ends at a time of its own, unless it is an instrument's
};
[[nodiscard]] Bars bars_of(const Chance& chance, const SearchOptions& options);

/// A claim that stood up, and others beside which its kind, or its place, is not told (rivals.hpp).
struct Finding {
  Claim claim;
  double log_evidence_gain = 0.0;  ///< over the best hypothesis without it, after the price of the number of candidates
  bool is_named = false;           ///< else suspected
  struct Alternative {
    Claim claim;
    Fit fit;  ///< of the hypothesis with it in the finding's place
    double log_evidence_gain = 0.0;
    double share = 0.0;  ///< of the odds
  };
  std::vector<Alternative> alternatives = {};
  Odds odds = {};
  double share = 1.0;  ///< of the odds, its own
  /// Share of faultless machines at which some candidate is as rare: of a cause that is suspected by that, its evidence being too little (faint_cause.hpp).
  std::optional<double> faint_chance = {};
};

struct SearchResult {
  std::vector<Candidate> candidates;  ///< those given, and the windows found in the readings
  Hypothesis hypothesis;
  Fit fit;
  Fit without;  ///< scatter alone
  std::vector<Finding> findings;
  Chance chance;              ///< what the best candidate would have with nothing wrong
  Chance rarest;              ///< how rare the rarest would be (chance.hpp)
  Bars bars;                  ///< that were held to
  std::vector<Score> scores;  ///< of all candidates on top of scatter alone
};

/// @param candidates  windows that the readings ask for are added
/// @param listener    once it wants an end, what has stood up so far is the result
/// @param before      null, or what a search of the same runs by another noise found: where a loud cause has bent the scenario's numbers, from which nothing can be
///                    weighed well, it is tried as well
[[nodiscard]] SearchResult search(Fitter& fitter, std::vector<Candidate> candidates, const SearchOptions& options,
                                  const Listener& listener, const SearchResult* before = nullptr);

}  // namespace driftwright::diagnosis
