#pragma once
// What could be wrong: every effect of the catalogue at every place where it can be, as knobs of the twin. What each kind may be doubted for it says
// itself (effects/doubt.hpp); numbers of effects that are written may be others.

#include <memory>
#include <set>

#include "diagnosis/scene.hpp"

namespace driftwright::diagnosis {

struct Event;

/// One law of an effect: its size first, then what shapes it.
struct Variant {
  std::string law;                               ///< in words
  std::vector<Knob> knobs;                       ///< knobs[0] is the size; turned in their order
  double trial_x = 0.1;                          ///< size at which its signature is taken
  std::vector<std::vector<double>> grid = {{}};  ///< x of knobs 1.. to try first
  double at_speed_rpm = 0.0;                     ///< the speed its size is stated at; 0: none
  bool all_or_nothing = false;                   ///< two cables are swapped or not: the size is trial_x
  double price_nats =
      0.0;  ///< before any reading: how much rarer it is than other laws, or what was chosen to make it, such as windows seen in a waveform
  bool happens = false;            ///< for a while or from a time on, not throughout
  bool of_chosen_records = false;  ///< its records were read off these very readings, which price_nats pays for
  bool seen = false;    ///< at times that were read off these very readings: simulated ones say nothing of its chances
  std::string in = {};  ///< run in which it is, or begins; "": all
  std::shared_ptr<const effects::Doubt> of_some_runs =
      {};                 ///< that it was made of, where it can be said of some records alone
  std::string adds = {};  ///< keys of the effects that it adds to the machine
};

/// A doubt as a law of a candidate.
[[nodiscard]] Variant law_of(const effects::Doubt& doubt);

/// An effect at a place. One candidate among many, whatever laws it may follow.
struct Candidate {
  std::string effect, where;
  std::vector<Variant> variants;
};

/// What one law of a candidate costs for being one of several [nats]; those whose records the readings have chosen pay for that themselves.
[[nodiscard]] double law_price(const Candidate& candidate);

/// @param without  keys of effects that are not looked for
[[nodiscard]] std::vector<Candidate> candidates(const Twin& twin, const std::vector<MeasuredRun>& runs,
                                                const std::set<std::string>& without);

/// Adds windows that were found as further laws of heat or exchange for a while, and stops of the spindle at the same times. @returns  candidate and law of each
std::vector<std::pair<std::size_t, std::size_t>> add_events(std::vector<Candidate>& list, const std::vector<Event>& events,
                                                            const std::set<std::string>& without);

/// Those that some readings may tell of. What is or begins in a run without any looks, in the others, like what is always there.
/// @param runs  readings that are not to be known missing (NaN)
[[nodiscard]] std::vector<Candidate> told_of_by(const std::vector<MeasuredRun>& runs, std::vector<Candidate> list);

/// The knobs of a doubt: the first one adds its effects to a state, the others turn numbers of those added last.
[[nodiscard]] std::vector<Knob> knobs_of(const effects::Doubt& doubt);

}  // namespace driftwright::diagnosis
