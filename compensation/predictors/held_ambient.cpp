#include "compensation/predictors/held_ambient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compensation/predictors/predictor.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kAmbientJump_K = 3.0;      // an ambient never changes by more from row to row
constexpr double kAmbientJumpIn_s = 600.0;  // for more distant rows, within this time

}  // namespace

bool HeldAmbient::take(const ObservedRun& run, std::size_t row) {
  const std::vector<double>& t = run.readings.time_s;
  const double t_s = t[run.at(row)], told_K = run.ambient.at(t_s);
  if (used_K_.size() > kRowsBack) {
    used_K_.pop_front();
    is_doubted_.pop_front();
    ++first_row_;
  }
  if (row == 0) {
    used_K_.push_back(told_K);
    is_doubted_.push_back(false);
    return false;
  }
  const double most_K = kAmbientJump_K * std::max(1.0, (t_s - t[run.at(row) - 1]) / kAmbientJumpIn_s);
  const bool is_doubted = std::abs(told_K - used_K_.back()) > most_K, begins = is_doubted && !is_doubted_.back();
  if (begins) {
    doubted_row = row;
    doubted_s = t_s;
  }
  used_K_.push_back(is_doubted ? used_K_.back() : told_K);
  is_doubted_.push_back(is_doubted);
  return begins;
}

void HeldAmbient::believe(const ObservedRun& run, std::size_t from, std::size_t last) {
  for (std::size_t k = from; k <= last; ++k) {
    used_K_[k - first_row_] = run.ambient.at(run.readings.time_s[run.at(k)]);
    is_doubted_[k - first_row_] = false;
  }
}

double HeldAmbient::between_rows(const ObservedRun& run, std::size_t row, double t_s) const {
  const std::size_t k = row - first_row_;
  return is_doubted_[k] || is_doubted_[k - 1] ? used_K_[k] : run.ambient.at(t_s);
}

std::string HeldAmbient::words() const {
  return fmt::format("the ambient thermometer from {:.0f} min", doubted_s / 60.0);
}

void HeldAmbient::recall(std::size_t row, double used_K, bool is_doubted) {
  used_K_ = {used_K};
  is_doubted_ = {is_doubted};
  first_row_ = row - 1;
}

}  // namespace driftwright::compensation
