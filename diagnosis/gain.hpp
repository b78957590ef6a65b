#pragma once
// What an extension gains on rows that its numbers were not fitted to, and which of its parts gain nothing there.

#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

struct HeldOut {
  std::string how;
  std::vector<ChannelGain> channels;  ///< of the claims that are kept
  /// Per claim: how much likelier the kept-out rows are with it than without it, those fitted given, whatever is not known of all numbers counted in [nats].
  std::vector<double> claim_nats;
  std::vector<char> keeps_claim;  ///< per claim: kept-out rows are not predicted worse with it
  bool fails = false;             ///< the claims together predict kept-out rows clearly worse than none of them does
  bool keeps_numbers =
      true;  ///< false: the scenario as written predicts kept-out rows better than any numbers that were fitted
};

/// Each run in turn is predicted with numbers fitted to the others; of a single run the last third with those of the rest. What happened in one run alone, or
/// at a time of the only one, is judged on blocks of it, every other one kept out. Each time all numbers are fitted anew, by the same search for the most probable
/// ones; which claims there are was decided on all rows.
[[nodiscard]] HeldOut held_out_gain(const Fitter& fitter, const SearchResult& result,
                                    const std::map<std::string, NoiseModel>& noise);

}  // namespace driftwright::diagnosis
