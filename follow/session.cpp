#include "follow/session.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "follow/state_json.hpp"

namespace driftwright::follow {
namespace {

constexpr double kOn = 0.99, kOff = 0.01;  // limits of trust
constexpr const char* kStateFormat = "driftwright follow 2";

}  // namespace

Session::Session(std::vector<Model> models) : models_(std::move(models)) {
  std::vector<std::string> names;
  for (const Model& m : models_) {
    for (const AxisCorrection& axis : m.followed->axes()) {
      if (std::find(names.begin(), names.end(), axis.name) != names.end())
        throw InputError(fmt::format("{}: '{}' is corrected by another model already; each axis requires a model of its own",
                                     m.path, axis.name));
      names.push_back(axis.name);
    }
  }
}

std::vector<WantedChannel> Session::wanted() const {
  std::vector<WantedChannel> list;
  for (const Model& m : models_) {
    for (WantedChannel& w : m.followed->wanted()) {
      const auto there = std::find_if(list.begin(), list.end(), [&](const WantedChannel& o) { return o.name == w.name; });
      if (there == list.end()) {
        list.push_back(std::move(w));
      } else if (there->unit != w.unit) {
        throw InputError(fmt::format("{} reads '{}' in {}, and {} in {}", there->by, w.name, there->unit, w.by, w.unit));
      }
    }
  }
  return list;
}

void Session::begin(const std::vector<Channel>& channels) {
  for (const WantedChannel& w : wanted()) {
    const auto there = std::find_if(channels.begin(), channels.end(), [&](const Channel& c) { return c.name == w.name; });
    std::vector<std::string> names;
    for (const Channel& c : channels) names.push_back(c.header());
    if (there == channels.end())
      throw InputError(
          fmt::format("{} reads '{}_{}', which the stream does not have: {}", w.by, w.name, w.unit, fmt::join(names, ", ")));
    if (there->unit != w.unit)
      throw InputError(fmt::format("{} reads '{}' in {}, which the stream has in {}", w.by, w.name, w.unit, there->unit));
  }
  require_probed_axes(channels);
  channels_ = channels;
  for (const Model& m : models_) m.followed->begin(channels);
}

/// A column of probings that nobody takes is a mistake in its name, or of the model.
void Session::require_probed_axes(const std::vector<Channel>& channels) const {
  std::vector<std::string> taken, axes;
  for (const Model& m : models_) {
    for (std::string& name : m.followed->probings(channels)) taken.push_back(std::move(name));
    for (const AxisCorrection& axis : m.followed->axes()) axes.push_back(axis.name);
  }
  for (const Channel& c : channels) {
    if (!is_probing(c) || std::find(taken.begin(), taken.end(), c.name) != taken.end()) continue;
    throw InputError(fmt::format(
        "the stream has the column '{}', a probing that no followed model takes: probe_AXIS_um and "
        "probe_left_AXIS_um are allowed, where AXIS is corrected by a model file of `validate`. Corrected here: {}. "
        "Leave the column out, or rename it if it is no probing",
        c.header(), fmt::join(axes, ", ")));
  }
}

bool Session::has_probing(const StreamRow& row) const {
  for (std::size_t k = 0; k < channels_.size(); ++k) {
    if (is_probing(channels_[k]) && std::isfinite(row.values[k])) return true;
  }
  return false;
}

void Session::wait_all(double step_s) {
  if (!(step_s > 0.0)) return;
  waited_s_ += step_s;
  for (const Model& m : models_) m.followed->wait(step_s);
}

FollowLine Session::take(StreamRow row) {
  const double gap_s = guard_.short_gap_s(), usual_s = guard_.usual_step_s();
  const JudgedRow judged = guard_.judge(row, channels_);
  const bool lost_probing = !judged.is_taken && has_probing(row);
  const double time_s = row.time_s;
  if (judged.is_taken) {
    double step_s = std::max(0.0, judged.step_s - waited_s_);
    if (judged.step_s > gap_s) {
      wait_all(step_s - usual_s);
      step_s = std::max(0.0, judged.step_s - waited_s_);
    }
    waited_s_ = 0.0;
    for (const Model& m : models_) (void)m.followed->take(judged.run_s, row.values, step_s);
    taken_ = std::move(row);
    taken_.time_s = judged.run_s;
  }
  FollowLine l = line(judged.is_taken, judged.faults, "", lost_probing);
  if (std::isfinite(time_s)) l.time_s = time_s;
  if (judged.is_taken) l.run_s = judged.run_s;
  return l;
}

FollowLine Session::pass_over(const std::string& why) {
  guard_.count_unreadable();
  return line(false, {Fault::kUnreadableRow}, why);
}

FollowLine Session::wait(double step_s) {
  wait_all(step_s);
  return line(false, {}, fmt::format("no row for {:.0f} s", waited_s_));
}

FollowLine Session::line(bool is_taken, std::vector<Fault> faults, const std::string& passed_over, bool lost_probing) const {
  FollowLine l;
  bool has_begun = true;
  double trust = 1.0;
  std::vector<std::string> doubted;
  for (const Model& m : models_) {
    has_begun = has_begun && m.followed->has_begun();
    for (AxisCorrection& axis : m.followed->axes()) {
      trust = std::min(trust, axis.trust);
      for (const std::string& name : axis.doubted) {
        if (std::find(doubted.begin(), doubted.end(), name) == doubted.end()) doubted.push_back(name);
      }
      if (axis.probing && !is_taken) axis.probing->answer.reset();  // it was to an earlier row
      l.axes.push_back(std::move(axis));
    }
  }
  for (Fault f : faults) l.faults.emplace_back(fault_words(f));
  l.state = !has_begun || trust <= kOff ? "off" : trust < kOn ? "reduced" : is_taken ? "on" : "held";
  if (l.state == "on") return l;
  if (!has_begun) {
    l.why = fmt::format("no row has given {} yet",
                        doubted.empty() ? "drive and ambient" : fmt::format("{}", fmt::join(doubted, ", ")));
  } else if (!is_taken) {
    l.why = !passed_over.empty() ? passed_over : fmt::format("the row is passed over: {}", fmt::join(l.faults, ", "));
    if (lost_probing) l.why += "; its probing was not used, probe again";
  } else if (!doubted.empty()) {
    l.why = fmt::format("in doubt: {}", fmt::join(doubted, ", "));
  } else {
    l.why = "trust comes back after rows that were missing, or readings are outside of what the model was fitted on";
  }
  return l;
}

Json Session::state() const {
  Json models = Json::array(), channels = Json::array();
  for (const Model& m : models_) models.push_back({{"file", m.path}, {"hash", m.hash}, {"state", m.followed->state()}});
  for (const Channel& c : channels_) channels.push_back(c.header());
  return {{"format", kStateFormat},
          {"channels", std::move(channels)},
          {"guard", state_json(guard_.state())},
          {"models", std::move(models)}};
}

void Session::recall(const Json& j) {
  if (output::value<std::string>(j, "format") != kStateFormat)
    throw InputError(fmt::format("this file holds no state of `follow` (key `format` must be \"{}\")", kStateFormat));
  const auto channels = output::value<std::vector<std::string>>(j, "channels");
  std::vector<std::string> here;
  for (const Channel& c : channels_) here.push_back(c.header());
  if (channels != here)
    throw InputError(fmt::format("it is of a stream with other columns ({}); this one has {}", fmt::join(channels, ", "),
                                 fmt::join(here, ", ")));
  const Json models = output::list(j, "models");
  if (models.size() != models_.size())
    throw InputError(fmt::format("it is of {} models; {} are followed", models.size(), models_.size()));
  for (std::size_t k = 0; k < models_.size(); ++k) {
    if (output::value<std::string>(models[k], "hash") != models_[k].hash)
      throw InputError(fmt::format("{} is not the file that the state was kept with ({})", models_[k].path,
                                   output::value<std::string>(models[k], "file")));
    try {
      models_[k].followed->recall(output::value<Json>(models[k], "state"));
    } catch (const std::logic_error& e) {
      throw InputError(fmt::format("the state of {}: {}", models_[k].path, e.what()));
    }
  }
  guard_.recall(row_guard_of(output::value<Json>(j, "guard")));
}

}  // namespace driftwright::follow
