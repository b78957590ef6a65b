#include "compensation/sensors/drift_left.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::compensation {
namespace {

std::vector<int> without(std::span<const int> set, std::size_t left_out) {
  std::vector<int> rest(set.begin(), set.end());
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
  return rest;
}

double rms(double a, double b) {
  return std::sqrt(0.5 * (a * a + b * b));
}

constexpr std::size_t kMostKept = 4000;

}  // namespace

bool LeftWithLoss::can_fail(int candidate) const {
  return std::find(lasting_.begin(), lasting_.end(), candidate) == lasting_.end();
}

double LeftWithLoss::worst(std::span<const int> set) const {
  double worst_um = 0.0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (can_fail(set[i])) worst_um = std::max(worst_um, whole_.of(without(set, i)));
  }
  return worst_um;
}

double LeftWithLoss::of(std::span<const int> set) const {
  return rms(whole_.of(set), worst(set));
}

std::vector<double> LeftWithLoss::known(std::vector<int> set) const {
  std::sort(set.begin(), set.end());
  {
    const std::lock_guard guard(lock_);
    if (const auto at = known_.find(set); at != known_.end()) return at->second;
  }
  std::vector<double> left = whole_.with_each(set);
  const std::lock_guard guard(lock_);
  if (known_.size() >= kMostKept) known_.clear();
  known_.emplace(std::move(set), left);
  return left;
}

std::vector<double> LeftWithLoss::with_each(std::span<const int> set) const {
  std::vector<std::vector<int>> sets = {{set.begin(), set.end()}};
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (can_fail(set[i])) sets.push_back(without(set, i));
  }
  std::vector<std::vector<double>> with(sets.size());
  for_each_part(sets.size(), n_candidates(), [&](std::size_t i) { with[i] = known(sets[i]); });
  std::vector<double> left = with.front();
  const double without_added_um = whole_.of(set);
  for (std::size_t c = 0; c < left.size(); ++c) {
    double worst_um = can_fail(static_cast<int>(c)) ? without_added_um : 0.0;
    for (std::size_t i = 1; i < with.size(); ++i) worst_um = std::max(worst_um, with[i][c]);
    left[c] = rms(left[c], worst_um);
  }
  return left;
}

double LeftOfBoth::of(std::span<const int> set) const {
  return std::sqrt(a_.of(set) * b_.of(set));
}

std::vector<double> LeftOfBoth::with_each(std::span<const int> set) const {
  std::vector<double> left = a_.with_each(set);
  const std::vector<double> other = b_.with_each(set);
  for (std::size_t c = 0; c < left.size(); ++c) left[c] = std::sqrt(left[c] * other[c]);
  return left;
}

}  // namespace driftwright::compensation
