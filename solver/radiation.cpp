#include "solver/radiation.hpp"

#include "mesh/shape.hpp"

namespace driftwright::solver {
namespace {

constexpr double kStefanBoltzmann_W_m2K4 = 5.670374419e-8;  // CODATA 2018

double pow4(double x) {
  return x * x * x * x;
}

class RadiatingSurface : public NonlinearTerm {
 public:
  struct Point {
    double strength_W_K4;  // emissivity σ dA
    double air_offset_K;
    Eigen::VectorXd N;
  };
  struct Facet {
    std::vector<int> nodes;
    std::vector<Point> points;
  };

  RadiatingSurface(const std::string& term_name, int surrounding, double reference_K)
      : NonlinearTerm(term_name), surrounding_(surrounding), reference_K_(reference_K) {}

  void add_heat_out(const double* theta, double ambient_K, double* r_W) const override {
    for (const Facet& facet : facets) {
      for (const Point& point : facet.points) {
        const double q_W = heat_W(facet, point, theta, ambient_K);
        for (std::size_t i = 0; i < facet.nodes.size(); ++i) r_W[facet.nodes[i]] += point.N[i] * q_W;
        if (surrounding_ >= 0) r_W[surrounding_] -= q_W;
      }
    }
  }

  void add_tangent(const double* theta, double ambient_K, SparseRow& k) const override {
    for (const Facet& facet : facets) {
      std::vector<int> unknowns = facet.nodes;
      if (surrounding_ >= 0) unknowns.push_back(surrounding_);
      const auto n = static_cast<Eigen::Index>(unknowns.size());
      Eigen::MatrixXd local = Eigen::MatrixXd::Zero(n, n);
      for (const Point& point : facet.points) {
        const double t_K = surface_K(facet, point, theta);
        Eigen::VectorXd jump = Eigen::VectorXd::Zero(n);
        jump.head(point.N.size()) = point.N;
        double slope_W_K = 4.0 * point.strength_W_K4 * t_K * t_K * t_K;
        if (surrounding_ >= 0) {  // the mean of the two ends' slopes keeps the tangent symmetric
          jump[n - 1] = -1.0;
          const double s_K = surrounding_K(point, theta, ambient_K);
          slope_W_K = point.strength_W_K4 * (t_K * t_K + s_K * s_K) * (t_K + s_K);
        }
        local += slope_W_K * jump * jump.transpose();
      }
      scatter_add(k, unknowns, local);
    }
  }

  void add_cliques(Cliques& cliques) const override {
    if (surrounding_ < 0) return;  // the cell already couples its facets' nodes
    for (const Facet& facet : facets) {
      std::vector<int> unknowns = facet.nodes;
      unknowns.push_back(surrounding_);
      cliques.add(unknowns);
    }
  }

  [[nodiscard]] double heat_out_W(const double* theta, double ambient_K) const override {
    double sum_W = 0.0;
    for (const Facet& facet : facets) {
      for (const Point& point : facet.points) sum_W += heat_W(facet, point, theta, ambient_K);
    }
    return sum_W;
  }
  [[nodiscard]] bool is_flow() const override { return true; }
  [[nodiscard]] bool reaches_ambient() const override { return surrounding_ < 0; }

  std::vector<Facet> facets;

 private:
  [[nodiscard]] double surface_K(const Facet& facet, const Point& point, const double* theta) const {
    double t_K = reference_K_;
    for (std::size_t i = 0; i < facet.nodes.size(); ++i) t_K += point.N[i] * theta[facet.nodes[i]];
    return t_K;
  }
  [[nodiscard]] double surrounding_K(const Point& point, const double* theta, double ambient_K) const {
    return reference_K_ + (surrounding_ >= 0 ? theta[surrounding_] : ambient_K + point.air_offset_K);
  }
  [[nodiscard]] double heat_W(const Facet& facet, const Point& point, const double* theta, double ambient_K) const {
    return point.strength_W_K4 * (pow4(surface_K(facet, point, theta)) - pow4(surrounding_K(point, theta, ambient_K)));
  }

  int surrounding_;
  double reference_K_;
};

}  // namespace

double ambient_offset_K(const std::vector<effects::Stratification>& air, double height_m) {
  double offset_K = 0.0;
  for (const effects::Stratification& s : air) offset_K += s.gradient_K_m * (height_m - s.level_m);
  return offset_K;
}

std::shared_ptr<const NonlinearTerm> radiating_surface(const mesh::Mesh& mesh, const effects::Radiation& radiation,
                                                       int surface, int surrounding_unknown,
                                                       const std::vector<effects::Stratification>& air, double reference_K) {
  auto term = std::make_shared<RadiatingSurface>(radiation.name, surrounding_unknown, reference_K);
  for (int f : mesh.facets_on(surface)) {
    const mesh::CellShape shape = mesh.facets.shape[f];
    const auto nodes = mesh.facets.nodes(f);
    const auto x = mesh::cell_coords(mesh, nodes);
    RadiatingSurface::Facet facet{{nodes.begin(), nodes.end()}, {}};
    for (const auto& q : mesh::mass_rule(shape)) {
      const mesh::ShapeValues s = mesh::shape_values(shape, q.xi);
      const Eigen::VectorXd n_values = s.N.head(s.n).transpose();
      facet.points.push_back({radiation.emissivity * kStefanBoltzmann_W_m2K4 * q.weight * mesh::jacobian(s, x, shape).det,
                              ambient_offset_K(air, x.row(2).dot(n_values)), n_values});
    }
    term->facets.push_back(std::move(facet));
  }
  return term;
}

}  // namespace driftwright::solver
