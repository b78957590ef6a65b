#pragma once
// Long work in numbered pieces, which processes may share out among themselves, keep, and put together: what a piece comes to is a few numbers, the
// same whoever works it out.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.hpp"

namespace driftwright {

/// The i-th of n parts of the work.
struct Shard {
  std::size_t number = 1, of = 1;  ///< from 1

  [[nodiscard]] bool is_all() const { return of == 1; }
  [[nodiscard]] bool has(std::size_t piece) const { return piece % of == number - 1; }
};

/// "3/8"; empty: all. @throws InputError  naming --shard
[[nodiscard]] Shard read_shard(const std::string& text);

/// Where pieces are kept. Each may be left out: then all is worked out, and nothing kept.
struct Pieces {
  using Numbers = std::vector<double>;

  Shard shard = {};
  std::function<std::optional<Numbers>(std::size_t piece)> find = {};
  std::function<void(std::size_t piece, const Numbers&)> keep = {};  ///< from any thread
  std::function<void()> look_again = {};                             ///< at what other processes have kept meanwhile

  [[nodiscard]] std::optional<Numbers> found(std::size_t piece) const { return find ? find(piece) : std::nullopt; }

  /// A piece that whatever follows needs, whoever's it is: as it is kept, also by another process meanwhile, or worked out here.
  /// @param listener  what was worked out until it wanted an end is not kept
  template <class Work>
  [[nodiscard]] Numbers of(std::size_t piece, const Work& work, const Listener& listener = {}) const {
    if (look_again && !found(piece)) look_again();
    if (std::optional<Numbers> kept = found(piece)) return *kept;
    const Numbers made = work();
    if (keep && !listener.wants_end()) keep(piece, made);
    return made;
  }

  /// Pieces first, first + 1, ... of this shard, side by side. Those of other shards stay empty.
  /// @param prepare  called once, where something has to be worked out
  /// @param work     of i < n
  template <class Prepare, class Work>
  [[nodiscard]] std::vector<Numbers> of_shard(std::size_t first, std::size_t n, const Prepare& prepare, const Work& work,
                                              const Listener& listener = {}) const {
    if (look_again) look_again();
    std::vector<Numbers> all(n);
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < n; ++i) {
      if (!shard.has(i)) continue;
      if (std::optional<Numbers> kept = found(first + i))
        all[i] = *kept;
      else
        missing.push_back(i);
    }
    if (missing.empty()) return all;
    prepare();
    parallel_for(
        missing.size(),
        [&](std::size_t k) {
          const std::size_t i = missing[k];
          all[i] = work(i);
          if (keep) keep(first + i, all[i]);
        },
        listener);
    return all;
  }

  /// All of them, since what follows needs them: those of this shard first, then what of the others nobody has kept meanwhile.
  template <class Prepare, class Work>
  [[nodiscard]] std::vector<Numbers> of_all(std::size_t first, std::size_t n, const Prepare& prepare, const Work& work) const {
    std::vector<Numbers> all = of_shard(first, n, prepare, work);
    if (shard.is_all()) return all;
    Pieces others = *this;
    others.shard = {};
    return others.of_shard(first, n, prepare, work);
  }

  /// The same, counted from another piece.
  [[nodiscard]] Pieces from(std::size_t first) const;
};

}  // namespace driftwright
