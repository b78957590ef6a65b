// From a record to a run, step by step; the helpers serve this one course and nothing else.
#include "diagnosis/measured_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/median.hpp"
#include "base/normal.hpp"
#include "base/quantity.hpp"
#include "base/record_channel.hpp"
#include "diagnosis/record_faults.hpp"
#include "diagnosis/stuck_sensor.hpp"
#include "effects/recorded_column.hpp"
#include "scenarios/reader/felt_run.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kAmbientKnots_s = 600.0;     // largest distance
constexpr double kAmbientKnown_K = 0.003;     // a smaller rest of the course is ignored
constexpr double kMostNoise_K = 0.1;          // largest noise of an ambient thermometer
constexpr std::size_t kReadingsOfStart = 24;  // readings that determine the ambient at the record's start
constexpr int kLongerAtLimit = 2;             // ratio of equal readings at the limit to those at any other value
constexpr int kSaturatedRows = 10;            // least equal rows at the largest or smallest value
constexpr int kMostColumns = 6;               // most columns that no effect uses; each may drive the machine at each body
constexpr std::ptrdiff_t kFewestLeft = 20;    // least readings of a channel that was stuck for a while

/// The existing readings of a series.
struct Readings {
  std::vector<double> time_s, value;
};

/// Piecewise linear least squares on evenly spaced knots.
TimeSeries on_knots(const Readings& r, int n_pieces) {
  const double length_s = r.time_s.back() - r.time_s.front(), width_s = length_s / n_pieces;
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(n_pieces + 1, n_pieces + 1);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n_pieces + 1);
  for (std::size_t i = 0; i < r.time_s.size(); ++i) {
    const double x = width_s > 0.0 ? (r.time_s[i] - r.time_s.front()) / width_s : 0.0;
    const int k = std::clamp(static_cast<int>(x), 0, n_pieces - 1);
    const Eigen::Vector2d hats(1.0 - (x - k), x - k);
    square.block<2, 2>(k, k) += hats * hats.transpose();
    rhs.segment<2>(k) += r.value[i] * hats;
  }
  for (int k = 1; k < n_pieces; ++k) {  // a small penalty on curvature bridges gaps
    const Eigen::Vector3d curvature(0.05, -0.1, 0.05);
    square.block<3, 3>(k - 1, k - 1) += curvature * curvature.transpose();
  }
  square.diagonal().array() += 1e-12;
  const Eigen::VectorXd knots = square.llt().solve(rhs);
  TimeSeries series;
  for (int k = 0; k <= n_pieces; ++k) {
    series.time_s.push_back(r.time_s.front() + k * width_s);
    series.value.push_back(knots[k]);
  }
  if (series.time_s.size() > 1 && !(series.time_s[1] > series.time_s[0])) return {{r.time_s.front()}, {knots[0]}};
  return series;
}

double rms_beside(const Readings& r, const TimeSeries& series) {
  double sum = 0.0;
  for (std::size_t i = 0; i < r.time_s.size(); ++i) sum += std::pow(r.value[i] - series.at(r.time_s[i]), 2);
  return std::sqrt(sum / static_cast<double>(r.time_s.size()));
}

/// Standard deviation of white noise, by second differences, which a smooth course hardly affects.
double white_noise(const Readings& r) {
  double sum = 0.0;
  for (std::size_t i = 2; i < r.value.size(); ++i) sum += std::pow(r.value[i] - 2.0 * r.value[i - 1] + r.value[i - 2], 2);
  return r.value.size() < 3 ? 0.0 : std::sqrt(sum / (6.0 * static_cast<double>(r.value.size() - 2)));
}

/// The same by the median, so that a single open door, or an instrument's steps, have no effect.
double usual_noise(const Readings& r) {
  std::vector<double> bends;
  for (std::size_t i = 2; i < r.value.size(); ++i)
    bends.push_back(std::abs(r.value[i] - 2.0 * r.value[i - 1] + r.value[i - 2]));
  return upper_median(std::move(bends)) / (kNormalMedian * std::sqrt(6.0));
}

/// As recorded, except the first reading: a machine at rest has the mean temperature of the air, not that of its last
/// gust.
TimeSeries gusty(const Readings& r) {
  TimeSeries series{r.time_s, r.value};
  const std::size_t n_readings = std::min(r.time_s.size(), kReadingsOfStart);
  const auto n = static_cast<double>(n_readings);
  double t = 0.0, v = 0.0, tt = 0.0, tv = 0.0;
  for (std::size_t i = 0; i < n_readings; ++i) {
    const double since_s = r.time_s[i] - r.time_s.front();
    t += since_s / n;
    v += r.value[i] / n;
    tt += since_s * since_s / n;
    tv += since_s * r.value[i] / n;
  }
  series.value.front() = v - t * (tv - t * v) / (tt - t * t);  // of the straight line through the first readings
  return series;
}

/// Marks the knots between two others that a straight line misses. Source: Douglas & Peucker, Cartographica 10 (1973)
/// 112-122.
void keep_bends(const TimeSeries& s, std::size_t first, std::size_t last, double within, std::vector<char>& kept) {
  std::size_t farthest = first;
  double most = within;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double share = (s.time_s[i] - s.time_s[first]) / (s.time_s[last] - s.time_s[first]);
    const double off = std::abs(s.value[i] - s.value[first] - share * (s.value[last] - s.value[first]));
    if (off > most) {
      most = off;
      farthest = i;
    }
  }
  if (farthest == first) return;
  kept[farthest] = 1;
  keep_bends(s, first, farthest, within, kept);
  keep_bends(s, farthest, last, within, kept);
}

/// A series with as few of its knots as are accurate: an integrator stops at each knot.
TimeSeries with_few_knots(const TimeSeries& s, double within) {
  std::vector<char> kept(s.time_s.size(), 0);
  kept.front() = kept.back() = 1;
  keep_bends(s, 0, s.time_s.size() - 1, within, kept);
  TimeSeries few;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) continue;
    few.time_s.push_back(s.time_s[i]);
    few.value.push_back(s.value[i]);
  }
  return few;
}

/// The readings that exist.
Readings present_readings(const std::vector<double>& time_s, const std::vector<double>& value) {
  Readings r;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (std::isnan(value[i])) continue;
    r.time_s.push_back(time_s[i]);
    r.value.push_back(value[i]);
  }
  return r;
}

/// The resolution of a thermometer; 0: none, or not visible, as for a constant temperature.
double seen_step(const std::vector<double>& value) {
  constexpr std::size_t kFewestValues = 3;
  return std::set<double>(value.begin(), value.end()).size() < kFewestValues ? 0.0 : quantum_of(value);
}

/// A recorded ambient without its noise, but with its whole course: the knots are as far apart as the missed part is
/// noise, or one per reading if necessary. Otherwise a machine that starts at the ambient would start wrong. Changes
/// between readings beyond the thermometer's noise are air (wind, a door), which warms and cools the machine. Requires at
/// least one reading.
TimeSeries smoothed(const Readings& r) {
  const double noise_K = white_noise(r);
  if (usual_noise(r) > kMostNoise_K + 0.5 * quantum_of(r.value)) return gusty(r);
  const double enough_K = std::max(kAmbientKnown_K, 1.1 * noise_K), length_s = r.time_s.back() - r.time_s.front();
  const int n_readings = static_cast<int>(r.time_s.size());
  for (int n_pieces = std::max(1, static_cast<int>(length_s / kAmbientKnots_s)); 3 * n_pieces <= n_readings; n_pieces *= 2) {
    const TimeSeries series = on_knots(r, n_pieces);
    if (rms_beside(r, series) <= enough_K) return with_few_knots(series, 2.0 * kAmbientKnown_K);
  }
  // If rows are too far apart to separate noise and course: as recorded. An error of a few knots would act as heat in
  // each body in the air.
  return n_readings < 3 ? on_knots(r, 1) : with_few_knots({r.time_s, r.value}, 2.0 * kAmbientKnown_K);
}

/// Longest run of equal values, among those that are selected.
template <class LookedAt>
int most_equal(const std::vector<double>& values, const LookedAt& looked_at) {
  int longest = 0, run = 0;
  double last = std::nan("");
  for (double v : values) {
    run = !looked_at(v) ? 0 : v == last ? run + 1 : 1;
    last = v;
    longest = std::max(longest, run);
  }
  return longest;
}

bool same_kind(const std::string& record_unit, const std::string& output_unit) {
  if (output_unit == "K") return is_temperature_unit(record_unit);
  if (output_unit == "m") return record_unit == "um" || record_unit == "mm";
  return record_unit == "urad";
}

/// Checks a channel for faults that are not the model's, and removes values that must not be compared.
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
                        fmt::format("{} stays at {:g} {} {} ({}); {}", channel.name, value, channel.unit, when, why,
                                    leaves_out ? "too little else is there: it is left out" : "these readings are left out"),
                        leaves_out});
    if (leaves_out) return;
  }
  const bool is_fine = quantum == 0.0 || dithers(channel.values);  // otherwise equal readings mean nothing
  const auto rows_at = [&](double value) { return most_equal(channel.values, [=](double v) { return v == value; }); };
  const double limit = rows_at(high) >= rows_at(low) ? high : low;
  const int n_at_limit = rows_at(limit),
            n_elsewhere = most_equal(channel.values, [=](double v) { return v != low && v != high; });
  if (is_fine && n_at_limit >= kSaturatedRows && n_at_limit > kLongerAtLimit * n_elsewhere) {
    findings.push_back({channel.name,
                        fmt::format("{} stays {} rows at its limit of {:g} {}: saturated; it is left out", channel.name,
                                    n_at_limit, limit, channel.unit),
                        true});
  }
}

/// Keeps the columns that the scenario's effects require, and other changing ones if there are only a few.
void keep_columns(MeasuredRun& run, const scenarios::MachineModel& model) {
  const std::vector<std::string> wanted = scenarios::wanted_columns(model, run.name);
  std::vector<Cyclogram::Column> kept;
  int n_others = 0, n_temperatures = 0;
  const auto is_wanted = [&](const Cyclogram::Column& c) {
    return std::any_of(wanted.begin(), wanted.end(), [&](const auto& name) { return name == c.name || name == c.header(); });
  };
  const auto is_offered = [](const Cyclogram::Column& c) {
    return std::adjacent_find(c.rows.value.begin(), c.rows.value.end(), std::not_equal_to<>()) != c.rows.value.end();
  };
  for (const Cyclogram::Column& c : run.cyclogram.columns) {
    if (is_wanted(c) || !is_offered(c)) continue;
    ++(c.unit == "degC" ? n_temperatures : n_others);
  }
  const bool with_temperatures =
      n_temperatures + n_others <= kMostColumns;  // otherwise a machine full of unknown thermometers
  for (Cyclogram::Column& c : run.cyclogram.columns) {
    const bool is_one_of_few = c.unit == "degC" ? with_temperatures : n_others <= kMostColumns;
    if (is_wanted(c) || (is_offered(c) && is_one_of_few)) kept.push_back(std::move(c));
  }
  run.cyclogram.columns = std::move(kept);
}

/// The ambient, smoothed, and its thermometer's noise and steps, from readings in degC.
void take_ambient(MeasuredRun& run, const std::vector<double>& read_C, double reference_K) {
  std::vector<double> ambient_K;
  for (double v : read_C) ambient_K.push_back(v + kZeroCelsius_K - reference_K);
  const Readings ambient = present_readings(run.time_s, ambient_K);
  run.ambient = smoothed(ambient);
  run.ambient_noise_K = white_noise(ambient);
  run.ambient_quantum_K = seen_step(present_readings(run.time_s, read_C).value);
}

/// @throws InputError  for a record's channel that cannot be in the output's unit
void require_same_kind(const std::string& path, const Channel& recorded, const std::string& output_unit) {
  if (!same_kind(recorded.unit, output_unit)) {
    throw InputError(fmt::format("{}: channel {} is in {}, but the scenario's {} is a {}", path, recorded.name,
                                 recorded.unit, recorded.name,
                                 output_unit == "K"   ? "temperature (degC)"
                                 : output_unit == "m" ? "displacement (um)"
                                                      : "tilt (urad)"));
  }
}

/// A channel in K, m or rad; missing at moments at which it is unknown what it shows, and in holes of the drive.
/// @param recorded  its values before those that cannot be right were left out
MeasuredChannel in_si(const MeasuredRun& run, const Channel& channel, const std::vector<double>& recorded, int output,
                      const std::string& unit, double reference_C) {
  MeasuredChannel measured{channel.name, output, unit, {}, 0.0, channel.unit};
  const double scale = unit == "K" ? 1.0 : channel.unit == "mm" ? 1e-3 : 1e-6;
  const double offset = channel.unit == "degC" ? reference_C : 0.0;
  measured.value.resize(static_cast<Eigen::Index>(run.time_s.size()));
  for (std::size_t i = 0; i < run.time_s.size(); ++i) {
    measured.value[static_cast<Eigen::Index>(i)] = scale * (channel.values[i] - offset);
  }
  for (std::size_t i = 0; unit != "K" && i < run.time_s.size(); ++i) {
    // At the exact time of a change, and of the start, it is unknown whether a reading that follows speed has jumped
    // already.
    const double before_rpm = i == 0 ? 0.0 : run.cyclogram.speed_rpm(run.time_s[i - 1]);
    if (run.cyclogram.speed_rpm(run.time_s[i]) == before_rpm) continue;
    measured.value[static_cast<Eigen::Index>(i)] = std::nan("");
  }
  for (const Hole& hole : run.holes) {
    for (std::size_t i = 0; i < run.time_s.size(); ++i) {
      if (run.time_s[i] > hole.begin_s && run.time_s[i] < hole.end_s)
        measured.value[static_cast<Eigen::Index>(i)] = std::nan("");
    }
  }
  measured.quantum = scale * quantum_of(recorded);
  return measured;
}

/// Says which channels are compared with nothing, and which of these may drive the machine.
void note_further_channels(MeasuredRun& run, const Record& record, const scenarios::MachineModel& model,
                           const solver::Outputs& outputs) {
  std::vector<std::string> unknown, drives;
  for (const Channel& c : record.channels) {
    const bool is_input = c.name == "speed" || c.name == "ambient" || effects::is_drive_channel(c.name);
    if (is_input || std::find(outputs.name.begin(), outputs.name.end(), c.name) != outputs.name.end()) continue;
    const bool is_drive = run.cyclogram.column(c.name) != nullptr;
    (is_drive ? drives : unknown).push_back(c.header());
    if (!is_drive) run.left_out.push_back({c.name, "the scenario has no sensor or displacement of that name"});
  }
  if (!unknown.empty()) {
    run.findings.push_back(
        {"", fmt::format("the scenario knows no sensor or displacement called {}; not compared", fmt::join(unknown, ", ")),
         false});
  }
  const std::vector<std::string> wanted = scenarios::wanted_columns(model, run.name);
  std::erase_if(drives, [&](const std::string& header) {
    return std::any_of(wanted.begin(), wanted.end(), [&](const std::string& name) {
      return run.cyclogram.column(name) && run.cyclogram.column(name)->header() == header;
    });
  });
  if (!drives.empty()) {
    run.findings.push_back(
        {"",
         fmt::format("the scenario knows no sensor or displacement called {}; not compared, but taken for "
                     "what may drive the machine",
                     fmt::join(drives, ", ")),
         false});
  }
}

}  // namespace

const MeasuredChannel* MeasuredRun::find(const std::string& channel) const {
  for (const MeasuredChannel& c : channels) {
    if (c.name == channel) return &c;
  }
  return nullptr;
}

double row_s(const MeasuredRun& run) {
  return run.time_s.back() / static_cast<double>(run.time_s.size() - 1);
}

double shortest_row_s(const std::vector<MeasuredRun>& runs) {
  double shortest_s = row_s(runs.front());
  for (const MeasuredRun& run : runs) shortest_s = std::min(shortest_s, row_s(run));
  return shortest_s;
}

void set_grid(MeasuredRun& run) {
  constexpr int kFiner = 4, kIntervals = 6;  // subdivision of this many intervals after a change
  std::vector<Cyclogram::Section>& sections = run.cyclogram.sections;
  while (!sections.empty() && run.cyclogram.duration_s() < run.time_s.back())
    sections.back().duration_s += run.time_s.back() - run.cyclogram.duration_s();
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

MeasuredRun measured_run(const ReadRecord& read, const scenarios::MachineModel& model, const solver::Outputs& outputs) {
  const Record& whole = read.record;
  const std::string& path = whole.source;
  if (whole.n_samples() < 3) {
    throw InputError(
        fmt::format("{}: {} rows; a diagnosis needs at least three, better a hundred", path, whole.n_samples()));
  }
  MeasuredRun run;
  run.path = path;
  for (const std::string& note : read.notes) run.findings.push_back({"", note, false});
  run.holes = holes_in(whole, run.findings);
  const Record record = without_spikes(whole, run.findings);
  std::vector<std::string> on_ambient;  // as good as an ambient thermometer
  for (std::size_t o = 0; o < outputs.name.size(); ++o) {
    if (outputs.ambient[static_cast<Eigen::Index>(o)] == 1.0) on_ambient.push_back(outputs.name[o]);
  }
  MachineRun recorded_run = scenarios::run_of(record, &model, on_ambient, scenarios::Reading::kStrict);
  run.time_s = std::move(recorded_run.readings.time_s);
  run.cyclogram = std::move(recorded_run.cyclogram);
  run.name = run.cyclogram.name;
  run.ambient = std::move(recorded_run.ambient);
  run.has_ambient = recorded_run.has_recorded_ambient();
  if (run.has_ambient) take_ambient(run, record.at(recorded_run.ambient_channel).values, model.reference_K);
  std::move(recorded_run.findings.begin(), recorded_run.findings.end(), std::back_inserter(run.findings));
  scenarios::require_columns(model, run.cyclogram);
  scenarios::require_resting(model.axes, run.cyclogram);
  keep_columns(run, model);
  set_grid(run);
  const double reference_C = model.reference_K - kZeroCelsius_K;
  for (std::size_t o = 0; o < outputs.name.size(); ++o) {
    const Channel* recorded = record.find(outputs.name[o]);
    if (!recorded) continue;
    if (run.has_ambient && outputs.ambient[static_cast<Eigen::Index>(o)] == 1.0) continue;
    require_same_kind(path, *recorded, outputs.unit[o]);
    const std::size_t n_before = run.findings.size();
    Channel channel = *recorded;
    inspect(record, run.time_s, channel, run.findings);
    const bool left_out = std::any_of(run.findings.begin() + static_cast<std::ptrdiff_t>(n_before), run.findings.end(),
                                      [](const DataFinding& f) { return f.leaves_out; });
    if (left_out) {
      run.left_out.push_back({channel.name, run.findings.back().what});
      continue;
    }
    run.channels.push_back(in_si(run, channel, recorded->values, static_cast<int>(o), outputs.unit[o], reference_C));
  }
  note_further_channels(run, record, model, outputs);
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

std::vector<MeasuredChannel> channels_without_output(const Record& record, const MeasuredRun& run,
                                                     const scenarios::MachineModel& model, const solver::Outputs& outputs) {
  const std::vector<std::string> wanted = scenarios::wanted_columns(model, run.name);
  std::vector<MeasuredChannel> channels;
  for (const Channel& c : record.channels) {
    const auto is_it = [&](const std::string& name) { return name == c.name || name == c.header(); };
    const bool is_input = c.name == "speed" || c.name == "ambient" || effects::is_drive_channel(c.name) ||
                          std::any_of(wanted.begin(), wanted.end(), is_it);
    if (is_input || std::any_of(outputs.name.begin(), outputs.name.end(), is_it)) continue;
    for (const char* unit : {"K", "m", "rad"}) {
      if (!same_kind(c.unit, unit)) continue;
      channels.push_back(in_si(run, c, c.values, -1, unit, model.reference_K - kZeroCelsius_K));
      break;
    }
  }
  return channels;
}

}  // namespace driftwright::diagnosis
