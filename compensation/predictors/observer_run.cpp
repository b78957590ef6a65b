// An observer during a run: the rows, as the state observer in C asks for them, and its judgement in words.

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <initializer_list>
#include <limits>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/median.hpp"
#include "base/record_channel.hpp"
#include "compensation/control/state_observer.h"
#include "compensation/predictors/observer.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kRoom = 2.0;  // factor on the distance in the training runs
constexpr int kLawFailed = 2;  // an exception is waiting
/// Steps of different length or coefficients, and coefficients, whose exponentials are kept.
constexpr int kStepsKept = 128, kModesKept = 32;
static_assert(kObserverRowsBack < kRowsBack);

template <class Values>
void append(std::vector<double>& list, const Values& values) {
  list.insert(list.end(), values.data(), values.data() + values.size());
}

/// The numbers of an observer as arrays, to which `core` points.
struct ObserverTables {
  std::vector<double> loads, rest_W, exchanges, to_ambient, offsets;
  std::vector<int> sensor_output;
  state_observer core = {};

  ObserverTables(const solver::ReducedSystem& s, const ObserverSettings& settings,
                 const std::vector<Eigen::Index>& sensors) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(s.size());
    for (const auto& source : s.sources) {
      append(loads, source.load);
      rest_W.push_back(source.power_W({}));
    }
    for (const auto& e : s.exchanges) {
      append(exchanges, e.matrix);
      append(to_ambient, e.reaches_ambient() ? e.to_ambient : none);
      append(offsets, e.offset.size() > 0 ? e.offset : none);
    }
    sensor_output.assign(sensors.begin(), sensors.end());
    core.machine = {.n = s.size(),
                    .n_sources = static_cast<int>(s.sources.size()),
                    .n_exchanges = static_cast<int>(s.exchanges.size()),
                    .conduction = s.conduction.data(),
                    .loads = loads.data(),
                    .exchanges = exchanges.data(),
                    .to_ambient = to_ambient.data(),
                    .offsets = offsets.data(),
                    .ones = s.ones.data()};
    core.settings = {.reading_K = settings.reading_K,
                     .model_K = settings.model_K,
                     .drift_um = settings.drift_um,
                     .model_um = settings.model_um,
                     .model_holds_s = settings.model_holds_s,
                     .factor = settings.factor,
                     .factor_walk = settings.factor_walk,
                     .longest_step_s = settings.longest_step_s,
                     .period_s = settings.period_s,
                     .most_apart = settings.most_apart};
    core.n_outputs = static_cast<int>(s.outputs.state.cols());
    core.outputs = s.outputs.state.data();
    core.outputs_ambient = s.outputs.ambient.data();
    core.reference_degC = s.reference_K - 273.15;
    core.n_sensors = static_cast<int>(sensor_output.size());
    core.sensor_output = sensor_output.data();
    core.rest_W = rest_W.data();
  }
  ObserverTables(const ObserverTables&) = delete;
  ObserverTables& operator=(const ObserverTables&) = delete;
};

}  // namespace

class Observer::Run final : public ObserverFollower {
 public:
  /// @param gives_up  whether sensors that differ from the expected values are dropped
  Run(const Observer& observer, bool with_drift, bool gives_up = true)
      : o_(observer),
        with_drift_(with_drift),
        tables_(observer.system_, observer.settings_, observer.sensor_output_),
        innovation_K_(observer.sensors_.size(), std::numeric_limits<double>::quiet_NaN()),
        deviation_K_(innovation_K_) {
    state_observer& core = tables_.core;
    core.start = o_.start_.data();
    core.start_ambient_K = o_.start_ambient_K_;
    core.drift_output = static_cast<int>(o_.drift_output_);
    core.factor_mean = o_.factors_.mean.data();
    core.factor_covariance = o_.factors_.covariance.data();
    core.with_drift = with_drift;
    core.keeps_all = !gives_up;
    // observer_start() sets what is read; most of both is touched late or never
    remembered_.reset(new double[observer_n_remembered(&core)]);
    room_.reset(new double[observer_n_room(&core, kStepsKept, kModesKept)]);
    run_ = observer_run_in(&core, remembered_.get(), room_.get(), kStepsKept, kModesKept);
    observer_clear_room(&run_);
    observer_start(&run_);
  }

  double next(const MachineRun& run) override {
    if (!has_channels_) find_channels(run);
    rows_of_ = &run;
    const observer_rows rows = {.of = this,
                                .time_s = time_s,
                                .ambient_K = told_ambient_K,
                                .reading_C = reading_C,
                                .drift_um = measured_drift_um,
                                .piece = piece,
                                .laws = laws};
    const double doubted_s = run_.memory->doubted_s;
    const int wrong = observer_next(&run_, &rows);
    if (wrong == kLawFailed) std::rethrow_exception(failure_);
    if (wrong != 0) throw SolveError("the decomposition of an observer's conduction matrix did not converge");
    if (run_.memory->doubted_s != doubted_s) distrusted_.push_back(words_of_ambient());
    for (std::size_t k = 0; k < o_.sensors_.size(); ++k) {
      innovation_K_[k] = run_.readings[k].innovation_K;
      deviation_K_[k] = run_.readings[k].deviation_K;
      if (run_.sensors[k].dropped_s == run_.memory->now_s) distrusted_.push_back(words_of_dropped(k));
    }
    return observer_drift_um(&run_);
  }

  [[nodiscard]] double apart() const { return observer_apart(&run_); }
  [[nodiscard]] double deserved_trust() const override { return observer_trust(&run_); }
  [[nodiscard]] std::optional<double> deviation_um() const override { return observer_deviation_um(&run_); }
  [[nodiscard]] Eigen::VectorXd outputs() const override {
    Eigen::VectorXd y(tables_.core.n_outputs);
    observer_outputs(&run_, y.data());
    return y;
  }
  [[nodiscard]] const std::vector<double>& innovation_K() const override { return innovation_K_; }
  [[nodiscard]] const std::vector<double>& deviation_K() const override { return deviation_K_; }
  [[nodiscard]] std::vector<std::string> given_up() const override {
    std::vector<std::string> names;
    if (observer_doubts_ambient(&run_)) names.push_back(words_of_ambient());
    for (std::size_t k = 0; k < o_.sensors_.size(); ++k) {
      if (run_.sensors[k].is_live == 0.0) {
        names.push_back(words_of_dropped(k));
      } else if (run_.memory->row > 0.0 && observer_is_silent(&run_, static_cast<int>(k))) {
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
    std::vector<double> all;
    double ambient_K = observer_ambient_K(&run_), is_doubted = observer_doubts_ambient(&run_);
    each_number(ambient_K, is_doubted, [&](double number) { all.push_back(number); });
    return all;
  }
  void recall(std::span<const double> memory) override {
    if (memory.size() != this->memory().size()) throw std::logic_error("the memory of another observer");
    auto at = memory.begin();
    double ambient_K = 0.0, is_doubted = 0.0;
    each_number(ambient_K, is_doubted, [&](double& number) { number = *at++; });
    observer_recall_ambient(&run_, ambient_K, is_doubted != 0.0);
    const int n = run_.filter.n_all;
    for (int c = 0; c < n; ++c) {
      for (int r = c; r < n; ++r) run_.filter.covariance[c * n + r] = run_.filter.covariance[r * n + c];
    }
    for (std::size_t k = 0; k < o_.sensors_.size(); ++k) {
      if (run_.sensors[k].is_live == 0.0) distrusted_.push_back(words_of_dropped(k));
    }
  }

  [[nodiscard]] Belief factors() const {
    const Eigen::Index n = tables_.core.machine.n, n_all = run_.filter.n_all, n_factors = o_.factors_.mean.size();
    const Eigen::Map<const Eigen::VectorXd> mean(run_.filter.mean, n_all);
    const Eigen::Map<const Eigen::MatrixXd> covariance(run_.filter.covariance, n_all, n_all);
    return {mean.segment(n, n_factors), covariance.block(n, n, n_factors, n_factors)};
  }

 private:
  /// All numbers of a memory in their order; of the covariance the lower triangle.
  template <class F>
  void each_number(double& ambient_K, double& is_doubted, const F& f) const {
    const auto each = [&](std::initializer_list<double*> list) {
      for (double* number : list) f(*number);
    };
    const auto agreement = [&](observer_agreement& a) { each({&a.agreed_s, &a.mean_C, &a.low_C, &a.high_C}); };
    observer_memory& m = *run_.memory;
    each({&m.row, &m.start_ambient_K, &ambient_K, &is_doubted, &m.doubted_row, &m.doubted_s, &m.is_model_wrong,
          &m.usual_step_s, &m.now_s, &m.start_s});
    agreement(m.model);
    for (std::size_t k = 0; k < o_.sensors_.size(); ++k) {
      observer_sensor& s = run_.sensors[k];
      observer_reading& r = run_.readings[k];
      each({&s.is_live, &s.dropped_s, &s.mean_innovation, &s.last_s, &r.last_s, &r.spread_K});
      agreement(s.agreement);
    }
    const observer_filter& filter = run_.filter;
    for (int i = 0; i < filter.machine->n_sources; ++i) f(filter.least_W[i]);
    for (int i = 0; i < filter.machine->n_sources; ++i) f(filter.most_W[i]);
    for (int i = 0; i < filter.machine->n; ++i) f(filter.start_state[i]);
    for (int i = 0; i < filter.n_all; ++i) f(filter.mean[i]);
    for (int c = 0; c < filter.n_all; ++c) {
      for (int r = c; r < filter.n_all; ++r) f(filter.covariance[r * filter.n_all + c]);
    }
  }

  void find_channels(const MachineRun& run) {
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

  [[nodiscard]] std::string words_of_dropped(std::size_t sensor) const {
    return fmt::format("{} from {:.0f} min", o_.sensors_[sensor], run_.sensors[sensor].dropped_s / 60.0);
  }
  [[nodiscard]] std::string words_of_ambient() const {
    return fmt::format("the ambient thermometer from {:.0f} min", run_.memory->doubted_s / 60.0);
  }

  // Callbacks of observer_rows. No exception passes a C frame.
  static const MachineRun& rows_of(void* of) { return *static_cast<Run*>(of)->rows_of_; }
  static std::size_t index_of(const MachineRun& run, long row) { return run.at(static_cast<std::size_t>(row)); }
  static double time_s(void* of, long row) { return rows_of(of).readings.time_s[index_of(rows_of(of), row)]; }
  static double told_ambient_K(void* of, long, double t_s) { return rows_of(of).ambient.at(t_s); }
  static double reading_C(void* of, long row, int sensor) {
    const std::size_t channel = static_cast<Run*>(of)->sensor_channel_[static_cast<std::size_t>(sensor)];
    return rows_of(of).readings.channels[channel].values[index_of(rows_of(of), row)];
  }
  static double measured_drift_um(void* of, long row) {
    return rows_of(of).readings.channels[static_cast<Run*>(of)->drift_channel_].values[index_of(rows_of(of), row)];
  }
  static int piece(void* of, long, int piece, double* until_s) {
    const MachineRun& run = rows_of(of);
    const auto k = static_cast<std::size_t>(piece), n = run.cyclogram.sections.size();
    if (k >= n) return 0;
    double& end_s = static_cast<Run*>(of)->section_end_s_;
    end_s = (k == 0 ? run.cyclogram_from_s : end_s) + run.cyclogram.sections[k].duration_s;
    *until_s = k + 1 == n ? std::numeric_limits<double>::infinity() : end_s;  // the last one goes on
    return 1;
  }
  static int laws(void* of, long, int piece, double from_s, double ambient_K, double* power_W, double* coefficient) {
    Run& own = *static_cast<Run*>(of);
    try {
      const Cyclogram& cyclogram = own.rows_of_->cyclogram;
      effects::Inputs at{
          .drive = cyclogram.sections[static_cast<std::size_t>(piece)].drive, .ambient_K = ambient_K, .time_s = from_s};
      at.run = cyclogram.name;
      for (const auto& source : own.o_.system_.sources) *power_W++ = source.power_W(at);
      for (const auto& e : own.o_.system_.exchanges) *coefficient++ = e.coefficient(at);
      return 0;
    } catch (...) {
      own.failure_ = std::current_exception();
      return kLawFailed;
    }
  }

  const Observer& o_;
  bool with_drift_, has_channels_ = false;
  ObserverTables tables_;
  std::unique_ptr<double[]> remembered_, room_;
  observer_run run_ = {};
  const MachineRun* rows_of_ = nullptr;  // of the call of next() that is under way
  double section_end_s_ = 0.0;
  std::exception_ptr failure_;
  std::vector<std::size_t> sensor_channel_;
  std::size_t drift_channel_ = 0;
  std::vector<double> innovation_K_, deviation_K_;
  std::vector<std::string> distrusted_;
};

void Observer::learn(std::span<const MachineRun> runs) {
  std::vector<double> steps_s;
  for (const MachineRun& run : runs) {
    for (std::size_t i = 1; i < run.readings.n_samples(); ++i)
      steps_s.push_back(run.readings.time_s[i] - run.readings.time_s[i - 1]);
  }
  if (!steps_s.empty()) settings_.period_s = quantile(std::move(steps_s), 0.5);
  for (const MachineRun& run : runs) {
    Run pass(*this, true);
    for (std::size_t i = 0; i < run.readings.n_samples(); ++i) (void)pass.next(run);
    factors_ = pass.factors();
  }
}

Observer Observer::calibrated(std::span<const MachineRun> runs) const {
  Observer other = *this;
  other.settings_.most_apart = std::numeric_limits<double>::infinity();
  std::vector<double> apart;  // the mean of few rows, or one row in a thousand, is not used as a limit
  for (const MachineRun& run : runs) {
    Run pass(other, false);
    for (std::size_t i = 0; i < run.readings.n_samples(); ++i) {
      (void)pass.next(run);
      if (i >= kObserverRowsWarm) apart.push_back(pass.apart());
    }
  }
  other.settings_.most_apart = apart.empty() ? 1.0 : std::max(1.0, kRoom * quantile(std::move(apart), 0.999));
  return other;
}

Observation Observer::observe(const MachineRun& run) const {
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
