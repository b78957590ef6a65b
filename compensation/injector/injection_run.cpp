#include "compensation/injector/injection_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "compensation/injector/pulse_injector.hpp"
#include "compensation/injector/quadrature.hpp"

namespace driftwright::compensation {
namespace {

/// One dither about 00: forward, back to the other side, and home.
std::vector<Lines> dither_rows(int n_periods) {
  const Lines home = 0;
  const int quarters = n_periods * kQuartersPerPeriod;
  std::vector<Lines> rows;
  for (int n_quarters : {+quarters, -2 * quarters, +quarters}) {
    const std::vector<Lines> leg = motion_rows(home, n_quarters);  // every leg starts and ends at 00
    rows.insert(rows.end(), leg.begin(), leg.end());
  }
  return rows;
}

}  // namespace

InjectionResult simulate_injection(std::span<const double> time_s, std::span<const double> correction_um, double period_um,
                                   int n_dither_periods) {
  if (!(period_um > 0.0)) throw RangeError(fmt::format("encoder period {} um must be positive", period_um));
  if (n_dither_periods < 1) throw RangeError(fmt::format("a dither of {} periods must be 1 or more", n_dither_periods));
  if (time_s.size() != correction_um.size()) {
    throw InputError(fmt::format("{} times but {} corrections", time_s.size(), correction_um.size()));
  }

  const std::vector<Lines> dither = dither_rows(n_dither_periods);
  QuadratureCounter upstream, downstream;
  PulseInjector injector;
  std::vector<Lines> rows(dither.size() * kMostRowsPerRow);
  InjectionResult run;
  run.max_periods_per_sample = static_cast<int>(std::count(dither.begin(), dither.end(), Lines{0}));
  double longest_step_s = 0.0;
  for (std::size_t i = 0; i < correction_um.size(); ++i) {
    if (i > 0) longest_step_s = std::max(longest_step_s, time_s[i] - time_s[i - 1]);
    if (std::isfinite(correction_um[i]))
      injector.set_target(kQuartersPerPeriod * std::llround(correction_um[i] / period_um));
    const std::size_t n_rows = injector.run(dither, rows.data());
    for (Lines row : dither) upstream.step(row);
    for (std::size_t r = 0; r < n_rows; ++r) downstream.step(rows[r]);
    run.inserted_periods.push_back(injector.inserted() / kQuartersPerPeriod);
    run.inserted_um.push_back(static_cast<double>(run.inserted_periods.back()) * period_um);
  }
  run.upstream_count = upstream.count();
  run.downstream_count = downstream.count();
  run.n_illegal = downstream.n_jumps();
  if (longest_step_s > 0.0) run.max_rate_um_s = run.max_periods_per_sample * period_um / longest_step_s;
  return run;
}

}  // namespace driftwright::compensation
