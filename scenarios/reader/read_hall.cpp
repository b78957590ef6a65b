#include "scenarios/reader/read_hall.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "base/mapped_record.hpp"
#include "base/quantity.hpp"
#include "scenarios/reader/read_columns.hpp"

namespace driftwright::scenarios {
namespace {

constexpr double kColdestHall_K = 200.0, kHottestHall_K = 400.0;

TimeSeries of_record(const ConfigMap& in, double reference_K) {
  const auto path = std::filesystem::path(in.file()).parent_path() / in.text("csv");  // an absolute path stays
  std::optional<ColumnMap> columns;
  if (const auto map = in.optional_map("columns")) columns = read_columns(*map);
  const Record record = read_record(path.string(), columns).record;
  const Channel& channel = record.at(in.text("channel"));
  in.reject_unknown_keys();
  if (channel.unit != "degC") in.fail("channel", fmt::format("{} is no temperature in degC", channel.header()));
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    const double T_K = channel.values[i] + kZeroCelsius_K;
    if (!(T_K >= kColdestHall_K && T_K <= kHottestHall_K)) {
      throw InputError(fmt::format("{}: {} is missing or outside -73 to 127 degC at {:g} s", record.source, channel.header(),
                                   record.time_s[i]));
    }
  }
  TimeSeries hall{record.time_s, channel.values};
  for (double& value : hall.value) value += kZeroCelsius_K - reference_K;
  return hall;
}

}  // namespace

schema::Key hall_key() {
  using namespace schema;
  const schema::Map record = {.name = "hall",
                              .keys = {compulsory("csv", text(), "a record, relative to the scenario"),
                                       compulsory("channel", text(), "its channel in degC, without the unit"),
                                       schema::optional("columns", schema::map(columns_schema()),
                                                        "how the file is written, where a logger wrote it")},
                              .about = "The hall's temperature from a record."};
  return compulsory(
      "hall",
      Ways{rows({quantity("s"), temperature(kColdestHall_K, kHottestHall_K)}), temperature(kColdestHall_K, kHottestHall_K),
           schema::map(record)},
      "air of the hall: rows of [time, temperature], linear between and constant outside; one temperature; or a record "
      "(docs/cyclograms.md)");
}

TimeSeries read_hall(const ConfigMap& in, double reference_K) {
  if (in.is_map("hall")) return of_record(in.map("hall"), reference_K);
  if (!in.is_list("hall")) return {{0.0}, {in.quantity("hall") - reference_K}};
  TimeSeries hall;
  for (const std::vector<double>& row : in.rows("hall")) {
    if (!hall.time_s.empty() && !(row[0] > hall.time_s.back())) in.fail("hall", "times must increase from row to row");
    hall.time_s.push_back(row[0]);
    hall.value.push_back(row[1] - reference_K);
  }
  return hall;
}

}  // namespace driftwright::scenarios
