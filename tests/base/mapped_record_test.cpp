// Files as loggers write them, read by a map of their columns. The samples in tests/data/loggers mimic:
//   keysight_34972a    USB files of a Keysight 34972A (User's Guide): a fraction after a colon, 9.9E+37 for overload
//   benchlink_utf16    BenchLink Data Logger 3: UTF-16, lines before the header, an alarm column beside each channel
//   hioki_lr8431       a HIOKI LR8431 (manual, appendix "Text File (CSV) Internal Format"): everything quoted, a table of
//                      channels in front
//   graphtec_gl840     a Graphtec GL840: units under the header, a column of milliseconds, BURNOUT, blanks after the sign
//   labview            NI LabVIEW's .lvm ("Specification for the LabVIEW Measurement File"): tabs, decimal commas, two
//                      header blocks, comments
//   german_latin1      a spreadsheet's export in Germany: Latin-1, semicolons, decimal commas, the night in which clocks are
//                      set back
//   simatic_data_log   a data log of a SIMATIC S7-1200: date and time in two columns, //END before rows of an earlier log
//   halsampler         LinuxCNC's halsampler -t (its manual page): no header, blanks, the number of the sample in front

#include "base/mapped_record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "scenarios/reader/read_columns.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::mapped_record_test {
namespace {

using ::testing::AllOf, ::testing::Contains, ::testing::DoubleNear, ::testing::ElementsAre, ::testing::HasSubstr;
using ::testing::IsEmpty, ::testing::NanSensitiveDoubleEq, ::testing::Pointwise, ::testing::ThrowsMessage;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

ColumnMap map_of(const std::string& yaml) {
  return scenarios::read_columns(
      ConfigMap::read_file(write_file("columns.yaml", yaml)).described_by(scenarios::columns_schema()));
}

ReadRecord read_sample(const std::string& file, const std::string& yaml) {
  return read_record("tests/data/loggers/" + file, map_of(yaml));
}

ReadRecord read_text_of(const std::string& text, const std::string& yaml) {
  return read_record(write_file("log.csv", text), map_of(yaml));
}

/// What a record is expected to hold; differences of rounding alone are borne.
void expect_values(const Record& record, const std::string& header, const std::vector<double>& values) {
  const Channel& channel = record.at(header);
  EXPECT_EQ(channel.header(), header);
  ASSERT_EQ(channel.values.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) {
      EXPECT_TRUE(std::isnan(channel.values[i])) << header << " row " << i;
    } else {
      EXPECT_NEAR(channel.values[i], values[i], 1e-9 * std::max(1.0, std::abs(values[i]))) << header << " row " << i;
    }
  }
}

void expect_times(const Record& record, const std::vector<double>& time_s) {
  EXPECT_THAT(record.time_s, Pointwise(DoubleNear(1e-9), time_s));
}

TEST(MappedRecord, Keysight34972A) {
  const ReadRecord read = read_sample("keysight_34972a.csv", R"yaml(
missing: ["9.90000000E+37"]
time: {column: Time, format: "%m/%d/%Y %H:%M:%S"}
channels:
  bearing: {column: Chan 101 (C), unit: degC}
  ambient: {column: Chan 103 (C), unit: degC}
  tip_z: {column: Chan 201 (VDC), unit: mm, factor: -0.2, offset: 10 um}
)yaml");
  expect_times(read.record, {0.0, 10.0, 20.25});
  expect_values(read.record, "bearing_degC", {20.125, 20.25, 20.375});
  expect_values(read.record, "ambient_degC", {kMissing, 20.5, 20.625});
  expect_values(read.record, "tip_z_um", {10.0 - 73.647326, 10.0 - 125.638466, 10.0 - 76.476424});
  EXPECT_THAT(read.notes, ElementsAre(AllOf(HasSubstr("not read"), HasSubstr("'Sweep #', 'Chan 102 (C)'"))));
}

TEST(MappedRecord, BenchLinkInUtf16) {
  const ReadRecord read = read_sample("benchlink_utf16.csv", R"yaml(
time: {column: Time, format: "%m/%d/%Y %H:%M:%S"}
channels:
  bearing: {column: "101 <bearing> (C)", unit: degC}
  ambient: {column: "102 <hall> (°C)", unit: "°C"}
)yaml");
  expect_times(read.record, {0.0, 10.002, 20.0});
  expect_values(read.record, "bearing_degC", {23.5, 23.75, 24.0});
  expect_values(read.record, "ambient_degC", {20.25, 20.5, kMissing});
}

TEST(MappedRecord, HiokiLr8431) {
  const ReadRecord read = read_sample("hioki_lr8431.csv", R"yaml(
time: {column: Time, unit: s}
channels:
  speed: {column: "P-3[r/s]", unit: rpm, factor: 60}
  nose: {column: "CH-7[C]", unit: degC}
  supply: {column: "CH-1[V]", unit: V}
)yaml");
  expect_times(read.record, {0.0, 1.0, 2.0});
  expect_values(read.record, "speed_rpm", {0.0, 1500.0, 3000.0});
  expect_values(read.record, "nose_degC", {35.9, 36.1, 36.4});
  expect_values(read.record, "supply_V", {1.5, 1.75, 2.0});
}

TEST(MappedRecord, GraphtecGl840) {
  const ReadRecord read = read_sample("graphtec_gl840.csv", R"yaml(
missing: [BURNOUT, +++++++]
time: {column: "Date&Time", milliseconds: ms, format: "%Y/%m/%d %H:%M:%S"}
channels:
  nose: {column: CH1, unit: degC}
  ambient: {column: CH2, unit: degC}
  tip_z: {column: CH3, unit: um, factor: 40}
)yaml");
  expect_times(read.record, {0.0, 0.5, 1.0, 1.5});
  expect_values(read.record, "nose_degC", {23.4, 23.6, kMissing, 24.0});
  expect_values(read.record, "ambient_degC", {20.1, kMissing, 20.3, 20.4});
  expect_values(read.record, "tip_z_um", {-50.0, 0.0, 50.0, 100.0});
  ASSERT_EQ(read.notes.size(), 2u);
  EXPECT_THAT(read.notes[1], AllOf(HasSubstr("passed over"), HasSubstr("line 15: 'NO.,Time,ms,degC")));
}

TEST(MappedRecord, LabView) {
  const ReadRecord read = read_sample("labview.lvm", R"yaml(
decimal: ","
time: {column: X_Value, unit: s}
channels:
  nose: {column: Temperature_0, unit: degC}
  tip_z: {column: Voltage_0, unit: mm, factor: 0.1}
)yaml");
  expect_times(read.record, {0.0, 0.5, 1.0});
  expect_values(read.record, "nose_degC", {23.5123, 23.6123, 23.7123});
  expect_values(read.record, "tip_z_um", {12.5, -25.0, 37.5});
}

// On 27 October 2024 clocks in Germany were set back from 3:00 to 2:00: 2:00 follows 2:59, and without the zone it would
// go back.
TEST(MappedRecord, GermanSpreadsheetOverAClockChange) {
  const std::string yaml = R"yaml(
separator: ";"
decimal: ","
time: {column: Zeitstempel, format: "%d.%m.%Y %H:%M:%S"ZONE}
channels:
  speed: {column: "Spindeldrehzahl [1/min]", unit: rpm}
  bearing_front: {column: "T3 (°C)", unit: degC}
  tip_z: {column: "Z [mm]", unit: mm}
)yaml";
  const auto with = [&](const std::string& zone) {
    std::string text = yaml;
    return text.replace(text.find("ZONE"), 4, zone);
  };
  const ReadRecord read = read_sample("german_latin1.csv", with(", zone: Europe/Berlin"));
  expect_times(read.record, {0.0, 60.0, 120.0, 180.0});
  expect_values(read.record, "speed_rpm", {1500, 1500, 0, 0});
  expect_values(read.record, "bearing_front_degC", {20.5, 20.75, 21.0, kMissing});
  expect_values(read.record, "tip_z_um", {12.5, 15.0, 17.5, 20.0});
  EXPECT_THAT(
      [&] { (void)read_sample("german_latin1.csv", with("")); },
      ThrowsMessage<InputError>(AllOf(HasSubstr("german_latin1.csv:7:1:"), HasSubstr("goes back by 3540 s from line 6"),
                                      HasSubstr("zone: Europe/Berlin"))));
}

TEST(MappedRecord, SimaticDataLog) {
  const ReadRecord read = read_sample("simatic_data_log.csv", R"yaml(
end: //END
time: {column: [Date, UTC Time], format: "%m/%d/%Y %H:%M:%S"}
channels:
  speed: {column: Speed, unit: rpm, magnitude: true}
  cutting_power: {column: Load, unit: kW, factor: 0.15}    # per cent of 15 kW
  t_front: {column: T_Front, unit: degF}
)yaml");
  expect_times(read.record, {0.0, 60.0, 120.0});
  expect_values(read.record, "speed_rpm", {3000, 3000, 0});
  expect_values(read.record, "cutting_power_W", {1875.0, 1912.5, 0.0});
  expect_values(read.record, "t_front_degC", {(31.25 - 32.0) / 1.8, (31.5 - 32.0) / 1.8, (31.75 - 32.0) / 1.8});
}

TEST(MappedRecord, HalSampler) {
  const ReadRecord read = read_sample("halsampler.txt", R"yaml(
header_line: none
separator: blank
time: {position: 1, unit: ms}
channels:
  speed: {position: 2, unit: rpm}
  tip_z: {position: 3, unit: mm}
)yaml");
  expect_times(read.record, {1.0, 1.001, 1.002});
  expect_values(read.record, "speed_rpm", {3000, 3000, 2999.5});
  expect_values(read.record, "tip_z_um", {12.5, 12.75, 13.0});
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("columns 4, 5")));
}

// The same numbers, whichever of two programs wrote them.
TEST(MappedRecord, ReadsARecordOfOursAsTheReaderOfRecordsDoes) {
  const std::string path = write_file("ours.csv", "# a comment\ntime_min,tip_z_um,oil_degC\n0,1.5,20\n2,-3,\n");
  const ReadRecord plain = read_record(path, std::nullopt);
  const ReadRecord mapped =
      read_record(path, map_of("time: {column: time_min, unit: min}\nchannels:\n  tip_z: {column: tip_z_um, unit: um}\n"
                               "  oil: {column: oil_degC, unit: degC}\n"));
  expect_times(mapped.record, plain.record.time_s);
  for (const Channel& c : plain.record.channels) expect_values(mapped.record, c.header(), c.values);
  EXPECT_THAT(plain.notes, IsEmpty());
}

TEST(MappedRecord, CountsRowsWhereThereIsNoTime) {
  const ReadRecord read = read_text_of("x\n1\n2\n\n3\n", "time: {interval: 500 ms}\nchannels: {x: {column: x, unit: um}}\n");
  expect_times(read.record, {0.0, 0.5, 1.0});
}

// A logger marks events in rows of their own: neither their time nor anything else of them counts, wherever they are.
TEST(MappedRecord, LeavesOutRowsInWhichNoChannelHasAReading) {
  const std::string map =
      "missing: [---]\ntime: {column: t, format: \"%H:%M:%S\"}\nchannels: {x: {column: x, unit: um}, y: {column: y, unit: "
      "degC}}\n";
  const ReadRecord read = read_text_of(
      "t;x;y;mark\n11:58:17;;;started\n11:59:00;1;20;\n12:00:00;2;;\n12:00:00;;;button\n11:59:58;---;---;button\n12:01:00;;"
      "21;\n"
      "13:30:00;---;;\n14:00:00;4;22;\n14:00:07;;;Logged\nend;;;\n",
      map);
  expect_times(read.record, {0.0, 60.0, 120.0, 7260.0});
  expect_values(read.record, "x_um", {1, 2, kMissing, 4});
  expect_values(read.record, "y_degC", {20, kMissing, 21, 22});
  EXPECT_EQ(read.n_without_reading, 6u);
  EXPECT_THAT(read.notes, Contains(HasSubstr("rows in which no channel has a reading are left out: 6 (lines 2 to 11)")));
  // A row that was cut short is still refused.
  EXPECT_REFUSED(read_text_of("t;x;y\n11:59:00;1;20\n12:00:00;2;21\n12:01:00;\n", map), ":4:");
}

TEST(MappedRecord, CountsTheTimeOfRowsWithoutAReadingBetweenOthers) {
  const ReadRecord read = read_text_of("x;mark\n;on\n1;\n;a\n;b\n2;\n3;\n;off\n",
                                       "time: {interval: 10 s}\nchannels: {x: {column: x, unit: um}}\n");
  expect_times(read.record, {0.0, 30.0, 40.0});
  EXPECT_EQ(read.n_without_reading, 4u);
}

TEST(MappedRecord, LeavesOutRowsOfMarksForNoReading) {
  std::string text = "t;a;b\n";
  for (int i = 0; i < 20; ++i)
    text += std::to_string(60 * i) + (i >= 17 ? ";888.8;-9999\n" : i == 5 ? ";888.8;21\n" : ";20.5;21\n");
  const ReadRecord read =
      read_text_of(text, "time: {column: t, unit: s}\nchannels: {a: {column: a, unit: degC}, b: {column: b, unit: degC}}\n");
  EXPECT_EQ(read.record.n_samples(), 17u);
  EXPECT_EQ(read.record.time_s.back(), 960.0);
  EXPECT_TRUE(std::isnan(read.record.at("a").values[5]));
  EXPECT_EQ(read.n_without_reading, 3u);
  EXPECT_THAT(read.notes, Contains(HasSubstr("rows that have no other reading are left out: 3")));
}

// A record CSV may say a time alone: the last row of a plan ends it.
TEST(MappedRecord, KeepsRowsWithoutAReadingInRecordsOfOurs) {
  const ReadRecord read = read_record(write_file("plan.csv", "time_s,speed_rpm\n0,1000\n60,\n"), std::nullopt);
  expect_times(read.record, {0.0, 60.0});
  EXPECT_EQ(read.n_without_reading, 0u);
}

TEST(MappedRecord, NotesAClockThatSeemsToHaveBeenSetForward) {
  const std::string text = "t,x\n2024-03-31T01:58:00,1\n2024-03-31T01:59:00,1\n2024-03-31T03:00:00,1\n";
  const ReadRecord naive = read_text_of(text, "time: {column: t}\nchannels: {x: {column: x, unit: um}}\n");
  expect_times(naive.record, {0.0, 60.0, 3720.0});
  EXPECT_THAT(naive.notes, ElementsAre(AllOf(HasSubstr("jumps by 61 min from line 3 to line 4"), HasSubstr("zone"))));
  const ReadRecord there =
      read_text_of(text, "time: {column: t, zone: Europe/Berlin}\nchannels: {x: {column: x, unit: um}}\n");
  expect_times(there.record, {0.0, 60.0, 120.0});
  EXPECT_THAT(there.notes, IsEmpty());
}

struct Bad {
  const char* name;
  const char* text;
  const char* columns;
  std::vector<const char*> message;
};
class BadLog : public ::testing::TestWithParam<Bad> {};
TEST_P(BadLog, IsRefusedWithItsLine) {
  for (const char* part : GetParam().message) {
    EXPECT_THAT([&] { (void)read_text_of(GetParam().text, GetParam().columns); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("log.csv"), HasSubstr(part))));
  }
}
constexpr const char* kPlain = "time: {column: t, unit: s}\nchannels: {x: {column: X, unit: um}}\n";
constexpr const char* kComma = "decimal: \",\"\ntime: {column: t, unit: s}\nchannels: {x: {column: X, unit: um}}\n";
constexpr const char* kClock = "time: {column: t, format: \"%H:%M:%S\"}\nchannels: {x: {column: X, unit: um}}\n";
INSTANTIATE_TEST_SUITE_P(
    All, BadLog,
    ::testing::Values(
        Bad{"no_reading",
            "t;X;mark\n0;;a\n1;;b\n2;5;\n",
            kPlain,
            {"1 rows of data", "In 2 more no channel has a reading (lines 2 to 3)"}},
        Bad{"no_column",
            "a log\nt;Nase;Y\n0;1;2\n1;2;3\n",
            "time: {column: t, unit: s}\nchannels: {x: {column: nase, unit: um}}\n",
            {":2:1: no column 'nase'", "'t', 'Nase', 'Y'", "Did you mean 'Nase'?", "columns.yaml:2"}},
        Bad{"twice", "t;X;X\n0;1;2\n1;2;3\n", kPlain, {":1:1: two columns are called 'X' (columns 2 and 3)", "position: 2"}},
        Bad{"text", "t;X\n0;1\n1;open\n", kPlain, {":3:3: 'open' is not a finite number", "`missing`", "[x]"}},
        Bad{"nan", "t;X\n0;1\n1;nan\n", kPlain, {":3:3: 'nan' is not a finite number"}},
        Bad{"thousands_point", "t;X\n0;1,5\n1;1.234,5\n", kComma, {":3:3:", "thousands separators"}},
        Bad{"thousands_blank", "t;X\n0;1,5\n1;1 234,5\n", kComma, {":3:3:", "thousands separator"}},
        Bad{"thousands_comma", "t;X\n0;1.5\n1;1,234.5\n", kPlain, {":3:3:", "thousands separators"}},
        Bad{"thousands_apostrophe", "t;X\n0;1.5\n1;1'234.5\n", kPlain, {":3:3:", "thousands separator"}},
        Bad{"decimal_comma", "t;X\n0;1\n1;1,5\n", kPlain, {":3:3: '1,5' has a decimal comma"}},
        Bad{"decimal_point", "t;X\n0;1\n1;1.5\n", kComma, {":3:3: '1.5' has a decimal point"}},
        Bad{"cut_short", "t;X\n0;1\n1\n", kPlain, {":3:1: this row has 1 cells, but column 2 is required"}},
        Bad{"doubled", "t;X\n0;1\n1;2\n1;2\n", kPlain, {":4:1: the time of this row is that of line 3"}},
        Bad{"unordered", "t;X\n0;1\n2;2\n1;2\n", kPlain, {":4:1: the time goes back by 1 s from line 3"}},
        Bad{"no_time", "t;X\n0;1\n;2\n", kPlain, {":3:1:", "'' is not a finite number"}},
        Bad{"clock_back", "t;X\n10:00:00;1\n10:00:10;2\n09:59:00;2\n", kClock, {":4:1: the time goes back by 70 s"}},
        Bad{"no_stamp", "t;X\nmonday;1\ntuesday;2\n", kClock, {":2:1: 'monday' is no time of the format '%H:%M:%S'"}},
        Bad{"quote", "t;X\n0;1\n1;\"2\n", kPlain, {":3:1: a quotation mark is opened and not closed"}},
        Bad{"one_row", "t;X\n0;1\n", kPlain, {"1 rows of data"}}, Bad{"empty", "", kPlain, {"no column"}}),
    [](const auto& bad) { return std::string(bad.param.name); });

struct BadMap {
  const char* name;
  const char* columns;
  std::vector<const char*> message;
};
class BadColumns : public ::testing::TestWithParam<BadMap> {};
TEST_P(BadColumns, AreRefusedWithTheirKey) {
  for (const char* part : GetParam().message) {
    EXPECT_THAT([&] { (void)map_of(GetParam().columns); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("columns.yaml:"), HasSubstr(part))));
  }
}
INSTANTIATE_TEST_SUITE_P(
    All, BadColumns,
    ::testing::Values(
        BadMap{"no_time", "channels: {x: {column: X, unit: um}}\n", {"key 'time' is missing"}},
        BadMap{"no_channel", "time: {column: t}\nchannels: {}\n", {"no channel"}},
        BadMap{"unit",
               "time: {column: t}\nchannels: {x: {column: X, unit: A}}\n",
               {":2:", "no channel for 'A'", "[channels.x.unit]"}},
        BadMap{"unknown_unit", "time: {column: t}\nchannels: {x: {column: X, unit: frob}}\n", {"unknown unit 'frob'"}},
        BadMap{"hertz", "time: {column: t}\nchannels: {speed: {column: X, unit: Hz}}\n", {"no channel for 'Hz'", "rpm"}},
        BadMap{"time_unit",
               "time: {column: t, unit: mm}\nchannels: {x: {column: X, unit: um}}\n",
               {"[time.unit]", "wrong unit 'mm'"}},
        BadMap{"zone",
               "time: {column: t, zone: Europe/Entenhausen}\nchannels: {x: {column: X, unit: um}}\n",
               {"is no time zone", "[time.zone]"}},
        BadMap{"zone_without_date",
               "time: {column: t, format: \"%H:%M\", zone: UTC}\nchannels: {x: {column: X, unit: um}}\n",
               {"a zone requires stamps with a date"}},
        BadMap{"two_times",
               "time: {column: t, interval: 1 s}\nchannels: {x: {column: X, unit: um}}\n",
               {"one of `column` (a name), `position` (from 1) and `interval`"}},
        BadMap{"number_and_stamp",
               "time: {column: t, unit: s, format: \"%H\"}\nchannels: {x: {column: X, unit: um}}\n",
               {"exclude each other", "[time.format]"}},
        BadMap{"column_and_position",
               "time: {column: t}\nchannels: {x: {column: X, position: 2, unit: um}}\n",
               {"one of `column`"}},
        BadMap{"name_without_header",
               "header_line: none\ntime: {column: t}\nchannels: {x: {position: 2, unit: um}}\n",
               {"write `position` (from 1) instead"}},
        BadMap{"factor",
               "time: {column: t}\nchannels: {x: {column: X, unit: um, factor: 0}}\n",
               {"would make every reading 0"}},
        BadMap{"offset_unit",
               "time: {column: t}\nchannels: {x: {column: X, unit: um, offset: 3 K}}\n",
               {"[channels.x.offset]", "wrong unit 'K'"}},
        BadMap{"typo",
               "time: {column: t}\nseperator: \";\"\nchannels: {x: {column: X, unit: um}}\n",
               {"unknown key 'seperator'", "Did you mean 'separator'?"}}),
    [](const auto& bad) { return std::string(bad.param.name); });

}  // namespace
}  // namespace driftwright::mapped_record_test
