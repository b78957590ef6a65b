#include "compensation/injector/encoder.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.hpp"
#include "base/random.hpp"

namespace driftwright::compensation {

EncoderEdges::EncoderEdges(const Encoder& encoder, double position_um) : encoder_(encoder), position_um_(position_um) {
  if (!(encoder.period_um > 0.0)) throw RangeError(fmt::format("signal period {} um must be positive", encoder.period_um));
  if (!(encoder.jitter >= 0.0 && encoder.jitter < 0.5))
    throw RangeError(
        fmt::format("jitter is {} quarters; it must be from 0 to below 0.5, or edges would change places", encoder.jitter));
  phase_ = static_cast<std::int64_t>(std::floor(position_um / encoder.quarter_um())) - 1;
  while (place_um(phase_ + 1) <= position_um) ++phase_;
}

double EncoderEdges::place_um(std::int64_t phase) const {
  double quarters = static_cast<double>(phase);
  if (encoder_.jitter > 0.0)
    quarters += encoder_.jitter * Random(encoder_.seed, static_cast<std::uint64_t>(phase)).uniform(-1.0, 1.0);
  return quarters * encoder_.quarter_um();
}

Lines EncoderEdges::lines() const {
  const std::int64_t turn = static_cast<std::int64_t>(encoder_.periods_per_index) * kQuartersPerPeriod;
  const bool index = turn > 0 && phase_ % turn == 0;
  return static_cast<Lines>(lines_of_phase(phase_) | (index ? kLineIndex : 0));
}

void EncoderEdges::move(std::int64_t from_t, std::int64_t to_t, double to_um, std::vector<Edge>& out) {
  const double way_um = to_um - position_um_;
  const auto pass = [&](double place_um, int direction) {
    phase_ += direction;
    const double share = (place_um - position_um_) / way_um;
    out.push_back({from_t + static_cast<std::int64_t>(share * static_cast<double>(to_t - from_t)), lines()});
  };
  if (way_um > 0.0) {
    for (double place = place_um(phase_ + 1); place <= to_um; place = place_um(phase_ + 1)) pass(place, +1);
  } else {
    for (double place = place_um(phase_); place > to_um; place = place_um(phase_)) pass(place, -1);
  }
  position_um_ = to_um;
}

}  // namespace driftwright::compensation
