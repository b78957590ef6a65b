#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/statement_builder.hpp"
#include "effects/instrument_groups.hpp"
#include "effects/reading_chain.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kDriveLags_s[] = {0.0, 120.0, 600.0, 1800.0, 5400.0};
constexpr double kReadingLags_s[] = {30.0, 120.0, 360.0, 1200.0, 3600.0};

/// A channel's row of a matrix with one row a channel of the run; empty for a channel that the run has not.
Eigen::RowVectorXd row_of(const MeasuredRun& run, const std::string& channel, const Eigen::MatrixXd& rows) {
  const MeasuredChannel* found = run.find(channel);
  return found ? Eigen::RowVectorXd(rows.row(found - run.channels.data())) : Eigen::RowVectorXd();
}

}  // namespace

double StatementBuilder::swing(const std::string& name) const {
  double squares = 0.0, n = 0.0, sum = 0.0;
  for (const MeasuredRun& run : runs_) {
    const MeasuredChannel* c = run.find(name);
    if (!c) continue;
    for (double v : c->value) {
      if (std::isnan(v)) continue;
      squares += v * v;
      sum += v;
      n += 1.0;
    }
  }
  return n > 1.0 ? std::sqrt(std::max(1e-18, squares / n - sum * sum / n / n)) : 1.0;
}

StatementBuilder::Row StatementBuilder::predicted(std::size_t r, const std::string& name) const {
  return row_of(runs_[r], name, machine_[r].predicted());
}

Statement StatementBuilder::about(const Channel& c) {
  return {.quantity = c.unit == "K" ? StatedQuantity::kReading : StatedQuantity::kDisplacement,
          .place = {c.name},
          .unit_size = c.swing,
          .unit = c.unit};
}

void StatementBuilder::say(const Channel& c, const std::string& follows, const std::string& law, double size,
                           const std::string& unit, const std::vector<Row>& course) {
  Statement s = about(c);
  s.follows = follows;
  s.law = law;
  s.unit_size = size;
  s.unit = unit;
  add(s, {alone(c.name, course)});
}

void StatementBuilder::follows_courses(const Channel& c) {
  for (std::size_t i = 0; i < courses_.size(); ++i) {
    const TimedCourse& course = courses_[i];
    const bool drives = i > 0 && i < n_drives_;
    for (double lag_s : kDriveLags_s) {
      if (lag_s > 0.0 && !drives) break;
      say(c, course.follows, lag_s > 0.0 ? fmt::format("{}, with a lag of {:g} min", course.law, lag_s / 60) : course.law,
          c.swing, c.unit, by_run([&](std::size_t r) -> Row {
            Row row = course.at_row[r];
            if (lag_s > 0.0) {
              row[0] = 0.0;
              effects::lag_behind(row, machine_[r].time_s(), lag_s);
            }
            return row;
          }));
    }
  }
}

void StatementBuilder::follows_itself(const Channel& c) {
  const bool is_sensor = c.unit == "K";
  const auto own = by_run([&](std::size_t r) { return predicted(r, c.name); });
  for (double lag_s : kReadingLags_s)
    say(c, "itself before", fmt::format("a lag of {:g} min", lag_s / 60), 1.0, "1", by_run([&](std::size_t r) -> Row {
          Row late = own[r];
          if (late.size() == 0) return late;
          late.array() -= own[r][0];
          effects::lag_behind(late, machine_[r].time_s(), lag_s);
          return late.array() + own[r][0] - own[r].array();
        }));
  say(c, "itself", "a gain", 1.0, "1",
      by_run([&](std::size_t r) -> Row { return is_sensor ? Row(own[r].array() - own[r][0]) : own[r]; }));
}

void StatementBuilder::follows_differences(const Channel& c) {
  const auto own = by_run([&](std::size_t r) { return predicted(r, c.name); });
  const auto air =
      by_run([&](std::size_t r) -> Row { return own[r].size() == 0 ? Row() : Row(machine_[r].ambient_K() - own[r]); });
  say(c, "difference to ambient", "a share of the ambient", 1.0, "1", air);
  Statement share = about(c);
  share.unit_size = 1.0;
  share.unit = "1";
  share.law = "difference to ambient";
  add_cells(share, {alone(c.name, air)});
  for (const Body& body : scene_.bodies) {
    if (body == effects::ambient_node()) continue;
    const auto warm = by_run([&](std::size_t r) { return machine_[r].temperature(body); });
    say(c, "difference to " + body.name, "a share of " + body.name, 1.0, "1",
        by_run([&](std::size_t r) -> Row { return warm[r] - own[r]; }));
  }
}

void StatementBuilder::follows_temperatures(const Channel& c) {
  for (const Body& body : scene_.bodies) {
    if (body == effects::ambient_node()) continue;
    const auto warm = by_run([&](std::size_t r) { return machine_[r].temperature(body); });
    double rms = 0.0;
    for (const Row& w : warm) rms = std::max(rms, (w.array() - w[0]).abs().maxCoeff());
    if (!(rms > 1e-9)) continue;
    for (double lag_s : {0.0, 600.0, 2400.0}) {
      say(c, "temperature of " + body.name, lag_s > 0.0 ? fmt::format("with a lag of {:g} min", lag_s / 60) : "at once",
          c.swing / rms, c.unit + "/K", by_run([&](std::size_t r) -> Row {
            Row w = warm[r].array() - warm[r][0];
            if (lag_s > 0.0) effects::lag_behind(w, machine_[r].time_s(), lag_s);
            return w;
          }));
    }
  }
  const auto air_of =
      by_run([&](std::size_t r) -> Row { return machine_[r].ambient_K().array() - machine_[r].ambient_K()[0]; });
  double rms = 0.0;
  for (const Row& w : air_of) rms = std::max(rms, w.cwiseAbs().maxCoeff());
  if (rms > 1e-9) say(c, "temperature of ambient", "at once", c.swing / rms, c.unit + "/K", air_of);
}

void StatementBuilder::readings() {
  for (const Channel& c : channels_) {
    follows_courses(c);
    follows_itself(c);
    if (c.unit == "K")
      follows_differences(c);
    else
      follows_temperatures(c);
    add_cells(about(c), {alone(c.name, by_run([&](std::size_t r) -> Row { return Row::Ones(machine_[r].n_rows()); }))});
  }
}

void StatementBuilder::exchanged_channels() {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    for (std::size_t j = i + 1; j < channels_.size(); ++j) {
      if (channels_[i].unit != channels_[j].unit) continue;
      const auto difference = by_run([&](std::size_t r) -> Row {
        const Row a = predicted(r, channels_[i].name), b = predicted(r, channels_[j].name);
        return a.size() > 0 && b.size() > 0 ? Row(b - a) : Row();
      });
      std::vector<Row> other = difference;
      for (Row& row : other) row = -row;
      add({.quantity = channels_[i].unit == "K" ? StatedQuantity::kReading : StatedQuantity::kDisplacement,
           .place = {channels_[i].name, channels_[j].name},
           .follows = "exchanged",
           .law = "exchanged",
           .unit_size = 1.0,
           .unit = "1"},
          {alone(channels_[i].name, difference), alone(channels_[j].name, other)});
    }
  }
}

void StatementBuilder::expansions() {
  const auto& parts = fitter_.twin().machine().system.parts;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::vector<Acting> acts;
    for (const Channel& c : channels_) {
      const auto of = by_run([&](std::size_t r) -> Row { return row_of(runs_[r], c.name, machine_[r].expansion(p)); });
      if (std::any_of(of.begin(), of.end(), [](const Row& row) { return row.squaredNorm() > 0.0; }))
        acts.push_back(alone(c.name, of));
    }
    if (acts.empty()) continue;
    add({.quantity = StatedQuantity::kDisplacement,
         .place = {parts[p].body},
         .follows = "expansion",
         .law = "its expansion",
         .unit_size = kUsualLogarithm,
         .unit = "1"},
        acts);
  }
}

void StatementBuilder::instruments_in_common() {
  std::vector<std::string> sensors;
  for (const Channel& c : channels_) {
    if (c.unit == "K") sensors.push_back(c.name);
  }
  const std::size_t n_alone = space_.columns.size();
  for (const std::vector<std::string>& group : effects::instrument_groups(sensors)) {
    std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> laws;  // columns of the members
    for (std::size_t i = 0; i < n_alone; ++i) {
      const Statement& s = space_.columns[i].says;
      if (s.quantity == StatedQuantity::kReading && s.place.size() == 1 &&
          std::find(group.begin(), group.end(), s.place.front()) != group.end())
        laws[{s.follows, s.law}].push_back(i);
    }
    for (const auto& [law, members] : laws) {
      if (members.size() != group.size()) continue;
      Statement says = space_.columns[members.front()].says;
      says.place = group;
      std::vector<Acting> acts;
      double size = 0.0;
      for (std::size_t i : members) {
        acts.insert(acts.end(), space_.columns[i].acts.begin(), space_.columns[i].acts.end());
        size += space_.columns[i].says.unit_size / static_cast<double>(members.size());
      }
      says.unit_size = size;
      add(std::move(says), std::move(acts));
    }
  }
}

}  // namespace driftwright::diagnosis
