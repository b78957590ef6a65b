#include "effects/learned.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "effects/doubt.hpp"
#include "effects/reading_chain.hpp"
#include "effects/recorded_column.hpp"

namespace driftwright::effects::learned {

const char* const kTables[] = {"rises", "grows", "tilts"};

const std::string& table_of(const Effect& e) {
  static const std::string kNames[] = {kTables[0], kTables[1], kTables[2]};
  for (const std::string& name : kNames) {
    if (e.tables.contains(name)) return name;
  }
  static const std::string kNone;
  return kNone;
}

/// The followed quantity, scaled to 1 at the stated drive.
std::function<double(const Drive&)> law_of(const Effect& e) {
  const std::string& follows = e.words.at("follows");
  if (follows == "running") return [above_rpm = e["above"]](const Drive& d) { return d.speed_rpm > above_rpm ? 1.0 : 0.0; };
  if (follows == "speed")
    return [n0_rpm = e["at_speed"], exponent = e["exponent"]](const Drive& d) {
      return std::pow(std::min(d.speed_rpm / n0_rpm, 1.0), exponent);
    };
  return [value = signal_of(e.words.at("column"), 0.0), at = e["at"]](const Drive& d) {
    return std::clamp(value(d).value_or(0.0) / at, -1.0, 1.0);
  };
}

/// By how much the law would exceed 1 if it went on; 0 within what it was learned from.
std::function<double(const Drive&)> excess_of(const Effect& e) {
  if (e.words.at("follows") == "column")
    return [value = signal_of(e.words.at("column"), 0.0), at = e["at"]](const Drive& d) {
      const double u = value(d).value_or(0.0) / at;
      return u - std::clamp(u, -1.0, 1.0);
    };
  if (!e.has("at_speed")) return [](const Drive&) { return 0.0; };
  return [n0_rpm = e["at_speed"], exponent = e["exponent"]](const Drive& d) {
    return std::pow(std::max(d.speed_rpm / n0_rpm, 1.0), exponent) - 1.0;
  };
}

/// The drive with the column that an effect follows.
Cyclogram followed_drive(const Effect& e, const Cyclogram& cyclogram) {
  return e.words.at("follows") == "column" ? with_signal(cyclogram, e.words.at("column"), 0.0) : cyclogram;
}

void change_readings(const Effect& e, ReadingChain& chain) {
  const bool is_sensor = e.place_kind == Place::kSensor;
  const auto row_of = [is_sensor, place = e.place](const Readings& r) {
    return is_sensor ? r.sensor(place) : r.displacement(place);
  };
  chain.add(ReadingStage::kKept, [=, keeps = e["keeps"], offset_K = e.has("offset") ? e["offset"] : 0.0](Readings& r) {
    if (keeps == 1.0 && offset_K == 0.0) return;
    auto row = r.value.row(row_of(r));
    const double start = is_sensor ? r.ambient.at(r.time_s.front()) : row[0];
    row = (start + offset_K + keeps * (row.array() - start)).matrix();
  });
  const std::string& table = table_of(e);
  if (table.empty()) return;
  chain.add(ReadingStage::kLearned,
            [=, effect = e, scale = is_sensor ? 1.0 : 1e-6, terms = e.tables.at(table)](Readings& r) {
              const std::string& follows = effect.words.at("follows");
              auto row = r.value.row(row_of(r));
              const bool is_ambient = follows == "ambient";
              const Cyclogram drive = followed_drive(effect, r.cyclogram);
              for (std::size_t k = 0; k < terms.time_s.size(); ++k) {
                const double lag_s = 60.0 * terms.time_s[k], amount = scale * terms.value[k];
                if (!is_ambient) {
                  row += amount * driven(r.time_s, drive, law_of(effect), lag_s);
                  continue;
                }
                Eigen::RowVectorXd rise(r.n_times());
                for (Eigen::Index i = 0; i < rise.size(); ++i)
                  rise[i] = r.ambient.at(r.time(i)) - r.ambient.at(r.time_s.front());
                lag_behind(rise, r.time_s, lag_s);
                row += amount * rise;
              }
            });
}

void check(const Effect& e, const ConfigMap& in) {
  const std::string& follows = e.words.at("follows");
  const std::string wanted = e.place_kind == Place::kSensor ? "rises" : e.tables.contains("tilts") ? "tilts" : "grows";
  for (const char* name : kTables) {
    if (e.tables.contains(name) && name != wanted)
      in.fail(name,
              "exactly one of them is required: `rises` (K) of a sensor, `grows` (um) or `tilts` (urad) of a displacement");
  }
  if (e.has("offset") && e.place_kind != Place::kSensor)
    in.fail("offset", "`offset` is allowed only for a sensor; displacements count from the start");
  if (e.tables.contains(wanted) == (follows == "nothing"))
    in.fail("follows", "what is learned (`" + wanted + "`) and what it `follows` must be given together");
  if ((follows == "column") == e.words.at("column").empty())
    in.fail("column", "`follows: column` and the `column` must be given together");
  if (follows == "speed" && !e.has("at_speed"))
    in.fail("at_speed", "`follows: speed` and `at_speed` must be given together");
  if (e.has("at_speed") && follows != "speed" && follows != "running")
    in.fail("at_speed", "`at_speed` is allowed only with `follows: speed` or `follows: running`");
  if (e.has("error") && (follows == "nothing" || follows == "ambient"))
    in.fail("error", "`error` is allowed only for what follows a drive: the turning spindle, its speed or a column");
  if (e.has("error") && follows == "running" && !e.has("at_speed"))
    in.fail("error", "`error` requires `at_speed`, the fastest that was learned from: beyond it the error grows");
  if ((follows == "column") != e.has("at")) in.fail("at", "`follows: column` and `at` must be given together");
  if (follows == "nothing" && e["keeps"] == 1.0 && !e.has("offset"))
    in.fail("follows", "the entry learns nothing; write what it `follows`, or `keeps`, or an `offset`");
}

EffectKind kind() {
  return {
      .key = "learned",
      .title = "what a machine's readings have beside the physics of the scenario, learned from records",
      .law =
          "y = y(0) + keeps (y_physics - y(0)) + sum_k a_k x_k, tau_k dx_k/dt = u - x_k, x_k = 0 at t = 0; u = 1 while the "
          "spindle runs, (n / at_speed)^exponent, a recorded column over `at`, or the ambient less its first value [K]. "
          "y(0) of a sensor: the ambient at the start. With a_k >= 0 of sensors such terms are bodies that the ambient "
          "cools "
          "(Foster)",
      .places = {Place::kSensor, Place::kDisplacement},
      .parameters =
          {{"keeps", "1", 0.0, 1.0, 1.0, "share of the change that the physics give"},
           {"offset", "K", -1e3, 1e3, kNotGiven, "of a sensor, at all times"},
           {"above", "rpm", 0.0, 1e6, 0.0, "running: faster than this; a tachometer may tremble at rest"},
           {"error", "1", 0.0, 1e6, kNotGiven,
            "one sigma of the sum of amounts, in their unit; the error grows by it beyond what was learned from"},
           {"at_speed", "rpm", 1.0, 1e6, kNotGiven,
            "the fastest that was learned from: there the amounts hold, and beyond; running: the error grows beyond it"},
           {"exponent", "1", 0.1, 4.0, 1.0, "growth with speed; running: of the error alone"},
           {"at", "1", 1e-12, 1e12, kNotGiven,
            "the largest value of the column that was learned from, in its unit: there the amounts hold, and beyond"},
           {"misses", "1", 0.0, 1e6, kNotGiven,
            "one sigma of what the channel still misses, in K, um or urad: the width of bands about predictions"}},
      .timing = Timing::kInRecord,
      .change_readings = change_readings,
      .choices = {{"follows",
                   {"nothing", "running", "speed", "ambient", "column"},
                   "nothing",
                   "what the amounts follow: the turning spindle, a power of its speed, the ambient (amounts for 1 K), a "
                   "recorded column"}},
      .tables = {{"rises", "min", "K", -1e4, 1e4, false, "of a sensor: time constant (0: at once), amount in the end"},
                 {"grows", "min", "um", -1e5, 1e5, false, "of a displacement"},
                 {"tilts", "min", "urad", -1e5, 1e5, false, "of a tilt"}},
      .check = check,
      .mentions = {{"column", Mention::Of::kColumn, false, "that is followed, with its unit or without"}}};
}

}  // namespace driftwright::effects::learned

namespace driftwright::effects {

Eigen::RowVectorXd learned_sd_beyond(const std::vector<Effect>& effects, Place kind, const std::string& place,
                                     const std::vector<double>& time_s, const Cyclogram& cyclogram) {
  const auto n = static_cast<Eigen::Index>(time_s.size());
  Eigen::RowVectorXd missing = Eigen::RowVectorXd::Zero(n), squares = missing;
  const double scale = kind == Place::kSensor ? 1.0 : 1e-6;
  for (const Effect& e : effects) {
    if (e.kind->key != "learned" || e.place_kind != kind || e.place != place || !e.acts_in(cyclogram.name)) continue;
    const std::string& table = learned::table_of(e);
    if (table.empty() || e.words.at("follows") == "ambient") continue;
    const Cyclogram drive = learned::followed_drive(e, cyclogram);
    const TimeSeries& terms = e.tables.at(table);
    Eigen::RowVectorXd largest = Eigen::RowVectorXd::Zero(n);
    for (std::size_t k = 0; k < terms.time_s.size(); ++k) {
      const Eigen::RowVectorXd excess = driven(time_s, drive, learned::excess_of(e), 60.0 * terms.time_s[k]);
      missing += scale * terms.value[k] * excess;
      largest = largest.cwiseMax(excess.cwiseAbs());
    }
    if (e.has("error")) squares += (scale * e["error"] * largest).cwiseAbs2();
  }
  return (missing.cwiseAbs2() + squares).cwiseSqrt();
}

LearnedStream::LearnedStream(const std::vector<Effect>& effects, const std::string& displacement) {
  for (const Effect& e : effects) {
    if (e.kind->key != "learned" || e.place_kind != Place::kDisplacement || e.place != displacement) continue;
    effects_.push_back(e);
    if (const std::string& table = learned::table_of(e); !table.empty())
      state_.x.resize(state_.x.size() + e.tables.at(table).time_s.size());
  }
}

void LearnedStream::begin(double displacement, double ambient_K) {
  state_.first = displacement;
  state_.first_ambient_K = ambient_K;
  std::fill(state_.x.begin(), state_.x.end(), 0.0);
}

void LearnedStream::advance(double step_s, const Drive& during, double ambient_before_K, double ambient_K) {
  auto x = state_.x.begin();
  for (const Effect& e : effects_) {
    const std::string& table = learned::table_of(e);
    if (table.empty()) continue;
    const bool is_ambient = e.words.at("follows") == "ambient";
    const double before = is_ambient ? ambient_before_K - state_.first_ambient_K : learned::law_of(e)(during),
                 now = is_ambient ? ambient_K - state_.first_ambient_K : before;
    for (const double lag_min : e.tables.at(table).time_s) {
      const double lag_s = 60.0 * lag_min;
      if (!(lag_s > 0.0)) {
        *x = now;
      } else if (step_s > 0.0) {  // exact for a signal that is linear from `before` to `now`
        const double share = -std::expm1(-step_s / lag_s);
        *x += (before - *x) * share + (now - before) * (1.0 - lag_s / step_s * share);
      }
      ++x;
    }
  }
}

double LearnedStream::with_learned(double displacement, const Drive& now) const {
  double keeps = 1.0, added = 0.0;
  auto x = state_.x.begin();
  for (const Effect& e : effects_) {
    keeps *= e["keeps"];
    const std::string& table = learned::table_of(e);
    if (table.empty()) continue;
    const bool is_ambient = e.words.at("follows") == "ambient";
    const TimeSeries& terms = e.tables.at(table);
    for (std::size_t k = 0; k < terms.time_s.size(); ++k, ++x)
      added += 1e-6 * terms.value[k] * (terms.time_s[k] > 0.0 || is_ambient ? *x : learned::law_of(e)(now));
  }
  return state_.first + keeps * (displacement - state_.first) + added;
}

void LearnedStream::recall(const State& state) {
  if (state.x.size() != state_.x.size())
    throw InputError("the state is of a machine with other effects `learned`: another number of terms");
  state_ = state;
}

}  // namespace driftwright::effects
