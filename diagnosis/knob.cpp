#include "diagnosis/knob.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {

double Knob::value(double x) const {
  return std::clamp(scale == Scale::kLog ? nominal * std::exp(x) : nominal + x, low, high);
}

double Knob::x(double value) const {
  return scale == Scale::kLog ? std::log(value / nominal) : value - nominal;
}

}  // namespace driftwright::diagnosis
