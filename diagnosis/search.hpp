#pragma once
// Which effects do the data want? Forward, with exchange and pruning, by evidence.

#include "diagnosis/fit.hpp"

namespace driftwright::diagnosis {

struct SearchOptions {
  int most_effects = 3;
  /// Evidence [nats] a claim must bring beyond the logarithm of how many candidates there are.
  std::vector<double> must_gain = {8.0, 8.0,
                                   20.0};  ///< the first, the second, the third: few machines are wrong in three ways
  /// Two claims whose evidence differs by less than this cannot be told apart.
  double cannot_tell = 3.0;
  int refits = 10;  ///< candidates of each round that are fitted in full
};

/// A claim that stood up, and others that would do as well in its place.
struct Finding {
  Claim claim;
  double log_evidence_gain = 0.0;  ///< over the best hypothesis without it, after the price of the number of candidates
  struct Alternative {
    Claim claim;
    Fit fit;  ///< of the hypothesis with it in the finding's place
    double log_evidence_gain = 0.0;
  };
  std::vector<Alternative> alternatives;
};

/// What one law of a candidate does to the whitened readings, at trial size and one shape, per unit of its size.
struct Signature {
  std::size_t candidate = 0, variant = 0;
  Eigen::VectorXd shape;  ///< x of the claim's knobs, the size at its trial
  Eigen::VectorXd column;
};
/// All of them, on top of a fit. They change little with what else is claimed.
[[nodiscard]] std::vector<Signature> signatures(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                                const Hypothesis& hypothesis, const Fit& fit);

/// How much evidence a candidate would bring on top of a fit: what the linear theory says.
struct Score {
  std::size_t candidate = 0, variant = 0;
  double gain = -1e300;   ///< nats
  Eigen::VectorXd start;  ///< x of the claim's knobs
};

struct SearchResult {
  Hypothesis hypothesis;
  Fit fit;
  Fit without;  ///< scatter alone
  std::vector<Finding> findings;
  int n_candidates = 0;
  /// Evidence that one more effect would bring; too little to claim it, and yet more than chance has to offer.
  double further_gain = 0.0;
  std::vector<Score> scores;  ///< of all candidates on top of scatter alone
};

/// @param say  is told what goes on
[[nodiscard]] SearchResult search(Fitter& fitter, const std::vector<Candidate>& candidates, const SearchOptions& options,
                                  const std::function<void(const std::string&)>& say);

/// The best shape of each law of each candidate, best first.
[[nodiscard]] std::vector<Score> scores(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                        const std::vector<Signature>& signatures, const Hypothesis& hypothesis,
                                        const Fit& fit);

}  // namespace driftwright::diagnosis
