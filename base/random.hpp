#pragma once
// Random numbers that a seed fixes to the last bit on every machine: the standard library fixes its engines, but not its
// distributions.

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace driftwright {

/// SplitMix64. Source: Steele, Lea & Flood, OOPSLA 2014, 453-472.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// @param purpose  an independent sequence for each purpose: more draws for one do not change the draws for another
  Random(std::uint64_t seed, std::uint64_t purpose)
      : state_(seed * 0x2545f4914f6cdd1dULL + purpose * 0xd1342543de82ef95ULL) {
    (void)bits();
  }

  [[nodiscard]] double uniform(double low = 0.0, double high = 1.0) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) + 0.5) * 0x1.0p-53;
  }
  /// Uniform in the logarithm.
  [[nodiscard]] double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
  /// Standard normal, by Box and Muller.
  [[nodiscard]] double normal() {
    const double u = uniform(), angle = 2.0 * std::numbers::pi * uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(angle);
  }
  [[nodiscard]] int below(int n) { return static_cast<int>(uniform() * n); }
  [[nodiscard]] bool chance(double share) { return uniform() < share; }
  [[nodiscard]] double sign() { return chance(0.5) ? 1.0 : -1.0; }
  template <class T>
  [[nodiscard]] const T& one_of(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(below(static_cast<int>(choices.size())))];
  }

 private:
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace driftwright
