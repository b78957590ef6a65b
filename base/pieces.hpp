#pragma once
// Long work in numbered pieces, which several processes can share, store and put together. The result of a piece is a list
// of numbers that does not depend on the process that computes it.

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.hpp"

namespace driftwright {

/// The share of the work of one process: part `number` of `of`.
struct Shard {
  std::size_t number = 1, of = 1;  ///< from 1

  [[nodiscard]] bool is_all() const { return of == 1; }
  [[nodiscard]] bool has(std::size_t piece) const { return piece % of == number - 1; }
};

/// "3/8"; empty: all. @throws InputError  naming --shard
[[nodiscard]] Shard read_shard(const std::string& text);

/// Where pieces are stored. Each function may be left out: then all pieces are computed and none is stored.
struct Pieces {
  using Numbers = std::vector<double>;

  Shard shard = {};
  std::function<std::optional<Numbers>(std::size_t piece)> find = {};
  std::function<void(std::size_t piece, const Numbers&)> keep = {};  ///< from any thread
  std::function<void()> look_again = {};                             ///< reads what other processes have stored meanwhile

  [[nodiscard]] std::optional<Numbers> found(std::size_t piece) const { return find ? find(piece) : std::nullopt; }

  /// A piece that all following work needs, of whichever shard: the stored one, also from another process, or computed here.
  /// @param listener  a result that was cut short by its request to end is not stored
  template <class Work>
  [[nodiscard]] Numbers of(std::size_t piece, const Work& work, const Listener& listener = {}) const {
    if (look_again && !found(piece)) look_again();
    if (std::optional<Numbers> kept = found(piece)) return *kept;
    const Numbers made = work();
    if (keep && !listener.wants_end()) keep(piece, made);
    return made;
  }

  /// Pieces first, first + 1, ... of this shard, in parallel. Those of other shards stay empty.
  /// @param prepare  called once, if anything has to be computed
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

  /// All pieces: first those of this shard, then those of the others that no process has stored meanwhile.
  template <class Prepare, class Work>
  [[nodiscard]] std::vector<Numbers> of_all(std::size_t first, std::size_t n, const Prepare& prepare,
                                            const Work& work) const {
    std::vector<Numbers> all = of_shard(first, n, prepare, work);
    if (shard.is_all()) return all;
    Pieces others = *this;
    others.shard = {};
    return others.of_shard(first, n, prepare, work);
  }

  /// The same pieces, numbered from `first` on.
  [[nodiscard]] Pieces from(std::size_t first) const;
};

}  // namespace driftwright
