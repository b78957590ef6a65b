#include "compensation/predictors/past_drift.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "base/json_value.hpp"
#include "compensation/predictors/predictor_kind.hpp"
#include "compensation/predictors/score.hpp"

namespace driftwright::compensation {
namespace {

/// A drift that is a function of the time since the run began; NaN in its lead-in.
class TimeFollower final : public Follower {
 public:
  explicit TimeFollower(std::function<double(double t_s)> drift_um) : drift_um_(std::move(drift_um)) {}
  double next(const MachineRun& run) override {
    const std::size_t row = row_++;
    if (row < run.n_before) return std::numeric_limits<double>::quiet_NaN();
    const std::vector<double>& t = run.readings.time_s;
    return drift_um_(run.n_before > 0 ? t[row] - t[run.n_before] : t[run.at(row)]);
  }
  [[nodiscard]] std::vector<double> memory() const override { return {static_cast<double>(row_)}; }
  void recall(std::span<const double> memory) override { row_ = static_cast<std::size_t>(memory[0]); }

 private:
  std::function<double(double)> drift_um_;
  std::size_t row_ = 0;
};

std::shared_ptr<const Predictor> read_constant(const json::Json& j, const DriftTarget&) {
  return std::make_shared<ConstantPredictor>(json::finite(j, "drift_um"));
}

std::shared_ptr<const Predictor> read_earlier_runs(const json::Json& j, const DriftTarget& target) {
  std::vector<Record> runs;
  for (const json::Json& run : json::list(j, "runs")) {
    Record r{.source = json::value<std::string>(run, "name"),
             .time_s = json::value<std::vector<double>>(run, "time_s"),
             .channels = {{target.name, "um", {}}}};
    for (const json::Json& v : json::list(run, "drift_um"))
      r.channels[0].values.push_back(v.is_number() ? v.get<double>() : std::numeric_limits<double>::quiet_NaN());
    if (r.time_s.empty() || r.time_s.size() != r.channels[0].values.size() ||
        std::adjacent_find(r.time_s.begin(), r.time_s.end(), std::greater_equal<>()) != r.time_s.end())
      throw InputError(fmt::format("run '{}' must have as many `drift_um` as `time_s`, which rise", r.source));
    runs.push_back(std::move(r));
  }
  if (runs.empty()) throw InputError("`runs` is empty; at least one run is required");
  return std::make_shared<EarlierRunsPredictor>(runs, target.name);
}

}  // namespace

std::optional<Written> ConstantPredictor::written() const {
  return Written{.kind = "constant", .content = {{"drift_um", drift_um_}}};
}

std::unique_ptr<Follower> ConstantPredictor::follow() const {
  return std::make_unique<TimeFollower>([this](double) { return drift_um_; });
}

EarlierRunsPredictor::EarlierRunsPredictor(std::span<const Record> runs, const std::string& target) : target_(target) {
  for (const Record& run : runs) runs_.push_back({.source = run.source, .time_s = run.time_s, .channels = {run.at(target)}});
}

std::optional<Written> EarlierRunsPredictor::written() const {
  json::Json runs = json::Json::array();
  for (const Record& run : runs_) {
    json::Json drift = json::Json::array();
    for (double v : run.channels.front().values) drift.push_back(json::number(v));
    runs.push_back({{"name", run.source}, {"time_s", run.time_s}, {"drift_um", std::move(drift)}});
  }
  return Written{.kind = "earlier_runs", .content = {{"runs", std::move(runs)}}};
}

std::unique_ptr<Follower> EarlierRunsPredictor::follow() const {
  return std::make_unique<TimeFollower>([this](double t_s) {
    const Record moment{.source = {}, .time_s = {t_s}, .channels = {}};
    return baseline_same_time(runs_, moment, target_).front();
  });
}

PredictorKind constant_kind() {
  return {.key = "constant", .read = read_constant};
}

PredictorKind earlier_runs_kind() {
  return {.key = "earlier_runs", .read = read_earlier_runs};
}

}  // namespace driftwright::compensation
