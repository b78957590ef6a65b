// Of a single record that stays unexplained: the causes with the scenario's numbers as they are written, where they hold
// on its end.

#include <gtest/gtest.h>

#include "diagnosis/extended_scenario.hpp"
#include "tests/shared/lumped_records.hpp"

namespace driftwright::diagnosis::causes_alone_test {
namespace {

constexpr const char* kBox = R"(name: box
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: heater, capacity: 2400 J/K}
  - {type: node, node: wall, capacity: 9000 J/K}
  - {type: heat_source, node: heater, power: 40 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: heater, to: wall, conductance: 3 W/K}
  - {type: link, node: wall, to: ambient, conductance: 1.5 W/K}
ambient: [[0 h, 21 degC]]
sensors:
  - {name: heater, node: heater}
  - {name: wall, node: wall}
displacements:
  - name: lift
    sensitivities:
      - {node: wall, sensitivity: 2 um/K}
cyclograms:
  day: [[60 min, 1000 rpm], [40 min, 0 rpm], [90 min, 1000 rpm], [50 min, 500 rpm], [70 min, 1000 rpm], [50 min, 0 rpm], [60 min, 1000 rpm]]
solver: {output_interval: 60 s}
)";
// Heat that is missing whatever the speed, and heat that comes and goes without any visible cause.
constexpr const char* kTruth =
    "{type: heat_source, node: heater, power: 20 W, exponent: 0}\n"
    "  - {type: heat_window, node: wall, power: 14 W, windows: [[10 min, 47 min]]}\n"
    "  - {type: heat_window, node: wall, power: -12 W, windows: [[81 min, 102 min]]}\n"
    "  - {type: heat_window, node: wall, power: 18 W, windows: [[131 min, 158 min]]}\n"
    "  - {type: heat_window, node: wall, power: -16 W, windows: [[195 min, 231 min]]}\n"
    "  - {type: heat_window, node: wall, power: 10 W, windows: [[262 min, 301 min]]}\n"
    "  - {type: heat_window, node: wall, power: -14 W, windows: [[322 min, 352 min]]}\n"
    "  - {type: heat_window, node: wall, power: 16 W, windows: [[377 min, 399 min]]}";

TEST(CausesAlone, AreWrittenWhereTheyHoldAndNothingElseIs) {
  const Found found(kBox, with_effect(kBox, kTruth), "box_", {.noise_K = 0.02, .noise_um = 0.05}, 2);
  const Beside& beside = found.beside;
  const Diagnosis& d = found.d;
  ASSERT_EQ(d.verdict, Verdict::kUnexplained) << d.reason;
  ASSERT_TRUE(d.written.causes_alone) << d.reason;
  ASSERT_EQ(d.written.hypothesis.size(), d.written.causes.size());
  const Cause& first = d.causes.at(d.written.causes.front());
  EXPECT_EQ(first.effect, "heat_source");
  EXPECT_EQ(first.where, "heater");
  EXPECT_NEAR(first.parameters.front().value, 20.0, 3.0);
  // what is printed of a written cause is what is written, and nothing else is said to be
  const Claim& claim = d.written.hypothesis.front();
  const Eigen::VectorXd x = d.written.fit.x.head(static_cast<Eigen::Index>(claim.knobs.size()));
  for (std::size_t k = 0; k < claim.knobs.size(); ++k)
    EXPECT_NEAR(first.parameters[k].value, claim.knobs[k].value(x[static_cast<Eigen::Index>(k)]), 1e-9);
  for (const Estimate& e : d.calibrated) EXPECT_FALSE(e.is_written) << e.name;
  for (const Cause& c : d.causes) EXPECT_EQ(c.is_written, c.why_not_written.empty()) << c.effect;
  for (const Cause& c : d.causes)
    EXPECT_EQ(c.is_written, &c == &first) << c.effect << ": what comes and goes does not hold on the end";
  const ExtendedScenario extended =
      extended_scenario(beside.scenario, *beside.twin, beside.runs, {{"it", "because", change_of(claim, x)}}, {});
  const TwinState read = scenarios::read_scenario(write_file("extended.yaml", extended.text)).machine->effects;
  Twin::Workspace workspace(*beside.twin);
  const Eigen::MatrixXd readings = beside.twin->readings(read, beside.runs[0], workspace);
  if (d.written.hypothesis.size() == 1) {
    EXPECT_LT((readings - d.extended[0]).topRows(2).cwiseAbs().maxCoeff(), 1e-3) << "kelvin";
  }
  for (const ChannelGain& g : d.gain) EXPECT_LT(g.rmse_after, 1.05 * g.rmse_before) << g.name;
  EXPECT_LT(d.gain.front().rmse_after, 0.5 * d.gain.front().rmse_before) << "the heater's thermometer";
}

}  // namespace
}  // namespace driftwright::diagnosis::causes_alone_test
