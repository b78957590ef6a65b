// Files of loggers that nobody has described: what is guessed of them, and that the guess as YAML reads them alike. The
// samples in tests/data/loggers mimic:
//   almemo_2590        an Ahlborn ALMEMO 2590 with AMR-Control: Latin-1, semicolons, decimal commas, ranges and comments in
//                      front, date and time apart, -.-- for a sensor that is off
//   catman_ap          HBM catman's ASCII export: tabs, decimal commas, a head, units in a line below the names, time as a
//                      number
//   picolog_6          PicoLog 6: no name over the stamps, which are ISO 8601 with an offset, here in the night in which
//                      clocks are set back
//   wincc_tag_logging  a tag log of WinCC: one tag's value in each row, one tag after the other, written when it changes

#include "studies/logger_import.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/guess_names.hpp"
#include "tests/shared/refused.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::logger_import_test {
namespace {

using ::testing::Contains, ::testing::DoubleNear, ::testing::HasSubstr, ::testing::Pointwise, ::testing::ThrowsMessage;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

void expect_values(const Record& record, const std::string& header, const std::vector<double>& values) {
  ASSERT_NO_THROW((void)record.at(header)) << header;
  const Channel& channel = record.at(header);
  ASSERT_EQ(channel.values.size(), values.size()) << header;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i]))
      EXPECT_TRUE(std::isnan(channel.values[i])) << header << " row " << i;
    else
      EXPECT_NEAR(channel.values[i], values[i], 1e-9 * std::max(1.0, std::abs(values[i]))) << header << " row " << i;
  }
}

/// The guess, after its own YAML has read the file to the same record.
studies::LoggerImport import_sample(const std::string& file, const GuessHints& hints = {}) {
  const std::string path = "tests/data/loggers/" + file;
  studies::LoggerImport guessed = studies::import_logger(path, "", hints);
  const studies::LoggerImport again = studies::import_logger(path, write_file("columns.yaml", yaml_text(guessed.map)), {});
  const Record &a = guessed.read.record, &b = again.read.record;
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t c = 0; c < std::min(a.channels.size(), b.channels.size()); ++c) {
    EXPECT_EQ(a.channels[c].header(), b.channels[c].header());
    expect_values(b, a.channels[c].header(), a.channels[c].values);
  }
  return guessed;
}

TEST(LoggerImport, AlmemoInLatin1WithDateAndTimeApart) {
  const studies::LoggerImport import = import_sample("almemo_2590.csv");
  const Record& record = import.read.record;
  EXPECT_THAT(record.time_s, Pointwise(DoubleNear(1e-9), std::vector<double>{0, 30, 60, 90}));
  EXPECT_EQ(import.map.decimal, ',');
  EXPECT_EQ(import.map.time.format, "%d.%m.%y %H:%M:%S");
  expect_values(record, "m00_degC", {20.5, 20.9, 21.4, 22.0});
  expect_values(record, "m01_degC", {20.4, 20.6, 20.9, kMissing});
  expect_values(record, "m20_um", {0.0, 1.2, 2.5, 4.1});  // mm in the file
  EXPECT_THAT(import.guesses, Contains(HasSubstr("'-.--' are taken to be readings that are missing")));
}

TEST(LoggerImport, CatmanWithUnitsBelowTheNames) {
  const studies::LoggerImport import = import_sample("catman_ap.txt");
  const Record& record = import.read.record;
  EXPECT_THAT(record.time_s, Pointwise(DoubleNear(1e-9), std::vector<double>{0, 1, 2, 3}));
  expect_values(record, "speed_rpm", {0, 2990, 3001, 3000});
  expect_values(record, "t_lager_vorn_degC", {20.1, 20.4, 20.9, 21.3});
  expect_values(record, "ambient_degC", {19.9, 19.9, 20.0, 20.0});
  expect_values(record, "weg_z_um", {0.0, 0.8, 2.1, 3.6});
  EXPECT_THAT(import.guesses, Contains(HasSubstr("'T_Raum' is taken to be the ambient air")));
}

TEST(LoggerImport, PicoLogOverTheEndOfSummerTime) {
  const Record record = import_sample("picolog_6.csv").read.record;
  EXPECT_THAT(record.time_s, Pointwise(DoubleNear(1e-9), std::vector<double>{0, 60, 120, 180}));
  expect_values(record, "front_bearing_last_degC", {25.1, 25.4, 25.8, 26.1});
  expect_values(record, "probe_z_last_um", {0.0, 1.5, 2.9, 4.2});
}

TEST(LoggerImport, WinCcTagsHoldUntilTheyChange) {
  const Record record = import_sample("wincc_tag_logging.csv").read.record;
  // Seconds after 10:00:00 at which a tag was written; between them nothing changed.
  EXPECT_THAT(record.time_s, Pointwise(DoubleNear(1e-9), std::vector<double>{0, 5, 12, 65, 125, 180, 185, 245, 300, 305}));
  expect_values(record, "speed_rpm", {0, 0, 1500, 1500, 1500, 3000, 3000, 3000, 0, 0});
  expect_values(record, "temp_lager_vorn_degC", {kMissing, 20.5, 20.5, 20.75, 21.25, 21.25, 22.0, 23.5, 23.5, 24.25});
}

TEST(LoggerImport, WinCcTagsInEvenSteps) {
  const Record record = import_sample("wincc_tag_logging.csv", {.zone = "", .interval = "", .every = "1 min"}).read.record;
  EXPECT_THAT(record.time_s, Pointwise(DoubleNear(1e-9), std::vector<double>{0, 60, 120, 180, 240, 300, 360}));
  expect_values(record, "speed_rpm", {0, 1500, 1500, 3000, 3000, 0, 0});
  expect_values(record, "temp_lager_vorn_degC", {kMissing, 20.5, 20.75, 21.25, 22.0, 23.5, 24.25});
}

/// The samples of mapped_record_test, whose maps people have written.
TEST(LoggerImport, GuessesWhatWasMappedByHand) {
  const Record keysight = import_sample("keysight_34972a.csv").read.record;
  expect_values(keysight, "chan_103_degC", {kMissing, 20.5, 20.625});
  expect_values(keysight, "chan_201_V", {0.36823663, 0.62819233, 0.38238212});
  EXPECT_THAT(keysight.time_s, Pointwise(DoubleNear(1e-6), std::vector<double>{0.0, 10.0, 20.25}));
  const Record german =
      import_sample("german_latin1.csv", {.zone = "Europe/Berlin", .interval = "", .every = ""}).read.record;
  EXPECT_EQ(german.at("speed_rpm").values.front(), 1500.0);
  EXPECT_EQ(german.at("t3_degC").values.front(), 20.5);
  EXPECT_NEAR(german.at("z_um").values.front(), 12.5, 1e-9);
  const Record simatic = import_sample("simatic_data_log.csv").read.record;
  expect_values(simatic, "speed_rpm", {3000, 3000, 0});
}

// A unit that is a quotient has a '_' in names of records.
TEST(LoggerImport, ReadsQuotientsInNamesOfColumns) {
  const Record record = studies::import_logger(write_file("log.csv",
                                                          "time_s,speed_rpm,feed_mm_min,slope_mm_m,way_mm\n"
                                                          "0,0,100,0.1,1\n60,10,200,0.2,2\n120,10,300,0.3,3\n"),
                                               "", {.zone = "", .interval = "", .every = ""})
                            .read.record;
  expect_values(record, "feed_mm_min", {100.0, 200.0, 300.0});
  expect_values(record, "slope_1", {1e-4, 2e-4, 3e-4});
  expect_values(record, "way_um", {1000.0, 2000.0, 3000.0});
  // a number and a minimum are none
  const Record others = studies::import_logger(write_file("log.csv",
                                                          "time_s,speed_rpm,sensor_1_min,way_mm_min,temp_1_K\n"
                                                          "0,0,1,2,300\n60,10,1,2,301\n120,10,1,2,302\n"),
                                               "", {.zone = "", .interval = "", .every = ""})
                            .read.record;
  EXPECT_EQ(others.find("way"), nullptr);
  EXPECT_EQ(others.find("sensor"), nullptr);
  EXPECT_EQ(others.at("speed_rpm").values.back(), 10.0);
}

/// Measured by others, in records: the units in headers are understood, whatever the columns are called.
TEST(LoggerImport, ReadsRecordsAsTheReaderOfRecordsDoes) {
  const std::string path = "../shared/data/fl_thermal/first_28h.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Record expected = read_record_csv(path);
  const Record record = studies::import_logger(path, "", {}).read.record;
  EXPECT_EQ(record.time_s, expected.time_s);
  ASSERT_EQ(record.channels.size(), expected.channels.size());
  for (const Channel& c : expected.channels) expect_values(record, c.header(), c.values);
}

TEST(LoggerImport, SaysWhatItCannotMakeOut) {
  const auto import = [](const std::string& text) {
    return [=] { (void)studies::import_logger(write_file("log.csv", text), "", {}); };
  };
  EXPECT_THAT(import("a;b\n1;2\n2;3\n3;4\n"), ThrowsMessage<InputError>(HasSubstr("no column holds the time")));
  EXPECT_THAT(import("10:00:00;2\n10:00:01;3\n10:00:02;4\n"),
              ThrowsMessage<InputError>(HasSubstr("there is no line of names")));
  EXPECT_THAT(import("some words\nand others\n"),
              ThrowsMessage<InputError>(HasSubstr("no rows of numbers were recognised")));
}

TEST(LoggerImport, ReadsStampsWithOffsets) {
  for (const char* offset : {"+01:00", " +01:00", "+0100", " CET"}) {
    const std::string text = fmt::format(
        "Zeit;T1 (°C)\n02.11.2026 07:30:00{0};20,1\n02.11.2026 07:30:10{0};20,2\n02.11.2026 07:30:20{0};20,4\n", offset);
    const Record record = studies::import_logger(write_file("log.csv", text), "", {}).read.record;
    EXPECT_THAT(record.time_s, Pointwise(DoubleNear(1e-9), std::vector<double>{0, 10, 20})) << offset;
  }
  EXPECT_REFUSED(
      studies::import_logger(
          write_file("log.csv", "Zeit;T (°C)\n02.11.2026 7h30;20,1\n02.11.2026 7h31;20,2\n02.11.2026 7h32;20,4\n"), "", {}),
      "'Zeit' holds '02.11.2026 7h30'");
}

TEST(LoggerImport, ReadsSwitchesAndClocksInSecondsSince1970) {
  const std::string path =
      write_file("log.csv",
                 "epoch,Spindle,Coolant,T1 (degC),open,note\n1606000000.25,False,off,20.1,No,a\n"
                 "1606000000.5,True,on,20.2,,b\n1606000001.125,TRUE,OFF,20.4,yes,c\n1606000002.25,false,on,20.3,no,d\n");
  const studies::LoggerImport import = studies::import_logger(path, "", {});
  const Record& record = import.read.record;
  EXPECT_THAT(record.time_s, Pointwise(DoubleNear(1e-6), std::vector<double>{0, 0.25, 0.875, 2.0})) << "written in full";
  expect_values(record, "spindle_1", {0, 1, 1, 0});
  expect_values(record, "coolant_1", {0, 1, 0, 1});
  expect_values(record, "open_1", {0, kMissing, 1, 0});
  EXPECT_THAT(import.guesses, Contains(HasSubstr("'Spindle' is a switch")));
  EXPECT_EQ(record.find("note"), nullptr);
  EXPECT_TRUE(import.without_unit.empty());
  const Record again = studies::import_logger(path, write_file("columns.yaml", yaml_text(import.map)), {}).read.record;
  expect_values(again, "spindle_1", {0, 1, 1, 0});
}

TEST(LoggerImport, RefusesASwitchWithOtherWordsInItUnlessItIsLeftOut) {
  const std::string path =
      write_file("log.csv", "time (s),T1 (degC),spindle,note\n0,20.1,on,no\n1,20.2,off,chips\n2,20.3,idle,cleaned\n");
  EXPECT_REFUSED(studies::import_logger(path, "", {}), "'spindle' is a switch in most rows, and contains 'idle' too");
  const studies::LoggerImport import =
      studies::import_logger(path, "", {.zone = "", .interval = "", .every = "", .units = {{"spindle", "none"}}});
  EXPECT_EQ(import.map.channels.size(), 1U) << "a column of words is no switch";
}

TEST(LoggerImport, DoesNotReadWordsOfSwitchesAsTemperatures) {
  EXPECT_THAT(
      [] {
        (void)studies::import_logger(
            write_file("log.csv", "time_s;T1\n0;20,1\n1;off\n2;20,3\n"),
            write_file("columns.yaml",
                       "columns: {time: {column: time_s, unit: s}, decimal: \",\", channels: {t1: {column: "
                       "T1, unit: degC}}}\n"),
            {});
      },
      ThrowsMessage<InputError>(HasSubstr("'off' is not a finite number")));
}

TEST(LoggerImport, TakesUnitsThatTheUserSays) {
  const std::string path = write_file("log.csv",
                                      "time (s),t1,Weg Z,load,n\n0,293.15,0.1,5,0\n1,293.25,0.2,6,1\n"
                                      "2,294.15,0.4,7,2\n");
  const auto with = [&](const std::vector<std::string>& units) {
    return studies::import_logger(path, "",
                                  {.zone = "", .interval = "", .every = "", .units = studies::units_of_columns(units)});
  };
  EXPECT_THAT(with({}).without_unit, ::testing::ElementsAre("t1", "Weg Z", "load", "n"));
  const studies::LoggerImport import = with({"t1=K", "weg_z=mm", "load=none", "n=1"});
  expect_values(import.read.record, "t1_degC", {20.0, 20.1, 21.0});
  expect_values(import.read.record, "weg_z_um", {100.0, 200.0, 400.0});
  EXPECT_EQ(import.read.record.find("load"), nullptr);
  EXPECT_TRUE(import.without_unit.empty());
  EXPECT_THAT([&] { (void)with({"t2=degC"}); }, ThrowsMessage<InputError>(HasSubstr("no column of numbers 't2'")));
  EXPECT_THAT([&] { (void)with({"t1=de"}); }, ThrowsMessage<InputError>(HasSubstr("--unit t1=de")));
  EXPECT_THAT([&] { (void)with({"t1=furlong"}); },
              ThrowsMessage<InputError>(
                  testing::AllOf(HasSubstr("--unit t1=furlong"), HasSubstr("largest unit of that kind is m"))));
  expect_values(with({"t1=m"}).read.record, "t1_um", {293.15e6, 293.25e6, 294.15e6});
  EXPECT_THAT([&] { (void)with({"t1"}); }, ThrowsMessage<InputError>(HasSubstr("a column and its unit are required")));
  EXPECT_THAT([&] { (void)with({"t1=degC", "t1=K"}); }, ThrowsMessage<InputError>(HasSubstr("has the unit degC already")));
}

TEST(LoggerImport, TakesAbsoluteKelvinForTemperatures) {
  const studies::LoggerImport import = studies::import_logger(
      write_file("log.csv", "time [s];T1 (K);dT (K)\n0;293,15;0,1\n10;293,25;0,2\n20;293,40;0,3\n"), "", {});
  expect_values(import.read.record, "t1_degC", {20.0, 20.1, 20.25});
  expect_values(import.read.record, "dt_K", {0.1, 0.2, 0.3});
  EXPECT_THAT(import.guesses, Contains(HasSubstr("'T1 (K)' is taken to be an absolute temperature in kelvin")));
  EXPECT_THAT(import.guesses, Contains(HasSubstr("'dT (K)' is taken to be a difference")));
  EXPECT_THAT(yaml_text(import.map), HasSubstr("unit: \"degC\", offset: -273.15 K"));
}

TEST(LoggerImport, NamesARowOutOfTimeOrderAsSuch) {
  const auto import = [](const std::string& text) {
    return [=] { (void)studies::import_logger(write_file("log.csv", text), "", {}); };
  };
  EXPECT_THAT(import("Zeit;T1 (°C)\n02.11.2026 07:30:00;20,1\n02.11.2026 07:30:20;20,2\n02.11.2026 "
                     "07:30:10;20,3\n02.11.2026 07:30:30;20,4\n"),
              ThrowsMessage<InputError>(
                  testing::AllOf(HasSubstr("log.csv:4:"), HasSubstr("the time goes back by 10 s from line 3"))));
  EXPECT_THAT(import("time [s];T1 (°C)\n0;20,1\n10;20,2\n20;20,2\n15;20,3\n30;20,4\n40;20,5\n"),
              ThrowsMessage<InputError>(
                  testing::AllOf(HasSubstr("log.csv:5:"), HasSubstr("the time goes back by 5 s from line 4"))));
  EXPECT_THAT(import("time_s;T1 (°C)\n0;20,1\n60;20,2\n120;20,2\n90;20,3\n"),
              ThrowsMessage<InputError>(
                  testing::AllOf(HasSubstr("log.csv:5:"), HasSubstr("the time goes back by 30 s from line 4"))));
}

TEST(LoggerImport, TakesTheSpindlesSpeedByItsUnitThenByItsName) {
  const auto speed = [](const std::string& header, const std::string& row) {
    const auto import = studies::import_logger(
        write_file("log.csv", "time [s];" + header + "\n0;" + row + "\n10;" + row + "\n20;" + row + "\n30;" + row + "\n"),
        "", {});
    const Channel* found = import.read.record.find("speed");
    return found ? found->values.front() : -1.0;
  };
  EXPECT_EQ(speed("n [U/min];T1 (°C)", "1500;20.1"), 1500.0);
  EXPECT_EQ(speed("S1 rpm;T1 (°C)", "1500;20.1"), 1500.0);
  EXPECT_EQ(speed("T1 (°C);Drehzahl", "20.1;1500"), 1500.0);
  EXPECT_EQ(speed("T1 (°C);spindle speed", "20.1;1500"), 1500.0);
  EXPECT_EQ(speed("Spindle;Ambient;Speed", "20.1;21.5;1500"), 1500.0) << "the spindle is a thermometer there";
  EXPECT_EQ(speed("Spindle;Ambient", "20.1;21.5"), -1.0) << "alone, too";
  EXPECT_EQ(speed("Spindle;Ambient", "1500;21.5"), 1500.0);
  EXPECT_EQ(speed("Fan [rpm];T1 (°C);n [U/min]", "900;20.1;1500"), 1500.0);
  EXPECT_EQ(speed("Feed speed;T1 (°C)", "900;20.1"), -1.0);
}

TEST(LoggerImport, SaysThatNoColumnIsTheSpeed) {
  const auto guesses = [](const std::string& header) {
    return studies::import_logger(
               write_file("log.csv", "time [s];" + header + "\n0;1500;2\n10;1500;3\n20;1500;3\n30;1500;4\n"), "", {})
        .guesses;
  };
  EXPECT_THAT(guesses("p (bar);T1 (°C)"), Contains(HasSubstr("no column was taken for the spindle speed")));
  EXPECT_THAT(guesses("n [U/min];T1 (°C)"), testing::Not(Contains(HasSubstr("no column was taken"))));
}

TEST(LoggerImport, TakesAmericanTwelveHourClocks) {
  const Record record =
      studies::import_logger(
          write_file("log.csv",
                     "Date Time;T1 (°C)\n03/04/24 11:59:00 AM;20.1\n03/04/24 12:00:00 PM;20.2\n03/04/24 01:00:00 PM;20.3\n"),
          "", {})
          .read.record;
  EXPECT_THAT(record.time_s, Pointwise(DoubleNear(1e-9), std::vector<double>{0, 60, 3660}));
}

TEST(LoggerImport, ReadsNamesUnitsAndKindsInThreeLines) {
  const Record record =
      studies::import_logger(
          write_file("log.csv",
                     "Name;Bearing;Drive;Speed\nUnit;°C;°C;1/min\nDate/Time;Value;Value;Value\n04.03.2024 "
                     "11:45:00,000;20,00;21,50;0\n"
                     "04.03.2024 11:46:00,000;20,10;21,55;2000\n04.03.2024 11:47:00,000;20,20;21,60;2000\n"),
          "", {})
          .read.record;
  expect_values(record, "bearing_degC", {20.0, 20.1, 20.2});
  expect_values(record, "drive_degC", {21.5, 21.55, 21.6});
  expect_values(record, "speed_rpm", {0, 2000, 2000});
}

TEST(LoggerImport, RefusesASecondTimeThatTellsOthers) {
  const std::string rows = "0;20.0;0;21.5\n60;20.1;120;21.6\n120;20.2;240;21.7\n180;20.3;;\n";
  EXPECT_REFUSED(studies::import_logger(write_file("log.csv", "Time (s);Head (C);Time (s);Amb (C)\n" + rows), "", {}),
                 "column 3 'Time (s)' is a time too, and another than that of column 1");
}

TEST(LoggerImport, SaysReadingsThatAreNone) {
  std::string text = "time [s];T1 (°C);n [U/min]\n";
  for (int i = 0; i < 30; ++i)
    text += fmt::format("{};{};1500\n", 60 * i, i >= 10 && i < 20 ? "-273.15" : fmt::format("{:.2f}", 20 + 0.1 * i));
  const studies::LoggerImport import = studies::import_logger(write_file("log.csv", text), "", {});
  EXPECT_THAT(import.read.notes,
              Contains(HasSubstr("t1_degC reads -273.15 degC in 10 rows from 10 to 19 min: an open or broken sensor")));
  EXPECT_TRUE(std::isnan(import.read.record.at("t1_degC").values[15]));
  EXPECT_NEAR(import.read.record.at("t1_degC").values[20], 22.0, 1e-9);
}

TEST(LoggerImport, SaysThatAWorkbookIsNoText) {
  EXPECT_REFUSED(studies::import_logger(write_file("log.xlsx", std::string("PK\x03\x04 of a zip archive")), "", {}),
                 "log.xlsx", "save its sheet as CSV");
}

TEST(LoggerImport, NamesATagThatNeverComes) {
  const std::string map =
      write_file("map.yaml",
                 "columns:\n  decimal: \",\"\n  time: {column: TimeString, format: \"%d.%m.%Y %H:%M:%S\"}\n"
                 "  tags: {column: VarName, value: VarValue}\n  channels:\n    oil: {tag: Temp_Lager_vorm, unit: degC}\n");
  EXPECT_REFUSED(studies::import_logger("tests/data/loggers/wincc_tag_logging.csv", map, {}), "no tag 'Temp_Lager_vorm'");
}

TEST(LoggerImport,
     CellsAndHeadersOfAMegabyteAreNoneOfNumbersStampsAndUnits) {  // std::regex goes as deep as its text is long
  const std::string digits(1'000'000, '1'), letters(1'000'000, 'x');
  for (const std::string& first : {digits + ",5", digits + ":59", letters + " [K] " + letters, digits + " CET"}) {
    std::string text = "time;" + first + "\n";
    for (int i = 0; i < 20; ++i) text += std::to_string(i) + ";" + first + "\n";
    try {
      (void)studies::import_logger(write_file("long.csv", text), "", {});
    } catch (const InputError&) {  // it may say that it is no record
    }
  }
  EXPECT_EQ(words_of_header(letters.substr(0, 500) + " [K]", "").unit, "K");
}

TEST(GuessNames, TakesUnitsOutOfHeaders) {
  const auto expect = [](const char* header, const char* name, const char* unit) {
    const HeaderWords words = words_of_header(header, "");
    EXPECT_EQ(words.name, name) << header;
    EXPECT_EQ(words.unit, unit) << header;
  };
  expect("T3 (°C)", "T3", "degC");
  expect("Drehzahl [U/min]", "Drehzahl", "rpm");
  expect("M00: °C", "M00:", "degC");
  expect("Celsius(°C)", "Celsius", "degC");
  expect("weg_um", "weg", "um");
  expect("Temp, °F (LGR S/N: 10432, LBL: headstock)", "Temp", "degF");
  expect("T_head_Avg(1)", "T_head_Avg(1)", "");
  expect("Achse C", "Achse C", "");  // an axis, not a temperature
  EXPECT_EQ(channel_name("Lager vörn (Ø)", 3), "lager_voern");
  EXPECT_EQ(channel_name("°", 3), "channel_3");
}

}  // namespace
}  // namespace driftwright::logger_import_test
