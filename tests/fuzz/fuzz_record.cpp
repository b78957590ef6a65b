// Records, plain and by a map of columns, and the run of a record.

#include <fmt/format.h>

#include "base/mapped_record.hpp"
#include "scenarios/reader/read_columns.hpp"
#include "scenarios/reader/recorded_run.hpp"
#include "tests/fuzz/driver.hpp"
#include "tests/shared/temporary_file.hpp"

using namespace driftwright;

int main(int argc, char** argv) {
  const auto map_of = [](const char* name, const char* yaml) {
    return scenarios::read_columns(ConfigMap::read_file(write_file(fmt::format("fuzz_columns_{}.yaml", name), yaml))
                                       .described_by(scenarios::columns_schema()));
  };
  const ColumnMap by_seconds = map_of("keysight", R"yaml(
missing: ["9.90000000E+37"]
time: {column: Time, format: "%m/%d/%Y %H:%M:%S"}
channels:
  bearing: {column: Chan 101 (C), unit: degC}
  tip_z: {column: Chan 201 (VDC), unit: mm, factor: -0.2, offset: 10 um}
)yaml");
  const ColumnMap by_milliseconds = map_of("graphtec", R"yaml(
missing: [BURNOUT, +++++++]
time: {column: "Date&Time", milliseconds: ms, format: "%Y/%m/%d %H:%M:%S"}
channels:
  nose: {column: CH1, unit: degC}
  ambient: {column: CH2, unit: degC}
)yaml");
  return fuzz::run(
      argc, argv,
      {.name = "record",
       .corpus = {"tests/fuzz/corpus/records", "tests/data/loggers", "scenarios/measured/gantry_table_days.csv"},
       .extensions = {".csv"},
       .words = {"time_s", "time_h", "speed_rpm", "ambient_degC", "_um", ",", ";", "\t", "\"", "#", "\r\n", "degC",
                 "\xEF\xBB\xBF", "\xFF\xFE", "\xE4", "Time", "CH1"},
       .read = [&](const std::filesystem::path& file) {
         for (const ColumnMap* map : {&by_seconds, &by_milliseconds}) {
           try {
             (void)read_record(file.string(), *map);
           } catch (const InputError&) {  // of another logger
           }
         }
         const Record record = read_record(file.string(), std::nullopt).record;
         try {
           (void)scenarios::run_of(record, nullptr, {}, scenarios::Reading::kStrict);
         } catch (const InputError&) {  // no drive in it
         }
         (void)scenarios::run_of(record, nullptr, {}, scenarios::Reading::kLenient);
         (void)record_csv(record);
       }});
}
