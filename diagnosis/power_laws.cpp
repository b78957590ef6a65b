#include "diagnosis/power_laws.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::diagnosis {

PowerLaws power_laws(const effects::Effect& effect, double at_speed_rpm, const std::vector<double>& speeds_rpm) {
  const effects::Law law = effects::heat_balance({effect}).heats.front().power_W;
  const auto power_W = [&](double rpm) { return law(effects::Inputs{.drive = {.speed_rpm = rpm}}); };
  const double at_W = power_W(at_speed_rpm);
  std::vector<std::pair<double, double>> pairs = {{5.0 / 3.0, 1.0}};
  for (std::size_t p = 0; p < effect.values.size(); ++p) {
    if (effect.kind->parameters[p].name == "exponent") pairs.emplace_back(effect.values[p], 0.0);
  }
  for (const auto& [a, b] : pairs) {
    // P(n) / P(at) = s r^a + (1 - s) r^b with r = n / at: s from half the speed, then tried elsewhere
    const double ra = std::pow(0.5, a), rb = std::pow(0.5, b);
    if (std::abs(ra - rb) < 1e-6) continue;
    const double s = (power_W(0.5 * at_speed_rpm) / at_W - rb) / (ra - rb);
    const bool same = std::isfinite(s) && std::all_of(speeds_rpm.begin(), speeds_rpm.end(), [&](double rpm) {
                        const double r = rpm / at_speed_rpm, want = power_W(rpm) / at_W;
                        return std::abs(s * std::pow(r, a) + (1.0 - s) * std::pow(r, b) - want) <= 1e-6 * std::abs(want);
                      });
    if (!same) continue;
    PowerLaws laws;
    if (std::abs(s) > 1e-9) laws.terms.push_back({s * at_W, a});
    if (std::abs(1.0 - s) > 1e-9) laws.terms.push_back({(1.0 - s) * at_W, b});
    return laws;
  }
  const double growth = std::log(power_W(1.03 * at_speed_rpm) / power_W(0.97 * at_speed_rpm)) / std::log(1.03 / 0.97);
  if (!std::isfinite(growth)) return {};
  PowerLaws laws{{{at_W, growth}}, 0.0};
  for (double rpm : speeds_rpm) {
    const double want = power_W(rpm), have = at_W * std::pow(rpm / at_speed_rpm, growth);
    laws.deviation = std::max(laws.deviation, std::abs(have - want) / std::abs(want));
  }
  return laws;
}

}  // namespace driftwright::diagnosis
