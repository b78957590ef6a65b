#pragma once
// The drift error that remains with a set of thermometers: the number that a search for sensor places minimises.

#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "base/parallel.hpp"

namespace driftwright::compensation {

/// With fewer candidates one thread is faster than starting others.
inline constexpr int kWorthThreads = 64;
/// Calls work(i) for each i < n; on all cores if there are enough candidates.
template <class Work>
void for_each_part(std::size_t n, int n_candidates, const Work& work) {
  if (n_candidates >= kWorthThreads) return parallel_for(n, work);
  for (std::size_t i = 0; i < n; ++i) work(i);
}

/// A remaining RMS error of the drift [um] as a function of the set of thermometers used, out of n_candidates().
/// Thread-safe.
class DriftLeft {
 public:
  virtual ~DriftLeft() = default;
  [[nodiscard]] virtual int n_candidates() const = 0;
  /// The error of a set. @param set  different candidates; empty: without thermometers
  [[nodiscard]] virtual double of(std::span<const int> set) const = 0;
  /// The error of the set plus each candidate in turn, n_candidates() long; values at members of the set have no meaning.
  [[nodiscard]] virtual std::vector<double> with_each(std::span<const int> set) const = 0;
};

/// The same if any one thermometer may fail: the root mean square of the error with all of them and of the error without the
/// one whose loss is worst. Thermometers that cannot fail, or are not counted, are `lasting`.
class LeftWithLoss final : public DriftLeft {
 public:
  /// @param whole  must outlive this object
  explicit LeftWithLoss(const DriftLeft& whole, std::vector<int> lasting = {})
      : whole_(whole), lasting_(std::move(lasting)) {}
  [[nodiscard]] int n_candidates() const override { return whole_.n_candidates(); }
  [[nodiscard]] double of(std::span<const int> set) const override;
  [[nodiscard]] std::vector<double> with_each(std::span<const int> set) const override;
  /// The error without the thermometer whose loss is worst.
  [[nodiscard]] double worst(std::span<const int> set) const;

 private:
  [[nodiscard]] std::vector<double> known(std::vector<int> set) const;  // whole_.with_each(), stored
  [[nodiscard]] bool can_fail(int candidate) const;

  const DriftLeft& whole_;
  std::vector<int> lasting_;
  mutable std::mutex lock_;
  mutable std::map<std::vector<int>, std::vector<double>> known_;
};

/// The geometric mean of two errors: a reduction of either by the same share counts the same.
class LeftOfBoth final : public DriftLeft {
 public:
  /// @param a, b  of the same candidates; must outlive this object
  LeftOfBoth(const DriftLeft& a, const DriftLeft& b) : a_(a), b_(b) {}
  [[nodiscard]] int n_candidates() const override { return a_.n_candidates(); }
  [[nodiscard]] double of(std::span<const int> set) const override;
  [[nodiscard]] std::vector<double> with_each(std::span<const int> set) const override;

 private:
  const DriftLeft &a_, &b_;
};

}  // namespace driftwright::compensation
