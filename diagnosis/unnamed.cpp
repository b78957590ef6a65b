#include "diagnosis/unnamed.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "diagnosis/no_solution.hpp"
#include "diagnosis/projection.hpp"
#include "diagnosis/scene.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kPiece_s = 2400.0;
constexpr int kMostPieces = 12;  // a run
constexpr double kAmbient_K = 2.0, kReading_K = 1.0, kDisplacement_m = 15e-6;
constexpr std::array<double, 3> kSizes = {0.1, 0.3, 1.0};           // of what a quantity may be
constexpr std::array<double, 2> kCorrelated_s = {3600.0, 10800.0};  // of a course over time
constexpr double kLaws = 5.0 * kSizes.size();

struct UnnamedPlace {
  Unnamed::Quantity quantity;
  std::string where;
  effects::Body body = {};
  int output = -1;
  double sd = 1.0;  ///< of the quantity
};

/// What 1 sd of a course does to the whitened readings, and the course over the first run.
struct Column {
  Eigen::VectorXd signature, course;
};

struct Piece {
  std::size_t run;
  double from_s, until_s;
};

std::vector<Piece> pieces_of(const std::vector<MeasuredRun>& runs) {
  std::vector<Piece> pieces;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const double end_s = runs[r].time_s.back();
    const int n = std::clamp(static_cast<int>(std::ceil(end_s / kPiece_s)), 1, kMostPieces);
    for (int i = 0; i < n; ++i) pieces.push_back({r, end_s * i / n, i + 1 == n ? effects::kNever_s : end_s * (i + 1) / n});
  }
  return pieces;
}

std::vector<UnnamedPlace> places_of(const effects::DoubtScene& s, const Twin& twin) {
  std::vector<UnnamedPlace> places;
  for (const effects::Body& body : s.bodies)
    places.push_back({Unnamed::Quantity::kHeat, body.name, body, -1, s.unknown_heat_W()});
  places.push_back({Unnamed::Quantity::kAmbient, "ambient", {}, -1, kAmbient_K});
  const auto& names = twin.outputs().name;
  const auto output = [&](const std::string& name) {
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  for (const std::string& name : s.sensors)
    places.push_back({Unnamed::Quantity::kReading, name, {}, output(name), kReading_K});
  for (const auto& d : s.displacements)
    places.push_back({Unnamed::Quantity::kReading, d.name, {}, output(d.name), kDisplacement_m});
  return places;
}

/// All columns of one place: constant, n/N, (n/N)², turns, then one a piece.
class Columns {
 public:
  Columns(const Fitter& fitter, const TwinState& best, const std::vector<Piece>& pieces)
      : fitter_(fitter), top_rpm_(top_speed_rpm(fitter.runs())), best_(best), pieces_(pieces) {
    Twin::Workspace workspace(fitter.twin());
    base_ = read(best, workspace);
  }

  [[nodiscard]] std::vector<Column> at(const UnnamedPlace& place, Twin::Workspace& workspace) const {
    return place.quantity == Unnamed::Quantity::kReading ? of_reading(place) : of_machine(place, workspace);
  }

 private:
  [[nodiscard]] Prediction read(const TwinState& state, Twin::Workspace& workspace) const {
    Prediction p;
    for (const MeasuredRun& run : fitter_.runs())
      p.push_back(fitter_.twin().read(state, run, fitter_.twin().respond(state, run, workspace)));
    return p;
  }
  /// Whitened, of one run alone or, without one, of all.
  [[nodiscard]] Eigen::VectorXd difference(const TwinState& state, std::optional<std::size_t> only,
                                           Twin::Workspace& workspace) const {
    Prediction p;
    for (std::size_t r = 0; r < base_.size(); ++r) {
      const MeasuredRun& run = fitter_.runs()[r];
      p.push_back(only && r != *only
                      ? Eigen::MatrixXd::Zero(base_[r].rows(), base_[r].cols()).eval()
                      : fitter_.twin().read(state, run, fitter_.twin().respond(state, run, workspace)) - base_[r]);
    }
    return fitter_.comparison().whitened(p);
  }
  [[nodiscard]] Eigen::VectorXd course(const std::function<double(double t_s)>& value) const {
    const std::vector<double>& time_s = fitter_.runs()[0].time_s;
    Eigen::VectorXd c(static_cast<Eigen::Index>(time_s.size()));
    for (std::size_t i = 0; i < time_s.size(); ++i) c[static_cast<Eigen::Index>(i)] = value(time_s[i]);
    return c;
  }
  [[nodiscard]] Eigen::VectorXd speed_course(double exponent) const {
    const Cyclogram& cyclogram = fitter_.runs()[0].cyclogram;
    return course([&](double t_s) { return std::pow(cyclogram.speed_rpm(t_s) / top_rpm_, exponent); });
  }

  /// Heat and ambient go through the machine: a fifth of their size at a time, laws stay where they are.
  [[nodiscard]] std::vector<Column> of_machine(const UnnamedPlace& place, Twin::Workspace& workspace) const {
    constexpr double kTrial = 0.2;
    const bool is_heat = place.quantity == Unnamed::Quantity::kHeat;
    const auto step = [&](double from_s, std::optional<std::size_t> run) {
      TwinState s = best_;
      const std::string in = run ? fitter_.runs()[*run].name : "";
      if (is_heat) {
        s.push_back(effects::make_effect("heat_source", place.body, {{"power", kTrial * place.sd}}));
        s.back().from_s = from_s;
      } else {
        s.push_back(effects::make_effect("ambient", effects::Place::kAmbient, effects::kAmbientName,
                                         {{"offset", kTrial * place.sd}, {"from", from_s / 60.0}}));
      }
      s.back().in = in;
      return Eigen::VectorXd(difference(s, run, workspace) / kTrial);
    };
    std::vector<Column> columns;
    columns.push_back({step(0.0, std::nullopt), course([](double) { return 1.0; })});
    for (const double exponent : {1.0, 2.0}) {
      Eigen::VectorXd signature = Eigen::VectorXd::Zero(fitter_.comparison().n());  // an ambient does not know the spindle
      if (is_heat) {
        TwinState s = best_;
        s.push_back(effects::make_effect("heat_source", place.body,
                                         {{"power", kTrial * place.sd}, {"at_speed", top_rpm_}, {"exponent", exponent}}));
        signature = difference(s, std::nullopt, workspace) / kTrial;
      }
      columns.push_back({std::move(signature), speed_course(exponent)});
    }
    columns.push_back({Eigen::VectorXd::Zero(fitter_.comparison().n()), course([](double) { return 0.0; })});
    std::vector<Eigen::VectorXd> steps;
    for (const Piece& piece : pieces_) steps.push_back(step(piece.from_s, piece.run));
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const bool is_last = k + 1 == pieces_.size() || pieces_[k + 1].run != pieces_[k].run;
      columns.push_back({is_last ? steps[k] : Eigen::VectorXd(steps[k] - steps[k + 1]), piece_course(pieces_[k])});
    }
    return columns;
  }
  [[nodiscard]] Eigen::VectorXd piece_course(const Piece& piece) const {
    return course([&](double t_s) { return piece.run == 0 && t_s >= piece.from_s && t_s < piece.until_s ? 1.0 : 0.0; });
  }

  /// An error of a reading is added to it.
  [[nodiscard]] std::vector<Column> of_reading(const UnnamedPlace& place) const {
    const auto& runs = fitter_.runs();
    const auto column = [&](const std::function<double(std::size_t run, double t_s)>& value) {
      Prediction p;
      for (std::size_t r = 0; r < runs.size(); ++r) {
        p.push_back(Eigen::MatrixXd::Zero(base_[r].rows(), base_[r].cols()));
        for (std::size_t i = 0; i < runs[r].time_s.size(); ++i)
          p[r](place.output, static_cast<Eigen::Index>(i)) = place.sd * value(r, runs[r].time_s[i]);
      }
      return Column{fitter_.comparison().whitened(p), course([&](double t_s) { return value(0, t_s); })};
    };
    std::vector<Column> columns;
    columns.push_back(column([](std::size_t, double) { return 1.0; }));
    for (const double exponent : {1.0, 2.0}) {
      columns.push_back(column(
          [&](std::size_t r, double t_s) { return std::pow(runs[r].cyclogram.speed_rpm(t_s) / top_rpm_, exponent); }));
    }
    double longest_s = 1.0;
    for (const MeasuredRun& run : runs) longest_s = std::max(longest_s, run.time_s.back());
    columns.push_back(column([&](std::size_t r, double t_s) {
      double turned = 0.0, start_s = 0.0;
      for (const auto& section : runs[r].cyclogram.sections) {
        turned += section.drive.speed_rpm * std::clamp(t_s - start_s, 0.0, section.duration_s);
        start_s += section.duration_s;
      }
      return turned / (top_rpm_ * longest_s);
    }));
    for (std::size_t k = 0; k < pieces_.size(); ++k) {  // a smooth course: hats on the middles of the pieces
      const auto middle_s = [&](std::size_t i) {
        const double until_s =
            pieces_[i].until_s < effects::kNever_s ? pieces_[i].until_s : runs[pieces_[i].run].time_s.back();
        return 0.5 * (pieces_[i].from_s + until_s);
      };
      const bool has_left = k > 0 && pieces_[k - 1].run == pieces_[k].run;
      const bool has_right = k + 1 < pieces_.size() && pieces_[k + 1].run == pieces_[k].run;
      const double at_s = middle_s(k), left_s = has_left ? middle_s(k - 1) : -1e300,
                   right_s = has_right ? middle_s(k + 1) : 1e300;
      columns.push_back(column([&](std::size_t r, double t_s) {
        if (r != pieces_[k].run) return 0.0;
        return t_s < at_s ? std::clamp((t_s - left_s) / (at_s - left_s), 0.0, 1.0)
                          : std::clamp((right_s - t_s) / (right_s - at_s), 0.0, 1.0);
      }));
    }
    return columns;
  }

  const Fitter& fitter_;
  double top_rpm_;
  const TwinState& best_;
  const std::vector<Piece>& pieces_;
  Prediction base_;
};

/// A course: which columns, and the square root of their prior covariance.
struct Course {
  const char* follows;
  Eigen::Index first;
  Eigen::MatrixXd root;
};

std::vector<Course> courses_of(const std::vector<Piece>& pieces) {
  std::vector<Course> courses = {{"nothing", 0, Eigen::MatrixXd::Identity(1, 1)},
                                 {"speed", 1, Eigen::MatrixXd::Identity(2, 2)},
                                 {"the turns made", 3, Eigen::MatrixXd::Identity(1, 1)}};
  const auto n = static_cast<Eigen::Index>(pieces.size());
  for (const double l_s : kCorrelated_s) {
    Eigen::MatrixXd k = Eigen::MatrixXd::Constant(n, n, 0.5);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        const Piece &a = pieces[static_cast<std::size_t>(i)], &b = pieces[static_cast<std::size_t>(j)];
        if (a.run == b.run) k(i, j) += std::exp(-0.5 * std::pow((a.from_s - b.from_s) / l_s, 2));
      }
      k(i, i) += 1e-6;
    }
    courses.push_back({"time", 4, k.llt().matrixL()});
  }
  return courses;
}

/// Some claims taken out, linearised about the best fit.
struct Subset {
  std::vector<std::size_t> claims;
  std::optional<Projection> left;
  double saved = 0.0;  ///< evidence lost with the claims, less what they had paid [nats]: what one unnamed cause must bring
};

std::vector<Subset> subsets_of(const Fitter& fitter, const std::vector<Candidate>& candidates, const Hypothesis& hypothesis,
                               const Fit& fit) {
  const Eigen::Index n_n = fitter.n_nuisance();
  const double price = std::log(std::max(1.0, static_cast<double>(candidates.size())));
  const Eigen::VectorXd sd = fitter.prior_width(hypothesis, fit.x);
  Twin::Workspace workspace(fitter.twin());
  std::vector<Subset> list;
  double log_evidence_of_all = 0.0;
  for (std::size_t mask = 0; mask < (std::size_t{1} << hypothesis.size()); ++mask) {  // 0: none is taken out
    Subset subset;
    double paid = 0.0;
    for (std::size_t c = 0; c < hypothesis.size(); ++c) {
      if (((mask >> c) & 1u) == 0) continue;
      subset.claims.push_back(c);
      paid +=
          price + law_price(candidates[hypothesis[c].candidate]) + price_of_times(hypothesis[c]) + hypothesis[c].price_nats;
    }
    const Remainder rest = without_claims(hypothesis, subset.claims, n_n);
    Eigen::MatrixXd slopes(fit.residual.size(), static_cast<Eigen::Index>(rest.x.size()));
    slopes.leftCols(n_n) = fitter.nuisance_slopes();
    for (Eigen::Index k = n_n; k < slopes.cols(); ++k)
      slopes.col(k) = fit.slopes.col(rest.x[static_cast<std::size_t>(k)] - n_n);
    const Eigen::VectorXd x = fit.x(rest.x);
    Eigen::VectorXd y = fit.residual + slopes * x;
    if (mask != 0) {
      y += fitter.comparison().whitened(fit.prediction) -
           fitter.comparison().whitened(fitter.predict(rest.hypothesis, x, workspace));
    }
    subset.left.emplace(std::move(slopes), sd(rest.x), y);
    if (mask == 0) {
      log_evidence_of_all = subset.left->log_evidence;
      continue;
    }
    subset.saved = log_evidence_of_all - paid - subset.left->log_evidence;
    list.push_back(std::move(subset));
  }
  return list;
}

}  // namespace

std::optional<Unnamed> best_unnamed(const Fitter& fitter, const std::vector<Candidate>& candidates,
                                    const Hypothesis& hypothesis, const Fit& fit, const Listener& listener) {
  if (hypothesis.empty()) return std::nullopt;
  const std::vector<UnnamedPlace> places = places_of(scene_of(fitter.twin(), fitter.runs()), fitter.twin());
  const std::vector<Piece> pieces = pieces_of(fitter.runs());
  const std::vector<Course> courses = courses_of(pieces);
  const std::vector<Subset> subsets = subsets_of(fitter, candidates, hypothesis, fit);
  const TwinState state = fitter.state(hypothesis, fit.x);
  const Columns columns(fitter, state, pieces);
  const double price = std::log(std::max(1.0, static_cast<double>(candidates.size()))) + std::log(kLaws);

  std::vector<Unnamed> best(places.size());
  for_each_index(
      places.size(), [&] { return Twin::Workspace(fitter.twin()); },
      [&](std::size_t p, Twin::Workspace& workspace) {
        best[p].log_evidence_gain = -1e300;
        std::vector<Column> at;
        if (!has_solution([&] { at = columns.at(places[p], workspace); })) return;  // none with that heat
        Eigen::MatrixXd s(fitter.comparison().n(), static_cast<Eigen::Index>(at.size()));
        for (std::size_t c = 0; c < at.size(); ++c) s.col(static_cast<Eigen::Index>(c)) = at[c].signature;
        for (const Subset& subset : subsets) {
          const Eigen::MatrixXd a = s.transpose() * subset.left->without(s);
          const Eigen::VectorXd b = s.transpose() * subset.left->rest;
          for (const Course& course : courses) {
            const Eigen::Index n = course.root.cols();
            const Eigen::MatrixXd ra = course.root.transpose() * a.block(course.first, course.first, n, n) * course.root;
            const Eigen::VectorXd rb = course.root.transpose() * b.segment(course.first, n);
            for (const double size : kSizes) {
              Eigen::MatrixXd m = size * size * ra;
              m.diagonal().array() += 1.0;
              const Eigen::LLT<Eigen::MatrixXd> factor(m);
              const Eigen::VectorXd z = factor.solve(size * rb);
              const double gain = 0.5 * size * rb.dot(z) - factor.matrixLLT().diagonal().array().log().sum();
              const double value = gain - price - subset.saved;
              if (!(value > best[p].log_evidence_gain)) continue;
              const Eigen::VectorXd amplitude = size * places[p].sd * (course.root * z);
              Eigen::VectorXd series = Eigen::VectorXd::Zero(at[0].course.size());
              for (Eigen::Index i = 0; i < n; ++i)
                series += amplitude[i] * at[static_cast<std::size_t>(course.first + i)].course;
              best[p] = {places[p].quantity,
                         places[p].where,
                         course.follows,
                         subset.claims,
                         value,
                         fitter.runs()[0].time_s,
                         {series.begin(), series.end()}};
            }
          }
        }
      },
      listener);
  if (listener.wants_end()) return std::nullopt;
  const auto found = std::max_element(best.begin(), best.end(), [](const Unnamed& a, const Unnamed& b) {
    return a.log_evidence_gain < b.log_evidence_gain;
  });
  return *found;
}

}  // namespace driftwright::diagnosis
