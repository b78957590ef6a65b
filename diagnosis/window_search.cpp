#include "diagnosis/window_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace driftwright::diagnosis {
namespace {

using Window = FoundWindows::Window;

constexpr double kOfAWindow = 5.0;  // nats that one more must bring while the others are looked for
constexpr std::size_t kMostWindows = 24;
constexpr int kMostTurns = 40;
// Several windows that are open for most of the time draw any slow course: one of several is no longer than this share of its run.
constexpr double kLongestOfSeveral = 0.3;
constexpr double kFewestTurns = 3.0;  // of the longest run: fewer do not repeat
constexpr double kShortestCells = 3.0;
constexpr double kCourseTimes[] = {0.02, 0.06, 0.2};  // of a run, for which a course stays alike
constexpr double kJitter = 1e-9;

/// What a set of windows has of slope and curvature.
struct Sums {
  double slope = 0.0, curvature = 0.0;
};

class Searcher {
 public:
  explicit Searcher(const WindowEvidence& e) : e_(e) {
    const Eigen::Index n = e.slope.size();
    slope_ = Eigen::VectorXd::Zero(n + 1);
    square_ = Eigen::MatrixXd::Zero(n + 1, n + 1);
    for (Eigen::Index i = 0; i < n; ++i) slope_[i + 1] = slope_[i] + e.slope[i];
    for (Eigen::Index j = 0; j < n; ++j) {
      double column = 0.0;
      for (Eigen::Index i = 0; i < n; ++i) {
        column += e.curvature(i, j);
        square_(i + 1, j + 1) = square_(i + 1, j) + column;
      }
    }
  }

  [[nodiscard]] double nats(const Sums& s) const {
    if (!(s.curvature > 1e-9)) return -1e300;
    if (e_.is_positive && s.slope < 0.0) return -1e300;
    const double known = 1.0 / (e_.prior_sd * e_.prior_sd);
    return 0.5 * s.slope * s.slope / (s.curvature + known) - 0.5 * std::log1p(s.curvature / known);
  }
  [[nodiscard]] double size(const Sums& s) const { return s.slope / (s.curvature + 1.0 / (e_.prior_sd * e_.prior_sd)); }

  /// Cells of a window among those of all runs.
  [[nodiscard]] std::pair<Eigen::Index, Eigen::Index> cells(const Window& w) const {
    return {e_.runs[w.run].first + w.first, e_.runs[w.run].first + w.last};
  }
  [[nodiscard]] Sums sums(const std::vector<Window>& set) const {
    Sums s;
    for (const Window& a : set) {
      const auto [i, j] = cells(a);
      s.slope += slope_[j] - slope_[i];
      for (const Window& b : set) {
        const auto [k, l] = cells(b);
        s.curvature += square_(j, l) - square_(i, l) - square_(j, k) + square_(i, k);
      }
    }
    return s;
  }

  /// A set whose windows all begin and end some cells later. @returns  none where one would be empty, or meet another
  [[nodiscard]] std::vector<Window> all_moved(std::vector<Window> set, Eigen::Index begin, Eigen::Index end) const {
    std::sort(set.begin(), set.end(),
              [](const Window& a, const Window& b) { return a.run != b.run ? a.run < b.run : a.first < b.first; });
    for (std::size_t k = 0; k < set.size(); ++k) {
      Window& w = set[k];
      w.first = std::max<Eigen::Index>(0, w.first + begin);
      w.last = std::min(static_cast<Eigen::Index>(e_.runs[w.run].edge_s.size()) - 1, w.last + end);
      if (w.first >= w.last || is_long(w) || (k > 0 && set[k - 1].run == w.run && set[k - 1].last >= w.first)) return {};
    }
    return set;
  }

  struct Addition {
    Window window;
    double nats = -1e300;
  };
  /// The window that goes best with a set, apart from all of it. @param run  the only one looked at, or all where negative
  [[nodiscard]] Addition best_addition(const std::vector<Window>& set, std::ptrdiff_t only_run = -1) const {
    const Eigen::Index n = e_.slope.size();
    const Sums now = sums(set);
    Eigen::VectorXd cross = Eigen::VectorXd::Zero(n + 1);  // sums of the set's curvature up to each cell
    std::vector<char> taken(static_cast<std::size_t>(n + 1), 0);
    for (const Window& w : set) {
      const auto [i, j] = cells(w);
      cross += square_.col(j) - square_.col(i);
      for (Eigen::Index k = std::max<Eigen::Index>(0, i - 1); k <= std::min(n - 1, j); ++k)
        taken[static_cast<std::size_t>(k)] = 1;
    }
    Addition best;
    for (std::size_t r = 0; r < e_.runs.size(); ++r) {
      if (only_run >= 0 && static_cast<std::size_t>(only_run) != r) continue;
      const Eigen::Index first = e_.runs[r].first, n_cells = n_of(r);
      for (Eigen::Index i = 0; i < n_cells; ++i) {
        for (Eigen::Index j = i + 1; j <= n_cells && !taken[static_cast<std::size_t>(first + j - 1)]; ++j) {
          if (i == 0 && j == n_cells) continue;  // throughout: no window
          if (!set.empty() && is_long({r, i, j})) break;
          const Eigen::Index a = first + i, b = first + j;
          const Sums with{now.slope + slope_[b] - slope_[a],
                          now.curvature + 2.0 * (cross[b] - cross[a]) + square_(b, b) - 2.0 * square_(a, b) + square_(a, a)};
          if (const double value = nats(with); value > best.nats) best = {{r, i, j}, value};
        }
      }
    }
    return best;
  }

  /// The set with one of its windows in two parts that goes best, a gap of at least a cell between them.
  struct Split {
    Window before, after;
    double nats = -1e300;
  };
  [[nodiscard]] Split best_split(const std::vector<Window>& set, std::size_t k) const {
    const Sums now = sums(set);
    Eigen::VectorXd cross = Eigen::VectorXd::Zero(e_.slope.size() + 1);
    for (const Window& w : set) {
      const auto [i, j] = cells(w);
      cross += square_.col(j) - square_.col(i);
    }
    const Window& whole = set[k];
    const Eigen::Index first = e_.runs[whole.run].first;
    Split best;
    for (Eigen::Index i = whole.first + 1; i + 1 < whole.last; ++i) {
      for (Eigen::Index j = i + 1; j < whole.last; ++j) {
        const Window before{whole.run, whole.first, i}, after{whole.run, j, whole.last};
        const Eigen::Index a = first + i, b = first + j;
        const Sums without{now.slope - slope_[b] + slope_[a], now.curvature - 2.0 * (cross[b] - cross[a]) + square_(b, b) -
                                                                  2.0 * square_(a, b) + square_(a, a)};
        if (const double value = nats(without); value > best.nats) best = {before, after, value};
      }
    }
    return best;
  }

  /// Whether a window is too long to be one of several.
  [[nodiscard]] bool is_long(const Window& w) const {
    const std::vector<double>& edge_s = e_.runs[w.run].edge_s;
    const double length_s = edge_s[static_cast<std::size_t>(w.last)] - edge_s[static_cast<std::size_t>(w.first)];
    return length_s > kLongestOfSeveral * (edge_s.back() - edge_s.front());
  }

  /// Price of the times of a set: each of them could have been anywhere, and some places would do as well as this one.
  /// @param set  is told how wide its times are
  [[nodiscard]] double price(std::vector<Window>& set) const {
    const double value = nats(sums(set));
    double price = 0.0;
    for (std::size_t k = 0; k < set.size(); ++k) {
      const WindowEvidence::Run& run = e_.runs[set[k].run];
      const double length_s = run.edge_s.back() - run.edge_s.front();
      for (const bool is_end : {false, true}) {
        double wide_s = 0.0;
        std::vector<Window> other = set;
        for (Eigen::Index edge = is_end ? set[k].first + 1 : 0; edge <= (is_end ? n_of(set[k].run) : set[k].last - 1);
             ++edge) {
          (is_end ? other[k].last : other[k].first) = edge;
          const auto at = static_cast<std::size_t>(edge);
          const double from_s = at > 0 ? run.edge_s[at - 1] : run.edge_s[at];
          const double to_s = at + 1 < run.edge_s.size() ? run.edge_s[at + 1] : run.edge_s[at];
          if (meets_another(other, k)) continue;
          wide_s += 0.5 * (to_s - from_s) * std::exp(std::min(0.0, nats(sums(other)) - value));
        }
        wide_s = std::clamp(wide_s, run.row_s, length_s);
        (is_end ? set[k].end_wide_s : set[k].begin_wide_s) = wide_s;
        price += std::log(length_s / wide_s);
      }
      price -= std::log(static_cast<double>(k + 1));  // in whatever order
    }
    return price;
  }

  [[nodiscard]] FoundWindows found(std::vector<Window> set) const {
    const Sums s = sums(set);
    FoundWindows f{std::move(set), size(s), 0.0, 0.0};
    f.price_nats = price(f.windows);
    f.gain = nats(s) - f.price_nats;
    return f;
  }
  [[nodiscard]] Eigen::Index n_of(std::size_t run) const {
    return static_cast<Eigen::Index>(e_.runs[run].edge_s.size()) - 1;
  }

 private:
  [[nodiscard]] bool meets_another(const std::vector<Window>& set, std::size_t k) const {
    for (std::size_t o = 0; o < set.size(); ++o) {
      if (o != k && set[o].run == set[k].run && set[o].first <= set[k].last && set[k].first <= set[o].last) return true;
    }
    return false;
  }

  const WindowEvidence& e_;
  Eigen::VectorXd slope_;   ///< sums of slopes up to each cell
  Eigen::MatrixXd square_;  ///< and of curvatures
};

/// Windows that repeat, a share of each cell.
class Turns {
 public:
  explicit Turns(const WindowEvidence& e) : e_(e) {}

  [[nodiscard]] Sums sums(double begin_s, double length_s, double every_s) const {
    Eigen::VectorXd share = Eigen::VectorXd::Zero(e_.slope.size());
    for (const WindowEvidence::Run& run : e_.runs) {
      for (double from_s = begin_s; from_s < run.edge_s.back(); from_s += every_s) {
        const double to_s = std::min(from_s + length_s, run.edge_s.back());
        auto k = std::upper_bound(run.edge_s.begin(), run.edge_s.end(), from_s) - run.edge_s.begin() - 1;
        for (k = std::max<std::ptrdiff_t>(0, k); k + 1 < static_cast<std::ptrdiff_t>(run.edge_s.size()); ++k) {
          const double cell_from_s = run.edge_s[static_cast<std::size_t>(k)],
                       cell_to_s = run.edge_s[static_cast<std::size_t>(k + 1)];
          if (cell_from_s >= to_s) break;
          share[run.first + k] += (std::min(to_s, cell_to_s) - std::max(from_s, cell_from_s)) / (cell_to_s - cell_from_s);
        }
      }
    }
    Sums s{share.dot(e_.slope), 0.0};
    for (Eigen::Index j = 0; j < share.size(); ++j) {
      if (share[j] != 0.0) s.curvature += share[j] * share.dot(e_.curvature.col(j));
    }
    return s;
  }

 private:
  const WindowEvidence& e_;
};

}  // namespace

namespace {

/// @param most  windows
std::optional<FoundWindows> grow(const Searcher& searcher, std::vector<Window> set, std::size_t most) {
  double value = set.empty() ? 0.0 : searcher.nats(searcher.sums(set)) - kOfAWindow * static_cast<double>(set.size());
  for (int turn = 0; turn < kMostTurns; ++turn) {
    bool changed = false;
    if (set.size() < most) {
      const Searcher::Addition more = searcher.best_addition(set);
      if (const double with = more.nats - kOfAWindow * static_cast<double>(set.size() + 1); with > value + 1e-6) {
        set.push_back(more.window);
        value = with;
        changed = true;
      }
    }
    for (std::size_t k = 0; k < set.size() && set.size() < most; ++k) {  // one that was two
      const Searcher::Split split = searcher.best_split(set, k);
      const double with = split.nats - kOfAWindow * static_cast<double>(set.size() + 1);
      if (!(with > value + 1e-6)) continue;
      set[k] = split.before;
      set.push_back(split.after);
      value = with;
      changed = true;
    }
    for (std::size_t k = 0; k < set.size(); ++k) {  // each elsewhere, or not at all
      std::vector<Window> others = set;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      const double without =
          others.empty() ? 0.0 : searcher.nats(searcher.sums(others)) - kOfAWindow * static_cast<double>(others.size());
      const Searcher::Addition moved = searcher.best_addition(others, static_cast<std::ptrdiff_t>(set[k].run));
      const double with = moved.nats - kOfAWindow * static_cast<double>(set.size());
      if (std::max(without, with) <= value + 1e-6) continue;
      value = std::max(without, with);
      changed = true;
      if (with > without) {
        set[k] = moved.window;
      } else {
        set = others;
        --k;
      }
    }
    for (const Eigen::Index by :
         {1, 2, 4}) {  // all of them longer or shorter: each alone would not fit the size of the others
      for (const auto& [begin, end] : {std::pair{-by, 0L}, {by, 0L}, {0L, -by}, {0L, by}, {-by, by}, {by, -by}}) {
        const std::vector<Window> moved = searcher.all_moved(set, begin, end);
        if (moved.size() < 2) continue;
        const double with = searcher.nats(searcher.sums(moved)) - kOfAWindow * static_cast<double>(moved.size());
        if (!(with > value + 1e-6)) continue;
        set = moved;
        value = with;
        changed = true;
      }
    }
    if (!changed) break;
  }
  if (set.empty()) return std::nullopt;
  if (set.size() > 1 && std::any_of(set.begin(), set.end(), [&](const Window& w) { return searcher.is_long(w); }))
    return grow(searcher, {}, 1);
  FoundWindows best = searcher.found(set);
  for (std::size_t k = 0;
       best.windows.size() > 1 && k < best.windows.size();) {  // what does not earn the price of its times
    std::vector<Window> others = best.windows;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    if (FoundWindows without = searcher.found(std::move(others)); without.gain >= best.gain) {
      best = std::move(without);
      k = 0;
    } else {
      ++k;
    }
  }
  std::sort(best.windows.begin(), best.windows.end(),
            [](const Window& a, const Window& b) { return a.run != b.run ? a.run < b.run : a.first < b.first; });
  return best;
}

}  // namespace

std::optional<FoundWindows> find_windows(const WindowEvidence& evidence, std::vector<Window> start) {
  return grow(Searcher(evidence), std::move(start), kMostWindows);
}

double course_gain(const WindowEvidence& evidence, const FoundWindows& windows) {
  const double size = windows.size;
  const Eigen::Index n = evidence.slope.size();
  double best = -1e300;
  for (const double share : kCourseTimes) {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
    for (const WindowEvidence::Run& run : evidence.runs) {
      const auto cells = static_cast<Eigen::Index>(run.edge_s.size()) - 1;
      const double time_s = share * (run.edge_s.back() - run.edge_s.front());
      const auto middle_s = [&](Eigen::Index k) {
        return 0.5 * (run.edge_s[static_cast<std::size_t>(k)] + run.edge_s[static_cast<std::size_t>(k) + 1]);
      };
      for (Eigen::Index i = 0; i < cells; ++i) {
        for (Eigen::Index k = 0; k < cells; ++k)
          covariance(run.first + i, run.first + k) = size * size * std::exp(-std::abs(middle_s(i) - middle_s(k)) / time_s);
      }
      covariance.diagonal().segment(run.first, cells).array() += kJitter * size * size;
    }
    const Eigen::MatrixXd root = covariance.llt().matrixL();
    Eigen::MatrixXd square = root.transpose() * evidence.curvature * root;
    square.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> factor(square);
    const Eigen::VectorXd slope = root.transpose() * evidence.slope;
    best = std::max(best, 0.5 * slope.dot(factor.solve(slope)) -
                              factor.matrixLLT().diagonal().array().log().sum());  // log det is twice that
  }
  const double curvature = Searcher(evidence).sums(windows.windows).curvature;
  return best - std::log(static_cast<double>(std::size(kCourseTimes))) -
         0.5 * std::log1p(evidence.prior_sd * evidence.prior_sd * curvature);
}

std::optional<FoundTurns> find_turns(const WindowEvidence& evidence) {
  const Searcher searcher(evidence);
  const Turns turns(evidence);
  double longest_s = 0.0, cell_s = 0.0;
  for (const WindowEvidence::Run& run : evidence.runs) {
    longest_s = std::max(longest_s, run.edge_s.back());
    cell_s = std::max(cell_s, (run.edge_s.back() - run.edge_s.front()) / static_cast<double>(run.edge_s.size() - 1));
  }
  struct Tried {
    std::array<double, 3> at;  // begin and length over every, the logarithm of every
    double nats;
  };
  const auto value = [&](const std::array<double, 3>& at) {
    const double every_s = std::exp(at[2]);
    return searcher.nats(turns.sums(at[0] * every_s, at[1] * every_s, every_s));
  };
  std::vector<Tried> all;
  const double low = std::log(kShortestCells * cell_s), high = std::log(longest_s / kFewestTurns);
  if (!(high > low)) return std::nullopt;
  for (double every = low; every <= high; every += std::log(1.07)) {
    for (const double length : {0.12, 0.25, 0.45}) {
      for (double begin = 0.0; begin < 1.0 - length; begin += 0.5 * length)
        all.push_back({{begin, length, every}, value({begin, length, every})});
    }
  }
  const auto best_of_grid =
      std::max_element(all.begin(), all.end(), [](const Tried& a, const Tried& b) { return a.nats < b.nats; });
  Tried best = *best_of_grid;
  std::array<double, 3> step = {0.05, 0.05, 0.02};
  for (int turn = 0; turn < kMostTurns && step[0] > 1e-3; ++turn) {
    bool changed = false;
    for (std::size_t k = 0; k < 3; ++k) {
      for (const double sign : {-1.0, 1.0}) {
        Tried t = best;
        t.at[k] += sign * step[k];
        if (t.at[0] < 0.0 || t.at[1] < 0.02 || t.at[0] + t.at[1] > 1.0) continue;
        t.nats = value(t.at);
        if (t.nats > best.nats + 1e-3) {
          best = t;
          changed = true;
        }
      }
    }
    if (!changed) {
      for (double& s : step) s *= 0.5;
    }
  }
  if (!(best.nats > 0.0)) return std::nullopt;
  FoundTurns f;
  f.every_s = std::exp(best.at[2]);
  f.begin_s = best.at[0] * f.every_s;
  f.length_s = best.at[1] * f.every_s;
  f.size = searcher.size(turns.sums(f.begin_s, f.length_s, f.every_s));
  double alike = 0.0;  // of those tried, that would do as well
  for (const Tried& t : all) alike += std::exp(std::min(0.0, t.nats - best.nats));
  f.price_nats = std::log(static_cast<double>(all.size()) / std::clamp(alike, 0.1, static_cast<double>(all.size())));
  f.gain = best.nats - f.price_nats;
  return f;
}

}  // namespace driftwright::diagnosis
