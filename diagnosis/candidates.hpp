#pragma once
// All possible faults: every effect of the catalogue at every possible place, as knobs of the twin. Each kind lists its
// own doubts (effects/doubt.hpp); also numbers of existing effects may be wrong.

#include <memory>
#include <set>

#include "diagnosis/scene.hpp"

namespace driftwright::diagnosis {

struct Event;

/// One law of an effect: its size first, then the numbers that shape it.
struct Variant {
  std::string law;                               ///< in words
  std::vector<Knob> knobs;                       ///< knobs[0] is the size; they are set in this order
  double trial_x = 0.1;                          ///< size at which its signature is computed
  std::vector<std::vector<double>> grid = {{}};  ///< x of knobs 1.. to try first
  double at_speed_rpm = 0.0;                     ///< speed at which its size is stated; 0: none
  bool all_or_nothing = false;                   ///< such as two swapped cables: the size is trial_x or zero
  double price_nats = 0.0;         ///< cost before any reading: rarity, numbers after the size, choices such as seen windows
  bool happens = false;            ///< for a while or from a time on, not throughout
  bool of_chosen_records = false;  ///< its records were chosen by these same readings; price_nats includes the cost
  bool seen = false;               ///< its times were chosen by these same readings: simulated records cannot test its odds
  std::string in = {};             ///< run in which it exists or begins; "": all
  std::shared_ptr<const effects::Doubt> of_some_runs =
      {};  ///< doubt that it was made of, if that can be limited to some records
};

/// A doubt as a law of a candidate.
[[nodiscard]] Variant law_of(const effects::Doubt& doubt);

/// An effect at a place. It counts as one candidate, whichever of its laws it follows.
struct Candidate {
  std::string effect, where;
  std::vector<Variant> variants;
};

/// Cost [nats] of a law for being one of several of a candidate; laws with records chosen by the readings have their own
/// cost.
[[nodiscard]] double law_price(const Candidate& candidate);

/// @param without  keys of effects that are excluded
[[nodiscard]] std::vector<Candidate> candidates(const Twin& twin, const std::vector<MeasuredRun>& runs,
                                                const std::set<std::string>& without);

/// Adds windows that were found as further laws of temporary heat or exchange, and stops of the spindle at the same
/// times.
void add_events(std::vector<Candidate>& list, const std::vector<Event>& events, const std::set<std::string>& without);

/// The knobs of a doubt: the first adds its effects to a state, the others change numbers of those effects.
[[nodiscard]] std::vector<Knob> knobs_of(const effects::Doubt& doubt);

}  // namespace driftwright::diagnosis
