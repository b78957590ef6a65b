// What indicators and tilts of the shipped machine read under rigid motions, known without any solver.

#include "machine/machine.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>

#include "mesh/quality.hpp"

namespace driftwright::scenarios::machine_test {
namespace {

class PlacedFp3 : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scenario_ = read_scenario("scenarios/fp3_spindle.yaml");
    placed_ = place(*scenario_.machine);
  }
  /// Readings, displacements then tilts, under a displacement of the nodes given by their region and position.
  static Eigen::VectorXd readings(const std::function<Eigen::Vector3d(const std::string&, const Eigen::Vector3d&)>& u) {
    const mesh::Mesh& m = placed_.mesh;
    std::vector<std::string> region_of(m.n_nodes());
    for (int c = 0; c < m.cells.size(); ++c) {
      for (int n : m.cells.nodes(c)) region_of[n] = m.regions[m.cells.group[c]];
    }
    Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(placed_.functionals.size()));
    for (std::size_t f = 0; f < placed_.functionals.size(); ++f) {
      for (const auto& [node, weight] : placed_.functionals[f].terms) {
        result[static_cast<Eigen::Index>(f)] += weight.dot(u(region_of[node], m.coords.col(node)));
      }
    }
    return result;
  }
  static inline Scenario scenario_;
  static inline PlacedMachine placed_;
};

const Eigen::Vector3d kTurn(2e-3, -3e-3, 5e-3);  // rad, small
const Eigen::Vector3d kShift(0.1, 0.2, -0.3);    // m

TEST_F(PlacedFp3, AMotionOfTheWholeMachineIsNotSeen) {
  // The stands move and turn with the table, so tool and table keep their places to each other.
  const Eigen::VectorXd r =
      readings([](const auto&, const Eigen::Vector3d& x) -> Eigen::Vector3d { return kShift + kTurn.cross(x); });
  ASSERT_EQ(r.size(), 5);
  EXPECT_LT(r.cwiseAbs().maxCoeff(), 1e-12);  // rounding of positions of 1 m times 1e-3 rad
}

TEST_F(PlacedFp3, AShiftOfToolOrTableIsReadAlongEachAxis) {
  const auto shift_of = [](bool tool) {
    return readings([=](const std::string& region, const Eigen::Vector3d&) -> Eigen::Vector3d {
      const bool is_tool = region == "quill" || region == "spindle";
      return is_tool == tool ? kShift : Eigen::Vector3d::Zero();
    });
  };
  const Eigen::VectorXd tool = shift_of(true), table = shift_of(false);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(tool[axis], kShift[axis], 1e-12);  // error = actual - commanded: the tool is that much too far
    EXPECT_NEAR(table[axis], -kShift[axis], 1e-12);
  }
  EXPECT_LT(tool.tail(2).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(PlacedFp3, ATurnOfTheSpindleIsItsTilt) {
  const Eigen::VectorXd r = readings([](const std::string& region, const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return region == "spindle" ? Eigen::Vector3d(kTurn.cross(x)) : Eigen::Vector3d::Zero();
  });
  EXPECT_NEAR(r[3], kTurn.x(), 1e-12);  // tilt_x, right-handed
  EXPECT_NEAR(r[4], kTurn.z(), 1e-12);
}

TEST_F(PlacedFp3, ATurnOfTheTableIsSeenThroughTheStand) {
  // Only the table turns, about its own foot point of the stand: an indicator at arm a reads -(ω × a), the tilts -ω.
  const auto& d = scenario_.machine->displacements;
  const Eigen::Vector3d foot = d[0].points->table->at_m;
  const Eigen::VectorXd r = readings([&](const std::string& region, const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return region == "table" ? Eigen::Vector3d(kTurn.cross(x - foot)) : Eigen::Vector3d::Zero();
  });
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(r[axis], -kTurn.cross(d[axis].points->tool.at_m - foot)[axis],
                1e-5);  // the tool point was moved onto the mesh: mm x mrad
  }
  EXPECT_NEAR(r[3], -kTurn.x(), 1e-12);
  EXPECT_NEAR(r[4], -kTurn.z(), 1e-12);
}

TEST_F(PlacedFp3, WithoutATableTheToolIsReadAgainstTheGround) {
  MachineModel model = *scenario_.machine;
  for (DisplacementOutput& d : model.displacements) d.points->table.reset();
  const PlacedMachine on_ground = place(model);
  const auto motion = [](const Eigen::Vector3d& x) -> Eigen::Vector3d { return kShift + kTurn.cross(x); };
  for (std::size_t i = 0; i < model.displacements.size(); ++i) {
    double reading_m = 0.0;
    for (const auto& [node, weight] : on_ground.functionals[i].terms) {
      reading_m += weight.dot(motion(on_ground.mesh.coords.col(node)));
    }
    const auto& tool = *model.displacements[i].points;
    EXPECT_NEAR(reading_m, motion(tool.tool.at_m)[tool.axis], 1e-5);  // the tool point was moved onto the mesh: mm x mrad
  }
}

TEST_F(PlacedFp3, MassAndJointAreasAreThoseOfTheDrawing) {
  const mesh::Mesh& m = placed_.mesh;
  // By hand from the scenario: column 480 x 560 x 1150 with walls of 30; knee and table full boxes [mm].
  const double column_l = 1e3 * (0.48 * 0.56 * 1.15 - 0.42 * 0.50 * 1.09);
  EXPECT_NEAR(1e3 * mesh::volume_m3(m, m.region("column")), column_l, 1e-6 * column_l);
  EXPECT_NEAR(1e3 * mesh::volume_m3(m, m.region("knee")), 300 * 400 * 240 * 1e-6, 1e-6);
  // Curved cells: the quill is a tube of 125 x 95 x 480; the few straightened cells cost less than 0.2 %.
  const double quill_l = 1e3 * 3.14159265 / 4 * (0.125 * 0.125 - 0.095 * 0.095) * 0.48;
  EXPECT_NEAR(1e3 * mesh::volume_m3(m, m.region("quill")), quill_l, 2e-3 * quill_l);
  // The quill lies in the headstock on 400 of its 480 mm.
  const double fit_m2 = 3.14159265 * 0.125 * 0.4;
  EXPECT_NEAR(mesh::area_m2(m, m.surface(m.joint("headstock/quill")->side_a)), fit_m2, 2e-3 * fit_m2);
}

}  // namespace
}  // namespace driftwright::scenarios::machine_test
