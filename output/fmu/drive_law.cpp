#include "output/fmu/drive_law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "effects/law_steps.hpp"

namespace driftwright::output {
namespace {

constexpr double kMmMin_per_m_s = 60e3;
constexpr double kTolerance = 1e-13, kNarrowest = 1e-9, kLeastShare = 1e-6;
constexpr int kNodes = kLawDegree + 1, kChecks = 41;
constexpr std::size_t kMostPieces = 2000;  // most pieces; a kink needs about forty

using Coefficients = std::array<double, kNodes>;

double sum(const double* c, double s) {
  double b0 = 0.0, b1 = 0.0;
  for (int j = kLawDegree; j > 0; --j) {
    const double b2 = b1;
    b1 = b0;
    b0 = 2.0 * s * b1 - b2 + c[j];
  }
  return s * b0 - b1 + c[0];
}

/// Interpolates at the zeros of the next Chebyshev polynomial.
Coefficients interpolated(const std::function<double(double)>& f, double low, double high) {
  Coefficients value{}, c{};
  for (int k = 0; k < kNodes; ++k) {
    const double s = std::cos(std::numbers::pi * (k + 0.5) / kNodes);
    value[static_cast<std::size_t>(k)] = f(0.5 * (low + high) + 0.5 * (high - low) * s);
  }
  for (int j = 0; j < kNodes; ++j) {
    double total = 0.0;
    for (int k = 0; k < kNodes; ++k)
      total += value[static_cast<std::size_t>(k)] * std::cos(std::numbers::pi * j * (k + 0.5) / kNodes);
    c[static_cast<std::size_t>(j)] = (j == 0 ? 1.0 : 2.0) / kNodes * total;
  }
  return c;
}

/// Within kTolerance, or within the rounding of x: a law has few digits where it is much less than x makes of it, as just above
/// the speed at which it begins.
/// @param at_rest  value that was subtracted from the law; it sets the rounding error of f
bool keeps_to(const Coefficients& c, const std::function<double(double)>& f, double at_rest, double low, double high) {
  // exp(log x) is off by half a unit of log x, and the law by a few of its own: 4 together.
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * std::max({1.0, std::abs(low), std::abs(high)});
  double most = std::abs(at_rest), error = 0.0, steepest = 0.0, before = f(low);
  for (int k = 0; k < kChecks; ++k) {
    const double s = -1.0 + 2.0 * k / (kChecks - 1), value = f(0.5 * (low + high) + 0.5 * (high - low) * s);
    most = std::max(most, std::abs(value));
    steepest = std::max(steepest, std::abs(value - before) * (kChecks - 1) / (high - low));
    error = std::max(error, std::abs(value - sum(c.data(), s)));
    before = value;
  }
  return error <= std::max(kTolerance * most, rounding * steepest);
}

/// @returns false if more than kMostPieces are needed
bool add_pieces(LawTerm& term, const std::function<double(double)>& f, double at_rest, double low, double high) {
  Coefficients c = interpolated(f, low, high);
  const bool keeps = keeps_to(c, f, at_rest, low, high);
  if (!keeps && high - low <= kNarrowest) c = {f(high)};  // a jump: use the value after it
  if (!keeps && high - low > kNarrowest) {
    const double middle = 0.5 * (low + high);
    return add_pieces(term, f, at_rest, low, middle) && add_pieces(term, f, at_rest, middle, high);
  }
  term.log_x.push_back(high);
  term.coefficients.insert(term.coefficients.end(), c.begin(), c.end());
  return term.log_x.size() <= kMostPieces;
}

}  // namespace

double value_of(DriveVariable variable, const Drive& drive) {
  switch (variable) {
    case DriveVariable::kSpeed:
      return drive.speed_rpm;
    case DriveVariable::kFeedX:
      return kMmMin_per_m_s * drive.feed_m_s[0];
    case DriveVariable::kFeedY:
      return kMmMin_per_m_s * drive.feed_m_s[1];
    case DriveVariable::kFeedZ:
      return kMmMin_per_m_s * drive.feed_m_s[2];
    case DriveVariable::kCuttingPower:
      return drive.cutting_power_W;
  }
  return effects::place_mm(drive, place_of(variable));
}

void set_value(DriveVariable variable, Drive& drive, double value) {
  switch (variable) {
    case DriveVariable::kSpeed:
      drive.speed_rpm = value;
      break;
    case DriveVariable::kFeedX:
      drive.feed_m_s[0] = value / kMmMin_per_m_s;
      break;
    case DriveVariable::kFeedY:
      drive.feed_m_s[1] = value / kMmMin_per_m_s;
      break;
    case DriveVariable::kFeedZ:
      drive.feed_m_s[2] = value / kMmMin_per_m_s;
      break;
    case DriveVariable::kCuttingPower:
      drive.cutting_power_W = value;
      break;
  }
  if (is_place(variable)) effects::set_place(drive, place_of(variable), value);
}

std::vector<DriveRange> largest_drives(const std::vector<Cyclogram>& cyclograms) {
  std::vector<DriveRange> ranges;
  for (int v = 0; v < kDriveVariables; ++v) {
    const auto variable = static_cast<DriveVariable>(v);
    double most = 0.0;
    for (const Cyclogram& c : cyclograms) {
      for (const Cyclogram::Section& s : c.sections) most = std::max(most, value_of(variable, s.drive));
    }
    if (most > 0.0) ranges.push_back({variable, most});
  }
  return ranges;
}

double DriveLaw::at(const std::vector<double>& x) const {
  double value = at_rest;
  for (const LawTerm& term : terms) {
    const double own = x[static_cast<std::size_t>(term.variable)];
    if (!(own > 0.0)) continue;
    const double log_x = std::clamp(std::log(own), term.log_x.front(), term.log_x.back());
    const auto above = std::upper_bound(term.log_x.begin() + 1, term.log_x.end() - 1, log_x);
    const double low = *(above - 1), high = *above;
    value +=
        sum(term.coefficients.data() + (above - term.log_x.begin() - 1) * kNodes, 2.0 * (log_x - low) / (high - low) - 1.0);
  }
  return value;
}

std::optional<DriveLaw> tabulated(const std::function<double(const Drive&)>& law, const std::vector<DriveRange>& ranges) {
  DriveLaw table{.at_rest = law({})};
  const bool has_places = std::any_of(ranges.begin(), ranges.end(), [](const auto& r) { return is_place(r.variable); });
  for (std::size_t v = 0; v < ranges.size(); ++v) {
    if (is_place(ranges[v].variable)) continue;  // the check below finds whether it acts
    const std::function<double(double)> beyond_rest = [&](double log_x) {
      Drive drive;
      set_value(ranges[v].variable, drive, std::exp(log_x));
      return law(drive) - table.at_rest;
    };
    const double high = std::log(ranges[v].most), low = high + std::log(kLeastShare);
    bool is_constant = true;
    for (int k = 0; k < kChecks && is_constant; ++k)
      is_constant = beyond_rest(low + (high - low) * k / (kChecks - 1)) == 0.0;
    if (is_constant) continue;
    LawTerm term{.variable = static_cast<int>(v), .log_x = {low}, .coefficients = {}};
    if (!add_pieces(term, beyond_rest, table.at_rest, low, high)) return std::nullopt;
    table.terms.push_back(std::move(term));
  }
  std::mt19937 random(1);  // drives in which no variable is 0
  std::uniform_real_distribution<double> share(0.05, 1.0);
  for (int k = 0; k < kChecks && (ranges.size() > 1 || has_places); ++k) {
    Drive drive;
    std::vector<double> x;
    for (const DriveRange& r : ranges) {
      x.push_back(r.least + share(random) * (r.most - r.least));
      set_value(r.variable, drive, x.back());
    }
    const double value = law(drive);
    if (std::abs(value - table.at(x)) > 1e-11 * (std::abs(value) + std::abs(table.at_rest))) return std::nullopt;
  }
  return table;
}

}  // namespace driftwright::output
