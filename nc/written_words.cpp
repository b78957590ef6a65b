#include "nc/written_words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "nc/units.hpp"

namespace driftwright {

double as_written_m(double x_m, double unit_m) {
  const double steps = unit_m == kMillimetre_m ? 1e6 : 1e7;
  return std::round(x_m / unit_m * steps) / steps * unit_m;
}

std::string written_length(double x_m, double unit_m) {
  std::string text = unit_m == kMillimetre_m ? fmt::format("{:.6f}", x_m / unit_m) : fmt::format("{:.7f}", x_m / unit_m);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string signed_length(double x_m, double unit_m) {
  const std::string text = written_length(x_m, unit_m);
  return text.front() == '-' ? text : "+" + text;
}

std::string axis_words(const std::array<std::optional<double>, 3>& x_m, double unit_m,
                       std::string (*write)(double x_m, double unit_m)) {
  std::string words;
  for (int axis = 0; axis < 3; ++axis) {
    if (x_m[axis]) words += fmt::format(" {}{}", "XYZ"[axis], write(*x_m[axis], unit_m));
  }
  return words;
}

std::vector<std::string> iso_straight_lines(std::string words, const std::string& feed, bool absolute) {
  if (!feed.empty()) words += " " + feed;
  if (absolute) return {words};
  return {"G90 " + words, "G91"};
}

}  // namespace driftwright
