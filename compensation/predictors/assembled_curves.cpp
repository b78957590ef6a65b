#include "compensation/predictors/assembled_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kStep_s = 30.0;           // of the tabulated curves
constexpr double kLength_s = 12 * 3600.0;  // after this a curve is constant
constexpr double kSame_rpm = 1e-9;

/// A row of a table at a time since the change, linear between its columns.
double value(const Eigen::MatrixXd& table, Eigen::Index channel, double t_s) {
  const double at = std::clamp(t_s / kStep_s, 0.0, static_cast<double>(table.cols() - 1));
  const auto i = std::min(static_cast<Eigen::Index>(at), table.cols() - 2);
  const double share = at - static_cast<double>(i);
  return (1.0 - share) * table(channel, i) + share * table(channel, i + 1);
}

/// First time at which a row has a level; none if it never has.
std::optional<double> time_at(const Eigen::MatrixXd& table, Eigen::Index channel, double level) {
  for (Eigen::Index i = 0; i + 1 < table.cols(); ++i) {
    const double a = table(channel, i) - level, b = table(channel, i + 1) - level;
    if (a == 0.0) return kStep_s * static_cast<double>(i);
    if (a * b < 0.0) return kStep_s * (static_cast<double>(i) + a / (a - b));
  }
  return std::nullopt;
}

/// The rest of a level after cooling: never more than the level, even after division by a small start.
double shrunk(double share) {
  return std::clamp(share, -1.0, 1.0);
}

double time_nearest(const Eigen::MatrixXd& table, Eigen::Index channel, double level) {
  Eigen::Index at = 0;
  (table.row(channel).array() - level).abs().minCoeff(&at);
  return kStep_s * static_cast<double>(at);
}

}  // namespace

const char* word(CyclogramType type) {
  switch (type) {
    case CyclogramType::kContinuous:
      return "continuous";
    case CyclogramType::kStepwiseUp:
      return "stepwise up";
    case CyclogramType::kIntermittent:
      return "intermittent";
    case CyclogramType::kStepwiseDown:
      return "stepwise down";
    case CyclogramType::kChaotic:
      return "chaotic";
  }
  return "";
}

CyclogramType type_of(const Cyclogram& cyclogram) {
  std::vector<double> speeds;
  for (const auto& s : cyclogram.sections) {
    if (speeds.empty() || std::abs(speeds.back() - s.drive.speed_rpm) > kSame_rpm) speeds.push_back(s.drive.speed_rpm);
  }
  bool rises = false, falls = false, stops = false;
  double only_rpm = 0.0;
  bool one_speed = true;
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    if (i > 0) (speeds[i] > speeds[i - 1] ? rises : falls) = true;
    stops = stops || speeds[i] == 0.0;
    if (speeds[i] == 0.0) continue;
    one_speed = one_speed && (only_rpm == 0.0 || speeds[i] == only_rpm);
    only_rpm = speeds[i];
  }
  if (speeds.size() < 2) return CyclogramType::kContinuous;
  if (stops && one_speed) return CyclogramType::kIntermittent;
  if (rises && !falls) return CyclogramType::kStepwiseUp;
  if (falls && !rises) return CyclogramType::kStepwiseDown;
  return CyclogramType::kChaotic;
}

AssembledCurves::AssembledCurves(const std::vector<ThermalTest>& tests, const TestChannels& channels)
    : n_channels_(channels.name.size()) {
  for (const ThermalTest& test : tests) {
    const auto& sections = test.cyclogram.sections;
    if (sections.size() != 2 || !(sections[0].drive.speed_rpm > 0.0) || sections[1].drive.speed_rpm != 0.0) {
      throw InputError(fmt::format(
          "test '{}' is not heating at one speed and standstill after it, which curves are cut from", test.cyclogram.name));
    }
    // Fitted exponentials instead of raw readings, so that noise is not assembled and the steady level is known.
    const IdentifiedModes fit = identify_modes({test}, channels, {.most_modes = 3, .powers = 2, .mean_over_s = 300.0});
    Curves c{sections[0].drive.speed_rpm, {}, {}};
    std::vector<double> time_s;
    for (double t_s = 0.0; t_s <= kLength_s; t_s += kStep_s) time_s.push_back(t_s);
    const TimeSeries no_ambient{{0.0}, {0.0}};
    c.heating = fit.predict({"", {{kLength_s + kStep_s, sections[0].drive}}}, no_ambient, time_s);
    std::vector<double> later_s;
    for (double t_s : time_s) later_s.push_back(sections[0].duration_s + t_s);
    c.cooling = fit.predict({"", {sections[0], {kLength_s + kStep_s, {}}}}, no_ambient, later_s);
    if (std::any_of(curves_.begin(), curves_.end(), [&](const Curves& o) { return o.speed_rpm == c.speed_rpm; })) {
      throw InputError(fmt::format("two tests at {:g} rpm", c.speed_rpm));
    }
    curves_.push_back(std::move(c));
  }
  if (curves_.empty()) throw InputError("curves cannot be assembled without tests");
  std::sort(curves_.begin(), curves_.end(), [](const Curves& a, const Curves& b) { return a.speed_rpm < b.speed_rpm; });
}

AssembledCurves::Curves AssembledCurves::at(double speed_rpm) const {
  const auto above = std::lower_bound(curves_.begin(), curves_.end(), speed_rpm - kSame_rpm,
                                      [](const Curves& c, double rpm) { return c.speed_rpm < rpm; });
  if (above == curves_.end()) return curves_.back();
  if (above == curves_.begin() || std::abs(above->speed_rpm - speed_rpm) <= kSame_rpm) return *above;
  const Curves &a = *std::prev(above), &b = *above;
  const double share = (speed_rpm - a.speed_rpm) / (b.speed_rpm - a.speed_rpm);
  return {speed_rpm, (1.0 - share) * a.heating + share * b.heating, (1.0 - share) * a.cooling + share * b.cooling};
}

Eigen::MatrixXd AssembledCurves::predict(const Cyclogram& cyclogram, const std::vector<double>& output_s,
                                         bool extrapolate) const {
  require_tested(cyclogram, {curves_.front().speed_rpm, curves_.back().speed_rpm, true}, extrapolate);
  Eigen::MatrixXd y =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n_channels_), static_cast<Eigen::Index>(output_s.size()));
  Eigen::VectorXd level = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n_channels_));
  double start_s = 0.0, before_rpm = 0.0;
  std::size_t next = 0;
  for (std::size_t s = 0; s < cyclogram.sections.size(); ++s) {
    const auto& section = cyclogram.sections[s];
    const double rpm = section.drive.speed_rpm, end_s = start_s + section.duration_s;
    const bool is_last = s + 1 == cyclogram.sections.size();
    const Curves now = at(rpm > 0.0 ? rpm : before_rpm > 0.0 ? before_rpm : curves_.front().speed_rpm);
    std::size_t end = next;
    while (end < output_s.size() && (output_s[end] < end_s || is_last)) ++end;
    for (Eigen::Index c = 0; c < level.size(); ++c) {
      const double from = level[c];
      const auto along = [&, c](double dt_s) -> double {
        const double steady = now.heating(c, now.heating.cols() - 1), cold = now.cooling(c, 0);
        if (rpm > 0.0) {
          if (const auto t_s = time_at(now.heating, c, from)) return value(now.heating, c, *t_s + dt_s);
          const bool is_beyond = std::abs(from) > std::abs(steady) && from * steady > 0.0;
          if (is_beyond && cold != 0.0) return steady + (from - steady) * shrunk(value(now.cooling, c, dt_s) / cold);
          return value(now.heating, c, time_nearest(now.heating, c, from) + dt_s);
        }
        if (before_rpm == 0.0) return from;  // the spindle has not turned yet
        if (const auto t_s = time_at(now.cooling, c, from)) return value(now.cooling, c, *t_s + dt_s);
        if (cold != 0.0 && from * cold > 0.0) return from * shrunk(value(now.cooling, c, dt_s) / cold);
        return value(now.cooling, c, time_nearest(now.cooling, c, from) + dt_s);
      };
      for (std::size_t i = next; i < end; ++i) y(c, static_cast<Eigen::Index>(i)) = along(output_s[i] - start_s);
      level[c] = along(section.duration_s);
    }
    next = end;
    start_s = end_s;
    if (rpm > 0.0) before_rpm = rpm;
  }
  return y;
}

}  // namespace driftwright::compensation
