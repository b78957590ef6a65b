#include "base/quantity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"

namespace driftwright::quantity_test {
namespace {

using ::testing::HasSubstr, ::testing::ThrowsMessage;

struct Good {
  const char* text;
  const char* unit;
  double value;
};
class QuantityIs : public ::testing::TestWithParam<Good> {};

TEST_P(QuantityIs, ConvertedByHand) {
  const double value = GetParam().value;
  EXPECT_NEAR(parse_quantity(GetParam().text, GetParam().unit), value, 1e-14 * std::abs(value));  // rounding
}

INSTANTIATE_TEST_SUITE_P(Each, QuantityIs,
                         ::testing::Values(Good{"80 mm", "m", 0.08}, Good{"80mm", "m", 0.08},
                                           Good{"-1.5e2 um", "m", -1.5e-4}, Good{"2 h", "s", 7200},
                                           Good{"30 min", "s", 1800}, Good{"1.5 kW", "W", 1500},
                                           Good{"10 W/(m^2 K)", "W/(m^2 K)", 10}, Good{"0.01 W/(cm^2 K)", "W/(m^2 K)", 100},
                                           Good{"7.2 g/cm^3", "kg/m^3", 7200}, Good{"32 cSt", "mm^2/s", 32},
                                           Good{"210 GPa", "Pa", 2.1e11}, Good{"12 um/(m K)", "1/K", 12e-6},
                                           Good{"12e-6 1/K", "1/K", 12e-6}, Good{"0.46 kJ/(kg K)", "J/(kg K)", 460},
                                           Good{"3 K", "K", 3}, Good{"2000 rpm", "rpm", 2000}, Good{"0.3", "1", 0.3},
                                           Good{"30 percent", "1", 0.3}, Good{"010 mm", "mm", 10}));

TEST(Quantity, SplitsIntoNumberAndKnownUnit) {
  EXPECT_EQ(split_quantity("2.5e1 L/min").number, 25.0);
  EXPECT_EQ(split_quantity("2.5e1 L/min").unit, "L/min");
  EXPECT_EQ(split_quantity("0.4").unit, "");
  EXPECT_THROW((void)split_quantity("3 furlongz"), RangeError);
  EXPECT_THROW((void)split_quantity("steel"), RangeError);
  EXPECT_THROW((void)split_quantity("inf N"), RangeError);
}

TEST(Quantity, ConvertsAbsoluteTemperatures) {
  EXPECT_DOUBLE_EQ(convert(20.0, "degC", "K"), 293.15);
  EXPECT_DOUBLE_EQ(convert(0.5, "kN", "N"), 500.0);
  EXPECT_DOUBLE_EQ(convert(30.0, "percent", ""), 0.3);
  EXPECT_THROW((void)convert(1.0, "N", "W"), RangeError);
  EXPECT_TRUE(has_offset("degC"));
  EXPECT_FALSE(has_offset("K"));
  EXPECT_FALSE(has_offset("N"));
}

TEST(Quantity, UnitsInNames) {
  EXPECT_EQ(unit_in_name("W/(m^2 K)"), "W_m2K");
  EXPECT_EQ(unit_in_name("L/min"), "L_min");
  EXPECT_EQ(unit_in_name("mm^2/s"), "mm2_s");
  EXPECT_EQ(unit_in_name("µm"), "um");
  EXPECT_EQ(unit_in_name("%"), "percent");
  EXPECT_EQ(unit_in_name(""), "1");
}

TEST(Quantity, ThreadsReadAtOnce) {
  double sum = 0.0;
#pragma omp parallel for num_threads(4) reduction(+ : sum)
  for (int i = 0; i < 4000; ++i) {
    const char* const units[] = {"mm", "um", "m", "cm", "km", "inch", "nm"};
    sum += parse_quantity("1 " + std::string(units[i % 7]), "m") > 0.0 ? 1.0 : 0.0;
  }
  EXPECT_EQ(sum, 4000.0);
}

TEST(Quantity, TemperaturesHaveTheirOffset) {
  EXPECT_DOUBLE_EQ(parse_temperature_K("20 degC"), 293.15);
  EXPECT_DOUBLE_EQ(parse_temperature_K("-40 degC"), 233.15);
  EXPECT_NEAR(parse_temperature_K("-40 degF"), 233.15, 1e-10);  // the two scales meet there
  EXPECT_DOUBLE_EQ(parse_temperature_K("297.15 K"), 297.15);
}

TEST(Quantity, FactorsLeaveOffsetsOut) {
  EXPECT_DOUBLE_EQ(unit_factor("mm", "m"), 1e-3);
  EXPECT_DOUBLE_EQ(unit_factor("h", "s"), 3600.0);
  EXPECT_NEAR(unit_factor("degC", "K"), 1.0, 1e-12);
  EXPECT_THROW((void)unit_factor("mm", "s"), RangeError);
}

struct Bad {
  const char* text;
  const char* unit;
  const char* message;
};
class QuantityIsNot : public ::testing::TestWithParam<Bad> {};

TEST_P(QuantityIsNot, ReadAndSaysWhy) {
  EXPECT_THAT([] { (void)parse_quantity(GetParam().text, GetParam().unit); },
              ThrowsMessage<RangeError>(HasSubstr(GetParam().message)));
}

INSTANTIATE_TEST_SUITE_P(
    Each, QuantityIsNot,
    ::testing::Values(Bad{"80", "m", "no unit"}, Bad{"80 kg", "m", "wrong unit 'kg'"},
                      Bad{"80 furlongz", "m", "unknown unit"}, Bad{"8 W/m2K", "W/(m^2 K)", "write 'W/(m^2 K)'"},
                      Bad{"20 C", "K", "write 'degC'"}, Bad{"mm", "m", "not a number"}, Bad{"", "m", "not a number"},
                      Bad{"nan mm", "m", "not a finite number"}, Bad{".nan", "1", "not a number"},
                      Bad{"inf", "1", "not a finite number"}, Bad{"1e999 mm", "m", "not a finite number"},
                      Bad{"1,5 mm", "m", "decimals need a point: 1.5 mm"}, Bad{"5 degC", "K", "temperature difference"},
                      Bad{"5 degF", "K", "temperature difference"}, Bad{"10 W/m^2", "W/(m^2 K)", "wrong unit"},
                      // A frequency is no rate of turning: 2 pi would slip in.
                      Bad{"33 Hz", "rpm", "wrong unit"}, Bad{"2000 1/min", "rpm", "wrong unit"}));

TEST(Quantity, TemperaturesNeedAUnitOfTemperature) {
  EXPECT_THROW((void)parse_temperature_K("20"), RangeError);
  EXPECT_THROW((void)parse_temperature_K("20 m"), RangeError);
  EXPECT_THAT([] { (void)parse_temperature_K("20.5 C"); }, ThrowsMessage<RangeError>(HasSubstr("write '20.5 degC'")));
  EXPECT_THAT([] { (void)parse_temperature_K("70 F"); }, ThrowsMessage<RangeError>(HasSubstr("write '70 degF'")));
  EXPECT_THROW((void)parse_temperature_K("nan degC"), RangeError);
}

}  // namespace
}  // namespace driftwright::quantity_test
