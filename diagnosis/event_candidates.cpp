#include "diagnosis/event_candidates.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "diagnosis/happening.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/scene.hpp"
#include "diagnosis/stretch_choice.hpp"
#include "diagnosis/visit.hpp"
#include "diagnosis/waveform.hpp"
#include "diagnosis/window_evidence.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr std::size_t kFewWindows = 5;   // more are held against a course of any shape
constexpr double kCourseIsBetter = 1.1;  // than windows, which are then left to what has no name
constexpr double kAlways =
    0.9;  // of its records' time: what lasts longer is no window, and what pauses instead was not chosen
constexpr double kWorthRefining = -8.0, kWorthTrying = 0.0;  // nats by linear theory
// Of a run, in which windows are looked for first. A spindle may stop for a minute of a day; what else acts for a while does so for longer, and at many places.
constexpr Eigen::Index kCells = 60, kCellsOfSpeed = 240;

/// The events that a happening may be.
void add_events_of(const Twin& twin, const effects::DoubtScene& scene, const Happening& happening,
                   std::vector<Event>& list) {
  if (is_unseen(happening) || share_of_time(happening) > kAlways) return;
  if (auto event = event_of(twin, scene, happening)) list.push_back(*std::move(event));
  for (Event& visit : visits_of(scene, happening)) {
    const bool is_known = std::any_of(list.begin(), list.end(), [&](const Event& e) {  // seen as heat and as an exchange
      return e.doubt.finding == visit.doubt.finding && e.doubt.where == visit.doubt.where && e.doubt.law == visit.doubt.law;
    });
    if (!is_known) list.push_back(std::move(visit));
  }
}

/// What was found at a place, its windows as times. @param evidence  in whose cells they are
/// @returns  nothing where so many windows are no more than a course of any shape
std::optional<Happening> happening_of(const Fitter& fitter, const WindowEvidence& evidence, const FoundWindows& found,
                                      Happening h) {
  if (found.windows.size() > kFewWindows) {
    const double course = course_gain(evidence, found);
    if (course > kCourseIsBetter * found.gain) return std::nullopt;
    h.is_course = course > found.gain;
  }
  for (const FoundWindows::Window& w : found.windows) {
    const MeasuredRun& run = fitter.runs()[w.run];
    if (h.in.empty() || h.in.back().first != &run) h.in.push_back({&run, {}});
    const std::vector<double>& edge_s = evidence.runs[w.run].edge_s;
    h.in.back().second.emplace_back(edge_s[static_cast<std::size_t>(w.first)], edge_s[static_cast<std::size_t>(w.last)]);
    if (w.begin_wide_s > 0.0) h.wide_s.emplace_back(w.begin_wide_s, w.end_wide_s);
  }
  h.size = found.size;
  h.price_nats = found.price_nats;
  return h;
}

}  // namespace

std::vector<Event> events_seen(const Twin& twin, const std::vector<MeasuredRun>& runs, const Listener& listener) {
  std::vector<Waveform> list;
  const bool is_solved = has_solution([&] {
    Twin::Workspace workspace(twin);
    Prediction prediction;
    for (const MeasuredRun& run : runs)
      prediction.push_back(twin.read(twin.as_written(), run, twin.respond(twin.as_written(), run, workspace)));
    list = waveforms(twin, runs, twin.as_written(), prediction, listener);
  });
  if (!is_solved) return {};
  struct Seen {
    std::string where, to;
    Happening happening;
  };
  std::vector<Seen> seen;
  for (const Waveform& w : list) {
    if (w.of != Waveform::Of::kHeat || w.shape.shape != Shape::kWindows) continue;
    auto same = std::find_if(seen.begin(), seen.end(), [&](const Seen& s) { return s.where == w.where && s.to == w.to; });
    if (same == seen.end()) {
      Happening h{.body = twin.body_of(w.where)};
      if (!w.to.empty()) h.other = w.to == effects::kAmbientName ? effects::ambient_node() : twin.body_of(w.to);
      seen.push_back({w.where, w.to, std::move(h)});
      same = seen.end() - 1;
    }
    const auto run = std::find_if(runs.begin(), runs.end(), [&](const MeasuredRun& r) { return r.name == w.run; });
    Happening& h = same->happening;
    const auto n = static_cast<double>(w.shape.windows_s.size());
    h.size += n * w.shape.size;
    h.price_nats += 2.0 * n * std::log(static_cast<double>(w.time_s.size()));
    h.in.emplace_back(&*run, w.shape.windows_s);
  }
  const effects::DoubtScene scene = scene_of(twin, runs);
  std::vector<Event> found;
  for (Seen& s : seen) {
    std::size_t n_windows = 0;
    for (const auto& [run, windows] : s.happening.in) n_windows += windows.size();
    s.happening.size /= static_cast<double>(n_windows);
    s.happening.price_nats -= std::lgamma(static_cast<double>(n_windows) + 1.0);  // in whatever order
    add_events_of(twin, scene, s.happening, found);
  }
  return found;
}

std::vector<Event> events_beside(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit,
                                 const Projection& projection, const Listener& listener) {
  const Twin& twin = fitter.twin();
  const effects::DoubtScene scene = scene_of(twin, fitter.runs());
  const std::vector<effects::Body> bodies = bodies_of(scene);
  const TwinState state = fitter.state(hypothesis, fit.x);
  std::vector<SeenRun> runs;
  {
    Twin::Workspace workspace(twin);
    for (std::size_t r = 0; r < fitter.runs().size(); ++r) runs.push_back(seen_run(fitter, state, r, bodies, workspace));
  }
  std::vector<WindowPlace> places;
  const auto body = [&](std::size_t b) { return b == bodies.size() ? effects::ambient_node() : bodies[b]; };
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    places.push_back({b});
    for (std::size_t other = b + 1; other <= bodies.size(); ++other) {
      if (exchange_window(twin, body(b), body(other))) places.push_back({b, other});
    }
  }
  const bool turns_heat =
      std::any_of(runs.begin(), runs.end(), [](const SeenRun& r) { return (r.linear.turning_W.array() != 0.0).any(); });
  if (turns_heat) places.push_back({.is_speed = true});
  const Edges few = coarse_edges(fitter.runs(), kCells), many = coarse_edges(fitter.runs(), kCellsOfSpeed);
  const std::vector<WorkStretches> of_work = stretches_of_work(fitter.runs());
  std::vector<std::vector<Happening>> of_place(places.size());
  for_each_index(
      places.size(), [] { return 0; },
      [&](std::size_t p, int) {
        const WindowPlace& place = places[p];
        const Edges& coarse = place.is_speed ? many : few;
        const auto asked = [&](const Edges& edges) {
          WindowEvidence e = evidence_of(fitter, projection, runs, place, bodies.size(), edges);
          e.prior_sd = place.is_speed ? kUnknownSpeed : (place.other ? kUnknownExchange : 1.0) * scene.unknown_heat_W();
          e.is_positive = place.other.has_value();
          return e;
        };
        Happening h{.body = body(place.body), .is_speed = place.is_speed};
        if (place.other) h.other = body(*place.other);
        const WindowEvidence first = asked(coarse);
        if (const auto turns = find_turns(first); turns && turns->gain > kWorthTrying) {
          Happening again = h;
          again.in = {{&fitter.runs().front(), {{turns->begin_s, turns->begin_s + turns->length_s}}}};
          again.every_s = turns->every_s;
          again.size = turns->size;
          again.price_nats = turns->price_nats;
          of_place[p].push_back(std::move(again));
        }
        for (const WorkStretches& stretches : of_work) {
          if (place.is_speed) break;  // a speed that is another one in some runs alone is a level of the drive
          const WindowEvidence there = asked(stretches.edges);
          auto chosen = choose_stretches(there, stretches);
          if (!chosen) continue;
          const double of_drives = std::log(static_cast<double>(of_work.size()));  // whose stretches they are
          chosen->gain -= of_drives;
          chosen->price_nats += of_drives;
          if (!(chosen->gain > kWorthTrying)) continue;
          if (auto seen = happening_of(fitter, there, *chosen, h)) of_place[p].push_back(*std::move(seen));
        }
        auto found = find_windows(first);
        if (!found || !(found->gain > kWorthRefining)) return;
        const Edges fine = finer_edges(coarse, found->windows);
        const WindowEvidence second = asked(fine);
        found = find_windows(second, found->windows);
        if (!found || !(found->gain > kWorthTrying)) return;
        if (auto seen = happening_of(fitter, second, *found, h)) of_place[p].push_back(*std::move(seen));
      },
      listener);
  std::vector<Event> events;
  for (const std::vector<Happening>& list : of_place) {
    for (const Happening& h : list) add_events_of(twin, scene, h, events);
  }
  return events;
}

}  // namespace driftwright::diagnosis
