#pragma once
// The information of a record that is still to be made, channel by channel, by the fitter and the signatures that would judge it.

#include "diagnosis/prospect.hpp"
#include "diagnosis/signatures.hpp"

namespace driftwright::diagnosis {

/// Readings to come: rows from 0 to the cyclogram's end.
/// @param ambient      recorded, minus the reference [K]
/// @param channels  their values are not looked at
[[nodiscard]] MeasuredRun planned_run(const Cyclogram& cyclogram, double interval_s, const TimeSeries& ambient,
                                      bool has_ambient, std::vector<MeasuredChannel> channels);

/// What a record of a machine may be asked before there is any: its uncertain numbers, and every law of the catalogue that could be there throughout.
/// Left out is what happens at some moment, which no programme knows ahead, and what is all or nothing.
struct Doubts {
  std::vector<Knob> numbers;  ///< of the scenario, and the ambient's
  std::vector<Candidate> candidates;
  struct Shape {
    std::size_t candidate = 0, variant = 0;
    Eigen::VectorXd x;  ///< of the law's knobs, the size at its trial
  };
  std::vector<Shape> shapes;  ///< of all laws, each of its grid
  Question question;          ///< about these, in this order
  [[nodiscard]] const Variant& variant(const Shape& s) const { return candidates[s.candidate].variants[s.variant]; }
};

/// @param run  a programme that turns as fast as any: at which speed laws are stated
[[nodiscard]] Doubts doubts_before(const Twin& twin, const MeasuredRun& run, const std::set<std::string>& without = {});

/// The effects of the machine where a law has its trial size; where a number is turned by its step.
[[nodiscard]] TwinState with_law(const Twin& twin, const Doubts& doubts, const Doubts::Shape& law);
[[nodiscard]] TwinState with_number(const Twin& twin, const Knob& number);

/// Enough to look for a programme by: without laws that follow time by themselves, and with as many of each kind as that at the most, evenly from its list.
[[nodiscard]] Doubts thinned(const Twin& twin, Doubts doubts, const MeasuredRun& run, std::size_t most_of_a_kind);

/// Of the readings of each channel of a run, in their order: what they add up to is that of all of them.
/// @param noise  by channel
/// @throws SolveError  where the machine as written has no solution
[[nodiscard]] std::vector<Eigen::MatrixXd> information_by_channel(const Twin& twin, const Doubts& doubts,
                                                                  const MeasuredRun& run,
                                                                  const std::map<std::string, NoiseModel>& noise);

}  // namespace driftwright::diagnosis
