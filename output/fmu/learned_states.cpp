#include "output/fmu/learned_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "effects/learned.hpp"

namespace driftwright::output {
namespace {

Eigen::MatrixXd with_zeros(const Eigen::MatrixXd& m, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd larger = Eigen::MatrixXd::Zero(rows, columns);
  larger.topLeftCorner(m.rows(), m.cols()) = m;
  return larger;
}

/// What places give, of a model with n_more more states after its n.
void grow(FmuAlong& along, Eigen::Index n, Eigen::Index n_more) {
  std::vector<double> cubics;
  for (auto row = along.cubics.begin(); row != along.cubics.end(); row += n + 1) {  // of the states and the ambient
    cubics.insert(cubics.end(), row, row + n);
    cubics.insert(cubics.end(), static_cast<std::size_t>(n_more), 0.0);
    cubics.push_back(row[n]);
  }
  along.cubics = std::move(cubics);
}

/// One more state, with dz/dt = -rate z so far. @return its index
Eigen::Index add_state(FmuModel& model, double rate_1_s) {
  const Eigen::Index i = model.start.size(), n = i + 1;
  const auto lengthen = [n](Eigen::VectorXd& v) { v = with_zeros(v, n, 1); };
  for (Eigen::VectorXd* v : {&model.constant_load, &model.ambient_load, &model.start, &model.ones}) lengthen(*v);
  model.conduction = with_zeros(model.conduction, n, n);
  model.conduction(i, i) = rate_1_s;
  const auto grow_law = [n](std::optional<FmuLiveLaw>& law) {
    if (law) law->weights = with_zeros(law->weights, n, law->weights.cols());
  };
  for (FmuSource& s : model.sources) lengthen(s.load), grow_law(s.live);
  for (FmuExchange& e : model.exchanges) {
    e.matrix = with_zeros(e.matrix, n, n);
    lengthen(e.to_ambient), lengthen(e.offset), grow_law(e.live);
  }
  for (FmuThermostat& t : model.thermostats) lengthen(t.weights);
  for (auto* outputs : {&model.outputs, &model.first}) {
    for (FmuOutput& o : *outputs) lengthen(o.state);
  }
  for (auto* list : {&model.along, &model.along_first}) {
    for (FmuAlong& a : *list) grow(a, i, 1);
  }
  return i;
}

/// One more state that begins with what a row gives.
Eigen::Index add_first(FmuModel& model, FmuOutput row, double rate_1_s) {
  const Eigen::Index i = add_state(model, rate_1_s);
  row.state = with_zeros(row.state, i + 1, 1);
  model.first.push_back(std::move(row));
  return i;
}

class LearnedStates {
 public:
  LearnedStates(FmuModel& model, const scenarios::MachineModel& machine) : model_(model) {
    for (const effects::Effect& e : machine.effects) {
      if (e.kind->key == "learned") effects_.push_back(&e);
    }
  }

  void add() {
    const std::vector<Kept> kept = scale_kept();
    for (const effects::Effect* e : effects_) {
      if (!follows_ambient(*e)) add_drive_terms(*e);
    }
    for (const Kept& k : kept) add_start(k);  // from here on states that begin with something: the last ones
    for (const effects::Effect* e : effects_) {
      if (follows_ambient(*e)) add_ambient_terms(*e);
    }
  }

 private:
  /// An output of which a share is kept, as it was before.
  struct Kept {
    std::size_t output;
    double share;
    FmuOutput whole;
    std::vector<FmuAlong> along;
  };

  static bool follows_ambient(const effects::Effect& e) { return e.words.at("follows") == "ambient"; }
  static bool is_sensor(const effects::Effect& e) { return e.place_kind == effects::Place::kSensor; }
  [[nodiscard]] std::size_t output_of(const effects::Effect& e) const {
    const auto at = std::find_if(model_.outputs.begin(), model_.outputs.end(), [&](const FmuOutput& o) {
      return o.name == e.place && (o.unit == "degC") == is_sensor(e);
    });
    if (at == model_.outputs.end()) throw std::logic_error("add_learned: there is no output " + e.place);
    return static_cast<std::size_t>(at - model_.outputs.begin());
  }

  std::vector<Kept> scale_kept() {
    std::map<std::size_t, std::pair<double, double>> shares_and_offsets_K;
    for (const effects::Effect* e : effects_) {
      auto& [share, offset_K] = shares_and_offsets_K.try_emplace(output_of(*e), 1.0, 0.0).first->second;
      share *= (*e)["keeps"];
      offset_K = (*e)["keeps"] * offset_K + (e->has("offset") ? (*e)["offset"] : 0.0);
    }
    std::vector<Kept> list;
    for (const auto& [output, kept_of] : shares_and_offsets_K) {
      const auto [share, offset_K] = kept_of;
      FmuOutput& o = model_.outputs[output];
      o.offset += o.factor * offset_K;
      if (share == 1.0) continue;
      Kept kept{output, share, o, {}};
      o.state *= share;
      o.ambient *= share;
      for (FmuAlong& a : model_.along) {
        if (a.output != static_cast<int>(output)) continue;
        kept.along.push_back(a);
        for (double& c : a.cubics) c *= share;
      }
      list.push_back(std::move(kept));
    }
    return list;
  }

  /// The share of an output that stays what it was at the start; of a sensor: the ambient then.
  void add_start(const Kept& kept) {
    Eigen::Index state = -1;
    if (kept.whole.unit == "degC") {
      state = ambient_at_start();
    } else {
      const auto row = static_cast<int>(model_.outputs.size() + model_.first.size());
      state = add_first(model_, kept.whole, 0.0);
      for (FmuAlong a : kept.along) {
        a.output = row;
        grow(a, kept.whole.state.size(), state + 1 - kept.whole.state.size());
        model_.along_first.push_back(std::move(a));
      }
    }
    model_.outputs[kept.output].state[state] += 1.0 - kept.share;
  }

  void add_drive_terms(const effects::Effect& e) {
    const std::string& table = effects::learned::table_of(e);
    if (table.empty()) return;
    if (e.words.at("follows") == "column")
      throw InputError(e.where, fmt::format("{} follows the recorded column '{}', which is no input of an FMU "
                                            "(docs/how-to/fmu.md)",
                                            e.name(), e.words.at("column")));
    const auto law = effects::learned::law_of(e);
    const std::optional<DriveLaw> u = tabulated(law, model_.drive);
    if (!u) throw std::logic_error("add_learned: a law of the speed cannot be tabulated");
    const auto number = [&](const char* name) { return e.has(name) ? e[name] : 0.0; };
    const std::string words =
        fmt::format("{} {:a} {:a} {:a}", e.words.at("follows"), number("above"), number("at_speed"), number("exponent"));
    const std::size_t output = output_of(e);
    const TimeSeries& terms = e.tables.at(table);
    for (std::size_t k = 0; k < terms.time_s.size(); ++k) {
      const double lag_s = 60.0 * terms.time_s[k], amount = amount_of(e, terms.value[k]);
      if (lag_s > 0.0) {
        model_.outputs[output].state[lagged(words, *u, lag_s)] += amount;
        continue;
      }
      DriveLaw at_once = *u;
      at_once.at_rest *= amount;
      for (LawTerm& term : at_once.terms) {
        for (double& c : term.coefficients) c *= amount;
      }
      model_.direct.push_back({static_cast<int>(output), std::move(at_once)});
    }
  }

  /// The state of a lag of a drive. Outputs share it.
  Eigen::Index lagged(const std::string& words, const DriveLaw& u, double lag_s) {
    const std::string key = fmt::format("{} {:a}", words, lag_s);
    if (const auto known = states_.find(key); known != states_.end()) return known->second;
    const Eigen::Index i = add_state(model_, 1.0 / lag_s);
    model_.sources.push_back({.load = Eigen::VectorXd::Unit(i + 1, i) / lag_s, .power_W = u});
    states_[key] = i;
    return i;
  }

  void add_ambient_terms(const effects::Effect& e) {
    const std::size_t output = output_of(e);
    const TimeSeries& terms = e.tables.at(effects::learned::table_of(e));
    for (std::size_t k = 0; k < terms.time_s.size(); ++k) {
      const double lag_s = 60.0 * terms.time_s[k], amount = amount_of(e, terms.value[k]);
      const Eigen::Index start = ambient_at_start();
      model_.outputs[output].state[start] -= amount;
      if (lag_s > 0.0) {
        const Eigen::Index state = lagged_ambient(lag_s);
        model_.outputs[output].state[state] += amount;
      } else {
        model_.outputs[output].ambient += amount;
      }
    }
  }
  Eigen::Index lagged_ambient(double lag_s) {
    const std::string key = fmt::format("ambient {:a}", lag_s);
    if (const auto known = states_.find(key); known != states_.end()) return known->second;
    const Eigen::Index i = add_first(model_, ambient_row(), 1.0 / lag_s);
    model_.ambient_load[i] = 1.0 / lag_s;
    states_[key] = i;
    return i;
  }
  Eigen::Index ambient_at_start() {
    if (const auto known = states_.find("start"); known != states_.end()) return known->second;
    return states_["start"] = add_first(model_, ambient_row(), 0.0);
  }
  [[nodiscard]] FmuOutput ambient_row() const {
    return {.name = "ambient", .unit = "degC", .state = Eigen::VectorXd::Zero(model_.start.size()), .ambient = 1.0};
  }

  /// In K, m or rad.
  static double amount_of(const effects::Effect& e, double amount) { return is_sensor(e) ? amount : 1e-6 * amount; }

  FmuModel& model_;
  std::vector<const effects::Effect*> effects_;
  std::map<std::string, Eigen::Index> states_;  ///< by what they follow and their lag
};

}  // namespace

void add_learned(FmuModel& model, const scenarios::MachineModel& machine) {
  LearnedStates(model, machine).add();
}

}  // namespace driftwright::output
