#pragma once
// The information that a planned record would give, channel by channel, computed by the same fitter and signatures that
// would judge it.

#include "diagnosis/prospect.hpp"
#include "diagnosis/signatures.hpp"

namespace driftwright::diagnosis {

/// A planned run: rows from 0 to the cyclogram's end.
/// @param ambient      recorded, minus the reference [K]
/// @param channels  their values are ignored
[[nodiscard]] MeasuredRun planned_run(const Cyclogram& cyclogram, double interval_s, const TimeSeries& ambient,
                                      bool has_ambient, std::vector<MeasuredChannel> channels);

/// The questions that can be asked before a record exists: the machine's uncertain numbers, and every law of the
/// catalogue that may hold throughout. Left out are events at some time, which no programme can plan for, and
/// all-or-nothing faults.
struct Doubts {
  std::vector<Knob> numbers;  ///< of the scenario and of the ambient
  std::vector<Candidate> candidates;
  struct Shape {
    std::size_t candidate = 0, variant = 0;
    Eigen::VectorXd x;  ///< of the law's knobs, with the size at its trial value
  };
  std::vector<Shape> shapes;  ///< all shapes of all laws, from their grids
  Question question;          ///< for these, in this order
  [[nodiscard]] const Variant& variant(const Shape& s) const { return candidates[s.candidate].variants[s.variant]; }
};

/// @param run  the fastest programme; it determines the speed at which laws are stated
[[nodiscard]] Doubts doubts_before(const Twin& twin, const MeasuredRun& run, const std::set<std::string>& without = {});

/// The machine's effects with a law at its trial size, or with a number changed by its step.
[[nodiscard]] TwinState with_law(const Twin& twin, const Doubts& doubts, const Doubts::Shape& law);
[[nodiscard]] TwinState with_number(const Twin& twin, const Knob& number);

/// A smaller set for the search of a programme: without laws that depend on time alone, and with at most that many laws
/// of each kind, evenly selected from its list.
[[nodiscard]] Doubts thinned(const Twin& twin, Doubts doubts, const MeasuredRun& run, std::size_t most_of_a_kind);

/// The information of each channel of a run, in their order; the sum is that of all channels.
/// @param noise  by channel
/// @throws SolveError  if the machine as written has no solution
[[nodiscard]] std::vector<Eigen::MatrixXd> information_by_channel(const Twin& twin, const Doubts& doubts,
                                                                  const MeasuredRun& run,
                                                                  const std::map<std::string, NoiseModel>& noise);

}  // namespace driftwright::diagnosis
