#include "diagnosis/visit.hpp"

#include <algorithm>
#include <cmath>

#include "effects/time_windows.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kBehindTheEnd = 1.01;          // times the record's length: it does not leave
constexpr double kLeast = 1e-4, kTrial = 0.1;   // relative to the capacity of the body that it comes to
constexpr double kTimeSd = 1.5;                 // standard deviation of the logarithm of its time constant
constexpr double kFollows[] = {0.3, 1.0, 3.0};  // in units of the detected window: time constants to try first
constexpr double kStays[] = {1.0, 3.0};         // in units of that window: lengths of its stay
constexpr double kShortestVisit_s = 1.0;

TimeSeries& rows(std::span<effects::Effect> added) {
  return added[0].tables.at(effects::kWindows);
}

}  // namespace

std::vector<Event> visits_of(const effects::DoubtScene& scene, const Happening& h) {
  if (h.is_speed || h.in.size() != 1 || (h.other && !(*h.other == effects::ambient_node()))) return {};
  const auto to =
      std::find_if(scene.materials.begin(), scene.materials.end(), [&](const auto& m) { return m.body == h.body; });
  const bool has_one = std::any_of(scene.own.begin(), scene.own.end(), [&](const effects::Effect& e) {
    return e.kind->key == "hidden_body" && e.place == h.body.name;
  });
  if (to == scene.materials.end() || !to->stores || has_one) return {};
  const MeasuredRun& run = *h.in.front().first;
  const auto [begin_s, end_s] = h.in.front().second.front();
  const double length_s = run.time_s.back(), seen_s = end_s - begin_s;
  if (!(seen_s > kShortestVisit_s)) return {};

  effects::Effect body =
      effects::make_effect("hidden_body", h.body, {{"capacity", kLeast * to->capacity_J_K}, {"conductance", 0.0}});
  body.in = run.name;
  body.tables[effects::kWindows] = {{begin_s}, {kBehindTheEnd * length_s}};
  effects::DoubtedNumber capacity = effects::doubted("capacity", "J/K", to->capacity_J_K, kTrial * to->capacity_J_K);
  capacity.low = 0.0;
  capacity.set = [least_J_K = kLeast * to->capacity_J_K](std::span<effects::Effect> added, double value) {
    added[0].set("capacity", std::max(value, least_J_K));
  };
  effects::DoubtedNumber behind = effects::doubted("time_constant", "min", kTimeSd, 0.1, seen_s / 60.0);
  behind.is_log = true;
  behind.set = [](std::span<effects::Effect> added, double value) {
    added[0].set("conductance", added[0]["capacity"] / (60.0 * value));
  };
  const effects::DoubtedNumber begin = effects::doubted_time(
      "begin", length_s, [end_s = kBehindTheEnd * length_s](std::span<effects::Effect> added, double value) {
        rows(added) = {{std::min(value, end_s - kShortestVisit_s)}, {end_s}};
      });
  Event stays{.doubt = {.finding = "hidden_body",
                        .where = h.body.name,
                        .law = "a body as warm as the ambient that comes and stays, in " + run.name,
                        .added = {body},
                        .numbers = {capacity, begin, behind},
                        .trial = kTrial * to->capacity_J_K,
                        .grid = {}}};
  Event goes = stays;
  goes.doubt.law = "a body as warm as the ambient that comes and goes, in " + run.name;
  goes.doubt.numbers[1].set = [](std::span<effects::Effect> added, double value) {
    const double there_s = rows(added).value[0] - rows(added).time_s[0];
    rows(added) = {{value}, {value + there_s}};
  };
  goes.doubt.added[0].tables[effects::kWindows] = {{begin_s}, {end_s}};
  effects::DoubtedNumber length = effects::doubted("length", "min", length_s / 60.0 / 4.0, 1.0, seen_s / 60.0);
  length.low = kShortestVisit_s / 60.0;
  length.high = length_s / 60.0;
  length.set = [](std::span<effects::Effect> added, double value) {
    rows(added).value[0] = rows(added).time_s[0] + 60.0 * value;
  };
  goes.doubt.numbers.push_back(length);

  for (double follows : kFollows) {
    const double time_x = begin_s - begin.nominal, follows_x = std::log(follows);
    stays.doubt.grid.push_back({time_x, follows_x});
    for (double there : kStays) goes.doubt.grid.push_back({time_x, follows_x, (there - 1.0) * seen_s / 60.0});
  }
  return {stays, goes};
}

}  // namespace driftwright::diagnosis
