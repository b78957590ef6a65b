// Test programmes and the expected information of their records, compared with closed forms, the fitter and the machine
// itself.

#include "studies/test_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/discrimination.hpp"
#include "diagnosis/level_machine.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"
#include "tests/studies/kept_in_memory.hpp"

namespace driftwright::studies::test_plan_test {
namespace {

using diagnosis::Question;

// 20 K and 4000 s at 1000 rpm.
constexpr const char* kOneBody = R"(name: one_body
reference_temperature: 20 degC
ambient: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: body, capacity: 20 kJ/K}
  - {type: heat_source, node: body, power: 100 W, at_speed: 1000 rpm, exponent: 1}
  - {type: link, node: body, to: ambient, conductance: 5 W/K}
sensors: [{name: t_body, node: body}]
cyclograms:
  job: [[120 min, 1000 rpm]]
)";

constexpr const char* kTwoBodies = R"(name: two_bodies
reference_temperature: 20 degC
ambient: [[0 h, 20 degC], [8 h, 22 degC]]
machine: {generator: lumped}
effects:
  - {type: node, node: spindle, capacity: 5.6 kJ/K}
  - {type: node, node: housing, capacity: 19 kJ/K}
  - {type: heat_source, node: spindle, power: 150 W, at_speed: 6000 rpm, exponent: 1.5}
  - {type: servo_loss, node: housing, axis: x, power: 60 W, at_feed: 6 m/min, exponent: 1}
  - {type: link, node: spindle, to: housing, conductance: 12 W/K}
  - {type: link, node: housing, to: ambient, conductance: 5 W/K}
sensors: [{name: t_housing, node: housing}]
displacements: [{name: nose_z, sensitivities: [{node: spindle, sensitivity: 2.5 um/K}]}]
cyclograms:
  job: {columns: [duration, speed, feed_x], rows: [[2 h, 6000 rpm, 6 m/min]]}
)";

scenarios::Scenario scenario_of(const std::string& text) {
  return scenarios::read_scenario(write_file("test_plan.yaml", text));
}

/// A twin with what may be asked about it before its usual test.
struct Planned {
  scenarios::Scenario scenario;
  TestLevels levels;
  PlannedTwin p;
  diagnosis::MeasuredRun usual;
  diagnosis::Doubts doubts;

  explicit Planned(const std::string& text, double duration_s = 8.0 * 3600.0)
      : scenario(scenario_of(text)),
        levels(test_levels(scenario, 0.0)),
        p(open_planned_twin(scenario, "plan-test", {cyclogram_of(usual_test(levels), levels, duration_s, "planned")}, 60.0,
                            {}, {})),
        usual(diagnosis::planned_run(cyclogram_of(usual_test(levels), levels, duration_s, "planned"), 60.0, p.ambient, true,
                                     p.channels)),
        doubts(diagnosis::doubts_before(*p.twin, usual)) {}
};

// One number of 10 % and two faults in three readings: J = (1, 0, 0), a = (1, 2, 0), b = (0, 1, 1).
TEST(Prospect, OfTwoFaultsInThreeReadingsIsTheClosedForm) {
  Question q{.number_sd = Eigen::VectorXd::Constant(1, 0.1),
             .laws = {{.effect = "a", .size_sd = 3.0, .price_nats = 0.5, .weight = 0.5},
                      {.effect = "b", .size_sd = 4.0, .price_nats = 1.0, .weight = 0.5}},
             .bar_nats = 4.0,
             .lead_nats = 3.0};
  Eigen::MatrixXd columns(3, 3);
  columns << 1, 1, 0, 0, 2, 1, 0, 0, 1;
  const diagnosis::Prospect p = prospect(q, columns.transpose() * columns);
  const double taken = 1.0 / (1.0 + 100.0);  // of a's first reading by the number: J'a / (J'J + 1 / 0.1²)
  const double a = 9.0 * (5.0 - taken), b = 16.0 * 2.0, ab = 12.0 * 2.0;
  EXPECT_NEAR(p.d(0, 1), std::sqrt(a - ab * ab / (1.0 + b)), 1e-12);
  EXPECT_NEAR(p.d(1, 0), std::sqrt(b - ab * ab / (1.0 + a)), 1e-12);
  EXPECT_NEAR(p.nats[0], 0.5 * a * a / (1.0 + a) - 0.5 * std::log(1.0 + a), 1e-12);
  EXPECT_NEAR(p.number_sigma[0], std::sqrt(1.0 / (1.0 + 100.0)) / 0.1, 1e-12);
  const double seen = 2.0 * (4.0 + 0.5 + 0.5 * std::log(1.0 + a)) / (a * a / (1.0 + a));
  const double told =
      2.0 * (3.0 + 0.5 - 1.0 + 0.5 * std::log((1.0 + a) / (1.0 + b))) / (a * a / (1.0 + a) - ab * ab / (1.0 + b));
  const auto share = [](double square) { return std::log(2.0 / std::sqrt(square)) / std::log(200.0); };
  EXPECT_NEAR(p.seen[0], share(seen), 1e-12);
  EXPECT_NEAR(p.named[0], share(std::max(seen, told)), 1e-12);
  EXPECT_NEAR(p.share_named, share_named(q, columns.transpose() * columns), 1e-15);
  q.laws[1].effect = "a";  // of one kind: its place need not be distinguished
  EXPECT_NEAR(prospect(q, columns.transpose() * columns).named[0], share(seen), 1e-12);
}

// The same distance as the experiment of `diagnose` takes, of outlooks with nothing known of number and of b's size.
TEST(Prospect, HasTheDistanceOfTheDiscriminatingExperiment) {
  const Question q{.number_sd = Eigen::VectorXd::Constant(1, 0.5),
                   .laws = {{.effect = "a", .size_sd = 3.0}, {.effect = "b", .size_sd = 4.0}}};
  Eigen::MatrixXd columns(4, 3);
  columns << 1, 1, 0, 2, 2, 1, -1, 0, 1, 0.5, 1, 3;
  diagnosis::Outlook a{3.0 * columns.col(1), Eigen::MatrixXd(4, 2)};
  a.root << 0.5 * columns.col(0), 4.0 * columns.col(2);
  diagnosis::Outlook b = a;
  b.mean.setZero();
  EXPECT_NEAR(prospect(q, columns.transpose() * columns).d(0, 1), discrimination(a, b), 1e-10);
}

// Heat and loss to the ambient of one body: T = P/G (1 - e^-t/tau), so dT/dlog P = T and dT/dlog G = -P/G (1 - e^-t/tau
// (1 + t/tau)), in readings every minute of 0.05 K. The information of both is their sum over the rows.
TEST(Foresight, OfOneBodyUnderAStepIsTheFisherInformation) {
  Planned planned(kOneBody);
  planned.p.noise.at("t_body") = {0.05, 0.0, 0.0};
  const diagnosis::MeasuredRun step = diagnosis::planned_run({"planned", {{8.0 * 3600.0, Drive{.speed_rpm = 1000.0}}}}, 60.0,
                                                             planned.p.ambient, true, planned.p.channels);
  const Eigen::MatrixXd information =
      diagnosis::information_by_channel(*planned.p.twin, planned.doubts, step, planned.p.noise).front();
  double pp = 0.0, gg = 0.0, pg = 0.0;
  for (double t_s : step.time_s) {
    const double x = t_s / 4000.0, by_power = 20.0 * (1.0 - std::exp(-x)),
                 by_conductance = -20.0 * (1.0 - std::exp(-x) * (1.0 + x));
    pp += by_power * by_power / (0.05 * 0.05);
    gg += by_conductance * by_conductance / (0.05 * 0.05);
    pg += by_power * by_conductance / (0.05 * 0.05);
  }
  const auto index_of = [&](const std::string& name) {
    const auto& n = planned.doubts.numbers;
    return std::find_if(n.begin(), n.end(), [&](const auto& k) { return k.name == name; }) - n.begin();
  };
  const auto p = index_of("power"), g = index_of("conductance");
  // Differences over half of 10 %, taken on one side, in pairs of rows summed: 6 % of the slope by G at the most, of the
  // sum less.
  EXPECT_NEAR(information(p, p) / pp, 1.0, 0.06);
  EXPECT_NEAR(information(g, g) / gg, 1.0, 0.06);
  EXPECT_NEAR(information(p, g) / pg, 1.0, 0.06);
  // Another power and another conductance to the ambient, each off by 0.7 of its logarithm, are distinguished equally by
  // the formula by hand and by the program's.
  Question q = planned.doubts.question;
  q.number_sd = Eigen::VectorXd(0);
  q.laws = {{.effect = "heat_source", .size_sd = 0.7}, {.effect = "link", .size_sd = 0.7}};
  Eigen::Matrix2d both;
  both << information(p, p), information(p, g), information(p, g), information(g, g);
  const double a = 0.49 * pp, b = 0.49 * gg, ab = 0.49 * pg;
  EXPECT_NEAR(prospect(q, both).d(0, 1) / std::sqrt(a - ab * ab / (1.0 + b)), 1.0, 0.06);
}

// C T' = P - G (T - h), h rising evenly over the step: T is the sum of e^-x T0, (P/G + h0) (1 - e^-x) and rise (1 - (1 -
// e^-x) / x).
TEST(LinearStep, OfOneBodyInAnAmbientThatRisesIsTheClosedForm) {
  const diagnosis::LinearSystem body{Eigen::MatrixXd::Constant(1, 1, 5.0), Eigen::VectorXd::Constant(1, 100.0),
                                     Eigen::VectorXd::Constant(1, 5.0)};
  const diagnosis::LinearStep step = linear_step(body, Eigen::MatrixXd::Constant(1, 1, 20e3), 3000.0);
  const double x = 3000.0 * 5.0 / 20e3, gone = 1.0 - std::exp(-x);
  EXPECT_NEAR(step.phi(0, 0), std::exp(-x), 1e-12);
  EXPECT_NEAR(step.constant[0], 20.0 * gone, 1e-10);
  EXPECT_NEAR(step.of_ambient[0], gone, 1e-12);
  EXPECT_NEAR(step.of_rise[0], 1.0 - gone / x, 1e-12);
}

// A power that falls with the body's temperature, P (1 - b T) with b = 0.02 / K, is linear: its loss is G + P b. At 1000
// rpm on 5 W/K it reaches 100 / (5 + 2) K.
TEST(LinearStep, TakesALawOfTemperatureToFirstOrder) {
  solver::ReducedSystem system;
  system.reference_K = 293.15;
  system.mass = Eigen::MatrixXd::Constant(1, 1, 20e3);
  system.conduction = Eigen::MatrixXd::Constant(1, 1, 5.0);
  solver::Probe probe;
  probe.weights = Eigen::VectorXd::Ones(1);
  system.probes.push_back(probe);
  solver::BoundLaw law(
      effects::Law([](const effects::Inputs& u) { return 100.0 * (1.0 - 0.02 * (u.probe_K.front() - 293.15)); },
                   {effects::node("body")}));
  law.probes = {0};
  solver::HeatSource friction;
  friction.load = Eigen::VectorXd::Ones(1);
  friction.power_W = law;
  system.sources.push_back(friction);
  const diagnosis::LinearSystem linear = diagnosis::linear_system(system, {}, Eigen::VectorXd::Zero(1));
  EXPECT_NEAR(linear.stiffness(0, 0), 7.0, 1e-9);
  EXPECT_NEAR(linear.constant[0], 100.0, 1e-8);
}

// What the search runs on says of a programme what the fitter says: slots of a quarter of an hour, axes and an ambient
// that warms.
TEST(LevelMachine, HasTheInformationOfTheFittersOwnSlopes) {
  Planned planned(kTwoBodies);
  const double row_s = 300.0;
  std::mt19937_64 random(3);
  const TestProgramme programme = random_test(planned.levels, random);
  const diagnosis::MeasuredRun run = diagnosis::planned_run(cyclogram_of(programme, planned.levels, 8.0 * 3600.0, "planned"),
                                                            row_s, planned.p.ambient, true, planned.p.channels);
  planned.doubts = diagnosis::thinned(*planned.p.twin, planned.doubts, planned.usual, 100);
  const diagnosis::LevelMachine machine(*planned.p.twin, planned.doubts, planned.levels.drives, planned.usual, row_s, row_s,
                                        planned.p.noise);
  std::vector<int> steps;
  for (int level : programme) steps.insert(steps.end(), 3, level);
  const Eigen::MatrixXd fast = machine.information(steps);
  const auto by_channel = diagnosis::information_by_channel(*planned.p.twin, planned.doubts, run, planned.p.noise);
  ASSERT_EQ(by_channel.size(), 2u);
  const Eigen::MatrixXd slow = by_channel[0] + by_channel[1];
  int n_compared = 0;
  for (Eigen::Index i = 0; i < slow.rows(); ++i) {
    const auto law = i - planned.doubts.question.number_sd.size();
    const std::string effect = law < 0 ? "" : planned.doubts.question.laws[static_cast<std::size_t>(law)].effect;
    if (slow(i, i) < 1e-6 && fast(i, i) < 1e-6) continue;
    // A clock shifts the programme itself, and lags are read on a finer grid there.
    const std::string words = law < 0 ? "" : planned.doubts.question.laws[static_cast<std::size_t>(law)].law;
    if (effect == "clock_offset" || effect.find("lag") != std::string::npos || words.find("lag") != std::string::npos)
      continue;
    // A power of a temperature difference is a line about the state halfway to balance there: a third of its information
    // is left.
    if (effect == "natural_convection") continue;
    if (words.find("after each stop") != std::string::npos) continue;      // minutes that no level has
    if (words.find("a conductance that falls as") != std::string::npos) {  // a line about that state, too: half is left
      EXPECT_GT(fast(i, i) / slow(i, i), 0.5) << words;
      EXPECT_LT(fast(i, i) / slow(i, i), 1.0) << words;
      continue;
    }
    // The fitter's numbers are slopes of first order, these are differences over half of what is known.
    const double runs_on = words.find("some minutes more") != std::string::npos ? 0.15 : 0.0;  // minutes that no level has
    EXPECT_NEAR(fast(i, i) / slow(i, i), 1.0, 0.1 + runs_on)
        << (law < 0 ? planned.doubts.numbers[static_cast<std::size_t>(i)].name
                    : effect + ", " + planned.doubts.question.laws[static_cast<std::size_t>(law)].where + ", " +
                          planned.doubts.question.laws[static_cast<std::size_t>(law)].law);
    ++n_compared;
  }
  EXPECT_GT(n_compared, 40);
  EXPECT_NEAR(share_named(planned.doubts.question, fast), share_named(planned.doubts.question, slow), 0.02);
}

TEST(TestProgramme, OfAnyKindLastsAsLongAndStaysWithinTheLevels) {
  const TestLevels levels = test_levels(scenario_of(kTwoBodies), 0.0);
  EXPECT_EQ(levels.drives.front(), Drive{});
  EXPECT_EQ(levels.drives[static_cast<std::size_t>(levels.full)].speed_rpm, 6000.0);
  EXPECT_NEAR(levels.drives[static_cast<std::size_t>(levels.full)].feed_m_s[0], 0.1, 1e-12);
  std::mt19937_64 random(7);
  TestProgramme programme = usual_test(levels);
  for (int i = 0; i < 2000; ++i) {
    programme = i % 50 == 0 ? random_test(levels, random) : changed_test(std::move(programme), levels, random);
    const Cyclogram c = cyclogram_of(programme, levels, 3600.0, "test");
    ASSERT_NEAR(c.duration_s(), 3600.0, 1e-6);
    for (std::size_t s = 0; s < c.sections.size(); ++s) {
      ASSERT_GT(c.sections[s].duration_s, 0.0);
      ASSERT_LE(c.sections[s].drive.speed_rpm, 6000.0);
      ASSERT_LE(c.sections[s].drive.feed_m_s[0], 0.1 + 1e-12);
      if (s > 0) {
        ASSERT_FALSE(c.sections[s].drive == c.sections[s - 1].drive);
      }
    }
  }
  EXPECT_EQ(test_levels(scenario_of(kOneBody), 800.0).drives.back().speed_rpm, 800.0);
  EXPECT_EQ(test_levels(scenario_of(kOneBody), 0.0).drives.size(), 5u);
}

TEST(TestPlan, IsTheSameEachTimeAndNoWorseThanTheUsualAndTheSteppedTest) {
  const TestPlanOptions options{.duration_s = 4.0 * 3600.0, .n_programmes = 400};
  const TestPlan plan = *plan_test(scenario_of(kTwoBodies), options, {});
  const TestPlan again = *plan_test(scenario_of(kTwoBodies), options, {});
  EXPECT_EQ(plan.planned.cyclogram.sections, again.planned.cyclogram.sections);
  EXPECT_EQ(plan.planned.prospect.share_named, again.planned.prospect.share_named);
  EXPECT_GT(plan.planned.prospect.share_named, plan.usual.prospect.share_named + 0.02);
  EXPECT_GE(plan.planned.prospect.share_named, plan.stepped.prospect.share_named);
  EXPECT_NEAR(plan.planned.cyclogram.duration_s(), options.duration_s, 1e-6);
  EXPECT_GT(plan.n_tried, 300);
  // More readings never give less information: each instrument has a value, and so has a further thermometer.
  ASSERT_EQ(plan.without.size(), 2u);
  for (const ChannelWorth& c : plan.without) EXPECT_LE(c.share_named, plan.planned.prospect.share_named) << c.name;
  ASSERT_EQ(plan.with.size(), 1u);  // the housing has one
  EXPECT_EQ(plan.with.front().name, "spindle");
  EXPECT_GE(plan.with.front().share_named, plan.planned.prospect.share_named);
}

TEST(TestPlan, OfShardsIsThatOfOneRun) {
  const TestPlanOptions options{.duration_s = 4.0 * 3600.0, .n_programmes = 300};
  const TestPlan whole = *plan_test(scenario_of(kTwoBodies), options, {});
  KeptInMemory kept;
  for (const char* shard : {"2/2", "1/2"})
    EXPECT_FALSE(plan_test(scenario_of(kTwoBodies), options, {}, kept.of(shard))) << shard;
  const int n_worked = kept.n_worked;
  const TestPlan merged = *plan_test(scenario_of(kTwoBodies), options, {}, kept.of(""));
  EXPECT_EQ(kept.n_worked, n_worked);
  EXPECT_EQ(merged.planned.cyclogram.sections, whole.planned.cyclogram.sections);
  EXPECT_EQ(merged.n_tried, whole.n_tried);
  for (const auto& [a, b] : {std::pair(&merged.usual, &whole.usual), std::pair(&merged.stepped, &whole.stepped),
                             std::pair(&merged.planned, &whole.planned)}) {
    EXPECT_EQ(a->prospect.share_named, b->prospect.share_named);
    EXPECT_EQ(a->prospect.d, b->prospect.d);
    EXPECT_EQ(a->prospect.taken, b->prospect.taken);
    EXPECT_EQ(a->prospect.named, b->prospect.named);
    EXPECT_EQ(a->prospect.number_sigma, b->prospect.number_sigma);
  }
  ASSERT_EQ(merged.without.size(), whole.without.size());
  for (std::size_t c = 0; c < whole.without.size(); ++c)
    EXPECT_EQ(merged.without[c].share_named, whole.without[c].share_named);
}

TEST(TestPlan, IsRefusedWhereNothingDrivesOrNothingIsRead) {
  std::string text = kOneBody;
  text.replace(text.find("1000 rpm]]"), 10, "0 rpm]]");
  EXPECT_REFUSED(plan_test(scenario_of(text), {}, {}), "no cyclogram of the scenario drives anything");
  text = kOneBody;
  text.replace(text.find("node: body}]\n"), 13, "node: ambient}]\n");
  EXPECT_REFUSED(plan_test(scenario_of(text), {}, {}), "needs a thermometer or a displacement");
}

}  // namespace
}  // namespace driftwright::studies::test_plan_test
