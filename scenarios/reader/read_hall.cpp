#include "scenarios/reader/read_hall.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "base/mapped_record.hpp"
#include "base/quantity.hpp"
#include "scenarios/reader/read_columns.hpp"

namespace driftwright::scenarios {
namespace {

bool is_hall_temperature(double temperature_K) {
  return temperature_K >= 200.0 && temperature_K <= 400.0;
}

TimeSeries of_record(const ConfigMap& in, double reference_K) {
  const auto path = std::filesystem::path(in.file()).parent_path() / in.text("csv");  // an absolute path stays
  std::optional<ColumnMap> columns;
  if (const auto map = in.optional_map("columns")) columns = read_columns(*map);
  const Record record = read_record(path.string(), columns).record;
  const Channel& channel = record.at(in.text("channel"));
  in.reject_unknown_keys();
  if (channel.unit != "degC") in.fail("channel", fmt::format("{} is no temperature in degC", channel.header()));
  for (std::size_t i = 0; i < record.n_samples(); ++i) {
    if (!is_hall_temperature(channel.values[i] + kZeroCelsius_K)) {
      throw InputError(fmt::format("{}: {} is missing or outside -73 to 127 degC at {:g} s", record.source, channel.header(),
                                   record.time_s[i]));
    }
  }
  TimeSeries hall{record.time_s, channel.values};
  for (double& value : hall.value) value += kZeroCelsius_K - reference_K;
  return hall;
}

}  // namespace

TimeSeries read_hall(const ConfigMap& in, double reference_K) {
  if (in.is_map("hall")) return of_record(in.map("hall"), reference_K);
  TimeSeries hall;
  for (const std::vector<double>& row : in.rows("hall", {"s", "degC"})) {
    if (!hall.time_s.empty() && !(row[0] > hall.time_s.back())) in.fail("hall", "times must increase from row to row");
    if (!is_hall_temperature(row[1])) {
      in.fail("hall",
              fmt::format("{:.0f} degC is no hall temperature; -73 to 127 degC is allowed", row[1] - kZeroCelsius_K));
    }
    hall.time_s.push_back(row[0]);
    hall.value.push_back(row[1] - reference_K);
  }
  return hall;
}

}  // namespace driftwright::scenarios
