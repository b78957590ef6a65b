#pragma once
// What no cause explains: where it is, how much, and what it looks like.

#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

/// Channels whose residual is more than noise, unless there is none.
[[nodiscard]] std::optional<Unexplained> unexplained_of(const Fitter& fitter, const SearchResult& result,
                                                        const std::map<std::string, NoiseModel>& noise);
/// Noise with what the model misses as a slow part of it, where that is far more than the noise: readings of a model so wrong weigh no more.
[[nodiscard]] std::optional<std::map<std::string, NoiseModel>> models_own_error(
    const std::vector<MeasuredRun>& runs, const Prediction& prediction, const std::map<std::string, NoiseModel>& noise);
/// Where the claims act that one cause without a name explains better, and what that cause looks like.
[[nodiscard]] Unexplained explained_better(const Fitter& fitter, const SearchResult& result, const Unnamed& unnamed,
                                           const std::map<std::string, NoiseModel>& noise);

}  // namespace driftwright::diagnosis
