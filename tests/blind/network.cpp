#include "blind/network.hpp"

#include <Eigen/Cholesky>
#include <Eigen/CholmodSupport>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace driftwright::blind {
namespace {

const double kGamma = 1.0 - std::numbers::sqrt2 / 2.0;
constexpr double kFine_s = 120.0;
constexpr int kParts = 4;  // of a step while fine

class SparseFactor {
 public:
  explicit SparseFactor(const solver::SparseRow& k) {
    llt_.cholmod().print = 0;
    llt_.compute(Columns(Eigen::SparseMatrix<double, Eigen::ColMajor, int>(k.transpose())));
    if (llt_.info() != Eigen::Success) throw std::logic_error("integrate: no Cholesky factor");
  }
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return llt_.solve(b); }

 private:
  using Columns = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;
  Eigen::CholmodSupernodalLLT<Columns, Eigen::Lower> llt_;
};

class DenseFactor {
 public:
  explicit DenseFactor(const Eigen::MatrixXd& k) : inverse_(k.llt().solve(Eigen::MatrixXd::Identity(k.rows(), k.rows()))) {}
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const { return inverse_ * b; }

 private:
  Eigen::MatrixXd inverse_;
};

template <class Matrix>
struct FactorOf {
  using type = DenseFactor;
};
template <>
struct FactorOf<solver::SparseRow> {
  using type = SparseFactor;
};

template <class Matrix>
class Stepper {
  using Factor = typename FactorOf<Matrix>::type;

 public:
  Stepper(const Network<Matrix>& network, const Laws& laws, const Run& run) : net_(network), laws_(laws), run_(run) {
    if (laws.powers_W.size() != net_.sources.size() || laws.coefficients.size() != net_.exchanges.size()) {
      throw std::logic_error("integrate: laws of another network");
    }
    for (const effects::Law& c : laws.coefficients) {
      if (!c.probes.empty()) throw std::logic_error("integrate: a coefficient that looks at temperatures");
    }
    for (const effects::Law& p : laws.powers_W) looks_ = looks_ || !p.probes.empty();
  }

  Eigen::MatrixXd outputs() {
    const auto n_steps = static_cast<Eigen::Index>(std::llround(run_.duration_s / run_.step_s));
    Eigen::MatrixXd out(net_.outputs.cols(), n_steps + 1);
    Eigen::VectorXd theta = Eigen::VectorXd::Zero(net_.size());
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(net_.size());  // of the last stage, as a first guess of the next
    double fine_until_s = 0.0;
    for (Eigen::Index step = 0; step <= n_steps; ++step) {
      const double t_s = static_cast<double>(step) * run_.step_s;
      out.col(step) = net_.outputs.transpose() * theta + run_.ambient_K(t_s) * net_.outputs_ambient;
      if (step == n_steps) break;
      if (look_around(t_s + 0.5 * run_.step_s)) fine_until_s = t_s + kFine_s;
      const bool is_fine = t_s < fine_until_s;
      const int n_parts = is_fine ? kParts : 1;
      h_s_ = run_.step_s / n_parts;
      factor_ = is_fine ? &fine_factor_ : &coarse_factor_;
      if (!*factor_) {
        const Matrix shifted = net_.mass + kGamma * h_s_ * k_;
        *factor_ = std::make_unique<Factor>(shifted);
      }
      for (int part = 0; part < n_parts; ++part) {
        const double start_s = t_s + part * h_s_;
        const Eigen::VectorXd first = stage(theta, start_s + kGamma * h_s_, slope);
        const Eigen::VectorXd second = stage(theta + (1.0 - kGamma) * h_s_ * first, start_s + h_s_, first);
        theta += h_s_ * ((1.0 - kGamma) * first + kGamma * second);
        slope = second;
      }
    }
    return out;
  }

 private:
  [[nodiscard]] effects::Inputs inputs(double t_s) const {
    return {.drive = drive_, .ambient_K = run_.ambient_K(t_s), .time_s = t_s, .probe_K = {}};
  }

  /// Drive and coefficients at a time. @return true where they are others than before
  bool look_around(double t_s) {
    const Drive before = drive_;
    drive_ = run_.drive.drive(t_s);
    std::vector<double> c;
    const effects::Inputs u = inputs(t_s);
    for (const effects::Law& law : laws_.coefficients) c.push_back(law(u));
    const bool is_first = k_.rows() == 0, is_other = is_first || c != c_;
    if (!is_other) return !(drive_ == before);
    c_ = std::move(c);
    k_ = net_.conduction;
    g_ambient_ = g_offset_ = Eigen::VectorXd::Zero(net_.size());
    for (std::size_t e = 0; e < c_.size(); ++e) {
      if (c_[e] == 0.0) continue;
      const auto& exchange = net_.exchanges[e];
      k_ += c_[e] * exchange.matrix;
      g_ambient_ += c_[e] * exchange.ambient;
      if (exchange.offset.size() > 0) g_offset_ += c_[e] * laws_.gradient_K_m * exchange.offset;
    }
    fine_factor_.reset();
    coarse_factor_.reset();
    return true;
  }

  /// dθ/dt of the stage: (M + γ h K) k = f(t, θ + γ h k) - K θ.
  Eigen::VectorXd stage(const Eigen::VectorXd& theta, double t_s, const Eigen::VectorXd& guess) const {
    const Eigen::VectorXd fixed = run_.ambient_K(t_s) * g_ambient_ + g_offset_ - k_ * theta;
    Eigen::VectorXd k = guess;
    for (int round = 0; round < (looks_ ? 3 : 1); ++round) {
      effects::Inputs u = inputs(t_s);
      Eigen::VectorXd f = fixed;
      for (std::size_t s = 0; s < laws_.powers_W.size(); ++s) {
        const effects::Law& law = laws_.powers_W[s];
        u.probe_K.clear();
        for (const effects::Body& body : law.probes) {
          const Eigen::VectorXd& mean = net_.means.at(body.name);
          u.probe_K.push_back(net_.reference_K + mean.dot(theta) + kGamma * h_s_ * mean.dot(k));
        }
        const double power_W = law(u);
        if (power_W != 0.0) f += power_W * net_.sources[s];
      }
      k = (*factor_)->solve(f);
    }
    return k;
  }

  const Network<Matrix>& net_;
  const Laws& laws_;
  const Run& run_;
  bool looks_ = false;
  Drive drive_;
  std::vector<double> c_;
  Matrix k_;
  Eigen::VectorXd g_ambient_, g_offset_;
  double h_s_ = 0.0;
  std::unique_ptr<Factor> fine_factor_, coarse_factor_;
  std::unique_ptr<Factor>* factor_ = nullptr;
};

}  // namespace

Laws laws_of(const effects::HeatBalance& balance) {
  Laws laws;
  for (const effects::HeatInput& h : balance.heats) laws.powers_W.push_back(h.power_W);
  for (const effects::Exchange& e : balance.exchanges) laws.coefficients.push_back(e.coefficient);
  for (const effects::Stratification& s : balance.stratifications) laws.gradient_K_m += s.gradient_K_m;
  return laws;
}

Eigen::MatrixXd integrate(const FullNetwork& network, const Laws& laws, const Run& run) {
  return Stepper<solver::SparseRow>(network, laws, run).outputs();
}
Eigen::MatrixXd integrate(const SmallNetwork& network, const Laws& laws, const Run& run) {
  return Stepper<Eigen::MatrixXd>(network, laws, run).outputs();
}

}  // namespace driftwright::blind
