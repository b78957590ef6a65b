#include "studies/table_strategy.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/median.hpp"
#include "base/quantity.hpp"
#include "base/record_channel.hpp"
#include "compensation/sensors/thermometers.hpp"

namespace driftwright::studies {
namespace {

constexpr double kExpansionScatter = 0.03;

}  // namespace

TableStrategy repeated(const std::string& name, const std::function<std::vector<Eigen::Matrix3Xd>(int)>& correct) {
  using compensation::PeakErrors;
  TableStrategy strategy{.name = name};
  std::vector<PeakErrors> all;
  for (int k = 0; k < kTableRepetitions; ++k) {
    const std::vector<Eigen::Matrix3Xd> left_m = correct(k);
    all.push_back(compensation::peaks(left_m));
    if (k > 0) continue;
    for (const Eigen::Matrix3Xd& e : left_m) strategy.course_um.push_back(1e6 * e.colwise().norm().maxCoeff());
  }
  for (auto member : {&PeakErrors::x_m, &PeakErrors::y_m, &PeakErrors::z_m, &PeakErrors::position_m}) {
    std::vector<double> values;
    for (const PeakErrors& p : all) values.push_back(p.*member);
    strategy.peak.*member = upper_median(values);
    strategy.worst.*member = *std::max_element(values.begin(), values.end());
  }
  return strategy;
}

ExpansionFactors wrong_expansions(const scenarios::TableSettings& s, int repetition) {
  Random random(static_cast<std::uint64_t>(s.seed), 60 + static_cast<std::uint64_t>(repetition));
  const auto factor = [&] { return std::exp(kExpansionScatter * random.normal()); };
  const double table = factor(), scale_x = factor(), scale_y = factor();
  return {.table = table, .scale_x = scale_x, .scale_y = scale_y};
}

compensation::RingPlan ring_plan(const scenarios::TableSettings& s, double every_s, int repetition) {
  return {.every_s = every_s, .noise_m = s.probe_noise_m, .seed = static_cast<std::uint64_t>(s.seed + 1000 * repetition)};
}

Record table_readings(const scenarios::Scenario& scenario, const MachineRun& felt, const Record& record, int repetition) {
  const scenarios::TableSettings& s = *scenario.table;
  Record thermometers{.source = record.source, .time_s = record.time_s, .channels = {}}, result = record;
  for (const Channel& channel : record.channels) {
    if (channel.unit == "degC") thermometers.channels.push_back(channel);
  }
  Channel ambient{kFeltAmbient, "degC", {}};
  for (double t_s : record.time_s)
    ambient.values.push_back(felt.ambient.at(t_s) + scenario.machine->reference_K - kZeroCelsius_K);
  thermometers.channels.push_back(ambient);
  result.channels.push_back(ambient);
  // Other seeds than those of the rings, since their noise is independent of the thermometers' noise.
  const auto seed = static_cast<std::uint64_t>(s.seed + 1000 * repetition + 500);
  const Record read = compensation::running_mean(
      compensation::as_read(compensation::sampled(thermometers, s.update_s), s.instrument, seed), s.sensor_mean_s);
  for (const Channel& channel : read.channels) {
    Channel& given = changeable_channel(result, channel.name);
    std::size_t row = 0;
    for (std::size_t i = 0; i < record.n_samples(); ++i) {
      while (row + 1 < read.n_samples() && read.time_s[row + 1] <= record.time_s[i] + 1e-6) ++row;
      given.values[i] = channel.values[row];
    }
  }
  return result;
}

std::string instrument_words(const scenarios::TableSettings& s) {
  const std::string mean =
      s.sensor_mean_s > 0.0 ? fmt::format("mean of the last {:g} min", s.sensor_mean_s / 60.0) : "no mean";
  return fmt::format("Thermometers: {:g} K of noise, steps of {:g} K, read every {:g} min, {}.", s.instrument.noise_K,
                     s.instrument.resolution_K, s.update_s / 60.0, mean);
}

std::vector<double> mean_K(const Record& record, const std::vector<std::string>& sensors) {
  std::vector<double> T_K(record.n_samples(), kZeroCelsius_K);
  for (const std::string& sensor : sensors) {
    const std::vector<double>& values = record.at(sensor).values;
    for (std::size_t i = 0; i < T_K.size(); ++i) T_K[i] += values[i] / static_cast<double>(sensors.size());
  }
  return T_K;
}

std::vector<double> TableTraining::at(const std::vector<double>& values) const {
  std::vector<double> found;
  for (std::size_t row : rows) found.push_back(values[row]);
  return found;
}

TableTraining train(const TableCourse& course, const scenarios::TableSettings& s, int repetition) {
  TableTraining training;
  Random random(static_cast<std::uint64_t>(s.seed), 80 + static_cast<std::uint64_t>(repetition));
  double next_s = s.train_from_s;
  for (std::size_t i = 0; i < course.table.time_s.size(); ++i) {
    if (course.table.time_s[i] < next_s - 1e-6) continue;
    next_s += s.every_s;
    training.rows.push_back(i);
    Eigen::Matrix3Xd measured_m = course.rings_m[i];
    for (double& value : measured_m.reshaped()) value += s.probe_noise_m * random.normal();
    training.rings_m.push_back(std::move(measured_m));
  }
  return training;
}

}  // namespace driftwright::studies
