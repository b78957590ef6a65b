#include "effects/law_steps.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace driftwright::effects {

std::vector<std::string> law_names(std::size_t n_probes) {
  std::vector<std::string> names = {"n", "v_x", "v_y", "v_z", "P_cut"};
  for (std::size_t p = 0; p < n_probes; ++p) names.push_back(fmt::format("T{}", p));
  return names;
}

std::size_t place_index(const std::string& column) {
  for (std::size_t k = 0; k < kPlaces; ++k) {
    if (column == kPlaceNames[k] || column == std::string(kPlaceNames[k]) + "_mm") return k;
  }
  return kPlaces;
}

double place_mm(const Drive& drive, std::size_t place) {
  for (const Signal& s : drive.signals) {
    if (place_index(s.name) == place) return s.value;
  }
  return 0.0;
}

void set_place(Drive& drive, std::size_t place, double value_mm) {
  std::erase_if(drive.signals, [&](const Signal& s) { return place_index(s.name) == place; });
  const std::string name = kPlaceNames[place];  // effects call it so or so
  drive.signals.push_back({name, value_mm});
  drive.signals.push_back({name + "_mm", value_mm});
}

std::string written(double number) {
  return number < 0.0 ? fmt::format("({})", number) : fmt::format("{}", number);
}

std::vector<Expression::Step> law_steps(const std::string& text, std::size_t n_probes) {
  return with_constants_folded(parse_expression(text, law_names(n_probes)).steps);
}

std::function<std::vector<Expression::Step>()> sum_of_steps(const std::vector<const Law*>& laws) {
  struct Term {
    std::function<std::vector<Expression::Step>()> steps;
    std::size_t n_probes;
  };
  std::vector<Term> terms;
  for (const Law* law : laws) {
    if (!law->steps) return {};
    terms.push_back({law->steps, law->probes.size()});
  }
  return [terms] {
    std::vector<Expression::Step> sum;
    std::size_t n_before = 0;
    for (std::size_t t = 0; t < terms.size(); ++t) {
      for (Expression::Step step : terms[t].steps()) {
        if (step.op == Op::kName && step.name >= kDriveNames && step.name < kFirstPlace) step.name += n_before;
        sum.push_back(step);
      }
      if (t > 0) sum.push_back({.op = Op::kAdd});
      n_before += terms[t].n_probes;
    }
    return sum;
  };
}

double value_of_law_steps(const std::vector<Expression::Step>& steps, const Inputs& u) {
  std::vector<double> x = {u.drive.speed_rpm, u.drive.feed_m_s[0], u.drive.feed_m_s[1], u.drive.feed_m_s[2],
                           u.drive.cutting_power_W};
  x.insert(x.end(), u.probe_K.begin(), u.probe_K.end());
  std::vector<Expression::Step> own = steps;
  for (Expression::Step& s : own) {
    if (s.op == Op::kName && s.name >= kFirstPlace) s.name += x.size() - kFirstPlace;
  }
  for (std::size_t k = 0; k < kPlaces; ++k) x.push_back(place_mm(u.drive, k));
  return value_of(own, x.data());
}

}  // namespace driftwright::effects
