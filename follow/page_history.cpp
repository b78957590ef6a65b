#include "follow/page_history.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "follow/json_words.hpp"
#include "output/base64.hpp"

namespace driftwright::follow {
namespace {

constexpr std::size_t kMostPoints = 3000, kMostEntries = 200;
constexpr double kWindow_s = 12.0 * 3600.0;

std::string numbers(const std::vector<double>& all) {
  std::vector<std::string> texts;
  for (double x : all) texts.push_back(number(x));
  return fmt::format("{}", fmt::join(texts, ","));
}

}  // namespace

void PageHistory::add(PageRow row) {
  ++n_rows_;
  Point point{n_rows_, row.run_s, {}};
  for (const AxisCorrection& a : row.line.axes)
    point.numbers.insert(point.numbers.end(), {a.predicted_um, a.correction_um, a.trust});
  point.numbers.insert(point.numbers.end(), row.values.begin(), row.values.end());
  note(row);
  if (points_.empty() || point.run_s > points_.back().run_s + spacing_s_) points_.push_back(point);
  tip_ = std::move(point);
  last_ = std::move(row);
  while (!points_.empty() && points_.front().run_s < last_.run_s - kWindow_s) points_.pop_front();
  if (points_.size() <= kMostPoints) return;
  spacing_s_ =
      std::max(2.0 * spacing_s_, 2.0 * (points_.back().run_s - points_.front().run_s) / static_cast<double>(kMostPoints));
  std::deque<Point> every_second;
  for (std::size_t i = 0; i < points_.size(); i += 2) every_second.push_back(std::move(points_[i]));
  points_ = std::move(every_second);
}

void PageHistory::say(double run_s, std::string words) {
  if (journal_.size() >= kMostEntries) journal_.pop_front();
  journal_.push_back({n_rows_, run_s, std::move(words)});
}

/// Writes changes into the journal: of the state, except for single rows that are passed over, and of alarms and doubts.
void PageHistory::note(const PageRow& row) {
  const FollowLine& line = row.line;
  const bool is_passed_over = !line.run_s && !line.faults.empty();
  if (!is_passed_over && line.state != state_) {
    say(row.run_s, line.why.empty() ? line.state : fmt::format("{}: {}", line.state, line.why));
    state_ = line.state;
  }
  std::set<std::string> now;
  for (const AxisCorrection& a : line.axes) {
    const bool has_before = standing_.contains("alarm of " + a.name);
    if (!a.alarm.empty()) {
      now.insert("alarm of " + a.name);
      if (!has_before) say(row.run_s, fmt::format("alarm of {}: {}", a.name, a.alarm));
    }
    for (const std::string& name : a.doubted) now.insert(fmt::format("{} in doubt for {}", name, a.name));
  }
  for (const std::string& what : now) {
    if (!standing_.contains(what) && !what.starts_with("alarm of ")) say(row.run_s, what);
  }
  for (const std::string& what : standing_) {
    if (!now.contains(what)) say(row.run_s, fmt::format("{}: no longer", what));
  }
  standing_ = std::move(now);
}

std::uint64_t PageHistory::number_of(const std::string& id) const {
  const std::string mine = run_ + "-";
  if (!id.starts_with(mine) || id.size() == mine.size() || id.size() > mine.size() + 18) return 0;
  std::uint64_t n = 0;
  for (char ch : id.substr(mine.size())) {
    if (ch < '0' || ch > '9') return 0;
    n = 10 * n + static_cast<std::uint64_t>(ch - '0');
  }
  return n <= n_rows_ ? n : 0;
}

std::string PageHistory::news(std::uint64_t since) const {
  std::string head, points, journal;
  if (since == 0) {
    std::vector<std::string> axes, channels;
    for (const AxisCorrection& a : last_.line.axes) axes.push_back(quoted(a.name));
    for (const Channel& c : channels_)
      channels.push_back(fmt::format(R"({{"name":{},"unit":{}}})", quoted(c.name), quoted(c.unit)));
    head = fmt::format(R"("head":{{"axes":[{}],"channels":[{}]}},)", fmt::join(axes, ","), fmt::join(channels, ","));
  }
  const auto text = [](const Point& p) { return fmt::format("[{},{}]", number(p.run_s), numbers(p.numbers)); };
  for (const Point& p : points_) {
    if (p.number > since) points += fmt::format("{}{}", points.empty() ? "" : ",", text(p));
  }
  for (const Entry& e : journal_) {
    if (e.number > since)
      journal += fmt::format(R"({}{{"run_s":{},"words":{}}})", journal.empty() ? "" : ",", number(e.run_s), quoted(e.words));
  }
  const std::string_view state(reinterpret_cast<const char*>(last_.state.data()),  // NOLINT: little-endian, as pages read it
                               static_cast<std::size_t>(last_.state.size()) * sizeof(double));
  return fmt::format(
      "id: {}-{}\nevent: row\ndata: "
      "{{{}\"run_s\":{},\"points\":[{}],\"tip\":{},\"journal\":[{}],\"line\":{},\"values\":[{}],"
      "\"state\":\"{}\",\"ambient_K\":{}}}\n\n",
      run_, n_rows_, head, number(last_.run_s), points, text(*tip_), journal, line_text(last_.line), numbers(last_.values),
      output::base64(state), number(last_.ambient_K));
}

}  // namespace driftwright::follow
