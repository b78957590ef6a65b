#include "studies/remainder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors.hpp"
#include "base/mean_error.hpp"
#include "base/normal.hpp"
#include "base/quantity.hpp"
#include "base/record_channel.hpp"
#include "base/shown_units.hpp"
#include "diagnosis/plain_regression.hpp"

namespace driftwright::studies {
namespace {

constexpr double kLeastPart = 1e-4;  // share of the largest amount of a channel; smaller amounts are not written

/// Six digits; more would not be significant.
double rounded(double value) {
  return std::stod(fmt::format("{:.6g}", value));
}

std::string unit_of(const diagnosis::MeasuredChannel& c) {
  return c.recorded_unit == "K" ? "K" : shown_reading_unit(c.unit);
}

/// Converts the twin's units into those of a record.
Eigen::VectorXd shown(const diagnosis::MeasuredChannel& c, Eigen::VectorXd values, double reference_K) {
  if (c.unit != "K") return 1e6 * values;
  if (unit_of(c) == "degC") values.array() += reference_K - kZeroCelsius_K;
  return values;
}

std::vector<double> listed(const Eigen::VectorXd& v) {
  return {v.begin(), v.end()};
}

template <class Value>
std::vector<double> at_rows(const std::vector<double>& time_s, const Value& value) {
  std::vector<double> list;
  for (double t_s : time_s) list.push_back(value(t_s));
  return list;
}

bool changes(const std::vector<Record>& records, const std::string& channel) {
  const double first = records.front().at(channel).values.front();
  return std::any_of(records.begin(), records.end(), [&](const Record& r) {
    const std::vector<double>& v = r.at(channel).values;
    return std::any_of(v.begin(), v.end(), [&](double x) { return x != first; });
  });
}

/// One sigma of the sum of a law's amounts in a channel, by the covariance of its fit.
double sum_error(const identification::IdentifiedChannel& c, const identification::Identified& of, std::size_t law) {
  Eigen::VectorXd rise_K = Eigen::VectorXd::Zero(c.fit.weight.size());
  for (std::size_t b = 0; b < of.bodies.size(); ++b) {
    if (of.bodies[b].body.law == law) rise_K[static_cast<Eigen::Index>(b)] = of.bodies[b].body.rise_K;
  }
  return std::sqrt(std::max(0.0, rise_K.dot(c.fit.covariance * rise_K)));
}

/// Whether a column may drive heat: not a temperature, which belongs to a medium or a body.
bool may_drive(const std::string& unit) {
  static const char* const kUnits[] = {"W", "V", "percent", "count", "1", "W_m2", "mm_min"};
  return std::find(std::begin(kUnits), std::end(kUnits), unit) != std::end(kUnits);
}

/// The runs without the readings that a fold hides, and those alone.
struct Halves {
  std::vector<diagnosis::MeasuredRun> fitted, hidden;
  std::vector<char> is_whole;  ///< of each run: all its rows are hidden
};

Halves halves(const std::vector<diagnosis::MeasuredRun>& runs, const std::vector<std::size_t>& blocks,
              const std::vector<bool>& hidden) {
  Halves h{runs, runs, std::vector<char>(runs.size(), 1)};
  std::size_t first = 0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::size_t n = runs[r].time_s.size(), n_blocks = n / blocks[r];
    for (std::size_t i = 0; i < n; ++i) {
      const bool is_stored = i / blocks[r] < n_blocks;  // rows after the last whole block are in no fold
      const bool is_hidden = is_stored && hidden[first + i / blocks[r]];
      if (is_stored && !is_hidden) h.is_whole[r] = 0;
      for (std::size_t c = 0; c < runs[r].channels.size(); ++c) {
        const auto at = static_cast<Eigen::Index>(i);
        (is_hidden ? h.fitted : h.hidden)[r].channels[c].value[at] = std::nan("");
        if (!is_stored) h.fitted[r].channels[c].value[at] = std::nan("");
      }
    }
    first += n_blocks;
  }
  return h;
}

/// Root mean square of a channel's hidden readings less a prediction, in the units of a record.
double missed_of(const Halves& h, const diagnosis::Prediction& predicted, const std::string& channel) {
  double squares = 0.0, n = 0.0;
  for (std::size_t r = 0; r < h.hidden.size(); ++r) {
    const diagnosis::MeasuredChannel* c = h.hidden[r].find(channel);
    if (!c) continue;
    const bool counts_from_start = c->unit != "K" || c->recorded_unit == "K";
    const Eigen::VectorXd less = (c->unit == "K" ? 1.0 : 1e6) * (c->value - predicted[r].row(c->output).transpose());
    double zero = h.is_whole[r] && counts_from_start ? std::nan("") : 0.0;
    for (double v : less) {
      if (!std::isfinite(v)) continue;
      if (std::isnan(zero)) zero = v;
      squares += (v - zero) * (v - zero);
      n += 1.0;
    }
  }
  return n > 0.0 ? std::sqrt(squares / n) : std::nan("");
}

}  // namespace

BesideRecords beside(const std::vector<diagnosis::MeasuredRun>& runs, const std::vector<Eigen::MatrixXd>& read,
                     double reference_K) {
  BesideRecords b;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const diagnosis::MeasuredRun& run = runs[r];
    Record measured{.source = run.name, .time_s = run.time_s, .channels = {}};
    measured.channels.push_back(
        {"speed", "rpm", at_rows(run.time_s, [&](double t_s) { return run.cyclogram.speed_rpm(t_s); })});
    measured.channels.push_back(
        {"cutting_power", "W", at_rows(run.time_s, [&](double t_s) { return run.cyclogram.drive(t_s).cutting_power_W; })});
    for (const Cyclogram::Column& column : run.cyclogram.columns) {
      if (may_drive(column.unit) && !measured.find(column.name))
        measured.channels.push_back(
            {column.name, column.unit, at_rows(run.time_s, [&](double t_s) { return column.at(t_s); })});
    }
    measured.channels.push_back({"ambient", "degC", at_rows(run.time_s, [&](double t_s) {
                                   return run.ambient.at(t_s) + reference_K - kZeroCelsius_K;
                                 })});
    Record simulated{.source = run.name, .time_s = run.time_s, .channels = {}};
    for (const diagnosis::MeasuredChannel& c : run.channels) {
      measured.channels.push_back({c.name, unit_of(c), listed(shown(c, c.value, reference_K))});
      simulated.channels.push_back({c.name, unit_of(c), listed(shown(c, read[r].row(c.output).transpose(), reference_K))});
    }
    b.measured.push_back(std::move(measured));
    b.simulated.push_back(std::move(simulated));
  }
  const auto have = [&](const std::string& name) {
    return std::all_of(b.measured.begin(), b.measured.end(), [&](const Record& r) {
      const Channel* c = r.find(name);
      return c && std::any_of(c->values.begin(), c->values.end(), [](double v) { return std::isfinite(v); });
    });
  };
  const Record& first = b.measured.front();
  const auto turns = [&](const Record& r) {
    const std::vector<double>& rpm = r.at("speed").values;
    return std::any_of(rpm.begin(), rpm.end(), [](double x) { return x > 0.0; });
  };
  if (std::any_of(b.measured.begin(), b.measured.end(), turns)) b.roles.speed = "speed";
  b.roles.ambient = "ambient";
  for (const Channel& c : first.channels) {
    if (c.name == "speed" || c.name == "ambient" || !have(c.name)) continue;
    if (b.simulated.front().find(c.name))
      (is_temperature_unit(c.unit) ? b.roles.thermometers : b.roles.displacements).push_back(c.name);
    else if (changes(b.measured, c.name))
      b.roles.drives.push_back(c.name);
  }
  if (b.roles.speed.empty() && b.roles.drives.empty())
    throw InputError(
        fmt::format("{}: nothing that drives the machine changes, so that nothing can be learned of it: a spindle that "
                    "turns is required, or a column such as heater_W that is switched",
                    runs.front().path));
  if (b.roles.thermometers.empty() && b.roles.displacements.empty())
    throw InputError(fmt::format("{}: no channel of the scenario is in all records", runs.front().path));
  return b;
}

double missed(const BesideRecords& beside, const std::string& channel) {
  double squares = 0.0, n = 0.0;
  for (std::size_t r = 0; r < beside.measured.size(); ++r) {
    const Channel &measured = beside.measured[r].at(channel), &simulated = beside.simulated[r].at(channel);
    double zero = measured.unit == "degC" ? 0.0 : std::nan("");
    for (std::size_t i = 0; i < measured.values.size(); ++i) {
      const double less = measured.values[i] - simulated.values[i];
      if (!std::isfinite(less)) continue;
      if (std::isnan(zero)) zero = less;
      squares += (less - zero) * (less - zero);
      n += 1.0;
    }
  }
  return n > 0.0 ? std::sqrt(squares / n) : std::nan("");
}

LearnedBeside learn_beside(const MeasuredTwin& m, const diagnosis::TwinState& state, const Listener& listener) {
  const diagnosis::Prediction read = read_of(m, state);
  LearnedBeside learned{beside(m.runs, read, m.twin->reference_K()), {}};
  identification::Identified& network = learned.network;
  network = identification::extend(learned.records.measured, learned.records.roles, learned.records.simulated, listener);
  listener.begin("a plain regression of the same rows");
  const auto n_outputs = static_cast<int>(read.front().rows());
  const auto n_folds = static_cast<Eigen::Index>(network.folds.size());
  Eigen::MatrixXd rms(n_folds, static_cast<Eigen::Index>(network.channels.size()));
  for (Eigen::Index f = 0; f < n_folds; ++f) {
    listener.share(static_cast<double>(f) / static_cast<double>(n_folds));
    const Halves h = halves(m.runs, network.blocks, network.folds[static_cast<std::size_t>(f)].hidden);
    const diagnosis::Prediction predicted =
        diagnosis::plain_regression(m.runs, h.fitted, n_outputs, diagnosis::Regressors::kDrive);
    for (Eigen::Index c = 0; c < rms.cols(); ++c)
      rms(f, c) = missed_of(h, predicted, network.channels[static_cast<std::size_t>(c)].name);
  }
  const auto noise = diagnosis::estimate_noise(m.runs, read, m.how.floor);
  for (std::size_t c = 0; c < network.channels.size(); ++c) {
    identification::IdentifiedChannel& channel = network.channels[c];
    channel.regression_kept_out = identification::missed(rms.col(static_cast<Eigen::Index>(c)), network.folds);
    channel.noise = (is_temperature_unit(channel.unit) ? 1.0 : 1e6) * noise.at(channel.name).total();
  }
  return learned;
}

Remainder remainder_of(const MeasuredTwin& m, const diagnosis::Diagnosis& d, const WrittenScenario& written,
                       const Listener& listener) {
  Remainder remainder;
  const bool is_too_short = std::any_of(m.runs.begin(), m.runs.end(), [](const diagnosis::MeasuredRun& run) {
    return run.time_s.size() < identification::kFewestRows;
  });
  if (!d.ended_at.empty() || listener.wants_end()) {
    remainder.why_not = "The diagnosis was ended before.";
  } else if (d.verdict == diagnosis::Verdict::kInsufficientData || is_too_short) {
    remainder.why_not = "The readings are too few.";
  } else if (!written.is_readable()) {
    remainder.why_not = "The file cannot be read back.";
  }
  if (!remainder.why_not.empty()) return remainder;
  try {
    const LearnedBeside learned = learn_beside(m, written.effects, listener);
    for (const identification::IdentifiedChannel& c : learned.network.channels)
      remainder.channels.push_back({c.name, c.unit == "um" || c.unit == "urad" ? c.unit : "K", c.scenario_kept_out,
                                    c.missed_kept_out, c.regression_kept_out, c.noise, c.is_extended});
  } catch (const InputError& e) {
    remainder.why_not = fmt::format("{}.", e.what());
  }
  return remainder;
}

double remaining_sd(const identification::IdentifiedChannel& channel) {
  const MeanError& square = channel.square_kept_out;
  if (square.n == 0) return 0.0;
  const double noise = std::isfinite(channel.noise) ? channel.noise : 0.0;
  return student_quantile(static_cast<double>(square.n), 0.975) / kNormal95 *
         std::sqrt(std::max(0.0, square.mean - noise * noise));
}

std::vector<effects::Effect> learned_effects(const identification::Identified& extension) {
  using identification::Law;
  std::vector<effects::Effect> list;
  for (const identification::IdentifiedChannel& c : extension.channels) {
    if (!c.is_extended) continue;
    const bool is_sensor = is_temperature_unit(c.unit);
    const std::string table = is_sensor ? "rises" : c.unit == "urad" ? "tilts" : "grows";
    const std::size_t before = list.size();
    const auto make = [&] {
      return effects::make_effect("learned", is_sensor ? effects::Place::kSensor : effects::Place::kDisplacement, c.name);
    };
    std::map<std::size_t, std::map<double, double>>
        of_law;  // time constant [min] -> amount; the index after the laws is the ambient
    const std::size_t ambient = extension.structure.laws.size();
    double largest = 0.0;
    for (std::size_t b = 0; b < extension.bodies.size(); ++b) {
      const identification::NetworkBody& body = extension.bodies[b].body;
      double amount = c.fit.weight[static_cast<Eigen::Index>(b)];
      if (body.law) amount *= body.rise_K * extension.structure.laws[*body.law].sign;
      of_law[body.law.value_or(ambient)][body.tau_s / 60.0] += amount;
      if (body.law) largest = std::max(largest, std::abs(amount));
    }
    if (is_sensor) of_law[ambient][0.0] += c.fit.of_ambient;
    for (const auto& [law, terms] : of_law) {
      effects::Effect e = make();
      TimeSeries& amounts = e.tables[table];
      for (const auto& [tau_min, amount] : terms) {
        if (std::abs(amount) <= (law == ambient ? kLeastPart : kLeastPart * largest)) continue;
        amounts.time_s.push_back(rounded(tau_min));
        amounts.value.push_back(rounded(amount));
      }
      if (amounts.time_s.empty()) continue;
      if (law == ambient) {
        e.words["follows"] = "ambient";
      } else {
        const Law& of = extension.structure.laws[law];
        switch (of.kind) {
          case Law::Kind::kTurning:
            e.words["follows"] = "running";
            e.set("above", rounded(identification::kTurns * of.top));
            e.set("at_speed", of.top);
            break;
          case Law::Kind::kPower:
            e.words["follows"] = "speed";
            e.set("at_speed", of.top);
            e.set("exponent", of.exponent);
            break;
          case Law::Kind::kColumn:
            e.words["follows"] = "column";
            e.words["column"] = of.channel;
            e.set("at", of.top);
            break;
        }
      }
      if (law != ambient) e.set("error", rounded(sum_error(c, extension, law)));
      list.push_back(std::move(e));
    }
    const double keeps = std::clamp(rounded(c.fit.kept), 0.0, 1.0);
    const bool has_offset = is_sensor && std::abs(c.fit.offset) > 0.0;
    if (list.size() == before) {
      if (keeps == 1.0 && !has_offset) continue;  // what is left is too small to be written
      list.push_back(make());
    }
    effects::Effect& leading = list[before];
    leading.set("keeps", keeps);
    if (has_offset) leading.set("offset", rounded(c.fit.offset));
    if (const double sd = remaining_sd(c); sd > 0.0) leading.set("misses", std::stod(fmt::format("{:.3g}", sd)));
  }
  return list;
}

std::vector<diagnosis::StatedChange> stated_extension(const identification::Identified& extension) {
  std::vector<diagnosis::StatedChange> changes;
  std::map<std::string, const identification::IdentifiedChannel*> of;
  for (const auto& c : extension.channels) of[c.name] = &c;
  for (effects::Effect& e : learned_effects(extension)) {
    const identification::IdentifiedChannel& c = *of.at(e.place);
    changes.push_back({fmt::format("learned at {}", e.place),
                       fmt::format("kept-out rows are missed by {:.3g} {} with it, by {:.3g} without", c.missed_kept_out,
                                   c.unit == "um"     ? "um"
                                   : c.unit == "urad" ? "urad"
                                                      : "K",
                                   c.scenario_kept_out),
                       [e](diagnosis::TwinState& state) { state.push_back(e); }, "learned"});
  }
  return changes;
}

}  // namespace driftwright::studies
