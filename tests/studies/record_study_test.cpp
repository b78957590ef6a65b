// Records that people bring: what is wrong with them is named before anything is fitted.

#include "studies/record_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "compensation/predictors/fitted_formulas.hpp"
#include "compensation/sensors/sensor_selection.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/sensor_records.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::studies::record_study_test {
namespace {

using ::testing::AllOf, ::testing::Contains, ::testing::HasSubstr, ::testing::IsEmpty, ::testing::ThrowsMessage;

TEST(SensorWarnings, NameWhatIsFlatMissingOrDouble) {
  std::vector<Record> records = {fixtures::sensor_record(1, 200, 6, 0.3), fixtures::sensor_record(2, 200, 6, 0.3)};
  EXPECT_THAT(studies::sensor_warnings(records, {"X1", "X2", "X3"}), IsEmpty());
  Random random(1);
  for (Record& r : records) {
    std::fill(r.channels[0].values.begin(), r.channels[0].values.end(), 21.5);
    for (std::size_t i = 0; i < 50; ++i) r.channels[1].values[3 * i] = NAN;
    for (std::size_t i = 0; i < 200; ++i)
      r.channels[4].values[i] = 3.0 - 2.0 * r.channels[3].values[i] + 0.01 * random.normal();
  }
  const std::vector<std::string> lines = studies::sensor_warnings(records, fixtures::sensor_names(6));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("X1"), HasSubstr("21.5"), HasSubstr("flat"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("X2"), HasSubstr("25 %"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("X4 and X5"), HasSubstr("move as one"))));
  EXPECT_EQ(lines.size(), 3u);
}

TEST(SensorWarnings, NameASensorThatNeverReads) {
  std::vector<Record> records = {fixtures::sensor_record(1, 50, 3, 0.3)};
  std::fill(records[0].channels[1].values.begin(), records[0].channels[1].values.end(), NAN);
  EXPECT_THAT(studies::sensor_warnings(records, fixtures::sensor_names(3)),
              Contains(AllOf(HasSubstr("X2"), HasSubstr("100 %"))));
}

struct Bad {
  const char* name;
  const char* text;
  std::vector<const char*> message;
};
class BadRecord : public ::testing::TestWithParam<Bad> {};
TEST_P(BadRecord, IsRefusedWithItsLine) {
  const std::string path = write_file("record.csv", GetParam().text);
  for (const char* part : GetParam().message)
    EXPECT_THAT([&] { (void)read_record_csv(path); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("record.csv"), HasSubstr(part))));
}
INSTANTIATE_TEST_SUITE_P(
    Each, BadRecord,
    ::testing::Values(Bad{"time_twice", "time_s,X1_degC,d_um\n0,20,0\n60,21,1\n60,22,2\n", {":4:", "60"}},
                      Bad{"time_backwards", "time_s,X1_degC,d_um\n0,20,0\n60,21,1\n30,22,2\n", {":4:", "30"}},
                      Bad{"a_word", "time_s,X1_degC,d_um\n0,20,0\n60,open,1\n", {":3:", "open"}},
                      Bad{"ragged", "time_s,X1_degC,d_um\n0,20,0\n60,21\n", {":3:"}}),
    [](const auto& p) { return std::string(p.param.name); });

TEST(MissingCells, AreLeftOutAndCounted) {
  const Record r =
      read_record_csv(write_file("gaps.csv", "time_s,X1_degC,d_um\n0,20,0\n60,,1\n120,22,2\n180,23,\n240,24,4\n"));
  const compensation::Regression fit = compensation::fit_regression(std::span(&r, 1), {"X1"}, "d");
  EXPECT_EQ(fit.n_samples, 3);
  EXPECT_EQ(fit.n_left_out, 2);
  EXPECT_NEAR(fit.coefficients[0], 1.0, 1e-12);
}

// Fewer rows than coefficients: every model that a study fits says so.
TEST(TooFewSamples, AreNamedByEveryModel) {
  const std::vector<Record> few = {fixtures::sensor_record(1, 3, 6), fixtures::sensor_record(2, 4, 6)};
  const std::vector<std::string> all = fixtures::sensor_names(6);
  EXPECT_REFUSED(compensation::fit_regression(std::span(few).first(1), all, "drift_y"),
                 "7 unknowns but only 3 complete rows");
  for (const auto& fit :
       {compensation::fit_ridge, compensation::fit_principal_components, compensation::fit_partial_least_squares})
    EXPECT_REFUSED(fit(few, all, "drift_y"), "complete rows");
  EXPECT_REFUSED(compensation::fit_with_lags(few, all, "drift_y"), "complete rows");
  EXPECT_REFUSED(compensation::select_best_set(few, all, "drift_y", 5), "complete rows");
}

// Six sensors that rise by 1 to 8 K at a speed, by half as much at another; in one record two of them hold each other's
// readings.
TEST(SensorWarnings, NameExchangedSensorsAndTheirRecord) {
  const std::vector<std::string> names = {"a", "b", "c", "d", "e", "f"};
  const std::vector<double> rise_K = {1.0, 1.6, 2.5, 4.0, 6.0, 8.0};
  const auto record = [&](const std::string& source, double level, bool is_exchanged) {
    Record r{.source = source, .time_s = {}, .channels = {}};
    for (const std::string& name : names) r.channels.push_back({name, "K", {}});
    for (int i = 0; i < 60; ++i) {
      r.time_s.push_back(60.0 * i);
      for (std::size_t s = 0; s < names.size(); ++s)
        r.channels[s].values.push_back(level * rise_K[s] * (1.0 - std::exp(-i / (5.0 + static_cast<double>(s)))));
    }
    if (is_exchanged) std::swap(r.channels[1].values, r.channels[4].values);
    return r;
  };
  const auto named = [&](const std::vector<Record>& records) {
    std::vector<std::string> lines = studies::sensor_warnings(records, names);
    std::erase_if(lines, [](const std::string& line) { return line.find("exchanged") == std::string::npos; });
    return lines;
  };
  EXPECT_THAT(named({record("one", 1.0, false), record("two", 0.5, false), record("three", 0.7, false)}), IsEmpty());
  EXPECT_THAT(named({record("one", 1.0, false), record("two", 0.5, true), record("three", 0.7, false)}),
              ElementsAre(HasSubstr("b and e look exchanged in two")));
  EXPECT_EQ(named({record("one", 1.0, false), record("two", 0.5, true)}).size(), 1u);  // which of the two is unknown
}

}  // namespace
}  // namespace driftwright::studies::record_study_test
