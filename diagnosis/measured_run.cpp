#include "diagnosis/measured_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/quantity.hpp"
#include "diagnosis/record_faults.hpp"
#include "diagnosis/stuck_sensor.hpp"
#include "diagnosis/unit_check.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kHallKnots_s = 600.0;      // films pass on nothing faster
constexpr double kJitter = 0.01;            // of the top speed: no change of the drive
constexpr int kSaturatedRows = 10;          // at the largest or smallest value of all
constexpr std::ptrdiff_t kFewestLeft = 20;  // readings of a channel that was stuck for a while

/// Piecewise linear least squares on knots; keeps a recorded hall's slow course and drops its noise.
TimeSeries smoothed(const std::vector<double>& time_s, const std::vector<double>& value) {
  std::vector<double> t, v;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!std::isnan(value[i])) {
      t.push_back(time_s[i]);
      v.push_back(value[i]);
    }
  }
  const double length_s = t.back() - t.front();
  const int n_pieces = std::max(1, std::min(static_cast<int>(length_s / kHallKnots_s), static_cast<int>(t.size()) / 3));
  const double width_s = length_s / n_pieces;
  Eigen::MatrixXd hats = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(t.size()) + n_pieces - 1, n_pieces + 1);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(hats.rows());
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double x = width_s > 0.0 ? (t[i] - t.front()) / width_s : 0.0;
    const int k = std::clamp(static_cast<int>(x), 0, n_pieces - 1);
    hats(static_cast<Eigen::Index>(i), k) = 1.0 - (x - k);
    hats(static_cast<Eigen::Index>(i), k + 1) = x - k;
    rhs[static_cast<Eigen::Index>(i)] = v[i];
  }
  for (int k = 1; k < n_pieces; ++k) {  // a light hand on curvature bridges gaps
    const auto row = static_cast<Eigen::Index>(t.size()) + k - 1;
    hats(row, k - 1) = hats(row, k + 1) = 0.05;
    hats(row, k) = -0.1;
  }
  const Eigen::VectorXd knots = hats.colPivHouseholderQr().solve(rhs);
  TimeSeries series;
  for (int k = 0; k <= n_pieces; ++k) {
    series.time_s.push_back(t.front() + k * width_s);
    series.value.push_back(knots[k]);
  }
  if (series.time_s.size() > 1 && !(series.time_s[1] > series.time_s[0])) return {{t.front()}, {knots[0]}};
  return series;
}

/// Sections of constant drive, each row's from its time on.
Cyclogram cyclogram_of(const Record& record, const std::vector<double>& time_s, const std::string& path) {
  const Channel* speed = record.find("speed");
  if (!speed) {
    throw InputError(
        fmt::format("{}: no channel speed_rpm; a diagnosis wants to know what drove the machine. Channels: {}", path, [&] {
          std::vector<std::string> names;
          for (const Channel& c : record.channels) names.push_back(c.header());
          return fmt::format("{}", fmt::join(names, ", "));
        }()));
  }
  if (speed->unit != "rpm") throw InputError(fmt::format("{}: channel speed is in {}; rpm is wanted", path, speed->unit));
  const Channel* feeds[] = {record.find("feed_x"), record.find("feed_y"), record.find("feed_z")};
  const Channel* cutting = record.find("cutting_power");
  Cyclogram cyclogram;
  double top_rpm = 0.0;
  for (double rpm : speed->values) top_rpm = std::isnan(rpm) ? top_rpm : std::max(top_rpm, rpm);
  const auto known = std::find_if(speed->values.begin(), speed->values.end(), [](double rpm) { return !std::isnan(rpm); });
  if (known == speed->values.end()) throw InputError(fmt::format("{}: channel speed_rpm is empty", path));
  double last_rpm = *known;  // before its first reading as at it
  for (std::size_t i = 0; i + 1 < time_s.size(); ++i) {
    Drive drive;
    if (!std::isnan(speed->values[i])) last_rpm = speed->values[i];
    if (!(last_rpm >= 0.0)) {
      throw InputError(fmt::format("{}: speed {:g} rpm at {:g} s; speeds are positive, whatever the direction", path,
                                   last_rpm, time_s[i]));
    }
    const double held_rpm = cyclogram.sections.empty() ? last_rpm : cyclogram.sections.back().drive.speed_rpm;
    const bool is_jitter = held_rpm > 0.0 && last_rpm > 0.0 && std::abs(last_rpm - held_rpm) <= kJitter * top_rpm;
    drive.speed_rpm = is_jitter ? held_rpm : last_rpm;
    for (int a = 0; a < 3; ++a) {
      if (feeds[a] && !std::isnan(feeds[a]->values[i]))
        drive.feed_m_s[static_cast<std::size_t>(a)] = feeds[a]->values[i] / 60e3;
    }
    if (cutting && !std::isnan(cutting->values[i])) drive.cutting_power_W = cutting->values[i];
    const double length_s = time_s[i + 1] - time_s[i];
    if (!cyclogram.sections.empty() && cyclogram.sections.back().drive == drive) {
      cyclogram.sections.back().duration_s += length_s;
    } else {
      cyclogram.sections.push_back({length_s, drive});
    }
  }
  return cyclogram;
}

/// The hall drives the machine: in the wrong unit it spoils every channel.
void refuse_foreign_hall(const Channel& ambient, const TimeSeries& hall, double reference_C, const std::string& path) {
  const auto [low, high] = std::minmax_element(hall.value.begin(), hall.value.end());
  const auto unit = foreign_temperature(ambient.values, reference_C + *low, reference_C + *high);
  if (!unit) return;
  const auto first = std::find_if(ambient.values.begin(), ambient.values.end(), [](double v) { return !std::isnan(v); });
  throw InputError(
      fmt::format("{}: {} looks like {}: it begins with {:g}, and the scenario's hall is {:g} to {:g} degC; "
                  "write it in degC",
                  path, ambient.header(), *unit, *first, reference_C + *low, reference_C + *high));
}

/// Most rows in a row at a value.
int run_at(const std::vector<double>& values, double value) {
  int longest = 0, run = 0;
  for (double v : values) {
    run = v == value ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

bool same_kind(const std::string& record_unit, const std::string& output_unit) {
  if (output_unit == "K") return record_unit == "degC" || record_unit == "K";
  if (output_unit == "m") return record_unit == "um" || record_unit == "mm";
  return record_unit == "urad";
}

/// Looks at a channel for what no model is to blame for, and takes out of its values what is not to be compared.
/// @param time_s  from the start of the record
void inspect(const Record& record, const std::vector<double>& time_s, Channel& channel, std::vector<DataFinding>& findings) {
  const auto n_readings = [&] {
    return std::count_if(channel.values.begin(), channel.values.end(), [](double v) { return !std::isnan(v); });
  };
  const auto n_there = n_readings();
  if (n_there < 3) {
    findings.push_back({channel.name, fmt::format("{} has {} readings; it is left out", channel.name, n_there), true});
    return;
  }
  const auto less = [](double a, double b) { return std::isnan(b) ? !std::isnan(a) : a < b; };
  const double low = *std::min_element(channel.values.begin(), channel.values.end(), less);
  double high = low;
  for (double v : channel.values) high = v > high ? v : high;
  if (low == high) {
    findings.push_back(
        {channel.name,
         fmt::format("{} is stuck: all {} readings are {:g} {}; it is left out", channel.name, n_there, low, channel.unit),
         true});
    return;
  }
  const auto n_missing = static_cast<std::ptrdiff_t>(channel.values.size()) - n_there;
  if (n_missing > 0)
    findings.push_back(
        {channel.name, fmt::format("{} misses {} of {} readings", channel.name, n_missing, channel.values.size()), false});
  const double quantum = quantum_of(channel.values);
  for (const StuckStretch& s : stuck_stretches(record, channel, quantum)) {
    const double value = channel.values[s.first];
    const std::string when = s.last + 1 == channel.values.size()
                                 ? fmt::format("from {:.0f} min on", time_s[s.first] / 60.0)
                                 : fmt::format("from {:.0f} to {:.0f} min", time_s[s.first] / 60.0, time_s[s.last] / 60.0);
    const std::string why =
        s.neighbour.empty()
            ? fmt::format("stuck or saturated: {} equal readings, though they have no coarse step", s.last - s.first + 1)
            : fmt::format("stuck: as {} goes, it should have moved by {:.2g} {}", s.neighbour, s.missed,
                          channel.unit == "degC" ? "K" : channel.unit);
    for (std::size_t i = s.first; i <= s.last; ++i) channel.values[i] = std::nan("");
    const bool leaves_out = n_readings() < std::max<std::ptrdiff_t>(kFewestLeft, n_there / 5);
    findings.push_back({channel.name,
                        fmt::format("{} stands still at {:g} {} {} ({}); {}", channel.name, value, channel.unit, when, why,
                                    leaves_out ? "too little else is there: it is left out" : "these readings are left out"),
                        leaves_out});
    if (leaves_out) return;
  }
  const bool is_fine = quantum == 0.0 || dithers(channel.values);  // else equal readings mean nothing
  if (const double limit = run_at(channel.values, high) >= run_at(channel.values, low) ? high : low;
      is_fine && run_at(channel.values, limit) >= kSaturatedRows) {
    findings.push_back({channel.name,
                        fmt::format("{} stays {} rows at its limit of {:g} {}: saturated; it is left out", channel.name,
                                    run_at(channel.values, limit), limit, channel.unit),
                        true});
  }
}

}  // namespace

const MeasuredChannel* MeasuredRun::find(const std::string& channel) const {
  for (const MeasuredChannel& c : channels) {
    if (c.name == channel) return &c;
  }
  return nullptr;
}

void set_grid(MeasuredRun& run) {
  constexpr int kFiner = 4, kIntervals = 6;  // of so many intervals after a change
  run.grid_s.clear();
  run.row_in_grid.clear();
  int since = 0;  // intervals since the last change
  for (std::size_t i = 0; i < run.time_s.size(); ++i) {
    run.row_in_grid.push_back(static_cast<Eigen::Index>(run.grid_s.size()));
    run.grid_s.push_back(run.time_s[i]);
    if (i + 1 == run.time_s.size()) break;
    const bool changes = i == 0 || !(run.cyclogram.drive(run.time_s[i]) == run.cyclogram.drive(run.time_s[i - 1]));
    since = changes ? 0 : since + 1;
    if (since >= kIntervals) continue;
    for (int k = 1; k < kFiner; ++k) run.grid_s.push_back(run.time_s[i] + k * (run.time_s[i + 1] - run.time_s[i]) / kFiner);
  }
}

MeasuredRun read_measured(const std::string& path, const scenarios::MachineModel& model, const solver::Outputs& outputs) {
  const Record whole = read_record_csv(path);
  if (whole.n_samples() < 3) {
    throw InputError(
        fmt::format("{}: {} rows; a diagnosis wants at least three, and rather a hundred", path, whole.n_samples()));
  }
  MeasuredRun run;
  run.path = path;
  run.name = std::filesystem::path(path).stem().string();
  for (char& c : run.name) {  // it may become the name of a cyclogram
    if (!is_name(std::string(1, c))) c = '_';
  }
  const Record record = without_spikes(without_holes(whole, run.findings), run.findings);
  for (double t_s : record.time_s) run.time_s.push_back(t_s - record.time_s.front());
  run.cyclogram = cyclogram_of(record, run.time_s, path);
  run.cyclogram.name = run.name;
  set_grid(run);
  run.hall = model.hall;
  const double reference_C = model.reference_K - kZeroCelsius_K;
  const Channel* ambient = record.find("ambient");
  for (std::size_t o = 0; !ambient && o < outputs.name.size(); ++o) {  // a thermometer in the hall does as well
    if (outputs.hall[static_cast<Eigen::Index>(o)] == 1.0) ambient = record.find(outputs.name[o]);
  }
  if (ambient) {
    const auto n_readings =
        std::count_if(ambient->values.begin(), ambient->values.end(), [](double v) { return !std::isnan(v); });
    if (ambient->unit != "degC") {
      throw InputError(fmt::format("{}: channel {} is in {}; degC is wanted", path, ambient->name, ambient->unit));
    }
    if (n_readings > 0) {
      refuse_foreign_hall(*ambient, model.hall, reference_C, path);
      std::vector<double> hall_K;
      for (double v : ambient->values) hall_K.push_back(v - reference_C);
      run.hall = smoothed(run.time_s, hall_K);
      run.has_ambient = true;
    }
  }
  if (!run.has_ambient) {
    run.findings.push_back({"ambient", "the record has no hall temperature (ambient_degC); the scenario's is taken", false});
  }
  for (std::size_t o = 0; o < outputs.name.size(); ++o) {
    const Channel* recorded = record.find(outputs.name[o]);
    if (!recorded) continue;
    if (run.has_ambient && outputs.hall[static_cast<Eigen::Index>(o)] == 1.0) continue;
    if (!same_kind(recorded->unit, outputs.unit[o])) {
      throw InputError(fmt::format("{}: channel {} is in {}, but the scenario's {} is a {}", path, recorded->name,
                                   recorded->unit, recorded->name,
                                   outputs.unit[o] == "K"   ? "temperature (degC)"
                                   : outputs.unit[o] == "m" ? "displacement (um)"
                                                            : "tilt (urad)"));
    }
    const std::size_t n_before = run.findings.size();
    Channel channel = *recorded;
    inspect(record, run.time_s, channel, run.findings);
    const bool left_out = std::any_of(run.findings.begin() + static_cast<std::ptrdiff_t>(n_before), run.findings.end(),
                                      [](const DataFinding& f) { return f.leaves_out; });
    if (left_out) continue;
    MeasuredChannel measured{channel.name, static_cast<int>(o), outputs.unit[o], {}, 0.0, channel.unit};
    const double scale = outputs.unit[o] == "K" ? 1.0 : channel.unit == "mm" ? 1e-3 : 1e-6;
    const double offset = channel.unit == "degC" ? reference_C : 0.0;
    measured.value.resize(static_cast<Eigen::Index>(run.time_s.size()));
    for (std::size_t i = 0; i < run.time_s.size(); ++i) {
      measured.value[static_cast<Eigen::Index>(i)] = scale * (channel.values[i] - offset);
    }
    for (std::size_t i = 0; outputs.unit[o] != "K" && i < run.time_s.size(); ++i) {
      // at the very moment of a change, and of the start, it is open whether what follows speed at once has jumped
      const double before_rpm = i == 0 ? 0.0 : run.cyclogram.speed_rpm(run.time_s[i - 1]);
      if (run.cyclogram.speed_rpm(run.time_s[i]) == before_rpm) continue;
      measured.value[static_cast<Eigen::Index>(i)] = std::nan("");
    }
    measured.quantum = scale * quantum_of(recorded->values);
    run.channels.push_back(std::move(measured));
  }
  std::vector<std::string> unknown;
  for (const Channel& c : record.channels) {
    const bool is_input =
        c.name == "speed" || c.name == "ambient" || c.name.starts_with("feed_") || c.name == "cutting_power";
    if (!is_input && std::find(outputs.name.begin(), outputs.name.end(), c.name) == outputs.name.end())
      unknown.push_back(c.header());
  }
  if (!unknown.empty()) {
    run.findings.push_back(
        {"", fmt::format("the scenario knows no sensor or displacement called {}; not compared", fmt::join(unknown, ", ")),
         false});
  }
  if (run.channels.empty()) {
    std::string why;
    for (const DataFinding& f : run.findings) {
      if (f.leaves_out) why += "; " + f.what;
    }
    throw InputError(
        fmt::format("{}: no channel to compare; the scenario's are called {}{}", path, fmt::join(outputs.name, ", "), why));
  }
  return run;
}

}  // namespace driftwright::diagnosis
