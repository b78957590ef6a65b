#pragma once
// Plans a test programme of given length before any measurement: the one after which a diagnosis would name most effects
// of the catalogue.

#include "base/pieces.hpp"
#include "diagnosis/prospect.hpp"
#include "studies/planned_twin.hpp"
#include "studies/test_programme.hpp"

namespace driftwright::studies {

struct TestPlanOptions {
  double duration_s = 8.0 * 3600.0;
  double interval_s = 60.0;     ///< of rows
  double most_speed_rpm = 0.0;  ///< 0: the fastest of the scenario
  InstrumentNoise noise = {};
  int n_programmes = 0;  ///< to try; 0: 10000, for a large machine as many as fit in about ten seconds
  unsigned seed = 1;
};

/// A programme, and what a diagnosis of its record is expected to find.
struct JudgedTest {
  std::string name;
  Cyclogram cyclogram;
  diagnosis::Prospect prospect;
};

/// The expected share of named effects without one of the instruments, or with one more.
struct ChannelWorth {
  std::string name;
  double share_named = 0.0;
};

struct TestPlan {
  double duration_s = 0.0, interval_s = 0.0;
  InstrumentNoise noise;
  std::vector<diagnosis::Knob> numbers;  ///< numbers of the scenario, as in the question
  diagnosis::Question question;
  JudgedTest usual = {}, stepped = {}, planned = {};
  double search_share = 0.0;  ///< expected share for the planned programme, by the machine of the search
  int n_tried = 0;
  std::vector<ChannelWorth>
      without = {},
      with = {};  ///< without each channel; with each further thermometer, on parts that have none, best first
  std::vector<std::string> channels = {};
  Record usual_record = {}, planned_record = {};  ///< of the machine as written, without noise
};

/// Tries programmes on a linear machine (diagnosis/level_machine.hpp), half of them random, the others a few changes from
/// the best so far. All programmes are tried in steps of a slot with up to three laws of each kind of effect, and the
/// @returns nothing if this is one shard of several
/// @throws InputError  as open_planned_twin(), test_levels()
/// and the best is judged by the signatures that `diagnose` itself uses. If the usual or the stepped test is as good,
/// that one is the plan.
/// @param pieces  the programmes tried, ten per piece, and the tests judged. Every shard needs the results of all
/// @returns nothing if this is one shard of several
[[nodiscard]] std::optional<TestPlan> plan_test(const scenarios::Scenario& scenario, const TestPlanOptions& options,
                                                const Listener& listener, const Pieces& pieces = {});

}  // namespace driftwright::studies
