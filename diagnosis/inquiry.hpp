#pragma once
// What the records say: noise, process noise, causes, numbers that have gone too far.

#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

/// Sigmas of its prior up to which a number is fitted; one that would go further is a cause. There the density of a fault
/// exceeds that of what is known: u²/2 = log(60 candidates) + log(0.7 / 0.1) + (0.1 u / 0.7)²/2.
inline constexpr double kTooFar = 3.5;

/// What an inquiry about a machine begins with; none of it is fitted to readings.
struct InquiryGround {
  const Twin& twin;
  const Twin* coarse;  ///< null: there is one mesh
  const DiagnosisOptions& options;
  const std::vector<Candidate>& candidates;
  const Fitter& fresh;           ///< at the scenario's own numbers, of all rows, without noise
  const Prediction& as_written;  ///< of all records
};

struct Inquiry {
  std::map<std::string, NoiseModel> noise;
  bool weighed_by_model_error = false;
  std::optional<HeatWander> wander;
  std::vector<std::size_t>
      moved;  ///< of scatter: numbers that have gone so far that they are causes; their priors are those of faults
  std::unique_ptr<Fitter> fitter;  ///< settled where the search ended, with its noise and those priors
  SearchResult search;
  std::optional<Unexplained> unexplained;
};

/// @param runs  all records; outlive the result
[[nodiscard]] Inquiry inquire(const InquiryGround& ground, const std::vector<MeasuredRun>& runs, const Listener& listener);

/// The beginning of a diagnosis: its data, its uncertain numbers and the scenario as written. @returns  a fitter of all
/// rows, without noise
[[nodiscard]] Fitter begun(Diagnosis& d, const Twin& twin, const Twin* coarse, const std::vector<MeasuredRun>& runs,
                           const DiagnosisOptions& options, const Listener& listener);

/// What a warm start, the unseen drive of a hole and another mesh (one column a channel) change: the amplitude of each is
/// unknown.
[[nodiscard]] std::vector<Prediction> unknown_columns(const Twin& twin, const Twin* coarse, double mesh_error_share,
                                                      const std::vector<MeasuredRun>& runs, const TwinState& state);

}  // namespace driftwright::diagnosis
