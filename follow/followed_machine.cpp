#include "follow/followed_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/quantity.hpp"
#include "effects/feed_axis.hpp"
#include "effects/learned.hpp"
#include "effects/recorded_column.hpp"
#include "follow/state_json.hpp"
#include "machine/simulated_run.hpp"
#include "scenarios/reader/felt_run.hpp"
#include "solver/propagator.hpp"
#include "solver/reduced_transient.hpp"
#include "studies/known_speed.hpp"
#include "studies/prediction.hpp"

namespace driftwright::follow {
namespace {

using scenarios::MachineModel;

void require_streamable(const MachineModel& machine) {
  for (const effects::Effect& e : machine.effects) {
    const auto refuse = [&](const std::string& why) {
      throw InputError(
          e.where, fmt::format("{} {}; a stream does not say enough about it, and `follow` requires a machine without it",
                               e.name(), why));
    };
    const bool is_of_positions = effects::follows_positions(e);
    if (effects::changes_drive(e) && !is_of_positions)
      refuse("changes what the record of the drive or of the ambient says, by what comes before or after a row");
    const bool is_learned = e.kind->key == "learned";
    if (effects::changes_readings(e) && e.place_kind != effects::Place::kSensor && !is_learned && !is_of_positions)
      refuse("changes what instruments say of displacements, by all that came before");
    if (is_learned && e.place_kind != effects::Place::kSensor && e.words.at("follows") == "column" &&
        !effects::is_drive_channel(e.words.at("column")))
      refuse(fmt::format("follows the recorded column '{}'", e.words.at("column")));
    if (e.kind->key == "heat_source" && e.has("fades")) refuse("fades from the start of a record");
    if (!e.in.empty()) refuse(fmt::format("holds in the cyclogram '{}' alone", e.in));
    if (e.from_s > 0.0 || e.until_s < effects::kNever_s) refuse("holds for a part of a run");
  }
}

/// The columns of positions that effects follow.
std::vector<FollowedColumn> columns_of_positions(const MachineModel& machine) {
  std::vector<FollowedColumn> columns;
  for (const effects::Effect& e : machine.effects) {
    if (!effects::follows_positions(e)) continue;
    for (const effects::Mention& m : e.kind->mentions) {
      if (m.of != effects::Mention::Of::kColumn) continue;
      const std::string &word = e.words.at(m.name), ending = "_" + m.unit;
      const auto is_it = [&](const FollowedColumn& c) { return c.signal == word; };
      if (word.empty() || std::any_of(columns.begin(), columns.end(), is_it)) continue;
      columns.push_back({word, word.ends_with(ending) ? word.substr(0, word.size() - ending.size()) : word, m.unit});
    }
  }
  return columns;
}

/// What effects add to displacements by positions.
effects::ReadingChain growth_by_positions(const MachineModel& machine) {
  std::vector<effects::Effect> list;
  std::copy_if(machine.effects.begin(), machine.effects.end(), std::back_inserter(list), effects::follows_positions);
  return effects::reading_chain(list, "");
}

/// `speed` of `limits`, else a fifth above all that the scenario says something of; beyond, laws may have no value.
double most_speed_rpm(const scenarios::Scenario& scenario) {
  constexpr double kRoom = 1.2;
  if (std::isfinite(scenario.limits.speed_rpm)) return scenario.limits.speed_rpm;
  const double known_rpm = studies::known_speed_rpm(scenario);
  return known_rpm > 0.0 ? kRoom * known_rpm : std::numeric_limits<double>::infinity();
}

class FollowedMachine final : public Followed {
 public:
  FollowedMachine(const scenarios::Scenario& scenario, const FollowOptions& options, const Listener& listener)
      : path_(scenario.path),
        machine_(*scenario.machine),
        most_speed_rpm_(most_speed_rpm(scenario)),
        tolerances_(scenario.solver.transient),
        columns_(columns_of_positions(machine_)),
        by_positions_(growth_by_positions(machine_)) {
    require_streamable(machine_);
    scenarios::Scenario asked = scenario;
    asked.solver.model = studies::predicting_model(scenario);
    if (options.for_picture && asked.solver.fields_format == FieldsFormat::kNone)
      asked.solver.fields_format = FieldsFormat::kVtu;
    model_.emplace(scenarios::open_model(asked, {}, listener, false));
    const auto has_thermostats = [](const auto& system) { return !system.thermostats.empty(); };
    if (model_->reduced() ? has_thermostats(model_->reduced()->system) : has_thermostats(model_->full()->system))
      throw InputError(machine_.where, "a machine with thermostats cannot be followed: no row says whether they are on");
    if (model_->reduced() && model_->is_linear()) exact_.emplace(model_->reduced()->system);
    for (const scenarios::Sensor& s : machine_.sensors) {
      if (scenarios::is_on_ambient(s) && ambient_.empty()) ambient_ = s.name;
    }
    if (ambient_.empty()) ambient_ = scenarios::kAmbient;
    const solver::Outputs& outputs = model_->outputs();
    OutputSettings settings;
    settings.most_rate_um_s = options.most_rate_um_s.value_or(settings.most_rate_um_s);
    settings.hold_s = options.hold_s.value_or(settings.hold_s);
    settings.fade_s = options.fade_s.value_or(settings.fade_s);
    settings.limits = scenario.limits.correction;
    for (const scenarios::DisplacementOutput& d : machine_.displacements) {
      const auto at = std::find(outputs.name.begin(), outputs.name.end(), d.name);
      if (at == outputs.name.end()) throw std::logic_error("a displacement is no output of the model");
      output_.push_back(at - outputs.name.begin());
      learned_.emplace_back(machine_.effects, d.name);
      axes_.push_back({.name = d.name, .interval_um = {}, .deviation_um = {}});
      stages_.emplace_back(settings);
    }
    if (axes_.empty()) throw InputError(machine_.where, "the machine has no `displacements`; there is nothing to correct");
  }

  [[nodiscard]] std::vector<WantedChannel> wanted() const override {
    std::vector<WantedChannel> channels = {{"speed", "rpm", path_}, {ambient_, "degC", path_}};
    for (const effects::Effect& e : machine_.effects) {
      if (e.kind->key == "feed_axis") channels.push_back({"feed_" + e.words.at("axis"), "mm_min", path_});
    }
    for (const FollowedColumn& c : columns_) channels.push_back({c.name, c.unit, path_});
    return channels;
  }
  void begin(const std::vector<Channel>& channels) override {
    for (std::size_t k = 0; k < channels.size(); ++k) {
      if (channels[k].name == "speed" && channels[k].unit == "rpm") speed_ = k;
    }
    for (const FollowedColumn& c : columns_) {
      const auto is_it = [&](const Channel& channel) { return channel.name == c.name && channel.unit == c.unit; };
      column_.push_back(static_cast<std::size_t>(std::find_if(channels.begin(), channels.end(), is_it) - channels.begin()));
    }
    run_.emplace(channels, ambient_, machine_.reference_K, true, columns_);
  }

  bool take(double run_s, const std::vector<double>& as_read, double step_s) override {
    std::vector<double> values = as_read;
    beyond_.clear();  // what is beyond the machine: the model goes on with the last value
    if (values[speed_] > most_speed_rpm_) {
      values[speed_] = std::numeric_limits<double>::quiet_NaN();
      beyond_.emplace_back("speed");
    }
    leave_out_beyond_travel(values);
    const double ambient_before_K = run_->ambient_K();
    const bool is_first = run_->n_rows() == 0;
    if (!run_->add(run_s, values)) return false;
    const double now_s = run_->run().readings.time_s.back();
    if (is_first) {
      begin_state();
      const Eigen::VectorXd first = observed();
      for (std::size_t a = 0; a < axes_.size(); ++a) learned_[a].begin(first[output_[a]], run_->ambient_K());
    } else {
      advance(now_s, ambient_before_K);
    }
    show_predicted();
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      if (!beyond_.empty()) {
        stages_[a].wait(step_s);  // the correction is held, and fades if that lasts
      } else {
        stages_[a].take(axes_[a].predicted_um, step_s, run_->drive_age_s());
      }
    }
    return true;
  }
  void wait(double step_s) override {
    for (OutputStage& stage : stages_) stage.wait(step_s);
  }
  [[nodiscard]] bool has_begun() const override { return run_ && run_->n_rows() > 0; }

  [[nodiscard]] const scenarios::Model* model() const override { return &*model_; }
  [[nodiscard]] std::optional<MachineState> machine_state() const override {
    if (!has_begun()) return std::nullopt;
    return MachineState{state_, run_->ambient_K()};
  }

  [[nodiscard]] std::vector<AxisCorrection> axes() const override {
    std::vector<AxisCorrection> axes = axes_;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      axes[a].correction_um = stages_[a].state().correction_um;
      axes[a].trust = has_begun() ? stages_[a].state().authority : 0.0;
      if (run_) axes[a].doubted = has_begun() ? run_->older_than(stages_[a].most_age_s()) : run_->not_given();
      for (const std::string& name : beyond_) {
        std::vector<std::string>& doubted = axes[a].doubted;
        if (std::find(doubted.begin(), doubted.end(), name) == doubted.end()) doubted.push_back(name);
      }
    }
    return axes;
  }

  [[nodiscard]] Json state() const override {
    Json stages = Json::array();
    for (const OutputStage& stage : stages_) stages.push_back(state_json(stage.state()));
    if (!has_begun()) return {{"run", nullptr}, {"stages", std::move(stages)}};
    Json j = {{"run", state_json(run_->state())},
              {"state", numbers_json({state_.begin(), state_.end()})},
              {"stages", std::move(stages)}};
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      if (learned_[a].empty()) continue;
      const effects::LearnedStream::State& learned = learned_[a].state();
      std::vector<double> numbers = {learned.first, learned.first_ambient_K};
      numbers.insert(numbers.end(), learned.x.begin(), learned.x.end());
      j[kLearned][axes_[a].name] = numbers_json(numbers);
    }
    return j;
  }
  void recall(const Json& j) override {
    const Json stages = output::list(j, "stages");
    if (stages.size() != stages_.size()) throw InputError("key `stages` is of another number of axes");
    for (std::size_t a = 0; a < stages_.size(); ++a) stages_[a].recall(output_stage_of(stages[a]));
    const auto run = output::value<Json>(j, "run");
    if (run.is_null()) return;
    run_->recall(live_run_of(run));
    const std::vector<double> state = numbers_of(j, "state");
    state_ = Eigen::Map<const Eigen::VectorXd>(state.data(), static_cast<Eigen::Index>(state.size()));
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      if (learned_[a].empty()) continue;
      const std::vector<double> numbers = numbers_of(output::value<Json>(j, kLearned), axes_[a].name.c_str());
      if (numbers.size() < 2) throw InputError(fmt::format("key `learned` has too few numbers of '{}'", axes_[a].name));
      learned_[a].recall({numbers[0], numbers[1], {numbers.begin() + 2, numbers.end()}});
    }
    show_predicted();
  }

 private:
  static constexpr const char* kLearned = "learned";  // key of the state

  void show_predicted() {
    const Eigen::VectorXd outputs = observed();
    for (std::size_t a = 0; a < axes_.size(); ++a)
      axes_[a].predicted_um = 1e6 * learned_[a].with_learned(outputs[output_[a]], run_->drive());
  }

  /// Positions of a row that would move a nut out of its travel count as missing.
  void leave_out_beyond_travel(std::vector<double>& values) {
    const auto index_of = [&](const std::string& word) {
      const auto is_it = [&](const FollowedColumn& c) { return c.signal == word; };
      return static_cast<std::size_t>(std::find_if(columns_.begin(), columns_.end(), is_it) - columns_.begin());
    };
    const std::vector<double> row = values;
    const auto value = [&](std::size_t column) {
      const double now = row[column_[column]];
      return std::isnan(now) ? run_->drive().signals[column].value : now;
    };
    for (const effects::Effect& e : machine_.effects) {
      if (e.kind->key != "feed_axis" || e.words.at("position").empty()) continue;
      const std::size_t position = index_of(e.words.at("position"));
      const bool has_stroke = !e.words.at("stroke").empty();
      const std::size_t stroke = has_stroke ? index_of(e.words.at("stroke")) : position;
      const double middle_mm = value(position), stroke_mm = has_stroke ? value(stroke) : 0.0;
      if (std::isnan(middle_mm) || std::isnan(stroke_mm) || effects::is_within_travel(e, middle_mm, stroke_mm)) continue;
      values[column_[position]] = values[column_[stroke]] = std::numeric_limits<double>::quiet_NaN();
      beyond_.push_back(columns_[position].name);
    }
  }

  /// Starts at the ambient of the first row if the scenario's start is the ambient or in balance with it.
  void begin_state() {
    const double warmer_K = scenarios::warmer_start_K(machine_, TimeSeries{{0.0}, {run_->ambient_K()}});
    state_ = scenarios::start_of(machine_, *model_) + warmer_K * scenarios::ones_of(*model_);
  }

  /// Advances the state over the last step. The time before it is one section, which is not computed again.
  void advance(double now_s, double ambient_before_K) {
    const double before_s = now_s - run_->run().cyclogram.sections.back().duration_s;
    for (effects::LearnedStream& learned : learned_)
      learned.advance(now_s - before_s, run_->drive_before(), ambient_before_K, run_->ambient_K());
    Cyclogram cyclogram{.name = "stream", .sections = {}};
    if (before_s > 0.0) cyclogram.sections.push_back({before_s, run_->drive_before()});
    cyclogram.sections.push_back({now_s - before_s, run_->drive_before()});
    const TimeSeries ambient{{before_s, now_s}, {ambient_before_K, run_->ambient_K()}};
    solver::TransientOptions from_here = tolerances_;
    from_here.from_s = before_s;
    const auto keep = [&](double, const Eigen::VectorXd& state) { state_ = state; };
    const Eigen::VectorXd start = state_;
    const double end_s = cyclogram.duration_s();
    if (exact_) {
      Eigen::MatrixXd states;
      (void)exact_->run(cyclogram, ambient, {end_s}, start, false, &states, before_s);
      state_ = states.col(0);
    } else if (model_->reduced()) {
      (void)solver::simulate(model_->reduced()->system, cyclogram, ambient, {end_s}, from_here, start, keep);
    } else {
      (void)solver::simulate(model_->full()->system, cyclogram, ambient, {end_s}, from_here, start, keep);
    }
  }

  /// The outputs of the model, with what positions add in the last row.
  [[nodiscard]] Eigen::VectorXd observed() const {
    const double ambient_K = run_->ambient_K();
    Eigen::VectorXd outputs = model_->reduced() ? model_->reduced()->system.observe(state_, ambient_K)
                                                : model_->full()->system.observe(state_, ambient_K);
    if (by_positions_.empty()) return outputs;
    Cyclogram row{.name = "stream", .sections = {}};
    for (std::size_t k = 0; k < columns_.size(); ++k)
      row.columns.push_back({columns_[k].signal, columns_[k].unit, {{0.0}, {run_->drive().signals[k].value}}});
    const solver::Outputs& of = model_->outputs();
    return by_positions_.apply(of.name, of.unit, {0.0}, row, {{0.0}, {ambient_K}}, outputs);
  }

  std::string path_, ambient_;
  MachineModel machine_;
  double most_speed_rpm_;
  std::vector<std::string> beyond_;  // channels of the last row with a value that the machine cannot have
  std::size_t speed_ = 0;            // channel
  solver::TransientOptions tolerances_;
  std::vector<FollowedColumn> columns_;
  std::vector<std::size_t> column_;  // channel of each
  effects::ReadingChain by_positions_;
  std::optional<scenarios::Model> model_;
  std::optional<solver::Propagator> exact_;  // for a linear reduced model
  std::optional<LiveRows> run_;
  Eigen::VectorXd state_;
  std::vector<Eigen::Index> output_;             // index of each axis
  std::vector<effects::LearnedStream> learned_;  // of each axis
  std::vector<AxisCorrection> axes_;
  std::vector<OutputStage> stages_;
};

}  // namespace

std::unique_ptr<Followed> followed_machine(const scenarios::Scenario& scenario, const FollowOptions& options,
                                           const Listener& listener) {
  return std::make_unique<FollowedMachine>(scenario, options, listener);
}

}  // namespace driftwright::follow
