#include "effects/reading_chain.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace driftwright::effects {
namespace {

/// amount (n / at_speed)^exponent at once, or behind one lag: each section's exact exponential, from nothing at t = 0.
Eigen::RowVectorXd growth(const ReadingChain::Growth& g, const std::vector<double>& time_s, const Cyclogram& cyclogram) {
  const auto target = [&](const Drive& drive) { return g.amount * std::pow(drive.speed_rpm / g.at_speed_rpm, g.exponent); };
  Eigen::RowVectorXd grown(static_cast<Eigen::Index>(time_s.size()));
  if (g.lag_s <= 0.0) {
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      grown[static_cast<Eigen::Index>(i)] = target(cyclogram.drive(time_s[i]));
    }
    return grown;
  }
  double start_s = 0.0, at_start = 0.0;  // of the section
  std::size_t section = 0;
  const auto after = [&](double passed_s) {
    const double end = cyclogram.sections.empty() ? 0.0 : target(cyclogram.sections[section].drive);
    return at_start + (end - at_start) * -std::expm1(-passed_s / g.lag_s);
  };
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    while (section + 1 < cyclogram.sections.size() && time_s[i] >= start_s + cyclogram.sections[section].duration_s) {
      at_start = after(cyclogram.sections[section].duration_s);
      start_s += cyclogram.sections[section].duration_s;
      ++section;
    }
    grown[static_cast<Eigen::Index>(i)] = after(time_s[i] - start_s);
  }
  return grown;
}

/// y' = (x - y) / lag for a signal x that is linear between its samples, exactly; settled at the first one.
void lag_behind(Eigen::Ref<Eigen::RowVectorXd> signal, const std::vector<double>& time_s, double lag_s) {
  if (lag_s <= 0.0 || signal.size() == 0) return;
  double before = signal[0], lagged = before;
  for (Eigen::Index i = 1; i < signal.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double step_s = time_s[at] - time_s[at - 1], now = signal[i];
    const double share = -std::expm1(-step_s / lag_s);
    lagged += (before - lagged) * share + (now - before) * (1.0 - lag_s / step_s * share);
    before = now;
    signal[i] = lagged;
  }
}

/// Readings at t that were taken at t - offset.
Eigen::MatrixXd shifted(const Eigen::MatrixXd& outputs, const std::vector<double>& time_s, double offset_s) {
  Eigen::MatrixXd late(outputs.rows(), outputs.cols());
  for (Eigen::Index i = 0; i < outputs.cols(); ++i) {
    const double taken_s = time_s[static_cast<std::size_t>(i)] - offset_s;
    const auto next = std::upper_bound(time_s.begin(), time_s.end(), taken_s);
    const auto after = static_cast<Eigen::Index>(next - time_s.begin());
    if (after == 0 || after == outputs.cols()) {
      late.col(i) = outputs.col(after == 0 ? 0 : after - 1);
      continue;
    }
    const double left_s = *(next - 1), share = (taken_s - left_s) / (*next - left_s);
    late.col(i) = outputs.col(after - 1) + share * (outputs.col(after) - outputs.col(after - 1));
  }
  return late;
}

}  // namespace

Eigen::MatrixXd readings(const ReadingChain& chain, const std::vector<std::string>& name,
                         const std::vector<std::string>& unit, const std::vector<double>& time_s, const Cyclogram& cyclogram,
                         const TimeSeries& hall, Eigen::MatrixXd outputs) {
  const auto row = [&](const std::string& output, bool is_temperature) {
    for (std::size_t i = 0; i < name.size(); ++i) {
      if (name[i] == output && (unit[i] == "K") == is_temperature) return static_cast<Eigen::Index>(i);
    }
    throw std::logic_error("readings: no " + std::string(is_temperature ? "sensor '" : "displacement '") + output + "'");
  };
  const auto happens = [&](const std::string& in) { return in.empty() || in == cyclogram.name; };

  for (const auto& g : chain.growths) outputs.row(row(g.displacement, false)) += growth(g, time_s, cyclogram);
  for (const auto& s : chain.scales) {
    Eigen::RowVectorXd signal = s.factor * outputs.row(row(s.displacement, false));
    lag_behind(signal, time_s, s.lag_s);
    outputs.row(row(s.displacement, false)) = signal;
  }
  for (const auto& s : chain.shifts) {
    const Eigen::Index shifted_row = row(s.displacement, false);
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      if (happens(s.in) && time_s[i] >= s.time_s) outputs(shifted_row, static_cast<Eigen::Index>(i)) += s.amount;
    }
  }
  for (const auto& d : chain.detachments) {
    const Eigen::Index sensor = row(d.sensor, true);
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      double& reading_K = outputs(sensor, static_cast<Eigen::Index>(i));
      if (happens(d.in) && time_s[i] >= d.time_s) reading_K += d.share * (hall.at(time_s[i]) - reading_K);
    }
  }
  for (const auto& l : chain.lags) {
    Eigen::RowVectorXd signal = outputs.row(row(l.sensor, true));
    lag_behind(signal, time_s, l.lag_s);
    outputs.row(row(l.sensor, true)) = signal;
  }
  for (const auto& e : chain.errors) {
    const Eigen::Index sensor = row(e.sensor, true);
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      outputs(sensor, static_cast<Eigen::Index>(i)) += e.bias_K + e.drift_K_s * time_s[i];
    }
  }
  for (const auto& s : chain.swaps) outputs.row(row(s.a, true)).swap(outputs.row(row(s.b, true)));
  if (chain.clock_offset_s != 0.0) outputs = shifted(outputs, time_s, chain.clock_offset_s);
  return outputs;
}

}  // namespace driftwright::effects
