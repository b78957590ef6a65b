#pragma once
// Pieces of several shards in one map, which stands for the folder that they share.

#include <map>
#include <mutex>

#include "base/pieces.hpp"

namespace driftwright {

struct KeptInMemory {
  std::map<std::size_t, Pieces::Numbers> kept = {};
  std::mutex lock = {};
  int n_worked = 0;

  [[nodiscard]] Pieces of(const std::string& shard) {
    Pieces pieces{.shard = read_shard(shard)};
    pieces.find = [this](std::size_t i) -> std::optional<Pieces::Numbers> {
      const std::lock_guard guard(lock);
      const auto found = kept.find(i);
      return found == kept.end() ? std::nullopt : std::optional(found->second);
    };
    pieces.keep = [this](std::size_t i, const Pieces::Numbers& numbers) {
      const std::lock_guard guard(lock);
      ++n_worked;
      kept[i] = numbers;
    };
    return pieces;
  }
};

}  // namespace driftwright
