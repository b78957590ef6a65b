#include "effects/reading_chain.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace driftwright::effects {

std::vector<bool> Readings::spindle_turns() const {
  std::vector<bool> turns;
  const std::vector<Cyclogram::Section>& sections = cyclogram.sections;
  std::size_t section = 0;
  double end_s = sections.empty() ? 0.0 : sections.front().duration_s;
  for (const double t_s : time_s) {
    while (section + 1 < sections.size() && t_s >= end_s) end_s += sections[++section].duration_s;
    turns.push_back(!sections.empty() && sections[section].drive.speed_rpm > 0.0);
  }
  return turns;
}

Eigen::Index Readings::row(const std::string& of, bool is_temperature) const {
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (name[i] == of && (unit[i] == "K") == is_temperature) return static_cast<Eigen::Index>(i);
  }
  throw std::logic_error("readings: no " + std::string(is_temperature ? "sensor '" : "displacement '") + of + "'");
}

void ReadingChain::add(ReadingStage stage, Step step) {
  const auto behind = std::find_if(steps_.begin(), steps_.end(), [&](const auto& s) { return s.first > stage; });
  steps_.insert(behind, {stage, std::move(step)});
}

Eigen::MatrixXd ReadingChain::apply(const std::vector<std::string>& name, const std::vector<std::string>& unit,
                                    const std::vector<double>& time_s, const Cyclogram& cyclogram, const TimeSeries& ambient,
                                    Eigen::MatrixXd outputs) const {
  Readings readings{name, unit, time_s, cyclogram, ambient, std::move(outputs)};
  for (const auto& [stage, step] : steps_) step(readings);
  return std::move(readings.value);
}

Eigen::RowVectorXd driven(const std::vector<double>& time_s, const Cyclogram& cyclogram,
                          const std::function<double(const Drive&)>& u, double lag_s) {
  const auto n = static_cast<Eigen::Index>(time_s.size());
  Eigen::RowVectorXd x(n);
  double start_s = 0.0, at_start = 0.0;  // of the section
  std::size_t section = 0;
  const auto after = [&](double passed_s) {
    const double end = cyclogram.sections.empty() ? 0.0 : u(cyclogram.sections[section].drive);
    return lag_s > 0.0 ? at_start + (end - at_start) * -std::expm1(-passed_s / lag_s) : end;
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t_s = time_s[static_cast<std::size_t>(i)];
    while (section + 1 < cyclogram.sections.size() && t_s >= start_s + cyclogram.sections[section].duration_s) {
      at_start = after(cyclogram.sections[section].duration_s);
      start_s += cyclogram.sections[section].duration_s;
      ++section;
    }
    x[i] = after(t_s - start_s);
  }
  return x;
}

Eigen::RowVectorXd speed_growth(const Readings& readings, double amount, double at_speed_rpm, double exponent,
                                double lag_s) {
  return driven(
      readings.time_s, readings.cyclogram,
      [=](const Drive& drive) { return amount * std::pow(drive.speed_rpm / at_speed_rpm, exponent); }, lag_s);
}

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

}  // namespace driftwright::effects
