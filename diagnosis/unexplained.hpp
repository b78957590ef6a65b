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
/// The likeliest statement with a probability over one half that no finding names, and the channel that shows it best; nothing where there is none.
[[nodiscard]] std::optional<Unexplained> without_name(const Fitter& fitter, const SearchResult& result,
                                                      const Posterior& statements,
                                                      const std::map<std::string, NoiseModel>& noise);

}  // namespace driftwright::diagnosis
