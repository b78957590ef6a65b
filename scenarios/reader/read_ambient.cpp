#include "scenarios/reader/read_ambient.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "base/mapped_record.hpp"
#include "base/quantity.hpp"
#include "scenarios/reader/read_columns.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kColdestAmbient_K = 200.0, kHottestAmbient_K = 400.0;

TimeSeries of_record(const ConfigMap& in, double reference_K) {
  const auto path = std::filesystem::path(in.file()).parent_path() / in.text("csv");  // an absolute path is unchanged
  std::optional<ColumnMap> columns;
  if (const auto map = in.optional_map("columns")) columns = read_columns(*map);
  const Record record = read_record(path.string(), columns).record;
  const Channel& channel = record.at(in.text("channel"));
  in.reject_unknown_keys();
  if (channel.unit != "degC") in.fail("channel", fmt::format("{} is no temperature in degC", channel.header()));
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    const double T_K = channel.values[i] + kZeroCelsius_K;
    if (!(T_K >= kColdestAmbient_K && T_K <= kHottestAmbient_K)) {
      throw InputError(fmt::format("{}: {} is missing or outside -73 to 127 degC at {:g} s", record.source, channel.header(),
                                   record.time_s[i]));
    }
  }
  TimeSeries ambient{record.time_s, channel.values};
  for (double& value : ambient.value) value += kZeroCelsius_K - reference_K;
  return ambient;
}

}  // namespace

schema::Key ambient_key() {
  using namespace schema;
  const schema::Map record = {.name = "ambient",
                              .keys = {compulsory("csv", text(), "a record, relative to the scenario"),
                                       compulsory("channel", text(), "its channel in degC, without the unit"),
                                       schema::optional("columns", schema::map(columns_schema()),
                                                        "how the file is written, where a logger wrote it")},
                              .about = "The ambient temperature from a record."};
  return compulsory(
      "ambient",
      Ways{rows({quantity("s"), temperature(kColdestAmbient_K, kHottestAmbient_K)}),
           temperature(kColdestAmbient_K, kHottestAmbient_K), schema::map(record)},
      "ambient air: rows of [time, temperature], linear between and constant outside; one temperature; or a record "
      "(docs/how-to/cyclograms.md)");
}

TimeSeries read_ambient(const ConfigMap& in, double reference_K) {
  if (in.is_map("ambient")) return of_record(in.map("ambient"), reference_K);
  if (!in.is_list("ambient")) return {{0.0}, {in.quantity("ambient") - reference_K}};
  TimeSeries ambient;
  for (const std::vector<double>& row : in.rows("ambient")) {
    if (!ambient.time_s.empty() && !(row[0] > ambient.time_s.back()))
      in.fail("ambient", "times must increase from row to row");
    ambient.time_s.push_back(row[0]);
    ambient.value.push_back(row[1] - reference_K);
  }
  return ambient;
}

}  // namespace driftwright::scenarios
