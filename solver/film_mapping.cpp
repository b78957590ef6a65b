#include "solver/film_mapping.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "mesh/shape.hpp"
#include "mesh/topology.hpp"

namespace driftwright::solver {
namespace {

using effects::SurfaceField;
using Eigen::Vector3d;

constexpr double kLeastCosine = 0.5;    // of the angle between a face and a cell that may lie on it: 60 degrees
constexpr int kSidesOfReach = 8;        // of the polygon about the circle of the reach
constexpr double kLeastPiece = 1e-12;   // of a face: a smaller piece is rounding
constexpr double kSameDistance = 1e-6;  // of the reach: closer distances from a face are those of one side
constexpr double kOpenShare = 1e-9;     // of a face: a larger part without a piece is not rounding

/// A plane convex polygon in space.
using Polygon = std::vector<Vector3d>;

/// The part of a polygon in which normal·x <= level (Sutherland & Hodgman 1974).
void clip(Polygon& polygon, const Vector3d& normal, double level) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double beyond_a = normal.dot(a) - level, beyond_b = normal.dot(b) - level;
    if (beyond_a <= 0.0) kept.push_back(a);
    if ((beyond_a < 0.0 && beyond_b > 0.0) || (beyond_a > 0.0 && beyond_b < 0.0))
      kept.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
  }
  polygon = std::move(kept);
}

double area_of(const Polygon& p) {
  Vector3d twice = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < p.size(); ++i) twice += Vector3d(p[i] - p[0]).cross(p[i + 1] - p[0]);
  return 0.5 * twice.norm();
}

/// A facet, or half of one with four corners: a plane triangle and where it lies in the reference facet.
struct Triangle {
  std::array<Vector3d, 3> x, xi;
  Vector3d normal;  ///< unit
  double area_m2 = 0.0;

  /// Reference coordinates of a point of its plane.
  [[nodiscard]] Vector3d xi_of(const Vector3d& at) const {
    const double b = normal.dot((x[2] - x[1]).cross(at - x[1])), c = normal.dot((x[0] - x[2]).cross(at - x[2]));
    const double u = 0.5 * b / area_m2, v = 0.5 * c / area_m2;  // barycentric, of corners 0 and 1
    return u * xi[0] + v * xi[1] + (1.0 - u - v) * xi[2];
  }
};

std::vector<Triangle> triangles_of(const mesh::Mesh& mesh, int facet) {
  const auto nodes = mesh.facets.nodes(facet);
  const auto xi = mesh::reference_nodes(mesh.facets.shape[facet]);
  std::vector<std::array<std::size_t, 3>> corners = {{0, 1, 2}};
  if (mesh::n_corners_of(mesh.facets.shape[facet]) == 4) corners.push_back({0, 2, 3});
  std::vector<Triangle> all;
  for (const auto& c : corners) {
    Triangle t;
    for (std::size_t i = 0; i < 3; ++i) {
      t.x[i] = mesh.coords.col(nodes[c[i]]);
      t.xi[i] = xi[c[i]];
    }
    const Vector3d twice = (t.x[1] - t.x[0]).cross(t.x[2] - t.x[0]);
    t.area_m2 = 0.5 * twice.norm();
    if (!(t.area_m2 > 0.0)) continue;
    t.normal = twice.normalized();
    all.push_back(t);
  }
  return all;
}

/// Points of a rule in the reference triangle (0, 0), (1, 0), (0, 1): total degree 4 for the products of triangles' shape
/// functions; for those of quadrilaterals 6, by Gauss-Legendre in the square, one side of which is drawn together.
std::vector<mesh::QuadraturePoint> rule_for(mesh::CellShape shape) {
  if (mesh::n_corners_of(shape) == 3) {
    const auto rule = mesh::quadrature(mesh::CellShape::kTri6, mesh::is_quadratic(shape) ? 4 : 2);
    return {rule.begin(), rule.end()};
  }
  std::vector<mesh::QuadraturePoint> rule;
  for (const auto& q : mesh::quadrature(mesh::CellShape::kQuad4, 7))
    rule.push_back({{q.xi[0], q.xi[1] * (1.0 - q.xi[0]), 0.0}, q.weight * (1.0 - q.xi[0])});
  return rule;
}

/// Unit normal of a plane polygon.
Vector3d normal_of(const Polygon& p) {
  Vector3d twice = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < p.size(); ++i) twice += Vector3d(p[i] - p[0]).cross(p[i + 1] - p[0]);
  return twice.normalized();
}

/// The part of a polygon that is within a cell, seen along a unit normal. @param cosine  between this and the cell's normal
void clip_to_cell(Polygon& polygon, const Polygon& cell, const Vector3d& normal, double cosine) {
  for (std::size_t i = 0; i < cell.size() && polygon.size() >= 3; ++i) {
    const Vector3d edge = cell[(i + 1) % cell.size()] - cell[i];
    const Vector3d outward = cosine > 0.0 ? edge.cross(normal) : normal.cross(edge);
    clip(polygon, outward, outward.dot(cell[i]));
  }
}

/// A piece of a triangle that belongs to one value.
struct Piece {
  const Triangle* triangle;
  Polygon polygon;
  int value;
  double area_m2;
};

class Mapper {
 public:
  Mapper(const mesh::Mesh& mesh, const SurfaceField& field, double reach_m)
      : mesh_(mesh), field_(field), reach_m_(std::isnan(reach_m) ? usual_reach_m() : reach_m) {
    std::vector<std::pair<double, int>> by_x;
    for (int v = 0; v < field.n_values(); ++v) {
      boxes_.push_back(box_of(v));
      by_x.emplace_back(boxes_.back().min().x(), v);
    }
    std::sort(by_x.begin(), by_x.end());
    for (const auto& [x_m, v] : by_x) {
      first_x_m_.push_back(x_m);
      value_.push_back(v);
    }
  }

  [[nodiscard]] double reach_m() const { return reach_m_; }

  void add(int facet, FilmMapping& mapping) {
    const std::vector<Triangle> triangles = triangles_of(mesh_, facet);
    std::vector<Piece> pieces;
    double whole_m2 = 0.0;
    for (const Triangle& t : triangles) {
      whole_m2 += t.area_m2;
      field_.has_cells() ? add_cells(t, pieces) : add_points(t, pieces);
    }
    double covered_m2 = 0.0;
    for (const Piece& p : pieces) covered_m2 += p.area_m2;
    const double side_m = std::sqrt(whole_m2 * (mesh::n_corners_of(mesh_.facets.shape[facet]) == 3 ? 2.0 : 1.0));
    double scale = 1.0;
    bool is_open = covered_m2 < (1.0 - kOpenShare) * whole_m2;
    if (pieces.empty() && field_.has_cells()) {
      if (const int near = nearest_cell(triangles); near >= 0) {
        for (const Triangle& t : triangles) pieces.push_back({&t, {t.x.begin(), t.x.end()}, near, t.area_m2});
        is_open = false;
      }
    } else if (field_.has_cells() && (whole_m2 - covered_m2) / side_m <= reach_m_) {
      scale = whole_m2 / covered_m2;
      is_open = false;
    } else if (!is_open && covered_m2 > 0.0) {
      scale = whole_m2 / covered_m2;  // rounding
    }
    const std::size_t before = mapping.points.size();
    if (is_open) {
      for (const Triangle& t : triangles) add_point_set(facet, t, {t.x.begin(), t.x.end()}, -1, 1.0, mapping);
    }
    double area_m2 = 0.0;
    for (const Piece& p : pieces) {
      area_m2 += add_point_set(facet, *p.triangle, p.polygon, p.value, scale, mapping);
      if (is_open) (void)add_point_set(facet, *p.triangle, p.polygon, -1, -1.0, mapping);
    }
    double open_m2 = 0.0;
    for (std::size_t i = before; i < mapping.points.size(); ++i) {
      if (mapping.points[i].value < 0) open_m2 += mapping.points[i].area_m2;
    }
    mapping.area_m2 += area_m2 + open_m2;
    mapping.uncovered_m2 += open_m2;
    if (is_open && open_m2 > largest_open_m2_) {
      largest_open_m2_ = open_m2;
      mapping.uncovered_at_m = (triangles[0].x[0] + triangles[0].x[1] + triangles[0].x[2]) / 3.0;
    }
  }

 private:
  [[nodiscard]] Polygon cell(int value) const {
    Polygon corners;
    const auto c = static_cast<std::size_t>(value);
    for (int i = field_.corner_from[c]; i < field_.corner_from[c + 1]; ++i) corners.emplace_back(field_.corner_m.col(i));
    return corners;
  }

  [[nodiscard]] Eigen::AlignedBox3d box_of(int value) const {
    Eigen::AlignedBox3d box(Vector3d(field_.point_m.col(value)));
    if (field_.has_cells()) {
      for (const Vector3d& x : cell(value)) box.extend(x);
    }
    const Vector3d more = Vector3d::Constant(1.1 * reach_m_);  // 1 / cos(pi / 8) = 1.08: the corners of the octagon
    return {box.min() - more, box.max() + more};
  }

  [[nodiscard]] double usual_reach_m() const {
    double largest = 0.0;
    if (field_.has_cells()) {
      for (int c = 0; c < field_.n_values(); ++c) largest = std::max(largest, field_.area_m2(c));
      return std::sqrt(largest);
    }
    std::vector<int> by_x(static_cast<std::size_t>(field_.n_values()));
    std::iota(by_x.begin(), by_x.end(), 0);
    const auto x = [&](std::size_t i) -> Vector3d { return field_.point_m.col(by_x[i]); };
    std::sort(by_x.begin(), by_x.end(), [&](int a, int b) { return field_.point_m(0, a) < field_.point_m(0, b); });
    for (std::size_t i = 0; i < by_x.size(); ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t j = i + 1; j < by_x.size() && x(j)[0] - x(i)[0] < nearest; ++j)
        nearest = std::min(nearest, (x(j) - x(i)).norm());
      for (std::size_t j = i; j-- > 0 && x(i)[0] - x(j)[0] < nearest;) nearest = std::min(nearest, (x(j) - x(i)).norm());
      if (std::isfinite(nearest)) largest = std::max(largest, nearest);
    }
    if (!(largest > 0.0)) throw std::logic_error("map_film: one point alone has no spacing");
    return 2.0 * largest;
  }

  /// Values whose box, with the reach around it, meets that of a triangle.
  [[nodiscard]] std::vector<int> near(const Triangle& t) const {
    Eigen::AlignedBox3d box(t.x[0]);
    box.extend(t.x[1]);
    box.extend(t.x[2]);
    std::vector<int> found;
    const auto end = std::upper_bound(first_x_m_.begin(), first_x_m_.end(), box.max().x()) - first_x_m_.begin();
    for (std::ptrdiff_t i = 0; i < end; ++i) {
      const int v = value_[static_cast<std::size_t>(i)];
      if (boxes_[static_cast<std::size_t>(v)].intersects(box)) found.push_back(v);
    }
    std::sort(found.begin(), found.end());  // the same order of sums however the values are sorted
    return found;
  }

  static void keep(const Triangle& t, Polygon polygon, int value, std::vector<Piece>& pieces) {
    if (polygon.size() < 3) return;
    const double area_m2 = area_of(polygon);
    if (area_m2 > kLeastPiece * t.area_m2) pieces.push_back({&t, std::move(polygon), value, area_m2});
  }

  /// A cell that may lie on a triangle.
  struct CellOnFace {
    Polygon corners;
    int value;
    double cosine, distance_m;  ///< between the normals; of its middle from the plane
    Polygon piece;
  };

  void add_cells(const Triangle& t, std::vector<Piece>& pieces) const {
    std::vector<CellOnFace> found;
    for (const int v : near(t)) {
      CellOnFace on{.corners = cell(v), .value = v, .cosine = 0.0, .distance_m = 0.0, .piece = {t.x.begin(), t.x.end()}};
      on.cosine = normal_of(on.corners).dot(t.normal);
      on.distance_m = std::abs(t.normal.dot(field_.point_m.col(v) - t.x[0]));
      if (!(std::abs(on.cosine) >= kLeastCosine) || on.distance_m > reach_m_) continue;
      clip_to_cell(on.piece, on.corners, t.normal, on.cosine);
      if (on.piece.size() >= 3 && area_of(on.piece) > kLeastPiece * t.area_m2) found.push_back(std::move(on));
    }
    for (const CellOnFace& on : found) {
      if (!is_other_side(on, found, t)) keep(t, on.piece, on.value, pieces);
    }
  }

  /// True for a cell of the other side of a thin wall: one that faces the other way lies before the same place, and nearer.
  [[nodiscard]] bool is_other_side(const CellOnFace& on, const std::vector<CellOnFace>& all, const Triangle& t) const {
    return std::any_of(all.begin(), all.end(), [&](const CellOnFace& other) {
      if (on.cosine * other.cosine > 0.0 || !(other.distance_m < on.distance_m - kSameDistance * reach_m_)) return false;
      Polygon common = on.piece;
      clip_to_cell(common, other.corners, t.normal, other.cosine);
      return common.size() >= 3 && area_of(common) > kLeastPiece * t.area_m2;
    });
  }

  void add_points(const Triangle& t, std::vector<Piece>& pieces) const {
    const std::vector<int> candidates = near(t);
    const Vector3d along = (t.x[1] - t.x[0]).normalized(), across = t.normal.cross(along);
    std::vector<std::pair<double, int>> others;
    for (const int v : candidates) {
      const Vector3d p = field_.point_m.col(v);
      const double above_m = t.normal.dot(p - t.x[0]);
      const double in_plane_2 = reach_m_ * reach_m_ - above_m * above_m;
      if (!(in_plane_2 > 0.0)) continue;
      Polygon piece(t.x.begin(), t.x.end());
      for (int side = 0; side < kSidesOfReach && piece.size() >= 3; ++side) {
        const double angle = 2.0 * std::numbers::pi * side / kSidesOfReach;
        const Vector3d outward = std::cos(angle) * along + std::sin(angle) * across;
        clip(piece, outward, outward.dot(p) + std::sqrt(in_plane_2));
      }
      if (piece.size() < 3) continue;
      others.clear();
      for (const int other : candidates) {
        const double distance = (field_.point_m.col(other) - p).norm();
        // Farther ones are nearer to no place within the octagon, whose corners are 1.09 times the reach away.
        if (other != v && distance <= 2.2 * reach_m_) others.emplace_back(distance, other);
      }
      std::sort(others.begin(), others.end());
      for (const auto& [distance, other] : others) {
        double farthest = 0.0;
        for (const Vector3d& x : piece) farthest = std::max(farthest, (x - p).norm());
        if (distance > 2.0 * farthest || piece.size() < 3) break;  // all that follow are farther from every part
        const Vector3d q = field_.point_m.col(other);
        if (distance == 0.0) {  // twice the same point: the first one counts
          if (other < v) piece.clear();
          continue;
        }
        clip(piece, q - p, 0.5 * (q.squaredNorm() - p.squaredNorm()));
      }
      keep(t, std::move(piece), v, pieces);
    }
  }

  /// The cell nearest to a facet without pieces, if it is within reach and faces it; -1 for none.
  [[nodiscard]] int nearest_cell(const std::vector<Triangle>& triangles) const {
    int best = -1;
    double nearest_m = reach_m_;
    for (const Triangle& t : triangles) {
      const Vector3d middle = (t.x[0] + t.x[1] + t.x[2]) / 3.0;
      for (const int v : near(t)) {
        const Polygon corners = cell(v);
        if (!(std::abs(normal_of(corners).dot(t.normal)) >= kLeastCosine)) continue;
        double distance_m = (field_.point_m.col(v) - middle).norm();
        for (const Vector3d& x : corners) distance_m = std::min(distance_m, (x - middle).norm());
        if (distance_m <= nearest_m) {
          nearest_m = distance_m;
          best = v;
        }
      }
    }
    return best;
  }

  /// Adds the points of a polygon in a triangle; returns their area.
  double add_point_set(int facet, const Triangle& t, const Polygon& polygon, int value, double scale,
                       FilmMapping& mapping) const {
    const mesh::CellShape shape = mesh_.facets.shape[facet];
    static thread_local std::vector<mesh::QuadraturePoint> rule;
    static thread_local mesh::CellShape of_shape = mesh::CellShape::kTet4;  // of no facet
    if (of_shape != shape) {
      rule = rule_for(shape);
      of_shape = shape;
    }
    const auto x = mesh::cell_coords(mesh_, mesh_.facets.nodes(facet));
    const Vector3d a = t.xi_of(polygon[0]);
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const Vector3d ab = t.xi_of(polygon[i]) - a, ac = t.xi_of(polygon[i + 1]) - a;
      const double twice = std::abs(ab.cross(ac).z());
      for (const auto& q : rule) {
        const Vector3d xi = a + q.xi[0] * ab + q.xi[1] * ac;
        const double area_m2 = scale * q.weight * twice * mesh::jacobian(mesh::shape_values(shape, xi), x, shape).det;
        mapping.points.push_back({facet, value, xi, area_m2});
        sum += area_m2;
      }
    }
    return sum;
  }

  const mesh::Mesh& mesh_;
  const SurfaceField& field_;
  double reach_m_;
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< of each value, with the reach around it
  std::vector<double> first_x_m_;           ///< lower ends of the boxes, sorted
  std::vector<int> value_;                  ///< in that order
  double largest_open_m2_ = 0.0;
};

}  // namespace

double FilmMapping::film_W_K(const effects::FieldPart& part) const {
  double sum = 0.0;
  for (const FilmPoint& p : points) sum += p.area_m2 * part.film_W_m2K(p.value);
  return sum;
}

FilmMapping map_film(const mesh::Mesh& mesh, int surface, const SurfaceField& field, double reach_m) {
  Mapper mapper(mesh, field, reach_m);
  FilmMapping mapping;
  mapping.reach_m = mapper.reach_m();
  for (const int facet : mesh.facets_on(surface)) mapper.add(facet, mapping);
  return mapping;
}

}  // namespace driftwright::solver
