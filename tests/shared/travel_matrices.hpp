#pragma once
// Strategies at three places of a screw whose error is in closed form: (position / 0.4 m)^2 um for each kelvin of a
// thermometer.

#include <memory>
#include <vector>

#include "compensation/judging/travel.hpp"
#include "compensation/predictors/formula_predictor.hpp"
#include "compensation/predictors/past_drift.hpp"

namespace driftwright::fixtures {

inline const std::vector<double> kTravelPlaces_m = {0.0, 0.4, 0.8};

inline double travel_um_per_K(double at_m) {
  return (at_m / 0.4) * (at_m / 0.4);
}

/// Judged at the corrected places and half-way between them.
inline std::vector<compensation::TravelPlace> travel_judged() {
  return {{"x_0", 0.0}, {"x_200", 0.2}, {"x_400", 0.4}, {"x_600", 0.6}, {"x_800", 0.8}};
}

/// Two runs, of which the second warms by 10 K. The formula is exact; a constant of 1 um is said to leave less on left-out
/// parts; "lost" is fitted at the first two places alone.
inline std::vector<compensation::StrategyMatrix> travel_matrices() {
  using namespace compensation;
  std::vector<StrategyMatrix> matrices;
  for (const double at_m : kTravelPlaces_m) {
    StrategyMatrix m;
    const TravelPlace here = travel_judged()[2 * matrices.size()];
    m.settings.strategies.target = here.channel;
    m.settings.strategies.place = ScrewPlace{"x_screw", at_m};
    m.settings.tolerance_um = 5.0;
    for (const double warms_K : {4.0, 10.0}) {
      Record r{.source = "run", .time_s = {}, .channels = {{"T", "degC", {}}}};
      for (const TravelPlace& p : travel_judged()) r.channels.push_back({p.channel, "um", {}});
      for (int i = 0; i <= 10; ++i) {
        r.time_s.push_back(60.0 * i);
        r.channels[0].values.push_back(20.0 + 0.1 * warms_K * i);
        for (std::size_t p = 0; p < 5; ++p)
          r.channels[p + 1].values.push_back(0.1 * warms_K * i * travel_um_per_K(travel_judged()[p].at_m));
      }
      m.runs.push_back({.family = "all",
                        .season = "",
                        .name = warms_K > 5.0 ? "warm" : "cool",
                        .run = {.cyclogram = {}, .ambient = {}, .readings = r}});
    }
    const double slope = travel_um_per_K(at_m);
    const auto add = [&](const std::string& name, std::shared_ptr<const Predictor> predictor, double left_out_um) {
      JudgedStrategy s;
      s.fitted.name = name;
      s.fitted.target = here.channel;
      s.fitted.predictor = std::move(predictor);
      s.fitted.fold_errors = {{.kind = "run", .name = "run a", .rms_um = left_out_um, .within_um = left_out_um}};
      s.fitted.is_baseline = name == kNoCorrection;
      m.strategies.push_back(std::move(s));
    };
    add(kNoCorrection, std::make_shared<ConstantPredictor>(0.0), 0.1);
    add("constant", std::make_shared<ConstantPredictor>(1.0), 1.0);
    add("exact",
        std::make_shared<FormulaPredictor>(DriftModel{.kind = "by hand",
                                                      .target = here.channel,
                                                      .target_unit = "um",
                                                      .intercept = -20.0 * slope,
                                                      .terms = {{.input = "T", .unit = "degC", .coefficient = slope}}}),
        2.0 + at_m);
    FailSafe& safe = m.strategies.back().fitted.fail_safe.emplace();
    safe.guards = {{.input = "T", .unit = "degC", .low = 0, .high = 100, .most_jump = 1e9, .others_coefficient = {}}};
    safe.lowest_um = -1e3;
    safe.highest_um = 1e3;
    safe.most_rate_um_s = 1e3;
    if (at_m < 0.5) add("lost", std::make_shared<ConstantPredictor>(0.0), 0.01);
    matrices.push_back(std::move(m));
  }
  return matrices;
}

}  // namespace driftwright::fixtures
