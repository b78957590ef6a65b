#pragma once
// Values of a time series at increasing times.

#include "base/cyclogram.hpp"

namespace driftwright {

/// For increasing times the search starts at the last knot found; for an earlier time it does what TimeSeries::at() does.
class SeriesInOrder {
 public:
  explicit SeriesInOrder(const TimeSeries& series) : series_(series) {}  ///< borrowed
  explicit SeriesInOrder(TimeSeries&&) = delete;

  /// @throws std::logic_error  without knots
  [[nodiscard]] double at(double t_s) {
    const std::vector<double>&knots = series_.time_s, &value = series_.value;
    if (knots.empty() || t_s < knots[last_]) return series_.at(t_s);
    while (last_ + 1 < knots.size() && knots[last_ + 1] <= t_s) ++last_;
    if (last_ + 1 == knots.size()) return value[last_];
    const double share = (t_s - knots[last_]) / (knots[last_ + 1] - knots[last_]);
    return value[last_] + share * (value[last_ + 1] - value[last_]);
  }

 private:
  const TimeSeries& series_;
  std::size_t last_ = 0;  ///< knot that is not after the last time
};

}  // namespace driftwright
