// An observer during a run: which readings it uses, when it drops a sensor and takes it back, how far it is to be trusted.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/median.hpp"
#include "base/record_channel.hpp"
#include "compensation/predictors/held_ambient.hpp"
#include "compensation/predictors/observer.hpp"
#include "compensation/predictors/observer_filter.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kFlag = 5.0;        // deviations of the mean innovation
constexpr double kOutlier = 6.0;     // deviations of one innovation; beyond this the reading is ignored
constexpr double kMemory = 0.9;      // factor of the mean innovation from row to row
constexpr std::size_t kReturn = 30;  // rows by which the filter returns when a sensor is dropped
static_assert(kReturn < kRowsBack);
constexpr std::size_t kWarm =
    10;  // rows that a mean remembers, 1 / (1 - kMemory): before, and until a sensor is tried again, it says nothing new
constexpr double kFoundWrong = 2.0;                 // times most_apart: more than chance or a passing disagreement
constexpr double kChance = 3.0902;                  // deviations of a normal number that one of a thousand is above
constexpr double kRoom = 2.0;                       // factor on the distance in the training runs
constexpr double kAgreesFor_s = kRemembersDoubt_s;  // of agreement, before a sensor, or the model, counts as right again
constexpr double kStale = 5.0;       // intervals without a reading, after which a sensor is silent; as the fail-safe has it
constexpr double kForgetStep = 0.8;  // from row to row, of a longer interval
constexpr double kGap = 2.5;         // intervals between rows, beyond which the drive in between is unknown

/// How long something has agreed with what is expected, and over which expected temperatures: a sensor that is stuck agrees
/// only as long as nothing moves. Temperatures are means over as many rows as the innovations that agree.
struct Agreement {
  double agreed_s = -1.0;                                    ///< in rows with a reading; < 0: it does not
  double mean_K = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no row yet
  double low_K = 0.0, high_K = 0.0;                          ///< of mean_K

  void take(bool agrees, double step_s, double expected_K) {
    mean_K = std::isnan(mean_K) ? expected_K : kMemory * mean_K + (1.0 - kMemory) * expected_K;
    if (!agrees) {
      agreed_s = -1.0;
    } else if (agreed_s < 0.0) {
      agreed_s = 0.0;
      low_K = high_K = mean_K;
    } else {
      agreed_s += step_s;
      low_K = std::min(low_K, mean_K);
      high_K = std::max(high_K, mean_K);
    }
  }
  [[nodiscard]] bool is_long(double moved_K) const { return agreed_s >= kAgreesFor_s && high_K - low_K > moved_K; }
};

/// Deviation of the mean of white innovations of deviation 1.
const double kMeanDeviation = std::sqrt((1.0 - kMemory) / (1.0 + kMemory));

}  // namespace

class Observer::Run final : public ObserverFollower {
 public:
  /// @param gives_up  whether sensors that differ from the expected values are dropped
  Run(const Observer& observer, bool with_drift, bool gives_up = true)
      : o_(observer),
        s_(observer.system_),
        with_drift_(with_drift),
        gives_up_(gives_up),
        filter_(observer.system_, observer.settings_, observer.factors_, observer.drift_output_, with_drift) {
    live_.assign(o_.sensors_.size(), true);
    for (const Eigen::Index output : o_.sensor_output_) sees_state_.push_back(s_.outputs.state.col(output).norm() > 0.0);
    agreement_.assign(o_.sensors_.size(), {});
    dropped_s_.assign(o_.sensors_.size(), std::numeric_limits<double>::quiet_NaN());
    mean_innovation_.assign(o_.sensors_.size(), 0.0);
    last_s_.assign(o_.sensors_.size(), std::numeric_limits<double>::quiet_NaN());
    innovation_K_.assign(o_.sensors_.size(), std::numeric_limits<double>::quiet_NaN());
    spread_K_.assign(o_.sensors_.size(), 0.0);
    last_reading_s_ = last_s_;
    deviation_K_ = innovation_K_;
  }

  double next(const ObservedRun& run) override {
    if (!has_channels_) find_channels(run);
    if (row_ == 0) begin(run);
    if (gives_up_) history_.push_back({row_, filter_.belief()});
    if (history_.size() > kReturn) history_.pop_front();
    if (ambient_.take(run, row_)) distrusted_.push_back(ambient_.words());
    temper_ = with_drift_ || row_ < kWarm ? 1.0 : std::max(1.0, apart() / o_.settings_.most_apart);
    const double before_s = now_s_;
    return_.clear();
    take_row(run, row_);
    temper_ = 1.0;
    if (!gives_up_) return 1e6 * drift_m(row_++);
    if (ambient_.is_doubted() && has_live_sensor() && row_ >= ambient_.doubted_row + kReturn && history_.size() == kReturn)
      settle_ambient(run);
    use_again(std::min(now_s_ - before_s, kGap * std::max(o_.settings_.period_s, usual_step_s_)));
    if (const int suspect = worst_suspect(row_); suspect >= 0 && row_ >= again_row_ && !history_.empty() && may_drop() > 0)
      give_up(run, static_cast<std::size_t>(suspect));
    // with a single sensor it is unknown whether the sensor or the model is wrong
    is_model_wrong_ =
        is_model_wrong_ || (live_.size() > 1 && row_ >= kWarm && apart() > kFoundWrong * o_.settings_.most_apart);
    return 1e6 * drift_m(row_++);
  }

  /// Distance of the active sensors from the model, relative to the distance that chance exceeds in one of a thousand rows:
  /// the sum of squares of their mean innovations, chi-squared if the model is right, without the worst of them while it may
  /// be the sensor's own fault.
  [[nodiscard]] double apart() const {
    // variance of the mean of white innovations that started at 0
    const double variance =
        (1.0 - kMemory) / (1.0 + kMemory) * (1.0 - std::pow(kMemory, 2.0 * static_cast<double>(n_in_means())));
    double sum = 0.0, worst = 0.0;
    int n = 0;
    for (std::size_t k = 0; k < live_.size(); ++k) {
      if (!live_[k] || !sees_state_[k] || is_silent(k)) continue;
      const double square = mean_innovation_[k] * mean_innovation_[k] / variance;
      sum += square;
      worst = std::max(worst, square);
      ++n;
    }
    if (n == 0) return 0.0;
    if (n > 1 && may_drop() > 0) {
      sum -= worst;
      --n;
    }
    const double third = 2.0 / (9.0 * n);  // Wilson & Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684
    return sum / (n * std::pow(1.0 - third + kChance * std::sqrt(third), 3));
  }
  [[nodiscard]] bool has_live_sensor() const {
    for (std::size_t k = 0; k < live_.size(); ++k) {
      if (live_[k] && sees_state_[k] && !is_silent(k)) return true;
    }
    return false;
  }
  /// Without a reading for so long that it says nothing of the present state.
  [[nodiscard]] bool is_silent(std::size_t sensor) const {
    const double last_s = std::isnan(last_reading_s_[sensor]) ? start_s_ : last_reading_s_[sensor];
    return now_s_ - last_s > kStale * std::max(o_.settings_.period_s, usual_step_s_);
  }
  [[nodiscard]] std::size_t n_in_means() const { return std::max<std::size_t>(row_ - means_from_, 1); }
  [[nodiscard]] double deserved_trust() const override {
    if (live_.empty()) return 1.0;  // a model without any sensor to compare with
    if (!has_live_sensor()) return 0.0;
    const double beyond = apart() / o_.settings_.most_apart;
    return beyond > 1.0 ? 1.0 / beyond : 1.0;
  }

  [[nodiscard]] std::optional<double> deviation_um() const override { return 1e6 * filter_.drift_deviation_m(); }
  [[nodiscard]] Eigen::VectorXd outputs() const override { return filter_.outputs(ambient_.last()); }
  [[nodiscard]] const std::vector<double>& innovation_K() const override { return innovation_K_; }
  [[nodiscard]] const std::vector<double>& deviation_K() const override { return deviation_K_; }
  [[nodiscard]] std::vector<std::string> given_up() const override {
    std::vector<std::string> names;
    if (row_ > 0 && ambient_.is_doubted()) names.push_back(ambient_.words());
    for (std::size_t k = 0; k < live_.size(); ++k) {
      if (!live_[k]) {
        names.push_back(words_of_dropped(k));
      } else if (row_ > 0 && is_silent(k)) {
        names.push_back(fmt::format("{} without a reading", o_.sensors_[k]));
      }
    }
    return names;
  }
  /// All sensors that have been dropped in the run, also those that are used again.
  [[nodiscard]] const std::vector<std::string>& distrusted() const { return distrusted_; }

  /// Does not contain the rows that the filter could return to: a sensor that is dropped soon after a recall counts until
  /// then.
  [[nodiscard]] std::vector<double> memory() const override {
    std::vector<double> m = {static_cast<double>(row_),
                             start_ambient_K_,
                             ambient_.last(),
                             static_cast<double>(ambient_.is_doubted()),
                             static_cast<double>(ambient_.doubted_row),
                             ambient_.doubted_s,
                             static_cast<double>(is_model_wrong_),
                             usual_step_s_,
                             now_s_,
                             start_s_};
    const auto add = [&](const Agreement& a) { m.insert(m.end(), {a.agreed_s, a.mean_K, a.low_K, a.high_K}); };
    add(model_agreement_);
    for (std::size_t k = 0; k < live_.size(); ++k) {
      m.insert(m.end(), {static_cast<double>(live_[k]), dropped_s_[k], mean_innovation_[k], last_s_[k], last_reading_s_[k],
                         spread_K_[k]});
      add(agreement_[k]);
    }
    filter_.add_numbers(m);
    return m;
  }
  void recall(std::span<const double> memory) override {
    const std::size_t n_sensors = live_.size();
    if (memory.size() != 14 + 10 * n_sensors + filter_.n_numbers()) throw std::logic_error("the memory of another observer");
    auto at = memory.begin();
    const auto take = [&] { return *at++; };
    row_ = static_cast<std::size_t>(take());
    start_ambient_K_ = take();
    const double ambient_K = take();
    ambient_.recall(row_, ambient_K, take() != 0.0);
    ambient_.doubted_row = static_cast<std::size_t>(take());
    ambient_.doubted_s = take();
    is_model_wrong_ = take() != 0.0;
    usual_step_s_ = take();
    now_s_ = take();
    start_s_ = take();
    const auto taken_agreement = [&] {
      Agreement a;
      a.agreed_s = take();
      a.mean_K = take();
      a.low_K = take();
      a.high_K = take();
      return a;
    };
    model_agreement_ = taken_agreement();
    for (std::size_t k = 0; k < n_sensors; ++k) {
      live_[k] = take() != 0.0;
      dropped_s_[k] = take();
      mean_innovation_[k] = take();
      last_s_[k] = take();
      last_reading_s_[k] = take();
      spread_K_[k] = take();
      agreement_[k] = taken_agreement();
      if (!live_[k]) distrusted_.push_back(words_of_dropped(k));
    }
    filter_.take_numbers({at, memory.end()});
  }

  [[nodiscard]] Belief factors() const { return filter_.factors(); }

 private:
  struct Snapshot {
    std::size_t row;
    Belief belief;  // before that row's step and readings
  };

  /// Everything that changes when a sensor is dropped.
  struct Kept {
    Belief belief;
    std::vector<bool> live;
    std::vector<double> dropped_s, mean_innovation, last_s;
    std::vector<Agreement> agreement;
    double last_drift_s;
    std::vector<std::string> distrusted;
    std::deque<Snapshot> history;
    std::size_t means_from;
  };

  void find_channels(const ObservedRun& run) {
    has_channels_ = true;
    const auto channel = [&](const std::string& name, const char* unit) {
      const Channel& c = run.readings.at(name);
      if (c.unit != unit)
        throw InputError(
            fmt::format("channel '{}' of {} is in {}; the model gives it in {}", name, run.readings.source, c.unit, unit));
      return channel_index(run.readings, name);
    };
    for (const std::string& name : o_.sensors_) sensor_channel_.push_back(channel(name, "degC"));
    if (with_drift_) drift_channel_ = channel(o_.drift_, "um");
  }

  void begin(const ObservedRun& run) {
    start_s_ = now_s_ = run.readings.time_s.front();
    start_ambient_K_ = run.ambient.at(run.readings.time_s.front());
    filter_.begin(o_.start_ + (start_ambient_K_ - o_.start_ambient_K_) * s_.ones);
  }

  /// Follows the last rows with the held ambient and with the one that the thermometer has shown since, and keeps what the
  /// other sensors contradict less.
  void settle_ambient(const ObservedRun& run) {
    const Kept before = kept();
    const auto followed = [&] {
      filter_.restore(before.history.front().belief);
      start_anew(before.history.front().row);
      squares_ = 0.0;
      n_readings_ = 0;
      for (std::size_t k = before.history.front().row; k <= row_; ++k) take_row(run, k);
      return squares_;
    };
    const double held = followed();
    const HeldAmbient held_ambient = ambient_;
    ambient_.believe(run, std::max(ambient_.doubted_row, before.history.front().row), row_);
    if (followed() <= held && n_readings_ > 0) {
      history_.clear();
      is_model_wrong_ = false;
      for (std::size_t k = 0; k < live_.size(); ++k) {  // what was judged by the held ambient is judged again
        if (!live_[k] && dropped_s_[k] >= ambient_.doubted_s) take_back(k);
      }
      return;
    }
    restore(before);
    ambient_ = held_ambient;
    ambient_.doubted_row = row_;  // asked again after as many rows
  }

  void take_back(std::size_t sensor) {
    live_[sensor] = true;
    dropped_s_[sensor] = std::numeric_limits<double>::quiet_NaN();
    mean_innovation_[sensor] = 0.0;
  }

  /// A sensor that has agreed again for long enough, over temperatures that moved by more than a stuck one could agree with,
  /// is used again; so is a model that was found wrong.
  void use_again(double step_s) {
    for (std::size_t k : return_) take_back(k);
    if (!has_live_sensor()) return;
    double expected_K = 0.0;
    for (std::size_t k = 0; k < live_.size(); ++k) expected_K += expected_K_of(k, row_) / static_cast<double>(live_.size());
    model_agreement_.take(apart() <= o_.settings_.most_apart, step_s, expected_K);
    const double widest_K = *std::max_element(spread_K_.begin(), spread_K_.end());
    if (is_model_wrong_ && model_agreement_.is_long(2.0 * kFlag * kMeanDeviation * widest_K)) is_model_wrong_ = false;
  }

  /// Up to a third of the sensors, at least one: more differing sensors show that the model is wrong. None after the model
  /// was found wrong, until it has agreed for long, because the sensor that shows its error best would be dropped first.
  [[nodiscard]] int may_drop() const {
    if (is_model_wrong_) return 0;
    const auto n_dropped = static_cast<int>(std::count(live_.begin(), live_.end(), false));
    return std::max(1, static_cast<int>(live_.size() / 3)) - n_dropped;
  }

  /// Follows the last rows without a sensor. If the others then agree with the model, it stays dropped; otherwise the model
  /// is wrong.
  void give_up(const ObservedRun& run, std::size_t sensor) {
    const Kept before = kept();
    drop(run, sensor);
    if (apart() <= o_.settings_.most_apart) return;
    restore(before);
    again_row_ = row_ + kWarm;
  }

  [[nodiscard]] Kept kept() const {
    return {filter_.belief(), live_,         dropped_s_,  mean_innovation_, last_s_,
            agreement_,       last_drift_s_, distrusted_, history_,         means_from_};
  }
  void restore(const Kept& before) {
    filter_.restore(before.belief);
    live_ = before.live;
    dropped_s_ = before.dropped_s;
    mean_innovation_ = before.mean_innovation;
    last_s_ = before.last_s;
    agreement_ = before.agreement;
    last_drift_s_ = before.last_drift_s;
    distrusted_ = before.distrusted;
    history_ = before.history;
    means_from_ = before.means_from;
  }
  /// Means and times of readings as if none had been taken before a row.
  void start_anew(std::size_t row) {
    mean_innovation_.assign(mean_innovation_.size(), 0.0);
    means_from_ = row;
    last_s_.assign(last_s_.size(), std::numeric_limits<double>::quiet_NaN());
    last_drift_s_ = std::numeric_limits<double>::quiet_NaN();
  }

  /// Returns to before its mean innovation began to grow, and follows the rows since then without it.
  void drop(const ObservedRun& run, std::size_t sensor) {
    live_[sensor] = false;
    agreement_[sensor] = {};
    dropped_s_[sensor] = run.readings.time_s[run.at(row_)];
    distrusted_.push_back(words_of_dropped(sensor));
    filter_.restore(history_.front().belief);
    start_anew(history_.front().row);
    for (std::size_t k = history_.front().row; k <= row_; ++k) take_row(run, k);
    history_.clear();
  }

  [[nodiscard]] std::string words_of_dropped(std::size_t sensor) const {
    return fmt::format("{} from {:.0f} min", o_.sensors_[sensor], dropped_s_[sensor] / 60.0);
  }

  void take_row(const ObservedRun& run, std::size_t i) {
    const std::size_t at = run.at(i);
    const double t_s = run.readings.time_s[at];
    const double step_s = std::min(t_s - now_s_, kGap * std::max(o_.settings_.period_s, usual_step_s_));
    if (i > 0) advance(run, i);
    now_s_ = t_s;
    for (std::size_t k = 0; k < sensor_channel_.size(); ++k) {
      const double read = run.readings.channels[sensor_channel_[k]].values[at];
      innovation_K_[k] = deviation_K_[k] = std::numeric_limits<double>::quiet_NaN();
      if (std::isnan(read)) continue;
      last_reading_s_[k] = t_s;
      ++n_readings_;
      const Eigen::VectorXd h = filter_.reading_gradient(o_.sensor_output_[k]);
      const double expected_K = expected_K_of(k, i);
      const double variance = variance_of(o_.settings_.reading_K, o_.settings_.model_K, t_s, last_s_[k]);
      const double spread = spread_K_[k] = std::sqrt(filter_.variance_along(h) + variance);
      deviation_K_[k] = read - expected_K;
      const double innovation = std::clamp(deviation_K_[k], -kOutlier * spread, kOutlier * spread);
      mean_innovation_[k] = kMemory * mean_innovation_[k] + (1.0 - kMemory) * innovation / spread;
      agreement_[k].take(std::abs(mean_innovation_[k]) <= kFlag * kMeanDeviation, step_s, expected_K);
      if (!live_[k] && agreement_[k].is_long(2.0 * kFlag * kMeanDeviation * spread)) return_.push_back(k);
      if (!live_[k]) continue;
      innovation_K_[k] = innovation;
      squares_ += innovation * innovation / (spread * spread);
      if (std::abs(innovation) < kOutlier * spread) filter_.correct(h, innovation, temper_ * variance);
    }
    const double drift_um = with_drift_ ? run.readings.channels[drift_channel_].values[at] : std::nan("");
    if (std::isfinite(drift_um)) {
      // the drift counts from the start of the run; if it is missing there, from the model's drift at the first measured
      // value
      if (first_drift_ >= i) {
        first_drift_ = i;
        drift_zero_m_ = 1e-6 * drift_um - (i > 0 ? drift_m(i) : 0.0);
      }
      const double variance = 1e-12 * variance_of(o_.settings_.drift_um, o_.settings_.model_um, t_s, last_drift_s_);
      filter_.correct_drift(1e-6 * drift_um - drift_zero_m_ - drift_m(i), variance);
    }
  }

  /// What a sensor is expected to read [degC].
  [[nodiscard]] double expected_K_of(std::size_t sensor, std::size_t row) const {
    return filter_.reading_C(o_.sensor_output_[sensor], ambient_.at(row));
  }

  /// Variance from a reading's white error and the model's own error, which neighbouring readings share. @param last_s
  /// previous time; NaN: none
  [[nodiscard]] double variance_of(double white, double model, double t_s, double& last_s) const {
    const double step_s = std::isnan(last_s) ? o_.settings_.period_s : t_s - last_s;
    last_s = t_s;
    return white * white + model * model * std::max(1.0, o_.settings_.model_holds_s / step_s);
  }

  /// The active sensor with the largest mean innovation, if one exceeds the flag.
  [[nodiscard]] int worst_suspect(std::size_t i) const {
    if (i < kWarm) return -1;
    int worst = -1;
    double most = kFlag * kMeanDeviation;
    for (std::size_t k = 0; k < live_.size(); ++k) {
      if (live_[k] && std::abs(mean_innovation_[k]) > most) {
        most = std::abs(mean_innovation_[k]);
        worst = static_cast<int>(k);
      }
    }
    return worst;
  }

  void advance(const ObservedRun& run, std::size_t i) {
    double from_s = run.readings.time_s[run.at(i) - 1], section_end_s = run.cyclogram_from_s;
    const double to_s = run.readings.time_s[run.at(i)], length_s = to_s - from_s;
    const double longest_s = kGap * std::max(o_.settings_.period_s, usual_step_s_);
    const bool is_gap = !with_drift_ && length_s > longest_s;
    if (is_gap) filter_.begin_gap();
    usual_step_s_ = std::max(std::min(length_s, longest_s), kForgetStep * usual_step_s_);
    for (std::size_t c = 0; c < run.cyclogram.sections.size() && from_s < to_s; ++c) {
      const bool is_last = c + 1 == run.cyclogram.sections.size();
      section_end_s += run.cyclogram.sections[c].duration_s;
      const double until_s = is_last ? to_s : std::min(to_s, section_end_s);
      while (from_s < until_s - 1e-9) {
        const auto n_left = std::ceil((until_s - from_s) / o_.settings_.longest_step_s - 1e-9);
        const double h_s = (until_s - from_s) / n_left;
        effects::Inputs at{.drive = run.cyclogram.sections[c].drive,
                           .ambient_K = ambient_.between_rows(run, i, from_s + 0.5 * h_s),
                           .time_s = from_s};
        at.run = run.cyclogram.name;
        filter_.step(at, h_s);
        from_s += h_s;
      }
      from_s = std::max(from_s, std::min(until_s, to_s));
    }
    if (is_gap) filter_.end_gap();
  }

  [[nodiscard]] double drift_m(std::size_t row) const { return filter_.drift_m(ambient_.at(row) - start_ambient_K_); }

  const Observer& o_;
  const solver::ReducedSystem& s_;
  bool with_drift_, gives_up_, is_model_wrong_ = false;
  ObserverFilter filter_;
  HeldAmbient ambient_;
  double start_ambient_K_ = 0.0, drift_zero_m_ = 0.0;
  double temper_ = 1.0;        // on the variance of readings, while they are further from the model than trust allows
  double squares_ = 0.0;       // of normalised innovations
  double usual_step_s_ = 0.0;  // between rows: the longest of the last ones
  double now_s_ = 0.0, start_s_ = 0.0;
  int n_readings_ = 0;  // taken
  std::vector<double> last_reading_s_, deviation_K_;
  std::vector<std::size_t> return_;  // sensors that have agreed for long enough
  std::size_t row_ = 0, again_row_ = 0, means_from_ = 0, first_drift_ = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> sensor_channel_;
  std::size_t drift_channel_ = 0;
  std::vector<bool> live_;
  std::vector<bool> sees_state_;  // false: of a thermometer of the ambient alone, which says nothing of the model
  std::vector<std::string> distrusted_;
  bool has_channels_ = false;
  std::vector<double> innovation_K_, dropped_s_;
  std::vector<double> mean_innovation_, spread_K_;
  std::vector<Agreement> agreement_;
  Agreement model_agreement_;
  std::vector<double> last_s_;  // of each sensor's last readings
  double last_drift_s_ = std::numeric_limits<double>::quiet_NaN();
  std::deque<Snapshot> history_;
};

void Observer::learn(std::span<const ObservedRun> runs) {
  std::vector<double> steps_s;
  for (const ObservedRun& run : runs) {
    for (std::size_t i = 1; i < run.readings.n_samples(); ++i)
      steps_s.push_back(run.readings.time_s[i] - run.readings.time_s[i - 1]);
  }
  if (!steps_s.empty()) settings_.period_s = quantile(std::move(steps_s), 0.5);
  for (const ObservedRun& run : runs) {
    Run pass(*this, true);
    for (std::size_t i = 0; i < run.readings.n_samples(); ++i) (void)pass.next(run);
    factors_ = pass.factors();
  }
}

Observer Observer::calibrated(std::span<const ObservedRun> runs) const {
  Observer other = *this;
  other.settings_.most_apart = std::numeric_limits<double>::infinity();
  std::vector<double> apart;  // the mean of few rows, or one row in a thousand, is not used as a limit
  for (const ObservedRun& run : runs) {
    Run pass(other, false);
    for (std::size_t i = 0; i < run.readings.n_samples(); ++i) {
      (void)pass.next(run);
      if (i >= kWarm) apart.push_back(pass.apart());
    }
  }
  other.settings_.most_apart = apart.empty() ? 1.0 : std::max(1.0, kRoom * quantile(std::move(apart), 0.999));
  return other;
}

Observation Observer::observe(const ObservedRun& run) const {
  Run pass(*this, false);
  const std::size_t n = run.readings.n_samples();
  Observation seen;
  seen.outputs.resize(system_.outputs.state.cols(), static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    seen.drift_um.push_back(pass.next(run));
    seen.deviation_um.push_back(*pass.deviation_um());
    seen.outputs.col(static_cast<Eigen::Index>(i)) = pass.outputs();
  }
  seen.distrusted = pass.distrusted();
  return seen;
}

std::unique_ptr<Follower> Observer::follow() const {
  return std::make_unique<Run>(*this, false);
}

std::unique_ptr<ObserverFollower> Observer::watch() const {
  return std::make_unique<Run>(*this, false, false);
}

}  // namespace driftwright::compensation
