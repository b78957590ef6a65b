#include "diagnosis/waveform_shape.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace driftwright::diagnosis {
namespace {

constexpr double kAlike = 4.0;             // neighbouring values of a smoothed waveform that say one thing
constexpr double kMustExplain = 0.6;       // of the squares about the mean
constexpr double kWindowsExplain = 0.8;    // of them: two levels are 0.64 of any noise
constexpr double kConstantExplains = 0.8;  // of all squares
constexpr double kMostOfTheTime = 0.5;     // windows are open
constexpr double kSlow = 0.25;             // of the record: bends of the base are slower than windows are long
constexpr int kMostRefinements = 12;
constexpr std::size_t kMostPieces = 40;

/// What a base leaves of values, and of further columns.
class Base {
 public:
  explicit Base(Eigen::MatrixXd columns) : columns_(std::move(columns)) {
    Eigen::MatrixXd normal = columns_.transpose() * columns_;
    normal.diagonal().array() += 1e-10 * std::max(1e-300, normal.trace());
    factor_.compute(normal);
  }
  [[nodiscard]] Eigen::VectorXd amplitudes(const Eigen::VectorXd& y) const {
    return factor_.solve(columns_.transpose() * y);
  }
  [[nodiscard]] Eigen::VectorXd without(const Eigen::VectorXd& y) const { return y - columns_ * amplitudes(y); }
  [[nodiscard]] const Eigen::MatrixXd& columns() const { return columns_; }

 private:
  Eigen::MatrixXd columns_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

class Classifier {
 public:
  Classifier(const std::vector<double>& edge_s, const Eigen::VectorXd& value, const Eigen::VectorXd& sd,
             const Eigen::VectorXd& carrier)
      : edge_s_(edge_s),
        y_(value),
        n_(value.size()),
        has_carrier_(carrier.size() > 0),
        carrier_(has_carrier_ ? carrier : Eigen::VectorXd::Ones(n_)),
        floor_(std::max(1e-300, sd.squaredNorm())),
        base_(base_columns(0)) {
    about_mean_ = (y_.array() - y_.mean()).matrix().squaredNorm();
  }

  void constant() {
    const double size = carrier_.dot(y_) / carrier_.squaredNorm();
    const Eigen::VectorXd left = y_ - size * carrier_;
    WaveShape w{.shape = Shape::kConstant, .size = size};
    w.explained = 1.0 - left.squaredNorm() / std::max(1e-300, y_.squaredNorm());
    finish(w, left.squaredNorm(), 1.0 + (has_carrier_ ? 1.0 : 0.0), carrier_.squaredNorm());
  }

  void step() {
    const Eigen::VectorXd rest = base_.without(y_);
    const Eigen::Index stride = std::max<Eigen::Index>(1, n_ / 200);
    for (Eigen::Index k = 2; k + 2 < n_; k += stride) {
      Eigen::VectorXd phi = Eigen::VectorXd::Zero(n_);
      phi.tail(n_ - k) = carrier_.tail(n_ - k);
      add(phi, rest, {.shape = Shape::kStep, .time_s = edge_s_[static_cast<std::size_t>(k)]}, 2.0);
    }
  }

  void decay() {
    const Eigen::VectorXd rest = base_.without(y_);
    const Eigen::Index stride = std::max<Eigen::Index>(1, n_ / 60);
    const double length_s = edge_s_.back() - edge_s_.front();
    for (const double share : {0.02, 0.05, 0.1, 0.2}) {
      for (Eigen::Index k = 0; k + 4 < n_; k += stride) {
        const double begin_s = edge_s_[static_cast<std::size_t>(k)], tau_s = share * length_s;
        Eigen::VectorXd phi = Eigen::VectorXd::Zero(n_);
        for (Eigen::Index i = k; i < n_; ++i) phi[i] = carrier_[i] * std::exp(-(middle_s(i) - begin_s) / tau_s);
        add(phi, rest, {.shape = Shape::kDecay, .time_s = begin_s, .time_constant_s = tau_s}, 3.0);
      }
    }
  }

  void proportional(const std::vector<NamedCourse>& courses) {
    const Eigen::VectorXd rest = base_.without(y_);
    for (const NamedCourse& c : courses) {
      const Eigen::VectorXd phi = c.value.cwiseProduct(carrier_);
      WaveShape w{.shape = Shape::kProportional};
      w.follows = c.name;
      add(phi, rest, w, 1.0);
    }
  }

  void periodic() {
    const double length_s = edge_s_.back() - edge_s_.front();
    for (double waves = 3.0; waves <= std::min(20.0, 0.125 * static_cast<double>(n_)); waves *= 1.04) {
      const double period_s = length_s / waves;
      Eigen::MatrixXd columns(n_, base_.columns().cols() + 2);
      columns.leftCols(base_.columns().cols()) = base_.columns();
      for (Eigen::Index i = 0; i < n_; ++i) {
        const double phase = 2.0 * std::numbers::pi * middle_s(i) / period_s;
        columns(i, columns.cols() - 2) = carrier_[i] * std::sin(phase);
        columns(i, columns.cols() - 1) = carrier_[i] * std::cos(phase);
      }
      const Base all(columns);
      const Eigen::VectorXd a = all.amplitudes(y_);
      const double left = (y_ - columns * a).squaredNorm();
      WaveShape w{.shape = Shape::kPeriodic, .size = a.tail<2>().norm(), .period_s = period_s};
      w.explained = 1.0 - left / std::max(1e-300, about_mean_);
      finish(w, left, 3.0 + static_cast<double>(base_.columns().cols()), 0.5 * carrier_.squaredNorm());
    }
  }

  /// Two levels, the second of them within windows: found by the Viterbi path, levels and path in turn.
  void windows() {
    const Base slow(base_columns(n_ >= 40 ? 3 : 0));
    const Eigen::VectorXd relative = slow.without(y_).cwiseQuotient(carrier_.cwiseAbs().cwiseMax(1e-9 * carrier_.norm()));
    std::vector<double> sorted(relative.data(), relative.data() + n_);
    std::sort(sorted.begin(), sorted.end());
    for (const double quantile : {0.995, 0.97, 0.9, 0.8, 0.005, 0.03, 0.1, 0.2}) {
      const double level = sorted[static_cast<std::size_t>(quantile * static_cast<double>(n_ - 1))];
      for (const Base& base : {std::cref(base_), std::cref(slow)}) two_levels(base, level - sorted[sorted.size() / 2]);
    }
  }

  [[nodiscard]] const WaveShape& best() const { return best_; }

 private:
  [[nodiscard]] double middle_s(Eigen::Index i) const {
    return 0.5 * (edge_s_[static_cast<std::size_t>(i)] + edge_s_[static_cast<std::size_t>(i + 1)]);
  }
  [[nodiscard]] Eigen::MatrixXd base_columns(int n_bends) const {
    const Eigen::Index n_first = has_carrier_ ? 2 : 1;
    Eigen::MatrixXd columns = Eigen::MatrixXd::Ones(n_, n_first + n_bends);
    if (has_carrier_) columns.col(1) = carrier_;
    for (int b = 0; b < n_bends; ++b) {
      for (Eigen::Index i = 0; i < n_; ++i)
        columns(i, n_first + b) =
            std::cos(std::numbers::pi * (b + 1.0) * (middle_s(i) - edge_s_.front()) / (edge_s_.back() - edge_s_.front()));
    }
    return columns;
  }

  /// @param square  of what the size multiplies, the base taken off
  void finish(WaveShape w, double left, double n_numbers, double square) {
    const double n_alike = std::max(4.0, static_cast<double>(n_) / kAlike);
    const double mean_left = std::max(left, floor_) / static_cast<double>(n_);
    w.price = n_alike * std::log(mean_left) + n_numbers * std::log(n_alike) + (has_carrier_ ? 1.0 : 0.0);
    w.size_sd = std::sqrt(mean_left * kAlike / std::max(1e-300, square));
    const bool is_enough = w.explained >= (w.shape == Shape::kConstant  ? kConstantExplains
                                           : w.shape == Shape::kWindows ? kWindowsExplain
                                                                        : kMustExplain);
    const bool was_enough = best_.shape != Shape::kNothing && best_.shape != Shape::kOther;
    if (best_.shape == Shape::kNothing || (is_enough && !was_enough) || (is_enough == was_enough && w.price < best_.price)) {
      best_ = std::move(w);
      if (!is_enough) best_.shape = Shape::kOther;
    }
  }

  void add(const Eigen::VectorXd& phi, const Eigen::VectorXd& rest, WaveShape w, double n_numbers) {
    const Eigen::VectorXd own = base_.without(phi);
    const double square = own.squaredNorm();
    if (!(square > 1e-9 * phi.squaredNorm()) || !(square > 0.0)) return;
    w.size = own.dot(rest) / square;
    const double left = rest.squaredNorm() - w.size * w.size * square;
    w.explained = 1.0 - left / std::max(1e-300, about_mean_);
    finish(std::move(w), left, n_numbers + static_cast<double>(base_.columns().cols()), square);
  }

  void two_levels(const Base& base, double size) {
    Eigen::VectorXd level = Eigen::VectorXd::Zero(n_);
    double median_free = 0.0;
    {  // about the median at first: windows pull a mean
      Eigen::VectorXd rest = y_;
      std::vector<double> sorted(rest.data(), rest.data() + n_);
      std::nth_element(sorted.begin(), sorted.begin() + n_ / 2, sorted.end());
      median_free = sorted[static_cast<std::size_t>(n_ / 2)];
      level.setConstant(median_free);
    }
    double variance = (y_ - level).squaredNorm() / static_cast<double>(n_);
    std::vector<char> open, before;
    Eigen::VectorXd own;
    double square = 0.0, left = 0.0;
    for (int turn = 0; turn < kMostRefinements; ++turn) {
      open = path(level, size, variance);
      const auto n_open = std::count(open.begin(), open.end(), 1);
      if (n_open == 0 || static_cast<double>(n_open) > kMostOfTheTime * static_cast<double>(n_)) return;
      Eigen::VectorXd phi = Eigen::VectorXd::Zero(n_);
      for (Eigen::Index i = 0; i < n_; ++i) phi[i] = open[static_cast<std::size_t>(i)] ? carrier_[i] : 0.0;
      own = base.without(phi);
      square = own.squaredNorm();
      if (!(square > 1e-9 * phi.squaredNorm())) return;
      size = own.dot(y_) / square;
      const Eigen::VectorXd beside = y_ - size * phi;
      level = base.columns() * base.amplitudes(beside);
      left = (beside - level).squaredNorm();
      variance = std::max(left, floor_) / static_cast<double>(n_);
      if (open == before) break;
      before = open;
    }
    WaveShape w{.shape = Shape::kWindows, .size = size};
    for (Eigen::Index i = 0; i < n_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!open[k]) continue;
      if (i > 0 && open[k - 1]) {
        w.windows_s.back().second = edge_s_[k + 1];
      } else {
        w.windows_s.emplace_back(edge_s_[k], edge_s_[k + 1]);
      }
    }
    if (w.windows_s.size() > kMostPieces) return;
    double longest_s = 0.0;
    for (const auto& [begin_s, end_s] : w.windows_s) longest_s = std::max(longest_s, end_s - begin_s);
    if (base.columns().cols() > base_.columns().cols() && longest_s > kSlow * (edge_s_.back() - edge_s_.front())) return;
    const double without = base.without(y_).squaredNorm();
    w.explained = 1.0 - left / std::max(1e-300, without);
    set_edges(level, size, w);
    finish(w, left, 1.0 + 2.0 * static_cast<double>(w.windows_s.size()) + static_cast<double>(base.columns().cols()),
           square);
  }

  /// Which values are of the second level, level + size carrier, at a price for each change.
  [[nodiscard]] std::vector<char> path(const Eigen::VectorXd& level, double size, double variance) const {
    const double change = std::log(static_cast<double>(n_)) * variance;
    std::vector<std::array<char, 2>> from(static_cast<std::size_t>(n_));
    double closed = 0.0, opened = change;
    for (Eigen::Index i = 0; i < n_; ++i) {
      const double off = y_[i] - level[i], on = off - size * carrier_[i];
      const bool closes = opened + change < closed, opens = closed + change < opened;
      const double next_closed = (closes ? opened + change : closed) + off * off / kAlike;
      const double next_opened = (opens ? closed + change : opened) + on * on / kAlike;
      from[static_cast<std::size_t>(i)] = {static_cast<char>(closes ? 1 : 0), static_cast<char>(opens ? 0 : 1)};
      closed = next_closed;
      opened = next_opened;
    }
    std::vector<char> open(static_cast<std::size_t>(n_));
    int now = opened < closed ? 1 : 0;
    for (Eigen::Index i = n_ - 1; i >= 0; --i) {
      open[static_cast<std::size_t>(i)] = static_cast<char>(now);
      now = from[static_cast<std::size_t>(i)][static_cast<std::size_t>(now)];
    }
    return open;
  }

  /// Begins and ends between two rows: values at the edges are shares.
  void set_edges(const Eigen::VectorXd& level, double size, WaveShape& w) const {
    const auto share = [&](std::size_t k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double s = (y_[i] - level[i]) / (size * carrier_[i]);
      return std::isfinite(s) ? std::clamp(s, 0.0, 1.0) : 0.0;
    };
    for (std::size_t v = 0; v < w.windows_s.size(); ++v) {
      auto& [begin_s, end_s] = w.windows_s[v];
      const auto first =
          static_cast<std::size_t>(std::lower_bound(edge_s_.begin(), edge_s_.end(), begin_s) - edge_s_.begin());
      const auto last =
          static_cast<std::size_t>(std::lower_bound(edge_s_.begin(), edge_s_.end(), end_s) - edge_s_.begin()) - 1;
      const auto length_s = [&](std::size_t k) { return edge_s_[k + 1] - edge_s_[k]; };
      const double earliest_s = v > 0 ? w.windows_s[v - 1].second : edge_s_.front();
      const double latest_s = v + 1 < w.windows_s.size() ? w.windows_s[v + 1].first : edge_s_.back();
      if (last == first) {  // one value alone: its share of the time, about its middle
        const double before = first > 0 ? share(first - 1) : 0.0, behind = last + 2 < edge_s_.size() ? share(last + 1) : 0.0;
        begin_s -= first > 0 ? before * length_s(first - 1) : 0.0;
        end_s += last + 2 < edge_s_.size() ? behind * length_s(last + 1) : 0.0;
      } else {
        begin_s =
            edge_s_[first + 1] - share(first) * length_s(first) - (first > 0 ? share(first - 1) * length_s(first - 1) : 0.0);
        end_s = edge_s_[last] + share(last) * length_s(last) +
                (last + 2 < edge_s_.size() ? share(last + 1) * length_s(last + 1) : 0.0);
      }
      begin_s = std::max(begin_s, earliest_s);
      end_s = std::min(end_s, latest_s);
    }
  }

  const std::vector<double>& edge_s_;
  const Eigen::VectorXd& y_;
  Eigen::Index n_;
  bool has_carrier_;
  Eigen::VectorXd carrier_;
  double floor_;
  Base base_;
  double about_mean_ = 0.0;
  WaveShape best_;
};

}  // namespace

const char* word(Shape shape) {
  constexpr const char* kWords[] = {"nothing", "constant",     "step",     "windows",
                                    "decay",   "proportional", "periodic", "none of these"};
  return kWords[static_cast<int>(shape)];
}

WaveShape shape_of(const std::vector<double>& edge_s, const Eigen::VectorXd& value, const Eigen::VectorXd& sd,
                   const Eigen::VectorXd& carrier, const std::vector<NamedCourse>& courses) {
  if (value.size() < 8) return {};
  Classifier c(edge_s, value, sd, carrier);
  c.constant();
  c.step();
  c.windows();
  c.decay();
  c.periodic();
  c.proportional(courses);
  return c.best();
}

}  // namespace driftwright::diagnosis
