#pragma once
// What an extension gains on data that its numbers were not fitted to.

#include "diagnosis/diagnosis.hpp"

namespace driftwright::diagnosis {

struct HeldOut {
  std::string how;
  std::vector<ChannelGain> channels;
};

/// Each run in turn is predicted with numbers fitted to the others; of a single run the last third with those of the rest. Numbers of
/// what happened in one run alone are kept.
[[nodiscard]] HeldOut held_out_gain(const Fitter& fitter, const SearchResult& result,
                                    const std::map<std::string, NoiseModel>& noise);

}  // namespace driftwright::diagnosis
