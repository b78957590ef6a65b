#include "diagnosis/event_candidates.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/parallel.hpp"
#include "diagnosis/linear_run.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/scene.hpp"
#include "diagnosis/waveform.hpp"
#include "diagnosis/window_search.hpp"
#include "effects/time_windows.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kShortest_s = 1.0;       // of a window that another length has shortened
constexpr double kUnknownExchange = 0.2;  // W/K per W of heat that nobody knows of
constexpr double kTurnsGoOn = 2.0;        // of the longest run: how long turns are written for
constexpr Eigen::Index kCells = 60;       // of a run, in which windows are looked for first
constexpr Eigen::Index kFiner = 12;       // parts of two of them about an edge
constexpr double kWorthRefining = -8.0, kWorthTrying = 0.0;  // nats by linear theory

/// Whether the twin's reduced machine holds for such an exchange.
bool holds(const Twin& twin, const effects::Effect& window) {
  const solver::ExchangePlace asked = solver::place_of(effects::heat_balance({window}).exchanges.front());
  const auto& exchanges = twin.machine().system.exchanges;
  return std::any_of(exchanges.begin(), exchanges.end(), [&](const auto& e) { return e.place == asked; });
}

/// The window of an exchange between two bodies, either end of which may be the one that stands first. None between two regions, or where the twin has no
/// place for it.
std::optional<effects::Effect> exchange_window(const Twin& twin, const effects::Body& a, const effects::Body& b) {
  const bool is_turned = b.kind != effects::BodyKind::kNode;
  if (is_turned && a.kind != effects::BodyKind::kNode) return std::nullopt;
  effects::Effect window = effects::make_effect("exchange_window", is_turned ? b : a);
  window.set("conductance", 0.0);
  window.references["surrounding"] = is_turned ? a : b;
  window.tables["windows"] = {{0.0}, {1.0}};
  const bool joins_nodes = a.kind == effects::BodyKind::kNode && b.kind == effects::BodyKind::kNode;
  if (!joins_nodes && !holds(twin, window)) return std::nullopt;
  return window;
}

using Times = std::vector<std::pair<double, double>>;  ///< beginnings and ends [s]

/// Windows of one size, wherever they are.
struct Happening {
  effects::Body body;
  std::optional<effects::Body> other = {};             ///< an exchange with it; else heat
  std::vector<std::pair<const MeasuredRun*, Times>> in = {};  ///< each run that has some; no run: all of them, one window in each turn
  double every_s = 0.0;                                ///< of windows that repeat
  double size = 0.0;                                   ///< W or W/K
  double price_nats = 0.0;
};

double row_s(const MeasuredRun& run) {
  return run.time_s.back() / static_cast<double>(run.time_s.size() - 1);
}

/// How much longer all windows are than they were seen to be.
effects::DoubtedNumber longer_by(double sd_min, const std::vector<effects::Effect>& before) {
  effects::DoubtedNumber longer = effects::doubted("longer", "min", sd_min, 0.1 * sd_min);
  longer.set = [before](std::span<effects::Effect> added, double value) {
    for (std::size_t i = 0; i < added.size(); ++i) {
      const TimeSeries& seen_rows = before[i].tables.at("windows");
      TimeSeries& rows = added[i].tables.at("windows");
      for (std::size_t k = 0; k < rows.value.size(); ++k) {
        const double next_s = k + 1 < rows.time_s.size() ? rows.time_s[k + 1] : 1e9;
        rows.value[k] = std::clamp(seen_rows.value[k] + 60.0 * value, rows.time_s[k] + kShortest_s, next_s);
      }
    }
  };
  return longer;
}

/// Begin, length and period of windows that repeat, each known to about a row.
std::vector<effects::DoubtedNumber> times_of_turns(const Happening& h, double row_min) {
  const double begin_min = h.in.front().second.front().first / 60.0,
               length_min = (h.in.front().second.front().second - h.in.front().second.front().first) / 60.0;
  effects::DoubtedNumber begin = effects::doubted("begin", "min", 2.0 * row_min, 0.2 * row_min, begin_min);
  begin.low = 0.0;
  begin.set = [](std::span<effects::Effect> added, double value) {
    TimeSeries& rows = added[0].tables.at("windows");
    rows = {{60.0 * value}, {60.0 * value + rows.value[0] - rows.time_s[0]}};
  };
  effects::DoubtedNumber length = effects::doubted("length", "min", 2.0 * row_min, 0.2 * row_min, length_min);
  length.low = kShortest_s / 60.0;
  length.high = h.every_s / 60.0;
  length.set = [](std::span<effects::Effect> added, double value) {
    TimeSeries& rows = added[0].tables.at("windows");
    rows.value[0] = rows.time_s[0] + 60.0 * value;
  };
  effects::DoubtedNumber every = effects::doubted("every", "min", row_min, 0.1 * row_min, h.every_s / 60.0);
  every.low = length_min;
  every.set = [](std::span<effects::Effect> added, double value) {
    const TimeSeries& rows = added[0].tables.at("windows");
    added[0].set("every", std::max(60.0 * value, rows.value[0] - rows.time_s[0]));
  };
  return {begin, length, every};
}

/// One window alone: when it begins and how long it lasts are numbers of its own, and pay for themselves.
std::optional<Event> one_event(const effects::DoubtScene& scene, const Happening& h, const effects::Effect& window,
                               const effects::DoubtedNumber& size) {
  const auto& [run, windows] = h.in.front();
  const auto [begin_s, end_s] = windows.front();
  if (!(end_s - begin_s > kShortest_s)) return std::nullopt;
  const auto of_run = std::find_if(scene.runs.begin(), scene.runs.end(), [&](const auto& r) { return r.name == run->name; });
  const std::string what = h.other ? effects::kLid : "heat for a while";
  Event event{.doubt = effects::one_window(*of_run, window, size, h.size, what), .price_nats = 0.0};
  const std::vector<effects::DoubtedNumber>& n = event.doubt.numbers;
  event.doubt.grid = {{begin_s - n[1].nominal, (end_s - begin_s) / 60.0 - n[2].nominal}};
  return event;
}

std::optional<Event> event_of(const Twin& twin, const effects::DoubtScene& scene, const Happening& h) {
  effects::Effect window = effects::make_effect("heat_window", h.body);
  if (h.other) {
    const auto between = exchange_window(twin, h.body, *h.other);
    if (!between) return std::nullopt;
    window = *between;
  }
  const double sd = (h.other ? kUnknownExchange : 1.0) * scene.unknown_heat_W();
  effects::DoubtedNumber size = effects::doubted(h.other ? "conductance" : "power", h.other ? "W/K" : "W", sd, 0.05 * sd);
  if (h.other || h.size > 0.0) size.low = 0.0;
  const std::string where =
      h.other && !(*h.other == effects::hall()) ? h.body.name + "," + h.other->name : h.body.name;
  const double trial = std::clamp(h.size, -sd, sd);
  if (trial == 0.0 || trial < size.low) return std::nullopt;
  if (h.every_s == 0.0 && h.in.size() == 1 && h.in.front().second.size() == 1) {
    auto event = one_event(scene, h, window, size);
    if (event) {
      event->doubt.where = where;
      event->doubt.trial = trial;
    }
    return event;
  }
  Event event{.doubt = {}, .price_nats = h.price_nats};
  effects::Doubt& d = event.doubt;
  std::size_t n_windows = 0;
  double longest_row_s = 0.0;
  std::vector<std::string> times;
  for (const auto& [run, windows] : h.in) {
    effects::Effect in_run = window;
    if (h.every_s == 0.0) in_run.in = run->name;
    TimeSeries& rows = in_run.tables["windows"];
    rows = {};
    for (const auto& [begin_s, end_s] : windows) {
      if (!(end_s - begin_s > kShortest_s)) continue;
      rows.time_s.push_back(std::round(begin_s));
      rows.value.push_back(std::max(std::round(begin_s) + 1.0, std::round(end_s)));
      times.push_back(fmt::format("{:.1f} to {:.1f}", begin_s / 60.0, end_s / 60.0));
      ++n_windows;
    }
    if (rows.time_s.empty()) continue;
    longest_row_s = std::max(longest_row_s, row_s(*run));
    if (h.every_s > 0.0) {
      in_run.set("every", h.every_s);
      in_run.set("until_time", kTurnsGoOn * scene.longest_s());
    }
    d.added.push_back(std::move(in_run));
  }
  if (n_windows == 0) return std::nullopt;
  d.numbers = {size};
  if (h.every_s > 0.0) {
    for (effects::DoubtedNumber& n : times_of_turns(h, longest_row_s / 60.0)) d.numbers.push_back(std::move(n));
  } else {
    d.numbers.push_back(longer_by(longest_row_s / 60.0, d.added));
  }
  d.finding = window.kind->key;
  d.where = where;
  const std::string to = h.other ? ", to " + h.other->name : std::string();
  d.law = h.every_s > 0.0 ? fmt::format("windows that repeat every {:.1f} min{}: {} min of each turn", h.every_s / 60.0, to,
                                        times.front())
                          : fmt::format("{}, seen in the waveform{}: {} min",
                                        n_windows == 1 ? std::string("a window") : fmt::format("{} windows of one size", n_windows),
                                        to, fmt::join(times, ", "));
  d.trial = trial;
  return event;
}

/// Where something may act for a while: heat in a body, or an exchange of two.
struct Place {
  std::size_t body = 0;
  std::optional<std::size_t> other = {};  ///< n_bodies: the hall
};

/// A run as linear theory sees it.
struct SeenRun {
  LinearRun linear;
  Eigen::MatrixXd decay;  ///< of each mode from row to row, modes x rows - 1
  Eigen::Index first_block = 0, first_row = 0, n_rows = 0;  ///< in the comparison, and of its whitened readings, condensed
};

SeenRun seen_run(const Fitter& fitter, const TwinState& state, std::size_t r, const std::vector<effects::Body>& bodies,
                 Twin::Workspace& workspace) {
  const MeasuredRun& run = fitter.runs()[r];
  std::vector<Eigen::Index> rows(run.time_s.size());
  std::iota(rows.begin(), rows.end(), 0);
  SeenRun s{.linear = linear_run(fitter.twin(), run, state, bodies, rows,
                                 Eigen::VectorXd::Ones(static_cast<Eigen::Index>(run.channels.size())), workspace),
            .decay = {}};
  const ModalCourse& course = s.linear.course;
  const auto n_steps = static_cast<Eigen::Index>(rows.size()) - 1;
  s.decay.resize(course.modes.front().rate_1_s.size(), n_steps);
  for (Eigen::Index k = 0; k < n_steps; ++k) {
    const auto i = static_cast<std::size_t>(k);
    s.decay.col(k) = (-(run.time_s[i + 1] - run.time_s[i]) * course.modes[course.of_interval[i]].rate_1_s).array().exp();
  }
  const auto& blocks = fitter.comparison().blocks();
  s.first_block = std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.run == r; }) - blocks.begin();
  for (auto b = static_cast<std::size_t>(s.first_block); b < blocks.size() && blocks[b].run == r; ++b) {
    const Comparison::Condensed& c = fitter.comparison().condensed_blocks()[b];
    if (s.n_rows == 0) s.first_row = c.first;
    s.n_rows += c.n;
  }
  return s;
}

/// What drives heat through a place from row to row: 1, or a difference of temperatures [K].
Eigen::VectorXd carrier_of(const SeenRun& run, const Place& place, std::size_t n_bodies) {
  const Eigen::Index n = run.decay.cols();
  Eigen::VectorXd carrier = Eigen::VectorXd::Ones(n);
  if (!place.other) return carrier;
  const Eigen::MatrixXd& warm_K = run.linear.temperature_K;
  const auto at = [&](Eigen::Index row) {
    const double other_K =
        *place.other == n_bodies ? run.linear.hall_K[row] : warm_K(row, static_cast<Eigen::Index>(*place.other));
    return other_K - warm_K(row, static_cast<Eigen::Index>(place.body));
  };
  for (Eigen::Index k = 0; k < n; ++k) carrier[k] = mean_difference(at(k), at(k + 1));
  return carrier;
}

/// Whitened readings, condensed, of a unit through a place in each cell of a run, n_rows x n_cells. @param edges  rows between the cells
Eigen::MatrixXd columns_of(const Comparison& comparison, const SeenRun& run, const Place& place, std::size_t n_bodies,
                           const std::vector<Eigen::Index>& edges) {
  const ModalCourse& course = run.linear.course;
  const Eigen::Index n_steps = run.decay.cols(), n_modes = run.decay.rows();
  const Eigen::VectorXd carrier = carrier_of(run, place, n_bodies);
  Eigen::MatrixXd load(n_modes, n_steps);
  for (Eigen::Index k = 0; k < n_steps; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const ModalCourse::Modes& m = course.modes[course.of_interval[i]];
    const double dt_s = course.time_s[i + 1] - course.time_s[i];
    Eigen::VectorXd b = m.load.col(static_cast<Eigen::Index>(place.body));
    if (place.other && *place.other < n_bodies) b -= m.load.col(static_cast<Eigen::Index>(*place.other));
    for (Eigen::Index j = 0; j < n_modes; ++j) {
      const double x = dt_s * m.rate_1_s[j];
      load(j, k) = carrier[k] * b[j] * (std::abs(x) < 1e-9 ? dt_s : (1.0 - run.decay(j, k)) / m.rate_1_s[j]);
    }
  }
  const auto n_channels = course.modes.front().observe.cols();
  const auto n_cells = static_cast<Eigen::Index>(edges.size()) - 1;
  Eigen::MatrixXd columns(run.n_rows, n_cells), readings(n_channels, n_steps + 1);
  Eigen::VectorXd whitened;
  for (Eigen::Index c = 0; c < n_cells; ++c) {
    const Eigen::Index from = edges[static_cast<std::size_t>(c)], to = edges[static_cast<std::size_t>(c + 1)];
    readings.setZero();
    Eigen::VectorXd a = Eigen::VectorXd::Zero(n_modes);
    for (Eigen::Index k = from; k < n_steps; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const ModalCourse::Modes& m = course.modes[course.of_interval[i]];
      if (k > from && course.of_interval[i] != course.of_interval[i - 1]) a = (m.from * a).eval();
      a.array() *= run.decay.col(k).array();
      if (k < to) a += load.col(k);
      readings.col(k + 1).noalias() = m.observe.transpose() * a;
    }
    for (Eigen::Index channel = 0; channel < n_channels; ++channel) {
      const auto b = static_cast<std::size_t>(run.first_block + channel);
      const Comparison::Condensed& few = comparison.condensed_blocks()[b];
      whitened.resize(comparison.blocks()[b].n);
      comparison.whitener(b).apply(readings.row(channel).transpose(), whitened);
      for (Eigen::Index k = 0; k < few.n; ++k) {
        const auto together = whitened.segment(k * few.together, std::min(few.together, whitened.size() - k * few.together));
        columns(few.first - run.first_row + k, c) = together.sum() / std::sqrt(static_cast<double>(together.size()));
      }
    }
  }
  return columns;
}

using Edges = std::vector<std::vector<Eigen::Index>>;  ///< rows between the cells of each run

WindowEvidence evidence_of(const Fitter& fitter, const Projection& projection, const std::vector<SeenRun>& runs,
                           const Place& place, std::size_t n_bodies, const Edges& edges) {
  WindowEvidence e;
  Eigen::Index n_cells = 0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    WindowEvidence::Run run{n_cells, {}, row_s(fitter.runs()[r])};
    for (Eigen::Index row : edges[r]) run.edge_s.push_back(fitter.runs()[r].time_s[static_cast<std::size_t>(row)]);
    e.runs.push_back(std::move(run));
    n_cells += static_cast<Eigen::Index>(edges[r].size()) - 1;
  }
  e.slope.resize(n_cells);
  e.curvature = Eigen::MatrixXd::Zero(n_cells, n_cells);
  Eigen::MatrixXd known(projection.slopes.cols(), n_cells);  // what the numbers known roughly have of each column
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::MatrixXd columns = columns_of(fitter.comparison(), runs[r], place, n_bodies, edges[r]);
    const Eigen::Index first = e.runs[r].first, n = columns.cols();
    e.curvature.block(first, first, n, n).noalias() = columns.transpose() * columns;
    known.middleCols(first, n).noalias() =
        projection.slopes.middleRows(runs[r].first_row, runs[r].n_rows).transpose() * columns;
    e.slope.segment(first, n).noalias() =
        columns.transpose() * projection.rest.segment(runs[r].first_row, runs[r].n_rows);
  }
  e.curvature.noalias() -= known.transpose() * projection.factor.solve(known);
  return e;
}

Edges coarse_edges(const std::vector<MeasuredRun>& runs) {
  Edges edges;
  for (const MeasuredRun& run : runs) {
    const auto n_steps = static_cast<Eigen::Index>(run.time_s.size()) - 1;
    const Eigen::Index n_cells = std::min(n_steps, kCells);
    std::vector<Eigen::Index>& of_run = edges.emplace_back();
    for (Eigen::Index c = 0; c <= n_cells; ++c) of_run.push_back(c * n_steps / n_cells);
  }
  return edges;
}

/// Finer cells about the edges of windows, and the windows in these.
Edges finer_edges(const Edges& coarse, std::vector<FoundWindows::Window>& windows) {
  std::vector<std::set<Eigen::Index>> rows;
  for (const auto& of_run : coarse) rows.emplace_back(of_run.begin(), of_run.end());
  for (const FoundWindows::Window& w : windows) {
    const auto& of_run = coarse[w.run];
    for (const Eigen::Index edge : {w.first, w.last}) {
      const Eigen::Index from = of_run[static_cast<std::size_t>(std::max<Eigen::Index>(0, edge - 1))];
      const Eigen::Index to = of_run[std::min(of_run.size() - 1, static_cast<std::size_t>(edge + 1))];
      const Eigen::Index stride = std::max<Eigen::Index>(1, (to - from) / kFiner);
      for (Eigen::Index row = from; row < to; row += stride) rows[w.run].insert(row);
    }
  }
  Edges finer;
  for (const auto& of_run : rows) finer.emplace_back(of_run.begin(), of_run.end());
  for (FoundWindows::Window& w : windows) {
    const auto index = [&](Eigen::Index edge) {
      const auto& fine = finer[w.run];
      return std::lower_bound(fine.begin(), fine.end(), coarse[w.run][static_cast<std::size_t>(edge)]) - fine.begin();
    };
    w = {w.run, index(w.first), index(w.last)};
  }
  return finer;
}

}  // namespace

std::vector<Event> events_seen(const Twin& twin, const std::vector<MeasuredRun>& runs) {
  std::vector<Waveform> list;
  const bool is_solved = has_solution([&] {
    Twin::Workspace workspace(twin);
    Prediction prediction;
    for (const MeasuredRun& run : runs)
      prediction.push_back(twin.read(twin.as_written(), run, twin.respond(twin.as_written(), run, workspace)));
    list = waveforms(twin, runs, twin.as_written(), prediction);
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
      if (!w.to.empty()) h.other = w.to == effects::kHallName ? effects::hall() : twin.body_of(w.to);
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
    if (auto event = event_of(twin, scene, s.happening)) found.push_back(*std::move(event));
  }
  return found;
}

std::vector<Event> events_beside(const Fitter& fitter, const Hypothesis& hypothesis, const Fit& fit,
                                 const Projection& projection) {
  const Twin& twin = fitter.twin();
  const effects::DoubtScene scene = scene_of(twin, fitter.runs());
  const std::vector<effects::Body> bodies = bodies_of(scene);
  const TwinState state = fitter.state(hypothesis, fit.x);
  std::vector<SeenRun> runs;
  {
    Twin::Workspace workspace(twin);
    for (std::size_t r = 0; r < fitter.runs().size(); ++r) runs.push_back(seen_run(fitter, state, r, bodies, workspace));
  }
  std::vector<Place> places;
  const auto body = [&](std::size_t b) { return b == bodies.size() ? effects::hall() : bodies[b]; };
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    places.push_back({b});
    for (std::size_t other = b + 1; other <= bodies.size(); ++other) {
      if (exchange_window(twin, body(b), body(other))) places.push_back({b, other});
    }
  }
  const Edges coarse = coarse_edges(fitter.runs());
  std::vector<std::vector<Happening>> of_place(places.size());
  for_each_index(
      places.size(), [] { return 0; },
      [&](std::size_t p, int) {
        const Place& place = places[p];
        const auto asked = [&](const Edges& edges) {
          WindowEvidence e = evidence_of(fitter, projection, runs, place, bodies.size(), edges);
          e.prior_sd = (place.other ? kUnknownExchange : 1.0) * scene.unknown_heat_W();
          e.is_positive = place.other.has_value();
          return e;
        };
        Happening h{.body = body(place.body)};
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
        auto found = find_windows(first);
        if (!found || !(found->gain > kWorthRefining)) return;
        const Edges fine = finer_edges(coarse, found->windows);
        const WindowEvidence second = asked(fine);
        found = find_windows(second, found->windows);
        if (!found || !(found->gain > kWorthTrying)) return;
        for (const FoundWindows::Window& w : found->windows) {
          const MeasuredRun& run = fitter.runs()[w.run];
          if (h.in.empty() || h.in.back().first != &run) h.in.push_back({&run, {}});
          const std::vector<double>& edge_s = second.runs[w.run].edge_s;
          h.in.back().second.emplace_back(edge_s[static_cast<std::size_t>(w.first)], edge_s[static_cast<std::size_t>(w.last)]);
        }
        h.size = found->size;
        h.price_nats = found->price_nats;
        of_place[p].push_back(std::move(h));
      });
  std::vector<Event> events;
  for (const std::vector<Happening>& list : of_place) {
    for (const Happening& h : list) {
      if (auto event = event_of(twin, scene, h)) events.push_back(*std::move(event));
    }
  }
  return events;
}

}  // namespace driftwright::diagnosis
