#pragma once
// What no cause explains: channels, size and structure.

#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

/// The channels whose residual is more than noise; none if there are none.
[[nodiscard]] std::optional<Unexplained> unexplained_of(const Fitter& fitter, const SearchResult& result,
                                                        const std::map<std::string, NoiseModel>& noise);
/// Noise including the model's error as a slow part, if that is far larger than the noise: readings of such a wrong model
/// get less weight.
[[nodiscard]] std::optional<std::map<std::string, NoiseModel>> models_own_error(
    const std::vector<MeasuredRun>& runs, const Prediction& prediction, const std::map<std::string, NoiseModel>& noise);
/// The likeliest statement with a probability above one half that no finding names, and the channel that shows it best;
/// none if there is none.
[[nodiscard]] std::optional<Unexplained> without_name(const Fitter& fitter, const SearchResult& result,
                                                      const Posterior& statements,
                                                      const std::map<std::string, NoiseModel>& noise);

}  // namespace driftwright::diagnosis
