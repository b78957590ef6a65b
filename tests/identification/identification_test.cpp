// A network from records alone: lags against closed forms, non-negative least squares against their conditions, a machine
// that is known found again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "base/random.hpp"
#include "identification/identify.hpp"
#include "identification/jury.hpp"
#include "identification/network_scenario.hpp"
#include "identification/non_negative.hpp"
#include "tests/shared/refused.hpp"

namespace driftwright::identification::identification_test {
namespace {

using ::testing::AllOf, ::testing::Contains, ::testing::ElementsAre, ::testing::HasSubstr, ::testing::IsEmpty;
using ::testing::Not;

TEST(Lags, OfAStepAreExponentials) {
  const std::vector<double> time_s = {0.0, 30.0, 100.0, 400.0};
  const Eigen::VectorXd x = lagged_steps(time_s, Eigen::VectorXd::Ones(4), 120.0);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(x[static_cast<Eigen::Index>(i)], -std::expm1(-time_s[i] / 120.0), 1e-12);
}

TEST(Lags, OfARampRunBehindByTheirTime) {
  std::vector<double> time_s;
  for (int i = 0; i <= 100; ++i) time_s.push_back(60.0 * i);
  Eigen::VectorXd u(101);
  for (int i = 0; i <= 100; ++i) u[i] = 0.01 * time_s[static_cast<std::size_t>(i)];
  const Eigen::VectorXd x = lagged_ramps(time_s, u, 300.0);
  EXPECT_NEAR(u[100] - x[100], 0.01 * 300.0, 1e-6);
  EXPECT_NEAR(x[5], 0.01 * (300.0 - 300.0 * -std::expm1(-1.0)), 1e-12);
}

// Karush, Kuhn and Tucker: what is above 0 has no slope, what is 0 would only get worse.
TEST(NonNegativeLeastSquares, AreWhereNoNumberGains) {
  Random random(4, 0);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd a(30, 8);
    Eigen::VectorXd b(30);
    for (Eigen::Index i = 0; i < a.size(); ++i) a.data()[i] = random.normal();
    for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = random.normal();
    const Eigen::MatrixXd g = a.transpose() * a;
    const Eigen::VectorXd c = a.transpose() * b, x = non_negative_least_squares(g, c), slope = g * x - c;
    int n_zero = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      EXPECT_GE(x[i], 0.0);
      if (x[i] > 0.0) {
        EXPECT_NEAR(slope[i], 0.0, 1e-9);
      } else {
        EXPECT_GE(slope[i], -1e-9);
        ++n_zero;
      }
    }
    EXPECT_GT(n_zero, 0) << "nothing was tried";
  }
}

/// A machine of two bodies, each on the ambient alone: one heated while the spindle turns, 40 min, one by the speed to
/// the 5/3, 120 min. Rows of a minute.
Record measured(const std::string& name, const std::vector<std::pair<double, double>>& minutes_rpm, std::uint64_t seed,
                double noise) {
  Record r{
      .source = name,
      .time_s = {},
      .channels = {
          {"speed", "rpm", {}}, {"hall", "degC", {}}, {"t_box", "degC", {}}, {"t_head", "degC", {}}, {"nose", "um", {}}}};
  for (const auto& [minutes, rpm] : minutes_rpm) {
    for (int i = 0; i < static_cast<int>(minutes); ++i) {
      r.time_s.push_back(60.0 * static_cast<double>(r.time_s.size()));
      r.channels[0].values.push_back(rpm);
    }
  }
  const auto n = static_cast<Eigen::Index>(r.time_s.size());
  Eigen::VectorXd turns(n), power(n), hall(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double rpm = r.channels[0].values[static_cast<std::size_t>(i)];
    turns[i] = rpm > 0.0 ? 1.0 : 0.0;
    power[i] = std::pow(rpm / 3000.0, 5.0 / 3.0);
    hall[i] = 1.5 * std::sin(static_cast<double>(i) / 60.0 + static_cast<double>(seed));
  }
  const Eigen::VectorXd box = lagged_ramps(r.time_s, hall, 2400.0) + 6.0 * lagged_steps(r.time_s, turns, 2400.0);
  const Eigen::VectorXd head = lagged_ramps(r.time_s, hall, 7200.0) + 12.0 * lagged_steps(r.time_s, power, 7200.0);
  Random random(seed, 0);
  for (Eigen::Index i = 0; i < n; ++i) {
    r.channels[1].values.push_back(20.0 + hall[i]);
    r.channels[2].values.push_back(20.0 + box[i] + noise * random.normal());
    r.channels[3].values.push_back(20.0 + head[i] + noise * random.normal());
    r.channels[4].values.push_back(3.0 * (head[i] - head[0]) - 2.0 * (box[i] - box[0]) + 5.0 * noise * random.normal());
  }
  return r;
}

std::vector<Record> three_days() {
  return {measured("one.csv", {{60, 0}, {120, 1000}, {60, 0}, {120, 3000}, {90, 0}, {120, 2000}}, 1, 0.03),
          measured("two.csv", {{30, 2000}, {90, 0}, {120, 1500}, {120, 2500}, {60, 0}, {60, 3000}}, 2, 0.03),
          measured("three.csv", {{100, 2500}, {100, 500}, {100, 0}, {100, 1750}, {100, 0}}, 3, 0.03)};
}

class IdentifiedMachine : public ::testing::Test {
 protected:
  static const Identified& network() {
    static const std::vector<Record> records = three_days();
    static const Identified identified = identify(records, {.ambient = "hall", .drives = {}});
    return identified;
  }
  static const IdentifiedChannel& channel(const std::string& name) {
    for (const IdentifiedChannel& c : network().channels) {
      if (c.name == name) return c;
    }
    throw std::out_of_range(name);
  }
};

TEST_F(IdentifiedMachine, LeavesAboutTheNoise) {
  EXPECT_THAT(network().roles.thermometers, ElementsAre("t_box", "t_head"));
  for (const char* name : {"t_box", "t_head"}) {
    EXPECT_LT(channel(name).missed_own, 0.08) << name;
    EXPECT_LT(channel(name).missed_kept_out, 0.25) << name;
    EXPECT_GT(channel(name).swing, 1.0) << name;
  }
  EXPECT_LT(channel("nose").missed_own, 0.4);
}

TEST_F(IdentifiedMachine, ReadsThermometersAsMeansOfBodies) {
  for (const char* name : {"t_box", "t_head"}) {
    const ChannelFit& fit = channel(name).fit;
    EXPECT_GE(fit.weight.minCoeff(), 0.0);
    EXPECT_LE(fit.weight.sum() + fit.of_ambient, 1.0 + 1e-3);
  }
}

TEST_F(IdentifiedMachine, SaysWhatDrivesEachChannel) {
  double sum = 0.0;
  for (const Driver& d : channel("t_box").ledger) sum += d.share;
  EXPECT_NEAR(sum, 1.0, 1e-9);
  const Driver& of_box = channel("t_box").ledger.front();
  EXPECT_EQ(of_box.name, "while speed is not 0");
  EXPECT_NEAR(of_box.in_the_end, 6.0, 0.9);
  EXPECT_NEAR(of_box.delay_s, 2400.0, 500.0);
  const Driver& of_head = channel("t_head").ledger.front();
  EXPECT_THAT(of_head.name, HasSubstr("speed^"));
  EXPECT_NEAR(of_head.in_the_end, 12.0, 1.8);
}

// A day at speeds that none of the records has, beyond the fastest by a fifth.
TEST_F(IdentifiedMachine, PredictsADayItHasNotSeen) {
  const std::vector<Record> other = {measured("other.csv", {{60, 0}, {150, 3600}, {60, 0}, {100, 1200}}, 9, 0.0)};
  double rise_K = 0.0;
  for (const IdentifiedBody& b : network().bodies) rise_K = std::max(rise_K, b.body.rise_K);
  const FosterProblem problem(other, network().roles, network().structure, rise_K, {1});
  for (std::size_t c = 0; c < network().channels.size(); ++c) {
    const Eigen::VectorXd predicted = problem.predicted(c, network().channels[c].fit, false);
    Eigen::VectorXd e = problem.measured(c) - predicted;
    e.array() -= e[0];
    const double swing = problem.measured(c).maxCoeff() - problem.measured(c).minCoeff();
    EXPECT_LT(std::sqrt(e.squaredNorm() / static_cast<double>(e.size())), 0.08 * swing) << network().channels[c].name;
  }
}

TEST_F(IdentifiedMachine, IsWrittenAsAScenario) {
  const std::string text = network_scenario(network(), "three_days", {"one.csv", "two.csv"}, {"what it is"});
  EXPECT_THAT(text, AllOf(HasSubstr("# what it is\n"), HasSubstr("name: three_days"), HasSubstr("runs: while_spindle_turns"),
                          HasSubstr("exponent: 1.6667"), HasSubstr("ambient: {csv: one.csv, channel: hall}"),
                          HasSubstr("- {name: t_box, node: at_t_box}"), HasSubstr("- name: nose\n")));
}

TEST(Identify, TakesADriveThatCools) {
  std::vector<Record> records = three_days();
  for (Record& r : records) {
    r.channels[0] = {"coolant", "percent", r.channels[0].values};
    for (double& v : r.channels[0].values) v /= 30.0;
    for (double& t : r.channels[3].values) t = 40.0 - t;  // falls where it rose
  }
  for (Record& r : records) r.channels.erase(r.channels.begin() + 2);
  const Identified found = identify(records, {.ambient = "hall", .drives = {}});
  EXPECT_EQ(found.structure.laws.front().sign, -1.0);
  EXPECT_LT(found.channels.front().ledger.front().in_the_end, -5.0);
  EXPECT_LT(found.channels.front().missed_own, 0.35 * found.channels.front().swing);
}

TEST(Identify, WorksWithoutAnAmbientAndWithoutThermometers) {
  std::vector<Record> records = three_days();
  for (Record& r : records) {
    for (double& d : r.channels[4].values) d += 7.0;  // an indicator that was not set to zero
    r.channels = {r.channels[0], r.channels[4]};
  }
  const Identified found = identify(records, {});
  EXPECT_THAT(found.roles.thermometers, IsEmpty());
  EXPECT_LT(found.channels.front().missed_own, 0.5 * found.channels.front().swing);
  EXPECT_THAT(network_scenario(found, "bare", {"one.csv"}, {}),
              AllOf(HasSubstr("ambient: 20 degC"), Not(HasSubstr("sensors:"))));
}

// Rows of a long record are taken together, those of a short one beside it are not; lags are of all rows.
TEST(Identify, TakesRowsTogetherOfLongRecordsAlone) {
  std::vector<std::pair<double, double>> day;
  for (int i = 0; i < 40; ++i) day.insert(day.end(), {{90, 1000.0 + 250.0 * (i % 7)}, {60, 0}});
  const std::vector<Record> records = {measured("long.csv", day, 1, 0.03),
                                       measured("short.csv", {{20, 0}, {15, 3000}}, 2, 0.03)};
  const Identified found = identify(records, {.ambient = "hall", .drives = {}});
  EXPECT_THAT(found.blocks, ElementsAre(3, 1));
  EXPECT_EQ(found.channels.front().predicted.size(), 6000 / 3 + 35);
  EXPECT_LT(found.channels.front().missed_own, 0.15);
}

// Days that begin 8 K apart: each counts from its own first ambient.
TEST(Identify, CountsEachDayFromItsOwnAmbient) {
  std::vector<Record> records = three_days();
  for (Record& r : std::span(records).subspan(1, 1)) {
    for (std::size_t c : {1, 2, 3}) {
      for (double& t : r.channels[c].values) t += 8.0;
    }
  }
  const Identified found = identify(records, {.ambient = "hall", .drives = {}});
  for (std::size_t c : {0, 1}) EXPECT_LT(found.channels[c].missed_simulated, 0.15) << found.channels[c].name;
}

TEST(RecordRoles, SayWhatTakesNoPart) {
  std::vector<Record> records = three_days();
  records[0].channels.push_back({"speed2", "rpm", records[0].channels[0].values});
  records[0].channels.push_back({"empty", "degC", std::vector<double>(records[0].n_samples(), std::nan(""))});
  records = {records[0]};
  records[0].time_s.back() += 86400.0;
  EXPECT_THAT(record_roles(records, {}).guesses,
              AllOf(Contains(HasSubstr("'speed2_rpm' is a second speed")), Contains(HasSubstr("'empty' takes no part")),
                    Contains(HasSubstr("has a hole of 1441 min"))));
  records[0].channels[2].name = "t [box]";
  EXPECT_REFUSED(record_roles(records, {}), "rename the column");
  records[0].channels[2].name = "ambient";
  EXPECT_REFUSED(record_roles(records, {.ambient = "hall", .drives = {}}), "none of the ambient");
  EXPECT_REFUSED(record_roles(records, {.ambient = "hall", .drives = {"hall"}}), "both --drive and --ambient");
}

TEST(RecordRoles, GuessTheAmbientAndSayIt) {
  const std::vector<Record> records = three_days();
  std::vector<Record> nameless = records;
  for (Record& r : nameless) r.channels[1].name = "t9";
  const RecordRoles roles = record_roles(nameless, {});
  EXPECT_EQ(roles.ambient, "t9");
  EXPECT_THAT(roles.guesses, Contains(AllOf(HasSubstr("'t9' is the ambient, a guess"), HasSubstr("--ambient"))));
  EXPECT_THAT(record_roles(records, {}).guesses, Contains(HasSubstr("by its name")));
}

TEST(RecordRoles, RefuseWhatTellsNothing) {
  std::vector<Record> records = three_days();
  EXPECT_REFUSED(record_roles(records, {.ambient = "t_wall", .drives = {}}), "t_wall");
  EXPECT_REFUSED(record_roles(records, {.ambient = "nose", .drives = {}}), "in degC is required");
  for (Record& r : records) std::fill(r.channels[0].values.begin(), r.channels[0].values.end(), 0.0);
  EXPECT_REFUSED(record_roles(records, {}), "switched at least twice");
  std::vector<Record> few = {measured("short.csv", {{10, 0}, {10, 1000}}, 1, 0.0)};
  EXPECT_REFUSED(record_roles(few, {}), "20 rows");
}

TEST(RecordRoles, TakeTheSpindleThatNeverStopsAsSwitchedOn) {
  const std::vector<Record> records = {measured("always.csv", {{200, 1500}}, 1, 0.0)};
  const RecordRoles roles = record_roles(records, {});
  EXPECT_EQ(roles.speed, "speed");
  EXPECT_THAT(roles.guesses, Contains(HasSubstr("switched on in the first row")));
}

TEST(RunRecord, HasASpeedAndNothingMissingOfWhatDrives) {
  Record record = measured("day.csv", {{20, 0}, {20, 1000}}, 1, 0.0);
  record.channels[0].name = "spindle";
  record.channels[0].values[25] = std::nan("");
  record.channels[1].values[0] = std::nan("");
  record.channels[2].values[3] = std::nan("");
  for (double& t : record.time_s) t += 1e9;
  RecordRoles roles;
  roles.speed = "spindle";
  roles.ambient = "hall";
  roles.thermometers = {"t_box"};
  const Record run = run_record(record, roles);
  EXPECT_EQ(run.time_s.front(), 0.0);
  EXPECT_EQ(run.at("speed").values[25], 1000.0);
  EXPECT_EQ(run.at("hall").values[0], record.channels[1].values[1]);
  EXPECT_TRUE(std::isnan(run.at("t_box").values[3]));
  EXPECT_EQ(run.find("nose"), nullptr);
}

/// What a scenario says of the rows of records: a part of the truth.
std::vector<Record> simulated(const std::vector<Record>& records, const std::function<void(Record&)>& change) {
  std::vector<Record> list;
  for (const Record& r : records) {
    list.push_back(r);
    change(list.back());
  }
  return list;
}

RecordRoles roles_of_machine() {
  return {.speed = "speed",
          .drives = {},
          .ambient = "hall",
          .thermometers = {"t_box", "t_head"},
          .displacements = {"nose"},
          .guesses = {}};
}

std::vector<Record> without_noise() {
  return {measured("one.csv", {{60, 0}, {120, 1000}, {60, 0}, {120, 3000}, {90, 0}, {120, 2000}}, 1, 0.0),
          measured("two.csv", {{30, 2000}, {90, 0}, {120, 1500}, {120, 2500}, {60, 0}, {60, 3000}}, 2, 0.0),
          measured("three.csv", {{100, 2500}, {100, 500}, {100, 0}, {100, 1750}, {100, 0}}, 3, 0.0)};
}

/// What a scenario says that has nothing to do with the machine.
std::vector<Record> of_another_machine(const std::vector<Record>& records) {
  return simulated(records, [](Record& r) {
    for (std::size_t i = 0; i < r.n_samples(); ++i) {
      for (std::size_t c : {2, 3}) r.channels[c].values[i] = 20.0 + 8.0 * std::sin(static_cast<double>(i) / 37.0);
      r.channels[4].values[i] = 40.0 * std::sin(static_cast<double>(i) / 53.0);
    }
  });
}

TEST(ExtendedMachine, LearnsNothingWhereTheScenarioIsRight) {
  const Identified e = extend(three_days(), roles_of_machine(), without_noise());
  for (const IdentifiedChannel& c : e.channels) {
    EXPECT_FALSE(c.is_extended) << c.name;
    EXPECT_EQ(c.fit.kept, 1.0);
    EXPECT_EQ(c.fit.weight.cwiseAbs().sum(), 0.0);
    EXPECT_NEAR(c.missed_kept_out, c.scenario_kept_out, 1e-12);
  }
}

// The scenario knows no heat that goes with the turning spindle: t_box lacks 6 K after a lag of 40 min, the nose -12 um.
TEST(ExtendedMachine, LearnsTheHeatThatTheScenarioLacks) {
  const auto lacks = simulated(without_noise(), [](Record& r) {
    Eigen::VectorXd turns(static_cast<Eigen::Index>(r.n_samples()));
    for (Eigen::Index i = 0; i < turns.size(); ++i)
      turns[i] = r.channels[0].values[static_cast<std::size_t>(i)] > 0.0 ? 1.0 : 0.0;
    const Eigen::VectorXd box = 6.0 * lagged_steps(r.time_s, turns, 2400.0);
    for (std::size_t i = 0; i < r.n_samples(); ++i) {
      r.channels[2].values[i] -= box[static_cast<Eigen::Index>(i)];
      r.channels[4].values[i] += 2.0 * box[static_cast<Eigen::Index>(i)];
    }
  });
  const Identified e = extend(three_days(), roles_of_machine(), lacks);
  const auto channel = [&](const std::string& name) {
    return *std::find_if(e.channels.begin(), e.channels.end(), [&](const auto& c) { return c.name == name; });
  };
  EXPECT_FALSE(channel("t_head").is_extended);
  for (const char* name : {"t_box", "nose"}) {
    const IdentifiedChannel c = channel(name);
    EXPECT_TRUE(c.is_extended) << name;
    EXPECT_GT(c.fit.kept, 0.9) << name;
    EXPECT_LT(c.missed_kept_out, 0.15 * c.scenario_kept_out) << name;
    EXPECT_GT(c.missed_more_without.mean, 5.0 * c.missed_more_without.standard_error) << name;
  }
  EXPECT_GE(channel("t_box").fit.weight.minCoeff(), 0.0) << "a thermometer is passive";
  double in_the_end = 0.0;
  for (const Driver& d : channel("t_box").ledger) {
    if (d.name != "ambient" && d.name != "the scenario") in_the_end += d.in_the_end;
  }
  EXPECT_NEAR(in_the_end, 6.0, 0.6);
  // Nearly all of what is missed is explained; the rest is noise.
  for (const char* name : {"t_box", "nose"}) {
    const IdentifiedChannel c = channel(name);
    double sum = 0.0, left = 0.0;
    for (const Driver& d : c.missing) {
      sum += d.share;
      if (d.name == kLeft) left = d.share;
    }
    EXPECT_NEAR(sum, 1.0, 1e-9) << name;
    EXPECT_GT(left, 0.0) << name;
    EXPECT_LT(left, 0.01) << name;
  }
  for (const Driver& d : channel("t_head").missing) {
    if (d.name == kLeft) {
      EXPECT_NEAR(d.share, 1.0, 1e-9);
    }
  }
}

// At one speed nothing shows how what is learned goes with the speed; the scenario knows it, however wrong it is. So one of
// the two fits whose mean is taken keeps all of it.
TEST(ExtendedMachine, KeepsHalfOfTheScenarioWhereNoSpeedCanBeHidden) {
  const std::vector<Record> records = {
      measured("one.csv", {{60, 0}, {120, 2000}, {60, 0}, {120, 2000}, {90, 0}, {120, 2000}}, 1, 0.03),
      measured("two.csv", {{30, 2000}, {90, 0}, {200, 2000}, {60, 0}, {60, 2000}}, 2, 0.03)};
  const Identified e = extend(records, roles_of_machine(), of_another_machine(records));
  for (const IdentifiedChannel& c : e.channels) EXPECT_GT(c.fit.kept, 0.499) << c.name;
}

// Two fits: 1 and 3 of one body, 3 and 1 of the other. Their mean is 2 and 2; one of them differs from it by 1 and -1.
TEST(MeanFit, IsTheMeanOfEachTerm) {
  ChannelFit one, other;
  one.weight = Eigen::Vector2d(1.0, 3.0);
  other.weight = Eigen::Vector2d(3.0, 1.0);
  one.covariance = 0.5 * Eigen::Matrix2d::Identity();
  one.kept = 1.0;
  other.offset = 4.0;
  one.of_records = other.of_records = Eigen::VectorXd::Constant(1, 7.0);
  const ChannelFit mean = mean_fit(std::vector{one, other});
  EXPECT_THAT(mean.weight, ElementsAre(2.0, 2.0));
  EXPECT_EQ(mean.kept, 0.5);
  EXPECT_EQ(mean.offset, 2.0);
  EXPECT_EQ(mean.of_records[0], 7.0);
  EXPECT_TRUE(mean.covariance.isApprox(0.25 * Eigen::Matrix2d::Identity())) << "a fit without a covariance is certain";
  const Eigen::Matrix2d apart{{1.0, -1.0}, {-1.0, 1.0}};
  EXPECT_TRUE(spread(std::vector{one, other}).isApprox(apart));
  EXPECT_TRUE(spread(std::vector{one, one, one}).isZero());
  EXPECT_THAT(mean_fit(std::vector{other, other}).weight, ElementsAre(3.0, 1.0));
}

// Fits whose errors are alike are averaged; one that errs by more than 1.5 times the best is left out.
TEST(Members, AreTheFitsThatErrLittleMoreThanTheBest) {
  const std::vector<Record> records = three_days();
  const RecordRoles roles = roles_of_machine();
  const std::vector<std::size_t> blocks(3, 1);
  const Law turning{.kind = Law::Kind::kTurning, .channel = "speed", .top = 3000.0},
      power{.kind = Law::Kind::kPower, .channel = "speed", .exponent = 5.0 / 3.0, .top = 3000.0};
  const Structure structure{.laws = {turning, power}, .poles = {{2400.0, {0, 1}}, {7200.0, {0, 1}}}};
  const auto is_alone = [](const Smoothness& s) { return s.is_scenario_alone; };
  const std::vector<Record> right = without_noise(), other = of_another_machine(records);
  for (bool is_right : {true, false}) {
    const Jury jury(records, roles, 40.0, blocks, is_right ? right : other);
    const Judged judged = jury.judged(structure);
    ASSERT_EQ(judged.members.size(), 3u);
    for (const auto& members : judged.members) {
      EXPECT_EQ(std::count_if(members.begin(), members.end(), is_alone), is_right ? 1 : 0);
      EXPECT_GE(members.size(), is_right ? 2u : 1u);
    }
    EXPECT_NEAR(jury.judged(structure, &judged).loss.mean, judged.loss.mean, 1e-12);
    EXPECT_EQ(jury.of_scenario(judged).mean > judged.loss.mean + std::log(1.5), !is_right);
  }
}

// A scenario of another machine is of no use: what is kept of it falls, and the network beside it predicts as if there
// were none.
TEST(ExtendedMachine, KeepsLittleOfAScenarioOfAnotherMachine) {
  const std::vector<Record> records = three_days();
  const Identified e = extend(records, roles_of_machine(), of_another_machine(records));
  const Identified alone = identify(records, {.ambient = "hall", .drives = {}});
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    EXPECT_TRUE(e.channels[c].is_extended);
    EXPECT_LT(e.channels[c].fit.kept, 0.1);
    EXPECT_LT(e.channels[c].missed_kept_out, 2.0 * alone.channels[c].missed_kept_out) << e.channels[c].name;
  }
}

}  // namespace
}  // namespace driftwright::identification::identification_test
