#include "follow/live_rows.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/quantity.hpp"
#include "scenarios/reader/recorded_run.hpp"

namespace driftwright::follow {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);
constexpr std::size_t kMostKept = 8 * kRowsBack;

}  // namespace

LiveRows::LiveRows(const std::vector<Channel>& channels, const std::string& ambient, double reference_K, bool wants_drive,
                   const std::vector<FollowedColumn>& columns)
    : reference_C_(reference_K - kZeroCelsius_K),
      ambient_K_(ambient.empty() ? 0.0 : std::numeric_limits<double>::quiet_NaN()),
      wants_drive_(wants_drive) {
  const auto find = [&](const std::string& name, const char* unit) {
    const auto at =
        std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.name == name && c.unit == unit; });
    return at == channels.end() ? kNone : static_cast<std::size_t>(at - channels.begin());
  };
  run_.cyclogram.name = "stream";
  run_.readings.source = "the stream";
  run_.readings.channels = channels;
  speed_ = find("speed", "rpm");
  cutting_ = find("cutting_power", "W");
  feed_ = {find("feed_x", "mm_min"), find("feed_y", "mm_min"), find("feed_z", "mm_min")};
  ambient_ = find(ambient, "degC");
  for (const FollowedColumn& c : columns) {
    followed_.push_back({find(c.name, c.unit.c_str()), 0.0});
    drive_.signals.push_back({c.signal, std::numeric_limits<double>::quiet_NaN()});
  }
}

void LiveRows::hear(double run_s, const std::vector<double>& values) {
  const auto value = [&](std::size_t channel) {
    return channel == kNone ? std::numeric_limits<double>::quiet_NaN() : values[channel];
  };
  now_s_ = run_s;
  if (const double ambient_C = value(ambient_); !std::isnan(ambient_C)) {
    ambient_K_ = ambient_C - reference_C_;
    ambient_at_s_ = run_s;
  }
  before_ = drive_;
  if (const double rpm = value(speed_); !std::isnan(rpm)) {
    has_drive_ = true;
    speed_at_s_ = run_s;
    top_rpm_ = std::max(top_rpm_, rpm);
    const bool is_jitter =
        drive_.speed_rpm > 0.0 && rpm > 0.0 && std::abs(rpm - drive_.speed_rpm) <= scenarios::kJitter * top_rpm_;
    if (!is_jitter) drive_.speed_rpm = rpm;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    if (const double feed = value(feed_[a]); !std::isnan(feed)) drive_.feed_m_s[a] = std::abs(feed) / 60e3;
  }
  if (const double power_W = value(cutting_); !std::isnan(power_W)) drive_.cutting_power_W = power_W;
  for (std::size_t k = 0; k < followed_.size(); ++k) {
    const double now = value(followed_[k].channel);
    if (std::isnan(now)) continue;
    drive_.signals[k].value = now;
    followed_[k].at_s = run_s;
  }
}

/// A section of the drive before the last values, up to a time.
void LiveRows::add_section(double time_s) {
  if (!(time_s > section_end_s_)) return;
  run_.cyclogram.sections.push_back({time_s - section_end_s_, before_});
  section_end_s_ = time_s;
  ++n_new_sections_;
}

void LiveRows::between(double run_s, const std::vector<double>& values) {
  hear(run_s, values);
  add_section(run_s - start_s_);
}

bool LiveRows::add(double run_s, const std::vector<double>& values) {
  hear(run_s, values);
  Record& readings = run_.readings;
  if (readings.time_s.empty()) {
    if (!not_given().empty()) return false;
    before_ = drive_;
    start_s_ = run_s;
  }
  forget();
  const double time_s = run_s - start_s_;
  const bool is_first = readings.time_s.empty();
  if (!is_first) add_section(time_s);
  section_end_s_ = time_s;
  n_sections_.push_back(n_new_sections_);
  n_new_sections_ = 0;
  readings.time_s.push_back(time_s);
  for (std::size_t k = 0; k < values.size(); ++k) readings.channels[k].values.push_back(values[k]);
  run_.ambient.time_s.push_back(time_s);
  run_.ambient.value.push_back(ambient_K_);
  return true;
}

double LiveRows::drive_age_s() const {
  double age_s = std::max(wants_drive_ ? now_s_ - speed_at_s_ : 0.0, ambient_ == kNone ? 0.0 : now_s_ - ambient_at_s_);
  for (const ColumnAge& f : followed_) age_s = std::max(age_s, now_s_ - f.at_s);
  return age_s;
}

std::vector<std::string> LiveRows::older_than(double age_s) const {
  std::vector<std::string> names;
  if (wants_drive_ && now_s_ - speed_at_s_ > age_s) names.emplace_back("speed");
  if (ambient_ != kNone && now_s_ - ambient_at_s_ > age_s) names.push_back(run_.readings.channels[ambient_].name);
  for (const ColumnAge& f : followed_) {
    const std::string& name = run_.readings.channels[f.channel].name;
    if (now_s_ - f.at_s > age_s && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<std::string> LiveRows::not_given() const {
  std::vector<std::string> names;
  if (wants_drive_ && !has_drive_) names.emplace_back("speed");
  if (std::isnan(ambient_K_)) names.push_back(ambient_ == kNone ? "ambient" : run_.readings.channels[ambient_].name);
  for (std::size_t k = 0; k < followed_.size(); ++k) {
    const std::string& name = run_.readings.channels[followed_[k].channel].name;
    if (std::isnan(drive_.signals[k].value) && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  }
  return names;
}

void LiveRows::forget() {
  Record& readings = run_.readings;
  if (readings.n_samples() < kMostKept) return;
  const auto n = static_cast<std::ptrdiff_t>(readings.n_samples() - kRowsBack - 1);
  const auto drop = [&](auto& list) { list.erase(list.begin(), list.begin() + n); };
  drop(readings.time_s);
  for (Channel& c : readings.channels) drop(c.values);
  drop(run_.ambient.time_s);
  drop(run_.ambient.value);
  std::ptrdiff_t sections = 0;
  for (std::ptrdiff_t i = 1; i <= n; ++i) sections += static_cast<std::ptrdiff_t>(n_sections_[static_cast<std::size_t>(i)]);
  drop(n_sections_);
  n_sections_.front() = 0;
  std::vector<Cyclogram::Section>& list = run_.cyclogram.sections;
  list.erase(list.begin(), list.begin() + sections);
  run_.n_forgotten += static_cast<std::size_t>(n);
  run_.cyclogram_from_s = readings.time_s.front();
}

LiveRows::State LiveRows::state() const {
  State s{.start_s = start_s_,
          .n_rows = n_rows(),
          .time_s = run_.readings.time_s.back(),
          .ambient_K = ambient_K_,
          .top_rpm = top_rpm_,
          .speed_age_s = now_s_ - speed_at_s_,
          .ambient_age_s = now_s_ - ambient_at_s_,
          .values = {},
          .drive = drive_};
  for (const Channel& c : run_.readings.channels) s.values.push_back(c.values.back());
  s.drive.signals.clear();
  for (std::size_t k = 0; k < followed_.size(); ++k) {
    s.followed.push_back(drive_.signals[k].value);
    s.followed_age_s.push_back(now_s_ - followed_[k].at_s);
  }
  return s;
}

void LiveRows::recall(const State& s) {
  if (s.followed.size() != followed_.size() || s.followed_age_s.size() != followed_.size())
    throw InputError("the state is of a machine that follows other recorded columns");
  start_s_ = s.start_s;
  now_s_ = s.start_s + s.time_s;
  speed_at_s_ = now_s_ - s.speed_age_s;
  ambient_at_s_ = now_s_ - s.ambient_age_s;
  ambient_K_ = s.ambient_K;
  top_rpm_ = s.top_rpm;
  std::vector<Signal> signals = std::move(drive_.signals);
  drive_ = s.drive;
  for (std::size_t k = 0; k < followed_.size(); ++k) {
    signals[k].value = s.followed[k];
    followed_[k].at_s = now_s_ - s.followed_age_s[k];
  }
  drive_.signals = std::move(signals);
  has_drive_ = true;
  run_.n_forgotten = s.n_rows - 1;
  run_.cyclogram_from_s = s.time_s;
  run_.readings.time_s = {s.time_s};
  for (std::size_t k = 0; k < s.values.size(); ++k) run_.readings.channels[k].values = {s.values[k]};
  run_.ambient = {{s.time_s}, {s.ambient_K}};
  run_.cyclogram.sections.clear();
  section_end_s_ = s.time_s;
  n_sections_ = {0};
  n_new_sections_ = 0;
}

}  // namespace driftwright::follow
