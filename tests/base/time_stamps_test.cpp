// Time stamps of loggers. Clock changes are those of the IANA data base: Berlin 2024-03-31 2:00 -> 3:00 and 2024-10-27
// 3:00 -> 2:00, Adelaide (half hours from UTC) 2024-04-07 3:00 -> 2:00.

#include "base/time_stamps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"

namespace driftwright::time_stamps_test {
namespace {

using ::testing::HasSubstr, ::testing::ThrowsMessage;

double seconds_between(TimeStamps stamps, const std::string& a, const std::string& b) {
  const auto first = stamps.read(a);
  return 1e-9 * static_cast<double>((stamps.read(b) - first).count());
}

TEST(TimeStamps, ReadIso8601) {
  const TimeStamps iso("", "");
  EXPECT_DOUBLE_EQ(seconds_between(iso, "2024-02-28T23:59:59", "2024-02-29 00:00:00.25"), 1.25);  // a leap year
  EXPECT_DOUBLE_EQ(seconds_between(iso, "2024-03-01T10:00:00Z", "2024-03-01T12:00:00+02:00"), 0.0);
  EXPECT_DOUBLE_EQ(seconds_between(iso, "2024-03-01T10:00", "2024-03-02"), 14 * 3600.0);
}

TEST(TimeStamps, ReadOffsetsAsTheyAreWritten) {
  for (const char* b :
       {"02.11.2026 07:30:00+01:00", "02.11.2026 07:30:00 +01:00", "02.11.2026 07:30:00+0100", "02.11.2026 07:30:00 +01",
        "02.11.2026 07:30:00 CET", "02.11.2026 07:30:00 MEZ", "02.11.2026 06:30:00Z", "02.11.2026 01:00:00 -05:30"}) {
    EXPECT_DOUBLE_EQ(seconds_between(TimeStamps("%d.%m.%Y %H:%M:%S%z", "Europe/Berlin"), "02.11.2026 06:29:00 UTC", b), 60.0)
        << b;
    EXPECT_DOUBLE_EQ(seconds_between(TimeStamps("%d.%m.%Y %H:%M:%S %Ez", ""), "02.11.2026 06:29:00 UTC", b), 60.0) << b;
  }
  for (const char* b :
       {"2026-11-02 07:30:00 +01:00", "2026-11-02T07:30:00+0100", "2026-11-02 07:30+01", "2026-11-02 07:30:00.0 CET"})
    EXPECT_DOUBLE_EQ(seconds_between(TimeStamps("", ""), "2026-11-02T06:29:00Z", b), 60.0) << b;
  EXPECT_DOUBLE_EQ(seconds_between(TimeStamps("", ""), "2026-11-02", "2026-11-03"), 86400.0);  // no offset of -02
  EXPECT_THAT([] { (void)TimeStamps("%d.%m.%Y %H:%M:%S%z", "").read("02.11.2026 07:30:00"); },
              ThrowsMessage<RangeError>(HasSubstr("has no offset to UTC at its end")));
}

TEST(TimeStamps, RefuseAMegabyteThatEndsAsAnOffsetDoes) {  // std::regex goes as deep as its text is long
  for (const std::string end : {"1+01:00", "1 CET", "1"}) {
    const std::string cell = std::string(1'000'000, '1') + end;
    EXPECT_THROW((void)TimeStamps("", "").read(cell), RangeError);
    EXPECT_THROW((void)TimeStamps("%d.%m.%Y %H:%M:%S%z", "").read(cell), RangeError);
  }
}

TEST(TimeStamps, ReadFractionsBehindPointCommaAndColon) {
  const TimeStamps german("%d.%m.%Y %H:%M:%S", "");
  for (const char* b : {"01.03.2024 10:00:01.237", "01.03.2024 10:00:01,237", "01.03.2024 10:00:01:237"})
    EXPECT_NEAR(seconds_between(german, "01.03.2024 10:00:00", b), 1.237, 1e-12) << b;
  EXPECT_NEAR(seconds_between(TimeStamps("%m/%d/%Y %I:%M:%S %p", ""), "3/1/2024 11:59:59 AM", "3/1/2024 12:00:00 PM"), 1.0,
              1e-12);
  EXPECT_NEAR(seconds_between(TimeStamps("%y%m%d %H:%M", ""), "240101 00:00", "240301 00:00"), 60 * 86400.0, 1e-9);
}

TEST(TimeStamps, GoOnOverMidnightWithoutADate) {
  const TimeStamps clock("%H:%M:%S", "");
  EXPECT_DOUBLE_EQ(seconds_between(clock, "23:59:50", "00:00:10"), 20.0);
  EXPECT_DOUBLE_EQ(seconds_between(clock, "10:00:00", "09:59:00"), -60.0);  // no midnight: the caller refuses it
  TimeStamps days("%H:%M:%S", "");
  const auto first = days.read("12:00:00");
  for (const char* t : {"20:00:00", "04:00:00", "12:00:00", "20:00:00"}) (void)days.read(t);
  EXPECT_EQ(days.read("04:00:00") - first, std::chrono::hours(40));
}

TEST(TimeStamps, TellTheRepeatedHourByTheirOrder) {
  TimeStamps berlin("%d.%m.%Y %H:%M", "Europe/Berlin");
  const auto first = berlin.read("27.10.2024 01:30");
  const std::pair<const char*, int> rows[] = {{"27.10.2024 02:00", 30},
                                              {"27.10.2024 02:30", 60},
                                              {"27.10.2024 02:00", 90},
                                              {"27.10.2024 02:30", 120},
                                              {"27.10.2024 03:00", 150}};
  for (const auto& [text, minutes] : rows) EXPECT_EQ(berlin.read(text) - first, std::chrono::minutes(minutes)) << text;
  EXPECT_DOUBLE_EQ(seconds_between(TimeStamps("%F %H:%M", "Australia/Adelaide"), "2024-04-07 01:59", "2024-04-07 03:01"),
                   7320.0);
}

TEST(TimeStamps, SkipTheMissingHour) {
  const TimeStamps berlin("%d.%m.%Y %H:%M", "Europe/Berlin");
  EXPECT_DOUBLE_EQ(seconds_between(berlin, "31.03.2024 01:59", "31.03.2024 03:00"), 60.0);
  EXPECT_THAT([&] { (void)seconds_between(berlin, "31.03.2024 01:59", "31.03.2024 02:30"); },
              ThrowsMessage<RangeError>(HasSubstr("does not exist in Europe/Berlin")));
}

TEST(TimeStamps, RefuseYearsOfClocksThatWereNeverSet) {
  // 64 bits of nanoseconds end in 1677 and 2262: what lies beyond came out as a time of some other year.
  for (const char* stamp : {"0001-01-01T00:00:00", "1600-01-01T00:00:00", "2300-06-01T12:00:00.5", "9999-12-31T23:59:59Z"}) {
    TimeStamps iso("", "");
    EXPECT_THAT([&] { (void)iso.read(stamp); }, ThrowsMessage<RangeError>(HasSubstr("1700 to 2200"))) << stamp;
    (void)iso.read("2024-03-01T10:00:00");
    EXPECT_THAT([&] { (void)iso.read(stamp); }, ThrowsMessage<RangeError>(HasSubstr("1700 to 2200"))) << stamp;
  }
  TimeStamps wrapped("", "");
  (void)wrapped.read("2024-03-01T10:00:00");
  EXPECT_THAT([&] { (void)wrapped.read("1439-08-12T10:00:00"); },  // 2^64 ns before, within a day
              ThrowsMessage<RangeError>(HasSubstr("1439")));
  TimeStamps german("%d.%m.%Y %H:%M:%S", "Europe/Berlin");
  EXPECT_THAT([&] { (void)german.read("31.12.9999 23:59:59"); }, ThrowsMessage<RangeError>(HasSubstr("9999")));
  EXPECT_NO_THROW((void)german.read("01.01.1970 00:00:00"));
}

TEST(Milliseconds, AreOfAStamp) {
  EXPECT_EQ(milliseconds(1.5), std::chrono::microseconds(1500));
  EXPECT_EQ(milliseconds(-2.0), std::chrono::milliseconds(-2));
  for (double count : {1e18, -1e300, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW((void)milliseconds(count), RangeError) << count;
}

TEST(TimeStamps, RefuseWhatTheFormatDoesNotFit) {
  for (const char* text : {"2024-03-01", "1.3.2024 10:00:00 Uhr", "32.01.2024 10:00:00", "01.03.2024 25:00:00", ""})
    EXPECT_THROW((void)TimeStamps("%d.%m.%Y %H:%M:%S", "").read(text), RangeError) << text;
  EXPECT_THROW((void)TimeStamps("", "").read("01.03.2024 10:00:00"), RangeError);
  EXPECT_THROW((void)TimeStamps("", "Europe/Entenhausen"), RangeError);
  EXPECT_THROW((void)TimeStamps("%H:%M", "Europe/Berlin"), RangeError);
}

}  // namespace
}  // namespace driftwright::time_stamps_test
