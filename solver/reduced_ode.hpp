#pragma once
// The reduced model in the form that integrate() needs, for laws that depend on temperatures and for thermostats.
//
// In each stretch the unknowns are coordinates in the eigenvectors of K. K contains exchanges that depend on temperatures
// with their value at the start of the stretch, or of an earlier stretch if that is close, so that I + γ K is diagonal. The
// deviation of these laws is a correction with few terms:
//
//     dw/dt = f + θ_ambient h - Λ w + Σ_s P_s(w) b_s - Σ_e (c_e(w) - c_e0) (G_e w - θ_ambient g_e - o_e)
//
// Newton's iterations use the diagonal and the slope of each power along its probes (one dense solve with as many equations
// as there are such sources), and neglect the change of the exchanges.

#include "solver/decomposition.hpp"
#include "solver/stage_ode.hpp"

namespace driftwright::solver {

class ReducedOde : public StageOde {
 public:
  /// @param system, ambient  borrowed
  ReducedOde(const ReducedSystem& system, const TimeSeries& ambient);

  [[nodiscard]] int size() const override { return n_ + static_cast<int>(flows_.size()); }
  [[nodiscard]] const std::vector<HeatFlow>& flows() const override { return flows_; }
  [[nodiscard]] const std::vector<Thermostat>& thermostats() const override { return system_.thermostats; }
  void begin(const Eigen::VectorXd& start, double* y) override;
  /// The error that changes an output by absolute_K, where 2 um and 20 urad count as 1 K.
  void tolerances(double absolute_K, double* tolerance) const override;
  bool begin_stretch(const LinearStretch& stretch, double* y) override;
  void restart(double t_s, const double* y) override;
  [[nodiscard]] double distance_to_switch_K(int i, double t_s, const double* y) const override;
  void toggle(int i) override { is_on_[static_cast<std::size_t>(i)] ^= 1; }
  void slopes(double t_s, const double* y, double* ydot) override;
  [[nodiscard]] bool solve_stage(double t_s, double gamma, const double* predicted, const double* s, const double* weight,
                                 double* c) override;
  [[nodiscard]] const double* slope_at_start() const override { return at_start_.data(); }
  [[nodiscard]] const double* slope_at_end() const override { return latest_.data(); }
  [[nodiscard]] bool starts_rough() const override { return is_rough_; }
  void look(double t_s, const double* y) override;
  [[nodiscard]] Eigen::VectorXd observe(const double* y, double ambient_K) const override;
  [[nodiscard]] Eigen::VectorXd state(const double* y) const override;
  [[nodiscard]] Eigen::VectorXd heats_J(const double* y) const override;
  [[nodiscard]] double stored_J(const double* y) const override;
  [[nodiscard]] int n_solves() const override { return n_solves_; }
  [[nodiscard]] int n_iterations() const override { return n_iterations_; }

 private:
  using Map = Eigen::Map<const Eigen::VectorXd>;

  /// A law that depends on temperature, in the current eigenvectors.
  struct LiveSource {
    std::size_t index;
    double power_W = 0.0;
    Eigen::VectorXd slope;  ///< dP/dw
  };
  struct LiveExchange {
    std::size_t index;
    double coefficient = 0.0, in_diagonal = 0.0;  ///< current value, and the value contained in Λ
    std::size_t matrix = 0;                       ///< index into matrices_
    Eigen::VectorXd to_ambient = {}, offset = {}, flow = {};
  };
  [[nodiscard]] Map unknowns(const double* y) const { return {y, n_}; }
  /// Value of a law at probe_K_.
  [[nodiscard]] double value(const BoundLaw& law);
  /// Sets probe_K_ of the probes that laws look at.
  void probe(const Eigen::VectorXd& w, double ambient_K);
  /// Sets powers and coefficients at w.
  void find_laws(double t_s, const Eigen::VectorXd& w);
  /// Sets heat_ and flow_W_ at w, after find_laws().
  void find_heat(const Eigen::VectorXd& w);
  void find_flows(const Eigen::VectorXd& w);
  void find_slopes(double t_s, const Eigen::VectorXd& w);

  const ReducedSystem& system_;
  const TimeSeries& ambient_;
  int n_;
  std::vector<HeatFlow> flows_;
  Decompositions decompositions_;
  Decomposition now_;
  std::vector<char> is_on_;
  effects::Inputs inputs_;
  Eigen::VectorXd power_W_;  ///< of sources
  std::vector<LiveSource> live_sources_;
  std::vector<LiveExchange> live_exchanges_;
  /// G of live exchanges; those of one surface (free convection and radiation) share one. Not transformed, V'G V: that costs
  /// as much as all products with them in a stretch.
  struct ExchangeMatrix {
    const Eigen::MatrixXd* of_system;
    double beyond = 0.0;  ///< sum of coefficients minus those in Λ
  };
  std::vector<ExchangeMatrix> matrices_;
  Eigen::MatrixXd probes_;              ///< size x n_probes, in the current eigenvectors
  std::vector<std::size_t> looked_at_;  ///< probes of laws
  std::vector<double> probe_K_;         ///< of each probe; those that no law looks at are not set
  bool is_first_ = true;
  bool has_jumped_ = false, is_rough_ = false;  ///< since the last step; before the current one
  double began_J_ = 0.0;
  Eigen::VectorXd at_start_, latest_;  ///< slopes of unknowns and flows
  Eigen::VectorXd heat_, flow_W_;      ///< into each unknown, and of each flow
  Eigen::VectorXd z_, exchanged_;      ///< V w, and Σ_e (c_e - c_e0) G_e V w
  int n_solves_ = 0, n_iterations_ = 0;
};

}  // namespace driftwright::solver
