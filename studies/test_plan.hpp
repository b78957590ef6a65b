#pragma once
// Before any measurement: the test programme behind which most effects of the catalogue would be named, in a given time.

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
  int n_programmes = 0;  ///< tried; 0: 10000, of a large machine as many as some ten seconds allow
  unsigned seed = 1;
};

/// A programme and what its record is expected to tell.
struct JudgedTest {
  std::string name;
  Cyclogram cyclogram;
  diagnosis::Prospect prospect;
};

/// The expected share without one of the instruments, or with one more.
struct ChannelWorth {
  std::string name;
  double share_named = 0.0;
};

struct TestPlan {
  double duration_s = 0.0, interval_s = 0.0;
  InstrumentNoise noise;
  std::vector<diagnosis::Knob> numbers;  ///< of the scenario, as the question has them
  diagnosis::Question question;
  JudgedTest usual = {}, stepped = {}, planned = {};
  double search_share = 0.0;  ///< expected of the planned one by the machine that the search ran on
  int n_tried = 0;
  std::vector<ChannelWorth> without = {}, with = {};  ///< each channel; each part without a thermometer, best first
  std::vector<std::string> channels = {};
  Record usual_record = {}, planned_record = {};  ///< of the machine as written, without noise
};

/// Tries programmes on a linear machine (diagnosis/level_machine.hpp), half of them random, the others a few changes off the best so far: all of them in steps of a slot by up to three laws
/// of each kind of effect, the best 200 of these in thirds of a slot by up to eight; takes away sections that are worth less than 1 % of the best; judges the best by the signatures that `diagnose` itself takes. Where the usual or the stepped test is as good, it is that.
/// @param pieces  programmes tried, ten a piece, and tests judged. Every shard needs what all have tried
/// @returns nothing where this is one shard of several
/// @throws InputError  as open_planned_twin(), test_levels()
[[nodiscard]] std::optional<TestPlan> plan_test(const scenarios::Scenario& scenario, const TestPlanOptions& options,
                                                const Listener& listener, const Pieces& pieces = {});

}  // namespace driftwright::studies
