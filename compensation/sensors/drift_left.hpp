#pragma once
// What a set of thermometers leaves unknown of a drift: the number that a search for places makes small.

#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "base/parallel.hpp"

namespace driftwright::compensation {

/// Fewer candidates than these are done before other threads have woken up.
inline constexpr int kWorthThreads = 64;
/// work(i) for each i < n; on all cores where there are enough candidates.
template <class Work>
void for_each_part(std::size_t n, int n_candidates, const Work& work) {
  if (n_candidates >= kWorthThreads) return parallel_for(n, work);
  for (std::size_t i = 0; i < n; ++i) work(i);
}

/// An RMS of drift in um, by which of n_candidates() thermometers there are. Calls may come from several threads.
class DriftLeft {
 public:
  virtual ~DriftLeft() = default;
  [[nodiscard]] virtual int n_candidates() const = 0;
  /// @param set  different candidates; none: what is left without a thermometer
  [[nodiscard]] virtual double of(std::span<const int> set) const = 0;
  /// Of the set and each candidate in turn, n_candidates() long; members of the set have no meaning there.
  [[nodiscard]] virtual std::vector<double> with_each(std::span<const int> set) const = 0;
};

/// The same where any one thermometer may fail: the root mean square of what is left with all of them and of what is left without the one whose
/// loss is worst. Thermometers that cannot fail, or are not counted, are `lasting`.
class LeftWithLoss final : public DriftLeft {
 public:
  /// @param whole  outlives this
  explicit LeftWithLoss(const DriftLeft& whole, std::vector<int> lasting = {}) : whole_(whole), lasting_(std::move(lasting)) {}
  [[nodiscard]] int n_candidates() const override { return whole_.n_candidates(); }
  [[nodiscard]] double of(std::span<const int> set) const override;
  [[nodiscard]] std::vector<double> with_each(std::span<const int> set) const override;
  /// Without the one whose loss is worst.
  [[nodiscard]] double worst(std::span<const int> set) const;

 private:
  [[nodiscard]] std::vector<double> known(std::vector<int> set) const;  // whole_.with_each(), kept
  [[nodiscard]] bool can_fail(int candidate) const;

  const DriftLeft& whole_;
  std::vector<int> lasting_;
  mutable std::mutex lock_;
  mutable std::map<std::vector<int>, std::vector<double>> known_;
};

/// The geometric mean of two: a tenth less of either counts alike, whichever of them is larger.
class LeftOfBoth final : public DriftLeft {
 public:
  /// @param a, b  of the same candidates; outlive this
  LeftOfBoth(const DriftLeft& a, const DriftLeft& b) : a_(a), b_(b) {}
  [[nodiscard]] int n_candidates() const override { return a_.n_candidates(); }
  [[nodiscard]] double of(std::span<const int> set) const override;
  [[nodiscard]] std::vector<double> with_each(std::span<const int> set) const override;

 private:
  const DriftLeft &a_, &b_;
};

}  // namespace driftwright::compensation
