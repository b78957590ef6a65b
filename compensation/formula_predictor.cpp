#include "compensation/formula_predictor.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "base/errors.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

class FormulaFollower final : public Follower {
 public:
  explicit FormulaFollower(const DriftModel& model) : model_(model), memories_(model.terms.size()) {}

  double next(const ObservedRun& run) override {
    if (row_ == 0) find_channels(run.readings);
    const double t_s = run.readings.time_s[row_];
    double drift = model_.intercept;
    for (std::size_t k = 0; k < memories_.size(); ++k)
      drift += model_.terms[k].coefficient * lagged(k, run.readings.channels[memories_[k].channel].values[row_], t_s);
    ++row_;
    return drift;
  }

 private:
  struct Memory {
    std::size_t channel = 0;
    double start = kMissing, state = kMissing, before = 0.0, before_s = 0.0;
  };

  void find_channels(const Record& readings) {
    for (std::size_t k = 0; k < memories_.size(); ++k) {
      const Channel& channel = readings.at(model_.terms[k].input);
      if (channel.unit != model_.terms[k].unit)
        throw InputError(fmt::format("channel '{}' of {} is in {}, but the model was fitted in {}", channel.name,
                                     readings.source, channel.unit, model_.terms[k].unit));
      memories_[k].channel = static_cast<std::size_t>(&channel - readings.channels.data());
    }
  }

  double lagged(std::size_t k, double x, double t_s) {
    const DriftModel::Term& term = model_.terms[k];
    Memory& m = memories_[k];
    if (std::isnan(x)) return kMissing;
    const bool drives = is_drive(term.unit);
    if (model_.from_start && !drives) {
      if (std::isnan(m.start)) m.start = x;
      x -= m.start;
    }
    const double value = std::pow(x, term.power);
    if (term.lag_s == 0.0) return value;
    if (std::isnan(m.state)) {
      m.state = drives ? 0.0 : value;
    } else {
      const double towards = drives ? m.before : 0.5 * (m.before + value);
      m.state += (1.0 - std::exp(-(t_s - m.before_s) / term.lag_s)) * (towards - m.state);
    }
    m.before = value;
    m.before_s = t_s;
    return m.state;
  }

  const DriftModel& model_;
  std::vector<Memory> memories_;
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
  return std::make_unique<FormulaFollower>(model_);
}

const DriftModel* as_formula(const Predictor& predictor) {
  const auto* formula = dynamic_cast<const FormulaPredictor*>(&predictor);
  return formula ? &formula->model() : nullptr;
}

}  // namespace driftwright::compensation
