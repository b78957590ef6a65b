// A machine that is mirrored, moved or turned has the same temperatures and displacements that are mirrored or turned with
// it.

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <cmath>

#include "mesh/topology.hpp"
#include "solver/elasticity.hpp"
#include "solver/heat_assembly.hpp"
#include "tests/shared/heat_runs.hpp"

namespace driftwright::solver::invariance_test {
namespace {

using fixtures::constant, fixtures::film, fixtures::text;
using mesh::CellShape;

/// Relative to the largest temperature or displacement.
constexpr double kRounding = 1e-9;
// In time linear solves stop at 0.02 of 1e-7 K each, and there are some hundred of them in a run of some 10 K.
constexpr double kSolves = 2e-8;

class InvarianceOfEachCell : public ::testing::TestWithParam<CellShape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, InvarianceOfEachCell, ::testing::ValuesIn(fixtures::kAllShapes),
                         [](const auto& test) { return fixtures::name_of(test.param); });

/// A column and a head on its side that share no nodes, 7 and 5 cells high: a joint, films, a hot node, a radiating face.
mesh::Mesh column_and_head(CellShape shape) {
  return fixtures::two_boxes({{0, 0, 0}, {0.2, 0.2, 0.5}, {2, 2, 5}, shape},
                             {{0.2, 0, 0.25}, {0.3, 0.2, 0.25}, {3, 2, 3}, shape}, "b.x0", "a.x1");
}

/// `radiates`: with a nonlinear face, whose tangent and Newton iterations must turn with the body as well.
effects::HeatBalance load(bool radiates) {
  effects::HeatBalance balance;
  balance.heats.push_back(
      {"spindle", effects::region("b"), [](const effects::Inputs& u) { return 0.1 * u.drive.speed_rpm; }});
  balance.heats.push_back({"motor", effects::surface("b.z1"), constant(40.0)});
  balance.exchanges.push_back(film("a.x0", 10.0));
  balance.exchanges.push_back(film("b.x1", 25.0, "air"));
  balance.exchanges.push_back(film("b.y0", 8.0));
  balance.exchanges.push_back(effects::make_contact("contact", "a/b", constant(1500.0)));
  balance.nodes.push_back({"air", 100.0});
  balance.exchanges.push_back(effects::make_link("air", effects::node("air"), constant(1.0)));
  balance.fixed.push_back({"foot", effects::surface("a.z0"), {{0, 500}, {293.15, 295.15}}, false});
  if (radiates) balance.radiations.push_back({"radiation", "b.y1", 0.9});
  return balance;
}

struct Answer {
  Eigen::VectorXd steady;         ///< [K]
  Eigen::VectorXd transient;      ///< at all nodes and two times [K]
  Eigen::Matrix3Xd displacement;  ///< under the steady temperatures [m]
};

Answer answer_of(const mesh::Mesh& mesh, bool radiates) {
  const RegionMaterials materials(mesh.regions.size(), fixtures::steel());
  FullSystem system = assemble_heat(mesh, materials, load(radiates));
  Answer answer;
  answer.steady = steady_state(system, {.drive = {.speed_rpm = 3000}, .ambient_K = 2.0, .time_s = 1000.0},
                               Eigen::VectorXd::Zero(system.size()));
  std::vector<int> all(system.size());
  for (int i = 0; i < system.size(); ++i) all[i] = i;
  fixtures::observe_unknowns(system, all);
  const Cyclogram cycle{.name = "c", .sections = {{400, {.speed_rpm = 3000}}, {600, {}}}};
  const Trajectory run = simulate(system, cycle, fixtures::still_ambient(2.0), {400, 1000},
                                  {.relative_tolerance = 1e-7, .absolute_tolerance_K = 1e-7, .max_step_s = 600.0},
                                  Eigen::VectorXd::Zero(system.size()));
  answer.transient = Eigen::Map<const Eigen::VectorXd>(run.outputs.data(), run.outputs.size());
  answer.displacement = Elasticity(mesh, materials, {{"a.z0", {true, true, true}}}).displacement(answer.steady);
  return answer;
}

double relative(const Eigen::MatrixXd& difference, const Eigen::MatrixXd& of) {
  return difference.cwiseAbs().maxCoeff() / of.cwiseAbs().maxCoeff();
}

/// Moves the machine and checks that nothing else changes.
void expect_unchanged(CellShape shape, const Eigen::Matrix3d& turn, const Eigen::Vector3d& shift_m) {
  for (bool radiates : {false, true}) {
    mesh::Mesh mesh = column_and_head(shape);
    const Answer before = answer_of(mesh, radiates);
    fixtures::map_nodes(mesh, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return turn * x + shift_m; });
    const Answer after = answer_of(mesh, radiates);
    const double steady = relative(after.steady - before.steady, before.steady);
    const double transient = relative(after.transient - before.transient, before.transient);
    const double displacement = relative(after.displacement - turn * before.displacement, before.displacement);
    const std::string which = radiates ? "_radiating" : "";
    ::testing::Test::RecordProperty("steady" + which, text(steady));
    ::testing::Test::RecordProperty("transient" + which, text(transient));
    ::testing::Test::RecordProperty("displacement" + which, text(displacement));
    EXPECT_GT(before.steady.maxCoeff(), 10.0);
    EXPECT_GT(before.displacement.cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_LT(steady, kRounding);
    EXPECT_LT(transient, kSolves);
    EXPECT_LT(displacement, kRounding);
  }
}

TEST_P(InvarianceOfEachCell, TranslationChangesNothing) {
  expect_unchanged(GetParam(), Eigen::Matrix3d::Identity(), {3.0, -7.0, 1.5});
}

TEST_P(InvarianceOfEachCell, RotationTurnsDisplacementsAndNothingElse) {
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -0.5).normalized()) * Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  expect_unchanged(GetParam(), turn, Eigen::Vector3d::Zero());
}

/// The nodes of a cell or facet after its first two reference directions have changed places: a mirrored one, right side
/// out.
std::vector<int> turned_inside_out(CellShape shape, std::span<const int> nodes) {
  const auto reference = mesh::reference_nodes(shape);
  std::vector<int> turned;
  for (const Eigen::Vector3d& at : reference) {
    const Eigen::Vector3d partner(at[1], at[0], at[2]);
    const auto is_partner = [&](const Eigen::Vector3d& x) { return (x - partner).norm() < 1e-12; };
    turned.push_back(nodes[std::find_if(reference.begin(), reference.end(), is_partner) - reference.begin()]);
  }
  return turned;
}

mesh::Cells turned_inside_out(const mesh::Cells& cells) {
  mesh::Cells turned;
  for (int c = 0; c < cells.size(); ++c)
    turned.add(cells.shape[c], turned_inside_out(cells.shape[c], cells.nodes(c)), cells.group[c]);
  return turned;
}

const Eigen::Matrix3d kMirror = Eigen::Vector3d(-1, 1, 1).asDiagonal();

TEST_P(InvarianceOfEachCell, MirrorImageHasMirroredDisplacementsAndTheSameTemperatures) {
  mesh::Mesh mesh = column_and_head(GetParam());
  const Answer before = answer_of(mesh, true);
  mesh.coords = kMirror * mesh.coords;
  mesh.cells = turned_inside_out(mesh.cells);
  mesh.facets = turned_inside_out(mesh.facets);
  const Answer after = answer_of(mesh, true);
  EXPECT_LT(relative(after.steady - before.steady, before.steady), kRounding);
  EXPECT_LT(relative(after.transient - before.transient, before.transient), kSolves);
  EXPECT_LT(relative(after.displacement - kMirror * before.displacement, before.displacement), kRounding);
}

TEST_P(InvarianceOfEachCell, SymmetricBodyUnderSymmetricLoadHasMirroredTemperaturesAndDisplacements) {
  // A box beside its mirror image in x = 0, one body; heat on top and radiation in front, films on the sides, foot fixed.
  mesh::Mesh mesh;
  fixtures::add_box(mesh, {{0, 0, 0}, {0.3, 0.2, 0.4}, {3, 2, 4}, GetParam()}, "body", "");
  const int n_half = mesh.n_nodes();
  const mesh::Cells cells = turned_inside_out(mesh.cells), facets = turned_inside_out(mesh.facets);
  mesh.coords.conservativeResize(3, 2 * n_half);
  mesh.coords.rightCols(n_half) = kMirror * mesh.coords.leftCols(n_half);
  const auto add_image = [&](mesh::Cells& to, const mesh::Cells& image) {
    for (int c = 0; c < image.size(); ++c) {
      std::vector<int> nodes(image.nodes(c).begin(), image.nodes(c).end());
      for (int& node : nodes) node += n_half;
      to.add(image.shape[c], nodes, image.group[c]);
    }
  };
  add_image(mesh.cells, cells);
  add_image(mesh.facets, facets);
  fixtures::merge_nodes(mesh);
  ASSERT_LT(mesh.n_nodes(), 2 * n_half);

  effects::HeatBalance balance;
  balance.heats = {{"top", effects::surface("z1"), constant(120.0)}};
  balance.exchanges.push_back(film("x1", 20.0));
  balance.exchanges.push_back(film("y0", 5.0));  // x1: both outer sides
  balance.radiations = {{"front", "y1", 0.8}};
  balance.fixed = {fixtures::fixed_at(effects::surface("z0"), 294.15)};
  const RegionMaterials materials(1, fixtures::steel());
  FullSystem system = assemble_heat(mesh, materials, balance);
  const Eigen::VectorXd steady = steady_state(system, {}, Eigen::VectorXd::Zero(system.size()));
  std::vector<int> all(system.size());
  for (int i = 0; i < system.size(); ++i) all[i] = i;
  fixtures::observe_unknowns(system, all);
  const Eigen::VectorXd transient =
      fixtures::run_at_rest(system, {300.0}, 1e-7, Eigen::VectorXd::Zero(system.size())).outputs.col(0);
  const Eigen::Matrix3Xd u = Elasticity(mesh, materials, {{"z0", {true, true, true}}}).displacement(steady);
  double steady_K = 0.0, transient_K = 0.0, displacement_m = 0.0;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const int image = fixtures::node_at(mesh, kMirror * mesh.coords.col(i));
    ASSERT_LT((mesh.coords.col(image) - kMirror * mesh.coords.col(i)).norm(), 1e-12);
    steady_K = std::max(steady_K, std::abs(steady[i] - steady[image]));
    transient_K = std::max(transient_K, std::abs(transient[i] - transient[image]));
    displacement_m = std::max(displacement_m, (u.col(i) - kMirror * u.col(image)).norm());
  }
  RecordProperty("steady", text(steady_K / steady.maxCoeff()));
  RecordProperty("transient", text(transient_K / transient.maxCoeff()));
  RecordProperty("displacement", text(displacement_m / u.cwiseAbs().maxCoeff()));
  EXPECT_GT(steady.maxCoeff() - steady.minCoeff(), 1.0);
  EXPECT_LT(steady_K, kRounding * steady.maxCoeff());
  EXPECT_LT(transient_K, kSolves * transient.maxCoeff());
  EXPECT_LT(displacement_m, kRounding * u.cwiseAbs().maxCoeff());
}

TEST_P(InvarianceOfEachCell, NumberOfThreadsChangesNoBit) {
  // Steady, transient (nonlinear) and elastic; the linear transient of a mesh large enough for every loop: transient_test.
  const mesh::Mesh mesh = column_and_head(GetParam());
  const int n_before = omp_get_max_threads();
  omp_set_num_threads(1);
  const Answer one = answer_of(mesh, true);
  omp_set_num_threads(2);
  const Answer two = answer_of(mesh, true);
  omp_set_num_threads(n_before);
  EXPECT_EQ(one.steady, two.steady);
  EXPECT_EQ(one.transient, two.transient);
  EXPECT_EQ(one.displacement, two.displacement);
}

}  // namespace
}  // namespace driftwright::solver::invariance_test
