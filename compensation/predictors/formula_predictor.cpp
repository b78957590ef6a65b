#include "compensation/predictors/formula_predictor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/json_value.hpp"
#include "base/record_channel.hpp"
#include "compensation/predictors/control_tables.hpp"
#include "compensation/predictors/predictor_kind.hpp"

namespace driftwright::compensation {
namespace {

/// A formula with the memories of its lags.
class Evaluated {
 public:
  /// @param inputs  the order of the readings
  Evaluated(const DriftModel& model, const std::vector<std::string>& inputs)
      : table_(formula_table(model, inputs)), memories_(model.terms.size()) {}

  double next(const double* readings, double dt_s) {
    return drift_formula_value(&table_.formula, memories_.data(), readings, dt_s);
  }
  void add_memory(std::vector<double>& m) const {
    for (const drift_term_state& t : memories_)
      m.insert(m.end(),
               {static_cast<double>(t.has_start), static_cast<double>(t.has_lag), t.start, t.lag, t.before, t.since_s});
  }
  [[nodiscard]] std::size_t n_memory() const { return 6 * memories_.size(); }
  void recall(const double* m) {
    for (drift_term_state& t : memories_) {
      t = {m[0] != 0.0, m[1] != 0.0, m[2], m[3], m[4], m[5]};
      m += 6;
    }
  }

 private:
  FormulaTable table_;
  std::vector<drift_term_state> memories_;  // all zero before the first row
};

class FormulaFollower final : public Follower {
 public:
  FormulaFollower(const DriftModel& model, const std::vector<DriftModel>& members, std::vector<Input> inputs)
      : inputs_(std::move(inputs)), channel_(inputs_.size()), reading_(inputs_.size()) {
    const std::vector<std::string> names = model.inputs();
    formulas_.emplace_back(model, names);
    for (const DriftModel& member : members) formulas_.emplace_back(member, names);
  }

  double next(const MachineRun& run) override {
    const Record& readings = run.readings;
    if (!has_channels_) find_channels(readings);
    const std::size_t at = run.at(row_);
    for (std::size_t k = 0; k < inputs_.size(); ++k) reading_[k] = readings.channels[channel_[k]].values[at];
    const double dt_s = row_ > 0 ? readings.time_s[at] - readings.time_s[at - 1] : 0.0;
    ++row_;
    const double mean_um = formulas_.front().next(reading_.data(), dt_s);
    square_um2_ = 0.0;
    members_um_.clear();
    for (std::size_t k = 1; k < formulas_.size(); ++k) {
      members_um_.push_back(formulas_[k].next(reading_.data(), dt_s));
      const double apart_um = members_um_.back() - mean_um;
      square_um2_ += apart_um * apart_um / static_cast<double>(formulas_.size() - 1);
    }
    return mean_um;
  }

  [[nodiscard]] std::optional<double> deviation_um() const override {
    return formulas_.size() > 1 && std::isfinite(square_um2_) ? std::optional(std::sqrt(square_um2_)) : std::nullopt;
  }

  [[nodiscard]] std::vector<double> members_um() const override { return members_um_; }

  [[nodiscard]] std::vector<double> memory() const override {
    std::vector<double> m = {static_cast<double>(row_)};
    for (const Evaluated& formula : formulas_) formula.add_memory(m);
    return m;
  }
  void recall(std::span<const double> memory) override {
    std::size_t n = 1;
    for (const Evaluated& formula : formulas_) n += formula.n_memory();
    if (memory.size() != n) throw std::logic_error("the memory of another formula");
    row_ = static_cast<std::size_t>(memory[0]);
    const double* m = &memory[1];
    for (Evaluated& formula : formulas_) {
      formula.recall(m);
      m += formula.n_memory();
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
  std::vector<Evaluated> formulas_;  // the formula, then its members
  std::vector<std::size_t> channel_;
  std::vector<double> reading_, members_um_;
  double square_um2_ = 0.0;  // mean square of the members' distances in the last row
  std::size_t row_ = 0;
  bool has_channels_ = false;
};

/// Intercept and terms.
json::Json written_terms(const DriftModel& model) {
  json::Json j = {{"kind", model.kind}, {"intercept", model.intercept}, {"terms", json::Json::array()}};
  for (const DriftModel::Term& t : model.terms) {
    j["terms"].push_back(
        {{"input", t.input}, {"unit", t.unit}, {"coefficient", t.coefficient}, {"power", t.power}, {"lag_s", t.lag_s}});
    if (t.is_running) j["terms"].back()["is_running"] = true;
  }
  return j;
}

DriftModel read_terms(const json::Json& j, const DriftTarget& target) {
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
  return m;
}

std::shared_ptr<const Predictor> read_formula(const json::Json& j, const DriftTarget& target) {
  DriftModel model = read_terms(j, target);
  std::vector<DriftModel> members;
  if (j.contains("members")) {
    const std::vector<std::string> inputs = model.inputs();
    for (const json::Json& member : json::list(j, "members")) {
      members.push_back(read_terms(member, target));
      for (const std::string& input : members.back().inputs()) {
        if (std::find(inputs.begin(), inputs.end(), input) == inputs.end())
          throw InputError(fmt::format("a member reads '{}', which the formula does not; `terms` must have it", input));
      }
    }
  }
  return std::make_shared<FormulaPredictor>(std::move(model), std::move(members));
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

double FormulaPredictor::memory_s() const {
  double longest_s = 0.0;
  for (const DriftModel::Term& t : model_.terms) longest_s = std::max(longest_s, t.lag_s);
  return longest_s;
}

std::unique_ptr<Follower> FormulaPredictor::follow() const {
  return std::make_unique<FormulaFollower>(model_, members_, inputs());
}

std::optional<Written> FormulaPredictor::written() const {
  json::Json j = written_terms(model_);
  for (const DriftModel& member : members_) j["members"].push_back(written_terms(member));
  return Written{.kind = "formula", .content = std::move(j)};
}

PredictorKind formula_kind() {
  return {.key = "formula", .read = read_formula};
}

}  // namespace driftwright::compensation
