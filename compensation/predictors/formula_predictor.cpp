#include "compensation/predictors/formula_predictor.hpp"

#include <fmt/format.h>

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
    if (row_ == 0) find_channels(readings);
    for (std::size_t k = 0; k < inputs_.size(); ++k) reading_[k] = readings.channels[channel_[k]].values[row_];
    const double dt_s = row_ > 0 ? readings.time_s[row_] - readings.time_s[row_ - 1] : 0.0;
    ++row_;
    return drift_formula_value(&table_.formula, memories_.data(), reading_.data(), dt_s);
  }

 private:
  void find_channels(const Record& readings) {
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
