#pragma once
// What an extension gains on rows that its numbers were not fitted to, and which of its parts gain nothing there.

#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

struct HeldOut {
  std::string how;
  std::vector<ChannelGain> channels;  ///< of the claims that are kept
  KeptOutMisses misses = {};          ///< of all channels together
  /// Per claim: how much likelier the kept-out rows are with it than without it, those fitted given, whatever is not known of all numbers counted in [nats].
  std::vector<double> claim_nats;
  /// Per claim: why the kept-out rows make it a hint, a clause; "" where they do not. They are predicted worse with it; or no better, and no claim would have been
  /// suspected without some of them.
  std::vector<std::string> doubt;
  /// Per claim: why it is not worth writing, a clause; "" where it is. It is doubted; or kept-out rows are predicted no better with it; or it happens
  /// in several records at times that nobody knows ahead, where a record whose times are not known is predicted worse by what was fitted beside it; or a search without the kept-out rows finds what does harm to them.
  std::vector<std::string> why_not_written;
  /// Searches without the kept-out rows, and in how many of them each claim's effect was found at its place, or at one that this is not told from.
  int n_searched = 0;
  std::vector<int> n_again = {};
  bool fails = false;  ///< the claims together predict kept-out rows clearly worse than none of them does
  /// Where they fail, the channel that they predict worst, and how: what is left of its kept-out rows.
  Unexplained::Channel fails_at;
  /// The same of what would be written, once all is taken out that is of single records: where the scenario as written predicts better then.
  std::optional<Unexplained::Channel> elsewhere_at = {};
  std::string why_nothing = {};  ///< why neither causes nor fitted numbers are worth writing, a clause; "" where they are
};

/// A search for what is wrong in records that have some of their readings alone: with noise, bars, numbers and process noise of these.
using SearchAgain = std::function<SearchResult(const std::vector<MeasuredRun>& fitted)>;

/// Each run in turn is predicted with numbers fitted to the others; of a single run the last third with those of the rest. What happened in one run alone, or
/// at a time of the only one, is judged on blocks of it, every other one kept out. Each time all numbers are fitted anew. Misses are those of what a file would hold:
/// of the machine's effects and numbers, without what is not known of a warm start or of the mesh.
/// @param search_again  makes the search again without the rows of each run, or of the last third; null: which claims there are was decided on all rows
/// @param listener      once it wants an end, the misses are those of rows that were fitted to, and nothing is worth writing
[[nodiscard]] HeldOut held_out_gain(const Fitter& fitter, const SearchResult& result,
                                    const std::map<std::string, NoiseModel>& noise, const SearchAgain& search_again,
                                    const Listener& listener = {});

/// Whether duty cycles, each kept out whole, are together predicted worse by what would be written, with numbers fitted to the records of the others, than by the scenario as written. Of a model
/// that is wrong in a way that nothing explains, a record of a cycle that others went through as well is predicted by what is true of that cycle alone.
/// @param claims  of the search's hypothesis: those that would be written
/// @return        a clause; "" where they are not, or where each record is of a cycle of its own, or all are of one
[[nodiscard]] std::string worse_in_another_cycle(const Fitter& fitter, const SearchResult& result,
                                                 const std::map<std::string, NoiseModel>& noise,
                                                 const std::vector<std::size_t>& claims);

/// Of a single record of which more is left than its causes explain: numbers of the scenario that were fitted beside them took up what nobody named, and hold for
/// their own rows alone. The causes with the scenario's numbers as they are written may hold.
struct CausesAlone {
  std::vector<std::size_t> claims;  ///< of the search's hypothesis, in their order
  Hypothesis hypothesis;
  Fit fit;                            ///< of them to all rows; x is of their knobs alone
  std::string how;                    ///< the kept-out rows
  std::vector<ChannelGain> channels;  ///< on these, fitted without them
  KeptOutMisses misses = {};
};

/// Those that bring 20 nats and are found again without the last third of the record, none of which tells of a time, if that is predicted better with them than by the scenario as it is
/// written, by a tenth of the squares, and no channel worse; the strongest one, where all together do not.
/// @param held  of held_out_gain(), which searched again
[[nodiscard]] std::optional<CausesAlone> causes_alone(const Fitter& fitter, const SearchResult& result,
                                                      const std::map<std::string, NoiseModel>& noise, const HeldOut& held);

}  // namespace driftwright::diagnosis
