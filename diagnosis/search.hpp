#pragma once
// Which effects do the data want? Forward, with exchange and pruning, by evidence.

#include <map>
#include <set>

#include "diagnosis/naming.hpp"
#include "diagnosis/posterior.hpp"
#include "diagnosis/rivals.hpp"
#include "diagnosis/signatures.hpp"

namespace driftwright::diagnosis {

struct SearchOptions {
  int most_effects = 3;
  std::set<std::string> without = {};  ///< keys of effects that are not looked for
  StatementOptions prior = {};
  int refits = 20;  ///< candidates of each round that are fitted in full
};

/// A claim that stood up, and others beside which its kind, or its place, is not told (rivals.hpp).
struct Finding {
  Claim claim;
  double log_evidence_gain = 0.0;  ///< over the best hypothesis without it, after the price of the number of candidates
  /// Of the statement that it is a name of (naming.hpp).
  double probability = 0.0;
  bool is_named = false;  ///< that statement, or one that its alternatives name, is as sure as kSure; else it is suspected
  struct Alternative {
    Claim claim;
    Fit fit;  ///< of the hypothesis with it in the finding's place
    double log_evidence_gain = 0.0;
    double share = 0.0;        ///< of the odds
    double probability = 0.0;  ///< of its statement
  };
  std::vector<Alternative> alternatives = {};
  Odds odds = {};
  double share = 1.0;  ///< of the odds, its own
};

struct SearchResult {
  Posterior statements;         ///< of the scenario's numbers as fitted; with what weigh_findings() adds
  std::size_t n_catalogue = 1;  ///< effects at places that were asked for a name: what a claim pays for being one of them
  std::vector<Candidate> candidates;   ///< names of statements
  std::vector<StatedPlace> names;      ///< of each, what its statement is about
  std::map<StatedPlace, Stated> said;  ///< these statements, when they were first named
  Hypothesis hypothesis;
  Fit fit;
  Fit without;  ///< scatter alone
  std::vector<Finding> findings;
};

/// Statements say what is missing; their names are fitted in full; beside the best of these, statements say what is missing
/// still.
/// @param fitter     with its noise; it ends settled at the result
/// @param catalogue  every effect at every place that may be a name
/// @param former     result of a search with other noise or other priors, or null; it is compared with the first name
/// @param listener   once it wants an end, what has stood up so far is the result
[[nodiscard]] SearchResult search(Fitter& fitter, const std::vector<Candidate>& catalogue, const SearchOptions& options,
                                  const SearchResult* former, const Listener& listener);

/// How sure each claim is: others in its place, fitted in full; its statement against all others, the other claims as
/// fitted; and whether it is named. And the statements of all places, and of one more.
/// @param fitter  that the search was made with, settled at its end; it ends settled there
void weigh_findings(Fitter& fitter, const SearchOptions& options, SearchResult& result, const Listener& listener);

}  // namespace driftwright::diagnosis
