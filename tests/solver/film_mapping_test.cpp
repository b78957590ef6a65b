// Films that differ from place to place: what reaches the faces of a surface, against closed forms.

#include "solver/film_mapping.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/quality.hpp"
#include "solver/heat_assembly.hpp"
#include "tests/shared/heat_runs.hpp"

namespace driftwright::solver::film_mapping_test {
namespace {

using effects::FieldPart;
using effects::SurfaceField;

/// A box of 0.2 x 0.1 x 0.05 m, of 3 x 2 x 1 bricks of a shape.
mesh::Mesh box(mesh::CellShape shape) {
  return fixtures::box_mesh({{0, 0, 0}, {0.2, 0.1, 0.05}, {3, 2, 1}, shape});
}

/// nx x ny rectangular cells over a part of the plane z = 0.05 m, with values of their middles.
SurfaceField cells_on_top(int nx, int ny, const fixtures::Field& film, double from_x_m = 0.0, double to_x_m = 0.2) {
  SurfaceField field;
  const double dx = (to_x_m - from_x_m) / nx, dy = 0.1 / ny;
  field.point_m.resize(3, nx * ny);
  field.corner_m.resize(3, 4 * nx * ny);
  field.film_W_m2K.resize(nx * ny, 1);
  field.corner_from = {0};
  for (int i = 0; i < nx * ny; ++i) {
    const double x = from_x_m + (i % nx) * dx, y = (i / nx) * dy;
    const int at = 4 * i;
    field.corner_m.col(at) = Eigen::Vector3d(x, y, 0.05);
    field.corner_m.col(at + 1) = Eigen::Vector3d(x + dx, y, 0.05);
    field.corner_m.col(at + 2) = Eigen::Vector3d(x + dx, y + dy, 0.05);
    field.corner_m.col(at + 3) = Eigen::Vector3d(x, y + dy, 0.05);
    field.corner_from.push_back(at + 4);
    field.point_m.col(i) = Eigen::Vector3d(x + 0.5 * dx, y + 0.5 * dy, 0.05);
    field.film_W_m2K(i, 0) = film(field.point_m.col(i));
  }
  return field;
}

SurfaceField as_points(SurfaceField field) {
  field.corner_from.clear();
  field.corner_m.resize(3, 0);
  return field;
}

FieldPart pattern(SurfaceField field) {
  effects::set_means(field);
  return {.field = std::make_shared<const SurfaceField>(std::move(field)), .id = "film"};
}

effects::Exchange film_of(FieldPart part) {
  effects::Exchange film = effects::make_film("film top", "z1", fixtures::constant(1.0));
  film.part = std::move(part);
  return film;
}

double uneven(const Eigen::Vector3d& x) {
  return 5.0 + 200.0 * x[0] + 90.0 * x[1];
}

class OnEveryShape : public ::testing::TestWithParam<mesh::CellShape> {};

TEST_P(OnEveryShape, AConstantFilmIsThatOfConvection) {
  const mesh::Mesh m = box(GetParam());
  effects::HeatBalance even, uneven_balance;
  even.exchanges.push_back(fixtures::film("z1", 12.5));
  even.exchanges.back().coefficient = fixtures::constant(1.0);
  uneven_balance.exchanges.push_back(film_of(pattern(cells_on_top(7, 5, [](const auto&) { return 12.5; }))));
  const FullSystem a = assemble_heat(m, {fixtures::steel()}, even),
                   b = assemble_heat(m, {fixtures::steel()}, uneven_balance);
  const Eigen::MatrixXd expected = 12.5 * Eigen::MatrixXd(a.exchanges[0].matrix),
                        found = Eigen::MatrixXd(b.exchanges[0].matrix);
  const double scale = expected.cwiseAbs().maxCoeff();
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-12 * scale);
  EXPECT_LT((b.exchanges[0].to_ambient - 12.5 * a.exchanges[0].to_ambient).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((b.exchanges[0].flow - 12.5 * a.exchanges[0].flow).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(b.exchanges[0].ambient_sum, 12.5 * 0.02, 1e-14);
}

TEST_P(OnEveryShape, ALinearFilmKeepsItsIntegralAndItsMoment) {
  const mesh::Mesh m = box(GetParam());
  // ∫ h dA of a linear h over the rectangle: its area times the value in its middle. So it is of each cell.
  const double exact_W_K = 0.02 * uneven({0.1, 0.05, 0.05});
  for (const auto& [nx, ny] : {std::pair{1, 1}, {2, 3}, {7, 5}, {40, 23}}) {
    const FieldPart part = pattern(cells_on_top(nx, ny, uneven));
    const FilmMapping mapping = map_film(m, m.surface("z1"), *part.field);
    EXPECT_NEAR(mapping.film_W_K(part), exact_W_K, 1e-13) << nx;
    EXPECT_NEAR(part.field->film_W_K(0), exact_W_K, 1e-13) << nx;
    EXPECT_NEAR(mapping.area_m2, 0.02, 1e-15);
    EXPECT_NEAR(mapping.uncovered_m2, 0.0, 1e-15);
    std::vector<double> of_cell(static_cast<std::size_t>(nx * ny), 0.0);
    for (const FilmPoint& p : mapping.points) of_cell[static_cast<std::size_t>(p.value)] += p.area_m2;
    for (const double area_m2 : of_cell) EXPECT_NEAR(area_m2, 0.02 / (nx * ny), 1e-15);  // cell by cell
  }
}

TEST_P(OnEveryShape, EachPointHasTheFacesNearestToIt) {
  const mesh::Mesh m = box(GetParam());
  // The faces nearest to a point of a regular grid are those of its rectangle.
  const FieldPart part = pattern(as_points(cells_on_top(8, 4, uneven)));
  const FilmMapping mapping = map_film(m, m.surface("z1"), *part.field);
  EXPECT_NEAR(mapping.reach_m, 2.0 * 0.025, 1e-12);
  std::vector<double> of_point(32, 0.0);
  for (const FilmPoint& p : mapping.points) {
    ASSERT_GE(p.value, 0);
    of_point[static_cast<std::size_t>(p.value)] += p.area_m2;
  }
  for (const double area_m2 : of_point) EXPECT_NEAR(area_m2, 0.02 / 32, 1e-15);
  EXPECT_NEAR(mapping.film_W_K(part), 0.02 * uneven({0.1, 0.05, 0.05}), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Each, OnEveryShape, ::testing::ValuesIn(fixtures::kAllShapes),
                         [](const auto& shape) { return fixtures::name_of(shape.param); });

TEST(FilmMapping, CellsThatEndBeforeTheFaceLeaveTheRestUncovered) {
  const mesh::Mesh m = box(mesh::CellShape::kHex20);
  // Cells of 10 mm end at x = 0.12 m, within the second third of the face.
  const SurfaceField field = cells_on_top(12, 10, uneven, 0.0, 0.12);
  const FilmMapping mapping = map_film(m, m.surface("z1"), field);
  EXPECT_NEAR(mapping.reach_m, 0.01, 1e-12);
  EXPECT_NEAR(mapping.uncovered_m2, 0.08 * 0.1, 1e-15);
  EXPECT_GT(mapping.uncovered_at_m[0], 0.12);
  const FieldPart part = pattern(field);
  EXPECT_NEAR(mapping.film_W_K(part), 0.012 * uneven({0.06, 0.05, 0.05}), 1e-14);

  // A film for the rest, which leaves the rest of the face alone.
  effects::HeatBalance balance;
  balance.exchanges.push_back(film_of(part));
  FieldPart rest = part;
  rest.id = "rest";
  rest.to = FieldPart::kUncovered;
  balance.exchanges.push_back(film_of(rest));
  const FullSystem system = assemble_heat(m, {fixtures::steel()}, balance);
  EXPECT_NEAR(system.exchanges[1].ambient_sum, 0.08 * 0.1, 1e-15);
  const Eigen::VectorXd x = fixtures::at_nodes(m, [](const Eigen::Vector3d& at) { return at[0]; });
  EXPECT_NEAR(system.exchanges[1].flow.dot(x), 0.08 * 0.1 * 0.16, 1e-15);  // its middle is at x = 0.16 m
}

TEST(FilmMapping, PointsCountUpToTheirReach) {
  const mesh::Mesh m = box(mesh::CellShape::kTet10);
  const SurfaceField field = as_points(cells_on_top(12, 10, uneven, 0.0, 0.12));
  // The last points are at x = 0.115 m; they count 20 mm further, in the octagons about them at least that.
  const FilmMapping mapping = map_film(m, m.surface("z1"), field);
  EXPECT_NEAR(mapping.reach_m, 0.02, 1e-12);
  EXPECT_LE(mapping.uncovered_m2, 0.065 * 0.1 + 1e-12);
  EXPECT_GE(mapping.uncovered_m2, (0.085 - 0.02 / std::cos(M_PI / 8)) * 0.1 - 1e-12);  // to the octagons' corners
  const FilmMapping far = map_film(m, m.surface("z1"), field, 0.2);
  EXPECT_NEAR(far.uncovered_m2, 0.0, 1e-15);
}

TEST(FilmMapping, AStripNarrowerThanACellIsCovered) {
  const mesh::Mesh m = box(mesh::CellShape::kTet10);
  SurfaceField field = cells_on_top(
      20, 10, [](const auto&) { return 30.0; }, 0.004, 0.196);
  const FilmMapping mapping = map_film(m, m.surface("z1"), field);
  EXPECT_NEAR(mapping.uncovered_m2, 0.0, 1e-15);
  EXPECT_NEAR(mapping.film_W_K(pattern(field)), 30.0 * 0.02, 1e-13);  // the strips have the film of their faces
}

TEST(FilmMapping, CellsOfAnotherSideDoNotCount) {
  const mesh::Mesh m = box(mesh::CellShape::kTet10);
  const SurfaceField field = cells_on_top(20, 10, uneven);
  EXPECT_NEAR(map_film(m, m.surface("x0"), field, 1e-3).uncovered_m2, 0.1 * 0.05, 1e-15);  // at 90 degrees
  EXPECT_NEAR(map_film(m, m.surface("x0"), field, 0.02).uncovered_m2, 0.1 * 0.05, 1e-15);  // though near its edge
  EXPECT_NEAR(map_film(m, m.surface("z0"), field).uncovered_m2, 0.02, 1e-15);              // 50 mm away
}

TEST(FilmMapping, EachSideOfAThinWallHasItsOwnCells) {
  // 4 mm thick, in cells of 20 x 20 mm: either side is within reach of the cells of the other one, which face away.
  const mesh::Mesh m = fixtures::box_mesh({{0, 0, 0.046}, {0.2, 0.1, 0.004}, {3, 2, 1}, mesh::CellShape::kHex8});
  const SurfaceField above = cells_on_top(10, 5, uneven);
  SurfaceField both = above;
  both.film_W_m2K.conservativeResize(100, 1);
  both.point_m.conservativeResize(3, 100);
  both.corner_m.conservativeResize(3, 400);
  for (int c = 0; c < 50; ++c) {
    both.film_W_m2K(50 + c, 0) = 3.0 * above.film_W_m2K(c, 0);
    both.point_m.col(50 + c) = above.point_m.col(c) - Eigen::Vector3d(0, 0, 0.004);
    for (int i = 0; i < 4; ++i)
      both.corner_m.col(200 + 4 * c + i) = above.corner_m.col(4 * c + 3 - i) - Eigen::Vector3d(0, 0, 0.004);
    both.corner_from.push_back(204 + 4 * c);
  }
  const FieldPart part = pattern(both);
  const double above_W_K = 0.02 * uneven({0.1, 0.05, 0.05});
  EXPECT_NEAR(map_film(m, m.surface("z1"), both).film_W_K(part), above_W_K, 1e-13);
  EXPECT_NEAR(map_film(m, m.surface("z0"), both).film_W_K(part), 3.0 * above_W_K, 1e-13);
}

TEST(FilmMapping, HeatFromTheAirOfTheFileIsKept) {
  const mesh::Mesh m = box(mesh::CellShape::kHex20);
  SurfaceField field = cells_on_top(10, 5, uneven);
  field.air_K.resize(50, 1);
  for (int i = 0; i < 50; ++i) field.air_K(i, 0) = 290.0 + 100.0 * field.point_m(0, i);
  double exact_W = 0.0;  // Σ_c A_c h_c (T_c - T_ref)
  for (int i = 0; i < 50; ++i) exact_W += 0.02 / 50 * field.film_W_m2K(i, 0) * (field.air_K(i, 0) - 293.15);
  effects::HeatBalance balance;
  balance.exchanges.push_back(film_of(pattern(field)));
  balance.exchanges.back().medium_K = 300.0;  // the mean, which only says that there is one
  const FullSystem system = assemble_heat(m, {fixtures::steel()}, balance, 293.15);
  EXPECT_NEAR(system.exchanges[0].offset_sum, exact_W, 1e-11 * std::abs(exact_W) + 1e-12);
  EXPECT_FALSE(system.exchanges[0].reaches_ambient());
  EXPECT_TRUE(system.exchanges[0].leaves_machine());
}

TEST(FilmMapping, AChangeWithoutSumReachesItsSurrounding) {
  const mesh::Mesh m = box(mesh::CellShape::kHex8);
  SurfaceField field = cells_on_top(2, 1, [](const auto&) { return 10.0; });
  field.film_W_m2K.conservativeResize(2, 2);
  field.film_W_m2K.col(1) = Eigen::Vector2d(20.0, 0.0);
  field.states = {effects::FieldOver::kSpeed, {0.0, 1000.0}, {}};
  FieldPart part = pattern(field);
  part.from = 0;
  part.to = 1;
  effects::HeatBalance balance;
  balance.exchanges.push_back(film_of(part));
  const FullSystem system = assemble_heat(m, {fixtures::steel()}, balance);
  EXPECT_NEAR(system.exchanges[0].to_ambient.sum(), 0.0, 1e-15);
  EXPECT_GT(system.exchanges[0].to_ambient.cwiseAbs().maxCoeff(), 0.01);
  EXPECT_TRUE(system.exchanges[0].reaches_ambient());
}

}  // namespace
}  // namespace driftwright::solver::film_mapping_test
