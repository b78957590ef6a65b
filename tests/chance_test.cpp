// What chance has to offer, against machines without fault: their numbers scattered as they are known, their readings noisy, by the full model.

#include "diagnosis/chance.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/random.hpp"
#include "diagnosis/diagnosis.hpp"
#include "machine/as_recorded.hpp"
#include "machine/machine.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/transient.hpp"
#include "studies/measured_twin.hpp"
#include "tests/temporary_file.hpp"

namespace driftwright::diagnosis::chance_test {
namespace {

constexpr double kNoise_K = 0.05, kNoise_um = 0.3;

/// A machine of two bodies, each number times exp(0.1 z), and an ambient that is off by 0.3 z K from what is recorded.
/// @param more  further lines of the list of effects
std::string machine(Random* random, const std::string& more = "") {
  const auto known = [&](double value) { return value * (random ? std::exp(0.1 * random->normal()) : 1.0); };
  std::string text = fmt::format(R"(name: two_bodies
reference_temperature: 20 degC
machine: {{generator: lumped}}
effects:
  - {{type: node, node: head, capacity: {} J/K}}
  - {{type: node, node: column, capacity: {} J/K}}
  - {{type: heat_source, node: head, power: {} W, at_speed: 1000 rpm, exponent: 1.3}}
  - {{type: link, node: head, to: column, conductance: {} W/K}}
  - {{type: link, node: column, to: ambient, conductance: {} W/K}}
)",
                                 known(6000.0), known(40000.0), known(100.0), known(12.0), known(14.0));
  for (const char* record : {"monday", "tuesday"}) {
    if (random) text += fmt::format("  - {{type: ambient, offset: {} K, in: {}}}\n", 0.3 * random->normal(), record);
  }
  return text + more +
         fmt::format(R"(ambient: [[0 min, 20 degC], [200 min, 22 degC], [400 min, 21 degC]]
sensors:
  - {{name: t_head, node: head}}
  - {{name: t_column, node: column}}
displacements:
  - {{name: nose, sensitivities: [{{node: head, sensitivity: {} um/K}}]}}
cyclograms:
  monday: [[60 min, 600 rpm], [60 min, 1900 rpm], [40 min, 0 rpm], [80 min, 1000 rpm]]
  tuesday: [[50 min, 1800 rpm], [70 min, 300 rpm], [60 min, 1000 rpm], [60 min, 0 rpm]]
solver: {{output_interval: 2 min}}
)",
                     known(3.0));
}

std::vector<std::string> records_of(const std::string& scenario, Random& random, const std::string& name) {
  const scenarios::Scenario s = scenarios::read_scenario(scenario);
  const scenarios::MachineModel& model = *s.machine;
  const scenarios::Machine full = scenarios::build(model, scenarios::place(model));
  std::vector<std::string> paths;
  for (const Cyclogram& c : s.cyclograms) {
    const scenarios::FeltRun felt = scenarios::felt_run(model, c);
    Record r = scenarios::as_recorded(
        model,
        solver::simulate(full.system, felt.cyclogram, felt.ambient, scenarios::output_times_s(c, 120.0),
                         {.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7}, scenarios::start_state(model, full)),
        full.system.outputs, c);
    for (Channel& channel : r.channels) {
      const double noise = channel.unit == "degC" ? kNoise_K : channel.unit == "um" ? kNoise_um : 0.0;
      for (double& v : channel.values) v += noise * random.normal();
    }
    paths.push_back(write_file(name + "_" + c.name + ".csv", record_csv(r)));
  }
  return paths;
}

TEST(Chance, IsThatOfGumbel) {
  const Chance c{.mode = -3.0, .spread = 0.8};
  EXPECT_NEAR(c.share_above(c.gain_at(0.01)), 0.01, 1e-12);
  EXPECT_NEAR(c.share_above(-3.0), 1.0 - std::exp(-1.0), 1e-12);  // at its mode
  EXPECT_NEAR(c.gain_at(1e-4), -3.0 + 0.8 * std::log(1e4), 1e-4);
}

TEST(Chance, OfOneCandidateFallsByAnEfoldANat) {
  // twice a gain of one free size is chi-squared with one degree of freedom: one machine in five has 0.82 nats, one in a thousand 5.41, one in 10^5 9.76
  constexpr double kOneInFive = 0.82, kOneInThousand = 5.41, kOneInHundredThousand = 9.76;
  EXPECT_NEAR(rarity(kOneInFive, kOneInFive), std::log(5.0), 1e-12);
  EXPECT_NEAR(rarity(kOneInThousand, kOneInFive), std::log(1e3), 0.75);  // never more than there is
  EXPECT_LT(rarity(kOneInThousand, kOneInFive), std::log(1e3));
  EXPECT_LT(rarity(kOneInHundredThousand, kOneInFive), std::log(1e5));
}

// A shift of 0.2 um where its prior fears 15 um, at a time that nobody knows, pays some 14 nats for what it might have been, and these readings are worth 8 to 15.
void expect_faint_causes(int n_machines, int least_faint) {
  const std::string scenario = write_file("nominal_for_shift.yaml", machine(nullptr));
  int n_faint = 0, n_rightly = 0;
  for (int i = 0; i < n_machines; ++i) {
    Random random(23, static_cast<std::uint64_t>(i));
    const std::string truth = write_file(
        "shifted.yaml",
        machine(&random, "  - {type: mount_shift, displacement: nose, shift: 0.2 um, time: 130 min, in: tuesday}\n"));
    const studies::MeasuredTwin m = studies::open_measured_twin(scenarios::read_scenario(scenario), "diagnose",
                                                                records_of(truth, random, fmt::format("s{}", i)), {});
    const Diagnosis d = diagnose(*m.twin, nullptr, m.runs, m.how);
    if (d.causes.empty()) continue;
    const Cause& c = d.causes.front();
    if (c.log_evidence_gain > d.search.bars.suspected.front()) continue;  // worth its prior's price
    ++n_faint;
    n_rightly += c.effect == "mount_shift";
    EXPECT_EQ(c.where, "nose") << c.effect;
    EXPECT_EQ(c.standing, Standing::kSuspected) << c.effect;
    EXPECT_FALSE(c.is_written);
    EXPECT_LT(c.chance, 0.005);
    EXPECT_EQ(d.verdict, Verdict::kSuspected);
  }
  EXPECT_GE(n_faint, least_faint);
  EXPECT_GE(2 * n_rightly, n_faint);  // the others say of the same channel what does nearly the same
}

TEST(ChanceAtLength, SeldomOffersWhatAFaintCauseHas) {
  expect_faint_causes(32, 4);
}

void expect_chance_is_met(int n_machines, int fewest_above_median, int most_above_median, int most_suspected) {
  const std::string scenario = write_file("nominal.yaml", machine(nullptr));
  int n_above_median = 0, n_suspected = 0;
  for (int i = 0; i < n_machines; ++i) {
    Random random(11, static_cast<std::uint64_t>(i));
    const std::string truth = write_file("truth.yaml", machine(&random));
    const studies::MeasuredTwin m = studies::open_measured_twin(scenarios::read_scenario(scenario), "diagnose",
                                                                records_of(truth, random, fmt::format("r{}", i)), {});
    const Diagnosis d = diagnose(*m.twin, nullptr, m.runs, m.how);
    const std::vector<Candidate> list = d.search.candidates;
    double best = -1e300;
    for (const Score& s : d.search.scores) {
      const double n_laws = static_cast<double>(list[s.candidate].variants.size());
      best = std::max(best, s.gain - std::log(n_laws) - std::log(static_cast<double>(list.size())));
    }
    n_above_median += best > d.search.chance.gain_at(0.5);
    n_suspected += d.verdict != Verdict::kConsistent;
  }
  EXPECT_GE(n_above_median, fewest_above_median);
  EXPECT_LE(n_above_median, most_above_median);
  EXPECT_LE(n_suspected, most_suspected);
}

TEST(Chance, IsMetByMachinesWithoutFault) {
  // half of ten, within 2.6 standard deviations of a fair coin; three in two hundred is what was asked for: two of ten have a probability of 1 %
  expect_chance_is_met(10, 1, 9, 1);
}
TEST(ChanceAtLength, IsMetByMachinesWithoutFault) {
  // half of forty, likewise; three of forty have a probability of 2.3 %
  expect_chance_is_met(40, 12, 28, 2);
}

}  // namespace
}  // namespace driftwright::diagnosis::chance_test
