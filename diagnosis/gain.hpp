#pragma once
// The gain of an extension on rows that its numbers were not fitted to, and the parts of it without gain there.

#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

struct HeldOut {
  std::string how;
  std::vector<ChannelGain> channels;  ///< with the claims that are kept
  KeptOutMisses misses = {};          ///< over all channels
  /// For each claim: how much likelier the kept-out rows are with it, given the fitted ones and the uncertainty of all
  /// numbers [nats].
  std::vector<double> claim_nats;
  /// For each claim: the reason why the kept-out rows make it only a hint, a clause; otherwise "". They are predicted
  /// worse with it; or no better, and without some of them no claim would have been suspected.
  std::vector<std::string> doubt;
  /// For each claim: the reason why it is not written, a clause; otherwise "". It is doubted; or kept-out rows are
  /// predicted no better with it; or it happens in several records at times that are unknown in advance, and the numbers
  /// fitted with it predict a record with unknown times worse.
  std::vector<std::string> why_not_written;
  bool fails = false;  ///< the claims together predict kept-out rows clearly worse than no claim
  /// If they fail: the channel with the worst prediction, and the rest of its kept-out rows.
  Unexplained::Channel fails_at;
  std::string why_nothing = {};  ///< reason why neither causes nor fitted numbers are written, a clause; otherwise ""
};

/// Each run in turn is predicted with numbers fitted to the others; of a single run the last third with those of the
/// rest. Events in a single run, or at a time of the only run, are judged on blocks of it, with every other block kept
/// out. All numbers are fitted anew each time. Errors are those of a written file: of the machine's effects and numbers,
/// without unknown warm starts or mesh errors.
/// @param listener      after a request to end, the errors are those of fitted rows, and nothing is written
[[nodiscard]] HeldOut held_out_gain(const Fitter& fitter, const SearchResult& result,
                                    const std::map<std::string, NoiseModel>& noise, const Listener& listener = {});

/// Whether the file to be written, with numbers fitted to the records of other duty cycles, predicts whole duty cycles
/// worse than the scenario as written, over all cycles. If the model has an unexplained error, a fit also predicts other
/// records of the same cycle well, but by features of that cycle alone.
/// @param claims  of the search's hypothesis: those to be written
/// @return        a clause; "" if the prediction is not worse, or if each record has its own cycle, or all have the same
[[nodiscard]] std::string worse_in_another_cycle(const Fitter& fitter, const SearchResult& result,
                                                 const std::map<std::string, NoiseModel>& noise,
                                                 const std::vector<std::size_t>& claims);

/// For a single record with more left than its causes explain: the scenario's numbers fitted with them absorbed unnamed
/// effects and hold for their own rows only. The causes with the scenario's numbers unchanged may hold.
struct CausesAlone {
  std::vector<std::size_t> claims;  ///< indices in the search's hypothesis, in order
  Hypothesis hypothesis;
  Fit fit;                            ///< to all rows; x has their knobs only
  std::string how;                    ///< the kept-out rows, in words
  std::vector<ChannelGain> channels;  ///< on the kept-out rows, fitted without them
  KeptOutMisses misses = {};
};

/// The claims with at least 20 nats that are not events, if they predict the last third of the record better than the
/// scenario as written, by a tenth of the squares, with no channel worse; if all together do not, the strongest one.
[[nodiscard]] std::optional<CausesAlone> causes_alone(const Fitter& fitter, const SearchResult& result,
                                                      const std::map<std::string, NoiseModel>& noise);

}  // namespace driftwright::diagnosis
