#include "diagnosis/waveform.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "diagnosis/linear_run.hpp"
#include "diagnosis/scene.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kLeast_nats = 12.0;  // of a heat that is worth a look
constexpr double kMostWork = 3e9;     // of the smoother: longer records are thinned
constexpr Eigen::Index kFewestRows = 200;
constexpr double kFewestNoise_K = 5e-3, kFewestNoise_m = 5e-8, kFewestNoise_rad = 5e-7;
constexpr double kAlike_K = 1.0;                   // of a conductance: no smaller difference of temperatures tells one
constexpr std::size_t kBestBodies = 3;             // of which conductances are tried
constexpr double kNearly = 0.9;                    // of the greatest likelihood gain
constexpr double kNegative = 0.7, kOneBody = 0.3;  // logarithms of what is left unexplained
constexpr double kTypicalShare = 0.1;              // of the heat that nobody knows of: a change from row to row

/// Scatter of a series from row to row: second differences know no slope.
double scatter(const Eigen::VectorXd& series) {
  std::vector<double> bends;
  for (Eigen::Index i = 1; i + 1 < series.size(); ++i) {
    const double bend = series[i - 1] - 2.0 * series[i] + series[i + 1];
    if (!std::isnan(bend)) bends.push_back(std::abs(bend));
  }
  if (bends.empty()) return 0.0;
  std::nth_element(bends.begin(), bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2), bends.end());
  return bends[bends.size() / 2] / 0.6745 / std::sqrt(6.0);
}

double noise_of(const MeasuredChannel& channel, const Eigen::VectorXd& residual) {
  const double fewest = channel.unit == "K" ? kFewestNoise_K : channel.unit == "m" ? kFewestNoise_m : kFewestNoise_rad;
  return std::max({fewest, channel.quantum / std::sqrt(12.0), scatter(residual)});
}

/// The rows that are looked at: all of them, or as many as the work allows, but never so few that nothing could be seen in them.
std::vector<Eigen::Index> rows_of(const MeasuredRun& run, Eigen::Index size, std::size_t n_bodies) {
  const auto n = static_cast<Eigen::Index>(run.time_s.size());
  const double work = 10.0 * static_cast<double>(n_bodies) * static_cast<double>(n) * static_cast<double>(size * size) *
                      (4.0 * static_cast<double>(run.channels.size()) + 10.0);
  const auto stride =
      std::min(static_cast<Eigen::Index>(std::ceil(work / kMostWork)), std::max<Eigen::Index>(1, n / kFewestRows));
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < n; i += std::max<Eigen::Index>(1, stride)) rows.push_back(i);
  return rows;
}

Eigen::VectorXd at_rows(const Eigen::VectorXd& series, const std::vector<Eigen::Index>& rows, Eigen::Index n) {
  Eigen::VectorXd picked(n);
  for (Eigen::Index i = 0; i < n; ++i) picked[i] = series[rows[static_cast<std::size_t>(i)]];
  return picked;
}

/// Share of the readings' squared misses that a heat takes away.
double explained(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& readings) {
  double before = 0.0, behind = 0.0;
  for (Eigen::Index c = 0; c < residual.cols(); ++c) {
    for (Eigen::Index i = 0; i < residual.rows(); ++i) {
      if (std::isnan(residual(i, c))) continue;
      before += std::pow(residual(i, c), 2);
      behind += std::pow(residual(i, c) - readings(i, c), 2);
    }
  }
  return before > 0.0 ? 1.0 - behind / before : 0.0;
}

/// A run, and what is asked of it.
struct Asked {
  const MeasuredRun& run;
  const LinearRun& linear;
  const Eigen::MatrixXd& residual;  ///< measured minus predicted over noise, rows x channels
  const std::vector<effects::Body>& bodies;
  double typical_W;
  std::vector<NamedCourse> courses;  ///< that a heat or a conductance may follow, per interval
};

void take(const SmoothedHeat& s, const Asked& a, Waveform& w) {
  const Eigen::Index n = s.heat_W.size();
  w.explained = explained(a.residual, s.readings);
  w.log_likelihood_gain = s.log_likelihood_gain;
  if (w.log_likelihood_gain > kLeast_nats) w.shape = shape_of(w.time_s, s.heat_W, s.sd_W, {}, a.courses);
  w.value.clear();
  w.sd.clear();
  for (Eigen::Index i = 0; i <= n; ++i) {
    w.value.push_back(s.heat_W[std::min(i, n - 1)]);
    w.sd.push_back(s.sd_W[std::min(i, n - 1)]);
  }
}

struct HeatCourse {
  Waveform wave;
  std::size_t body = 0;
  Eigen::MatrixXd warm_K = {};  ///< means of the bodies with it, rows x bodies
};

HeatCourse heat_of(const Asked& a, std::size_t b) {
  const Eigen::Index n = a.residual.rows() - 1;
  HeatCourse h{
      .wave = {.of = Waveform::Of::kHeat, .run = a.run.name, .where = a.bodies[b].name, .time_s = a.linear.course.time_s},
      .body = b};
  const SmoothedHeat s =
      smooth_heat(a.linear.course, a.residual, static_cast<Eigen::Index>(b), Eigen::VectorXd::Ones(n), a.typical_W);
  take(s, a, h.wave);
  h.warm_K = a.linear.temperature_K + s.mean_K;
  return h;
}

/// The same as a conductance to another body or the ambient; nothing where there is no difference of temperatures.
std::optional<Waveform> conductance_of(const Asked& a, const HeatCourse& heat, std::size_t other) {
  const bool is_ambient = other == a.bodies.size();
  const auto b = static_cast<Eigen::Index>(heat.body);
  const Eigen::Index n = heat.warm_K.rows() - 1;
  Eigen::VectorXd difference_K(n);  // mean from row to row
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = [&](Eigen::Index row) {
      return (is_ambient ? a.linear.ambient_K[row] : heat.warm_K(row, static_cast<Eigen::Index>(other))) -
             heat.warm_K(row, b);
    };
    difference_K[i] = mean_difference(at(i), at(i + 1));
  }
  const double rms_K = std::sqrt(difference_K.squaredNorm() / static_cast<double>(n));
  if (!(rms_K > kAlike_K)) return std::nullopt;
  Waveform w{.of = Waveform::Of::kHeat, .run = a.run.name, .where = heat.wave.where, .time_s = heat.wave.time_s};
  w.to = is_ambient ? effects::kAmbientName : a.bodies[other].name;
  take(smooth_heat(a.linear.course, a.residual, b, difference_K, a.typical_W / rms_K), a, w);
  w.conductance_W_K = w.value;
  for (Eigen::Index i = 0; i <= n; ++i) w.value[static_cast<std::size_t>(i)] *= difference_K[std::min(i, n - 1)];
  for (Eigen::Index i = 0; i <= n; ++i) w.sd[static_cast<std::size_t>(i)] *= std::abs(difference_K[std::min(i, n - 1)]);
  return w;
}

/// How good a description is: how much of the waveform a simple course explains. Nothing takes heat out of a body, or away from a path, as easily as an
/// exchange does; a heat wants one body less.
double worth(const Waveform& w) {
  const bool is_simple = w.shape.shape != Shape::kOther && w.shape.shape != Shape::kNothing;
  return (is_simple ? -std::log(1.01 - w.shape.explained) : 0.0) - (w.shape.size < 0.0 ? kNegative : 0.0) +
         (w.to.empty() ? kOneBody : 0.0);
}

/// The best description of those that explain the readings nearly as well as any; likelihoods know the laws to first order alone.
Waveform best_of(std::vector<Waveform> descriptions) {
  double most = descriptions.front().log_likelihood_gain;
  for (const Waveform& w : descriptions) most = std::max(most, w.log_likelihood_gain);
  std::erase_if(descriptions,
                [&](const Waveform& w) { return w.log_likelihood_gain < most - (1.0 - kNearly) * std::abs(most); });
  return *std::max_element(descriptions.begin(), descriptions.end(),
                           [](const Waveform& a, const Waveform& b) { return worth(a) < worth(b); });
}

/// What a displacement has beside its prediction, against bodies, readings and drive.
Waveform growth_of(const MeasuredRun& run, const MeasuredChannel& channel, const Eigen::VectorXd& predicted,
                   const std::vector<NamedCourse>& courses) {
  Waveform w{.of = Waveform::Of::kGrowth, .run = run.name, .unit = channel.unit, .where = channel.name};
  const Eigen::VectorXd missed = channel.value - predicted;
  const double noise = noise_of(channel, missed);
  std::vector<Eigen::Index> there;
  for (Eigen::Index i = 0; i < missed.size(); ++i) {
    if (std::isnan(missed[i])) continue;
    there.push_back(i);
    w.time_s.push_back(run.time_s[static_cast<std::size_t>(i)]);
    w.value.push_back(missed[i]);
    w.sd.push_back(noise);
  }
  const auto n = static_cast<Eigen::Index>(there.size());
  if (n < 8) return w;
  const Eigen::VectorXd value = at_rows(missed, there, n);
  if (!(std::sqrt(value.squaredNorm() / static_cast<double>(n)) > 1.5 * noise)) return w;
  std::vector<NamedCourse> known;
  for (const NamedCourse& c : courses) {
    if (c.name != channel.name) known.push_back({c.name, c.unit, at_rows(c.value, there, n)});
  }
  std::vector<double> edge_s = w.time_s;
  edge_s.push_back(2.0 * edge_s.back() - edge_s[edge_s.size() - 2]);
  w.shape = shape_of(edge_s, value, Eigen::VectorXd::Constant(n, noise), {}, known);
  w.explained = w.shape.explained;
  return w;
}

}  // namespace

std::vector<NamedCourse> recorded_courses(const MeasuredRun& run) {
  const auto n = static_cast<Eigen::Index>(run.time_s.size());
  std::vector<NamedCourse> list;
  const auto add = [&](const std::string& name, const std::string& unit, const auto& value) {
    NamedCourse c{name, unit, Eigen::VectorXd(n)};
    for (Eigen::Index i = 0; i < n; ++i) {
      const double t_s = run.time_s[static_cast<std::size_t>(i)];
      const double next_s = i + 1 < n ? run.time_s[static_cast<std::size_t>(i + 1)] : t_s;
      c.value[i] = value(t_s, run.cyclogram.drive(0.5 * (t_s + next_s)));
    }
    if ((c.value.array() - c.value.mean()).matrix().norm() > 1e-9 * c.value.norm()) list.push_back(std::move(c));
  };
  add("speed", "rpm", [](double, const Drive& d) { return d.speed_rpm; });
  add("the square of speed", "rpm^2", [](double, const Drive& d) { return d.speed_rpm * d.speed_rpm; });
  add("the spindle turning", "1", [](double, const Drive& d) { return d.speed_rpm > 0.0 ? 1.0 : 0.0; });
  for (std::size_t a = 0; a < 3; ++a)
    add(std::string("feed ") + "xyz"[a], "m/s", [a](double, const Drive& d) { return d.feed_m_s[a]; });
  add("cutting power", "W", [](double, const Drive& d) { return d.cutting_power_W; });
  add("ambient temperature", "K", [&](double t_s, const Drive&) { return run.ambient.at(t_s); });
  for (const MeasuredChannel& c : run.channels) {
    double last = 0.0;  // holes are filled by the reading before
    Eigen::Index i = 0;
    add(c.name, c.unit, [&](double, const Drive&) {
      const double v = c.value[i++];
      if (!std::isnan(v)) last = v;
      return last;
    });
  }
  return list;
}

std::vector<Waveform> waveforms(const Twin& twin, const std::vector<MeasuredRun>& runs, const TwinState& state,
                                const Prediction& prediction, const Listener& listener) {
  const effects::DoubtScene scene = scene_of(twin, runs);
  const std::vector<effects::Body> bodies = bodies_of(scene);
  const double typical_W = kTypicalShare * scene.unknown_heat_W();
  std::vector<Waveform> heats, growths;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const MeasuredRun& run = runs[r];
    if (run.time_s.size() < 10 || run.channels.empty()) continue;
    Twin::Workspace workspace(twin);
    const std::vector<Eigen::Index> rows = rows_of(run, twin.machine().system.size(), bodies.size());
    Eigen::VectorXd noise(static_cast<Eigen::Index>(run.channels.size()));
    Eigen::MatrixXd residual(static_cast<Eigen::Index>(rows.size()), noise.size());
    for (Eigen::Index c = 0; c < noise.size(); ++c) {
      const MeasuredChannel& channel = run.channels[static_cast<std::size_t>(c)];
      const Eigen::VectorXd missed = channel.value - prediction[r].row(channel.output).transpose();
      noise[c] = noise_of(channel, missed);
      residual.col(c) = at_rows(missed, rows, residual.rows()) / noise[c];
    }
    const LinearRun l = linear_run(twin, run, state, bodies, rows, noise, workspace);
    std::vector<NamedCourse> courses = recorded_courses(run);
    Asked asked{run, l, residual, bodies, typical_W, {}};
    for (const NamedCourse& c : courses) {
      if (run.find(c.name)) continue;  // heat does not follow a reading: that would be an exchange
      asked.courses.push_back({c.name, c.unit, at_rows(c.value, rows, residual.rows() - 1)});
    }
    std::vector<HeatCourse> of_body(bodies.size());
    for_each_index(
        bodies.size(), [] { return 0; }, [&](std::size_t b, int) { of_body[b] = heat_of(asked, b); }, listener);
    if (listener.wants_end()) return {};
    std::stable_sort(of_body.begin(), of_body.end(), [](const HeatCourse& a, const HeatCourse& b) {
      return a.wave.log_likelihood_gain > b.wave.log_likelihood_gain;
    });
    const std::size_t n_best = std::min<std::size_t>(kBestBodies, of_body.size());
    std::vector<std::optional<Waveform>> exchanges(n_best * (bodies.size() + 1));
    for_each_index(
        exchanges.size(), [] { return 0; },
        [&](std::size_t i, int) {
          const HeatCourse& heat = of_body[i % n_best];
          const std::size_t other = i / n_best;
          if (other != heat.body && heat.wave.log_likelihood_gain > kLeast_nats)
            exchanges[i] = conductance_of(asked, heat, other);
        },
        listener);
    if (listener.wants_end()) return {};
    for (std::size_t i = 0; i < of_body.size(); ++i) {
      std::vector<Waveform> descriptions = {std::move(of_body[i].wave)};
      for (std::size_t other = bodies.size() + 1; i < n_best && other-- > 0;) {  // the ambient first
        if (std::optional<Waveform>& exchange = exchanges[other * n_best + i]) descriptions.push_back(*std::move(exchange));
      }
      heats.push_back(best_of(std::move(descriptions)));
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const std::string name = "mean of " + bodies[b].name;
      for (std::size_t o = 0; o < twin.outputs().name.size(); ++o) {
        if (twin.outputs().name[o] == name)
          courses.push_back({name, "K", prediction[r].row(static_cast<Eigen::Index>(o)).transpose()});
      }
    }
    for (const MeasuredChannel& c : run.channels) {
      if (c.unit != "K") growths.push_back(growth_of(run, c, prediction[r].row(c.output).transpose(), courses));
    }
  }
  std::stable_sort(heats.begin(), heats.end(),
                   [](const Waveform& a, const Waveform& b) { return a.log_likelihood_gain > b.log_likelihood_gain; });
  std::move(growths.begin(), growths.end(), std::back_inserter(heats));
  return heats;
}

}  // namespace driftwright::diagnosis
