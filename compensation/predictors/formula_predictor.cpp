#include "compensation/predictors/formula_predictor.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/errors.hpp"
#include "base/json_value.hpp"
#include "base/record_channel.hpp"
#include "compensation/predictors/control_tables.hpp"
#include "compensation/predictors/predictor_kind.hpp"

namespace driftwright::compensation {
namespace {

class FormulaFollower final : public Follower {
 public:
  FormulaFollower(const DriftModel& model, std::vector<Input> inputs)
      : inputs_(std::move(inputs)),
        table_(formula_table(model, model.inputs())),
        memories_(model.terms.size()),
        channel_(inputs_.size()),
        reading_(inputs_.size()) {}

  double next(const ObservedRun& run) override {
    const Record& readings = run.readings;
    if (!has_channels_) find_channels(readings);
    const std::size_t at = run.at(row_);
    for (std::size_t k = 0; k < inputs_.size(); ++k) reading_[k] = readings.channels[channel_[k]].values[at];
    const double dt_s = row_ > 0 ? readings.time_s[at] - readings.time_s[at - 1] : 0.0;
    ++row_;
    return drift_formula_value(&table_.formula, memories_.data(), reading_.data(), dt_s);
  }

  [[nodiscard]] std::vector<double> memory() const override {
    std::vector<double> m = {static_cast<double>(row_)};
    for (const drift_term_state& t : memories_)
      m.insert(m.end(),
               {static_cast<double>(t.has_start), static_cast<double>(t.has_lag), t.start, t.lag, t.before, t.since_s});
    return m;
  }
  void recall(std::span<const double> memory) override {
    if (memory.size() != 1 + 6 * memories_.size()) throw std::logic_error("the memory of another formula");
    row_ = static_cast<std::size_t>(memory[0]);
    for (std::size_t k = 0; k < memories_.size(); ++k) {
      const double* m = &memory[1 + 6 * k];
      memories_[k] = {m[0] != 0.0, m[1] != 0.0, m[2], m[3], m[4], m[5]};
    }
  }

 private:
  void find_channels(const Record& readings) {
    has_channels_ = true;
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
      const Channel& channel = readings.at(inputs_[k].name);
      if (channel.unit != inputs_[k].unit)
        throw InputError(fmt::format("channel '{}' of {} is in {}, but the model was fitted in {}", channel.name,
                                     readings.source, channel.unit, inputs_[k].unit));
      channel_[k] = channel_index(readings, inputs_[k].name);
    }
  }

  std::vector<Input> inputs_;
  FormulaTable table_;
  std::vector<drift_term_state> memories_;  // all zero before the first row
  std::vector<std::size_t> channel_;
  std::vector<double> reading_;
  std::size_t row_ = 0;
  bool has_channels_ = false;
};

std::shared_ptr<const Predictor> read_formula(const json::Json& j, const DriftTarget& target) {
  DriftModel m;
  m.target = target.name;
  m.target_unit = "um";
  m.from_start = target.from_start;
  m.kind = json::value<std::string>(j, "kind");
  m.intercept = json::finite(j, "intercept");
  for (const json::Json& t : json::list(j, "terms")) {
    m.terms.push_back({.input = json::value<std::string>(t, "input"),
                       .unit = json::value<std::string>(t, "unit"),
                       .coefficient = json::finite(t, "coefficient"),
                       .power = json::value<int>(t, "power"),
                       .lag_s = json::finite(t, "lag_s"),
                       .is_running = t.contains("is_running") && json::value<bool>(t, "is_running")});
    const DriftModel::Term& term = m.terms.back();
    if (term.lag_s < 0.0 || term.power < 1)
      throw InputError(fmt::format("term '{}' has `lag_s` {} and `power` {}; they must be at least 0 and 1", term.input,
                                   term.lag_s, term.power));
    if (term.is_running && term.power != 1)
      throw InputError(fmt::format("term '{}' has `is_running` and `power` {}; with `is_running` the power is 1", term.input,
                                   term.power));
  }
  return std::make_shared<FormulaPredictor>(std::move(m));
}

}  // namespace

std::vector<Input> FormulaPredictor::inputs() const {
  std::vector<Input> inputs;
  for (const std::string& name : model_.inputs()) {
    for (const DriftModel::Term& t : model_.terms) {
      if (t.input != name) continue;
      inputs.push_back({name, t.unit});
      break;
    }
  }
  return inputs;
}

std::unique_ptr<Follower> FormulaPredictor::follow() const {
  return std::make_unique<FormulaFollower>(model_, inputs());
}

std::optional<Written> FormulaPredictor::written() const {
  json::Json j = {{"kind", model_.kind}, {"intercept", model_.intercept}, {"terms", json::Json::array()}};
  for (const DriftModel::Term& t : model_.terms) {
    j["terms"].push_back(
        {{"input", t.input}, {"unit", t.unit}, {"coefficient", t.coefficient}, {"power", t.power}, {"lag_s", t.lag_s}});
    if (t.is_running) j["terms"].back()["is_running"] = true;
  }
  return Written{.kind = "formula", .content = std::move(j)};
}

PredictorKind formula_kind() {
  return {.key = "formula", .read = read_formula};
}

}  // namespace driftwright::compensation
