#include "findings/machine_section.hpp"

#include <gmock/gmock.h>

#include "tests/shared/fixtures.hpp"

namespace driftwright::findings::machine_section_test {
namespace {

using ::testing::HasSubstr;

scenarios::WholeFields bent(double time_s, double um, Eigen::Index n_nodes) {
  scenarios::WholeFields fields{
      .time_s = time_s, .temperature_degC = Eigen::VectorXd::Constant(n_nodes, 20.0), .displacement_um = {}};
  fields.displacement_um = Eigen::Matrix3Xd::Zero(3, n_nodes);
  fields.displacement_um(0, n_nodes / 2) = um;
  return fields;
}

TEST(WorstMoment, IsThatOfTheLargestDisplacementOfAnyNode) {
  WorstMoment worst;
  EXPECT_FALSE(worst.fields());
  for (const auto& [time_s, um] :
       {std::pair{0.0, 0.0}, std::pair{60.0, -7.0}, std::pair{120.0, 5.0}, std::pair{180.0, std::nan("")}})
    worst.take(bent(time_s, um, 9));
  ASSERT_TRUE(worst.fields());
  EXPECT_EQ(worst.fields()->time_s, 60.0);
}

TEST(AddMachine, ShowsFieldsElseSurfacesAndNothingWithoutAMesh) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.2}, .n = {1, 1, 2}});
  scenarios::MachineModel machine;
  machine.sensors = {{"t1", scenarios::PointOnRegion{"body", {0.0, 0.05, 0.1}, {}}, {}},
                     {"air", std::string("ambient"), {}}};
  const auto shown = [&](const mesh::Mesh& of, const WorstMoment& worst) {
    output::Section body;
    add_machine(body, machine, of, "shift", worst);
    return body.blocks;
  };
  WorstMoment worst;
  EXPECT_TRUE(shown({}, worst).empty());
  const auto surfaces = shown(mesh, worst);
  ASSERT_EQ(surfaces.size(), 1u);
  EXPECT_THAT(std::get<output::Picture>(surfaces[0]).title, HasSubstr("Named surfaces"));
  EXPECT_THAT(std::get<output::Picture>(surfaces[0]).svg, HasSubstr(">t1</text>"));
  worst.take(bent(5400.0, 12.34, mesh.n_nodes()));
  EXPECT_EQ(std::get<output::Picture>(shown(mesh, worst).at(0)).title,
            "'shift' after 90 min, when of all stored fields the machine is bent most: up to 12.3 µm");
}

}  // namespace
}  // namespace driftwright::findings::machine_section_test
