// Side by side with CalculiX on the same mesh: steady and transient temperatures and thermo-elastic displacements of a frame
// of two materials. Skipped where its program ccx (Debian: calculix-ccx) is not installed.

#include "tests/shared/calculix.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "mesh/topology.hpp"
#include "solver/elasticity.hpp"
#include "solver/heat_assembly.hpp"
#include "tests/shared/heat_runs.hpp"

namespace driftwright::solver::calculix_test {
namespace {

using fixtures::text;
using mesh::CellShape;

constexpr double kHeadPower_W = 150.0, kHeadVolume_m3 = 0.018, kHtc_W_m2K = 12.0, kAmbient_K = 2.0;
constexpr double kOn_s = 600.0, kEnd_s = 1200.0;
const std::vector<std::string> kFilmed = {"bed_x0",    "bed_x1",    "bed_y1",  "column_x0",
                                          "column_x1", "column_y0", "head_z1", "head_y1"};

/// A C-shaped frame: a bed, a column on it and a head in front of the column, of cells of 0.1 m / refinement.
mesh::Mesh frame(CellShape shape, int refinement) {
  const auto cells = [&](int x, int y, int z) { return std::array{x * refinement, y * refinement, z * refinement}; };
  mesh::Mesh mesh;
  fixtures::add_box(mesh, {{0, 0, 0}, {0.3, 0.6, 0.2}, cells(3, 6, 2), shape}, "bed", "bed_");
  fixtures::add_box(mesh, {{0, 0, 0.2}, {0.3, 0.3, 0.6}, cells(3, 3, 6), shape}, "column", "column_");
  fixtures::add_box(mesh, {{0, 0.3, 0.6}, {0.3, 0.3, 0.2}, cells(3, 3, 2), shape}, "head", "head_");
  fixtures::merge_nodes(mesh);
  return mesh;
}

RegionMaterials materials() {
  const Material iron{7200.0, 50.0, 500.0, 110e9, 0.27, 11e-6, "test"};
  return {iron, iron, {7850.0, 46.0, 480.0, 206e9, 0.3, 11.7e-6, "test"}};
}

/// Heat in the head at speed, films, the foot at the reference temperature.
FullSystem system_of(const mesh::Mesh& mesh, const std::vector<std::string>& filmed) {
  effects::HeatBalance balance;
  balance.heats.push_back({"heat", effects::region("head"),
                           [](const effects::Inputs& u) { return u.drive.speed_rpm > 0.0 ? kHeadPower_W : 0.0; }});
  for (const std::string& surface : filmed) balance.exchanges.push_back(fixtures::film(surface, kHtc_W_m2K));
  balance.fixed.push_back(fixtures::fixed_at(effects::surface("bed_z0"), 293.15));
  return assemble_heat(mesh, materials(), balance);
}

std::string heat_step(const mesh::Mesh& mesh, const std::vector<std::string>& filmed, const std::string& procedure,
                      double power_W, int print_every) {
  std::string step = "*STEP, INC=100000\n" + procedure + "*BOUNDARY\nNbed_z0, 11, 11, 0.\n*DFLUX, OP=NEW\n";
  step += fmt::format("Ehead, BF, {:.12e}\n", power_W / kHeadVolume_m3);
  if (!filmed.empty()) step += "*FILM, OP=NEW\n";
  for (const std::string& surface : filmed) step += fixtures::calculix_film(mesh, surface, kAmbient_K, kHtc_W_m2K);
  return step + fmt::format("*NODE PRINT, NSET=NALL, FREQUENCY={}\nNT\n*END STEP\n", print_every);
}

Eigen::VectorXd steady_by_calculix(const mesh::Mesh& mesh, const std::vector<std::string>& filmed) {
  const std::string procedure = "*HEAT TRANSFER, STEADY STATE\n1., 1.\n";
  const std::string deck =
      fixtures::calculix_model(mesh, materials(), {"bed_z0"}) + heat_step(mesh, filmed, procedure, kHeadPower_W, 1);
  return fixtures::run_calculix("steady", deck, mesh.n_nodes()).temperature.rbegin()->second;
}
Eigen::VectorXd steady_by_us(const mesh::Mesh& mesh, const std::vector<std::string>& filmed) {
  const FullSystem system = system_of(mesh, filmed);
  return steady_state(system, {.drive = {.speed_rpm = 1.0}, .ambient_K = kAmbient_K}, Eigen::VectorXd::Zero(system.size()));
}

/// At the end of the heating and at the end. CalculiX steps by backward Euler.
std::array<Eigen::VectorXd, 2> transient_by_calculix(const mesh::Mesh& mesh, double step_s) {
  const auto step = [&](double duration_s, double power_W) {
    return heat_step(mesh, kFilmed, fmt::format("*HEAT TRANSFER, DIRECT\n{}, {}\n", step_s, duration_s), power_W,
                     static_cast<int>(std::lround(duration_s / step_s)));
  };
  const std::string deck =
      fixtures::calculix_model(mesh, materials(), {"bed_z0"}) + step(kOn_s, kHeadPower_W) + step(kEnd_s - kOn_s, 0.0);
  const fixtures::CalculixResult result = fixtures::run_calculix("transient", deck, mesh.n_nodes());
  if (result.temperature.size() != 2) throw std::logic_error("two outputs were asked for");
  return {result.temperature.begin()->second, result.temperature.rbegin()->second};
}

Eigen::Matrix3Xd displacement_by_calculix(const mesh::Mesh& mesh, const Eigen::VectorXd& theta) {
  std::string deck = fixtures::calculix_model(mesh, materials(), {"bed_z0"});
  deck += "*STEP\n*STATIC\n1., 1.\n*BOUNDARY\nNbed_z0, 1, 3, 0.\n*TEMPERATURE\n";
  for (int i = 0; i < mesh.n_nodes(); ++i) deck += fmt::format("{}, {:.12e}\n", i + 1, theta[i]);
  deck += "*NODE PRINT, NSET=NALL\nU\n*END STEP\n";
  return fixtures::run_calculix("static", deck, mesh.n_nodes()).displacement.rbegin()->second;
}

Eigen::Matrix3Xd displacement_by_us(const mesh::Mesh& mesh, const Eigen::VectorXd& theta) {
  return Elasticity(mesh, materials(), {{"bed_z0", {true, true, true}}}).displacement(theta);
}

struct Case {
  CellShape shape;
  int refinement;
};
class SameMesh : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!fixtures::has_calculix()) GTEST_SKIP() << "CalculiX is not installed: apt-get install calculix-ccx";
  }
  mesh::Mesh mesh_ = frame(GetParam().shape, GetParam().refinement);
};

double largest(const Eigen::MatrixXd& difference) {
  return difference.cwiseAbs().maxCoeff();
}

TEST_P(SameMesh, SteadyTemperatures) {
  const Eigen::VectorXd ours = steady_by_us(mesh_, kFilmed);
  const double without_films_K = largest(steady_by_us(mesh_, {}) - steady_by_calculix(mesh_, {}));
  const double with_films_K = largest(ours - steady_by_calculix(mesh_, kFilmed));
  RecordProperty("n_nodes", mesh_.n_nodes());
  RecordProperty("largest_K", text(ours.maxCoeff()));
  RecordProperty("difference_without_films_K", text(without_films_K));
  RecordProperty("difference_with_films_K", text(with_films_K));
  // Seven digits are printed: 5e-6 K of 20 K, 5e-5 K above 100 K. CalculiX samples films on triangles in one point (C3D4)
  // and three (C3D10), which is not exact for the products of shape functions; ours and its rules on quads are.
  EXPECT_LT(without_films_K, 6e-5);
  const bool exact_films = mesh::n_corners_of(GetParam().shape) == 8;
  EXPECT_LT(with_films_K, exact_films ? 6e-6 : 0.01);
}

TEST_P(SameMesh, TransientTemperatures) {
  // Theirs with steps of 20 and 10 s: the error in time is of first order, 2 T(10 s) - T(20 s) of second. Ours to 1e-6.
  const auto coarse = transient_by_calculix(mesh_, 20.0), fine = transient_by_calculix(mesh_, 10.0);
  FullSystem system = system_of(mesh_, kFilmed);
  std::vector<int> all(mesh_.n_nodes());
  for (int i = 0; i < mesh_.n_nodes(); ++i) all[i] = i;
  fixtures::observe_unknowns(system, all);
  const Cyclogram on_off{.name = "on, off", .sections = {{kOn_s, {.speed_rpm = 1.0}}, {kEnd_s - kOn_s, {}}}};
  const Trajectory run = simulate(system, on_off, fixtures::still_ambient(kAmbient_K), {kOn_s, kEnd_s},
                                  {.relative_tolerance = 1e-6, .absolute_tolerance_K = 1e-6, .max_step_s = kEnd_s},
                                  Eigen::VectorXd::Zero(system.size()));
  RecordProperty("largest_K", text(run.outputs.maxCoeff()));
  for (int k : {0, 1}) {
    const std::string at = k == 0 ? "_on" : "_end";
    const double time_error_K = largest(coarse[k] - fine[k]);
    const double difference_K = largest(run.outputs.col(k) - fine[k]);
    const double extrapolated_K = largest(run.outputs.col(k) - (2 * fine[k] - coarse[k]));
    RecordProperty("their_time_error" + at + "_K", text(time_error_K));
    RecordProperty("difference" + at + "_K", text(difference_K));
    RecordProperty("difference_extrapolated" + at + "_K", text(extrapolated_K));
    EXPECT_LT(time_error_K, 5e-3);
    EXPECT_LT(difference_K, 0.01);
    EXPECT_LT(extrapolated_K, mesh::n_corners_of(GetParam().shape) == 8 ? 1e-4 : 0.01);  // films on triangles, as above
  }
}

/// The field with mid-side values in the middle of their neighbours: linear or trilinear within each cell.
Eigen::VectorXd on_corners(const mesh::Mesh& mesh, Eigen::VectorXd theta) {
  for (int c = 0; c < mesh.cells.size(); ++c) {
    if (!mesh::is_quadratic(mesh.cells.shape[c])) continue;
    const auto nodes = mesh.cells.nodes(c);
    int middle = mesh::n_corners_of(mesh.cells.shape[c]);
    for (const auto& [p, q] : mesh::edges_of(mesh.cells.shape[c])) {
      theta[nodes[middle++]] = 0.5 * (theta[nodes[p]] + theta[nodes[q]]);
    }
  }
  return theta;
}

TEST_P(SameMesh, Displacements) {
  // Of the same temperatures. How CalculiX 2.20 takes them within a cell (its resultsmech.f): C3D4 and C3D10 by the shape
  // functions, as we do; C3D20 by those of the eight corners alone; C3D8 as one mean value. So C3D20 must agree where
  // mid-side temperatures lie on the chord, and C3D8 where the temperature is even; elsewhere both programs differ by what
  // the cell does not resolve.
  const Eigen::VectorXd theta = steady_by_us(mesh_, kFilmed);
  struct Field {
    const char* name;
    Eigen::VectorXd theta;
    bool same_rule;
  };
  const CellShape shape = GetParam().shape;
  const std::vector<Field> fields = {{"even", Eigen::VectorXd::Constant(theta.size(), 10.0), true},
                                     {"on_corners", on_corners(mesh_, theta), shape != CellShape::kHex8},
                                     {"steady", theta, shape == CellShape::kTet4 || shape == CellShape::kTet10}};
  for (const Field& field : fields) {
    const Eigen::Matrix3Xd ours = displacement_by_us(mesh_, field.theta);
    const double difference_um = 1e6 * largest(ours - displacement_by_calculix(mesh_, field.theta));
    RecordProperty(std::string("largest_um_") + field.name, text(1e6 * largest(ours)));
    RecordProperty(std::string("difference_um_") + field.name, text(difference_um));
    if (!field.same_rule) continue;
    EXPECT_LT(difference_um, 1e-4) << field.name;  // seven digits are printed: 5e-5 um above 100 um
  }
}

INSTANTIATE_TEST_SUITE_P(Cells, SameMesh,
                         ::testing::Values(Case{CellShape::kHex8, 1}, Case{CellShape::kTet10, 1},
                                           Case{CellShape::kHex20, 1}),
                         [](const auto& test) { return fixtures::name_of(test.param.shape); });
INSTANTIATE_TEST_SUITE_P(CellsAtLength, SameMesh, ::testing::Values(Case{CellShape::kTet4, 2}),
                         [](const auto& test) { return fixtures::name_of(test.param.shape); });

TEST(SideBySide, RulesForTemperatureWithinHexahedraDifferByWhatTheMeshLeavesOut) {
  if (!fixtures::has_calculix()) GTEST_SKIP() << "CalculiX is not installed: apt-get install calculix-ccx";
  for (CellShape shape : {CellShape::kHex8, CellShape::kHex20}) {
    std::vector<double> difference_um;
    for (int refinement : {1, 2}) {
      const mesh::Mesh mesh = frame(shape, refinement);
      const Eigen::VectorXd theta = steady_by_us(mesh, kFilmed);
      difference_um.push_back(1e6 * largest(displacement_by_us(mesh, theta) - displacement_by_calculix(mesh, theta)));
      RecordProperty(fixtures::name_of(shape) + "_um_" + std::to_string(refinement), text(difference_um.back()));
    }
    EXPECT_LT(difference_um[1], 0.5 * difference_um[0]) << fixtures::name_of(shape);
  }
}

}  // namespace
}  // namespace driftwright::solver::calculix_test
