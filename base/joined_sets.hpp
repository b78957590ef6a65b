#pragma once
// Sets of numbers that grow together (union-find).

#include <numeric>
#include <vector>

namespace driftwright {

/// The numbers 0, ..., n - 1, each in a set of its own until join().
/// Source: Tarjan, J. ACM 22 (1975) 215-225; paths are halved.
class JoinedSets {
 public:
  explicit JoinedSets(int n) : parent_(static_cast<std::size_t>(n)) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// A number that all members of i's set share.
  int of(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) { parent_[of(a)] = of(b); }

 private:
  std::vector<int> parent_;
};

}  // namespace driftwright
