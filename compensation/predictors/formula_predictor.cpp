#include "compensation/predictors/formula_predictor.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/errors.hpp"
#include "compensation/predictors/control_tables.hpp"

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
      channel_[k] = static_cast<std::size_t>(&channel - readings.channels.data());
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

const DriftModel* as_formula(const Predictor& predictor) {
  const auto* formula = dynamic_cast<const FormulaPredictor*>(&predictor);
  return formula ? &formula->model() : nullptr;
}

}  // namespace driftwright::compensation
