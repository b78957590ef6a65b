// Fields as 16-bit numbers, the outside of a mesh, and names that would break out of a page.

#include "output/twin/twin_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>

#include "tests/shared/column_and_head.hpp"

namespace driftwright::output::twin_page_test {
namespace {

using ::testing::HasSubstr, ::testing::Not;

TEST(TwinSurface, KeepsModesToHalfAStepOfSixteenBits) {
  Eigen::MatrixXf modes = Eigen::MatrixXf::Random(400, 3);
  modes.col(1) *= 1e-9F;
  modes.col(2).setZero();
  const Quantised q = quantised(modes);
  for (Eigen::Index c = 0; c < 3; ++c) {
    const double most = modes.col(c).cwiseAbs().maxCoeff();
    for (Eigen::Index r = 0; r < 400; ++r) {
      const double value = q.scale[static_cast<std::size_t>(c)] * q.value[static_cast<std::size_t>(400 * c + r)];
      EXPECT_NEAR(value, modes(r, c), 0.501 * most / 32767.0 + 1e-30);
    }
  }
}

/// Two boxes with fields that say where a node is.
scenarios::ReducedMachine boxes() {
  scenarios::ReducedMachine machine;
  machine.mesh = fixtures::column_and_head();
  const auto n = machine.mesh.n_nodes();
  machine.temperature.resize(n, 2);
  machine.displacement_m.resize(3 * n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    machine.temperature.row(i) << static_cast<float>(machine.mesh.coords(0, i)), 1.0F;
    for (Eigen::Index k = 0; k < 3; ++k)
      machine.displacement_m.row(3 * i + k) << static_cast<float>(machine.mesh.coords(k, i)), 0.0F;
  }
  return machine;
}

TEST(TwinSurface, IsTheOutsideWithTheFieldsOfItsNodes) {
  const scenarios::ReducedMachine machine = boxes();
  const TwinSurface s = twin_surface(machine);
  // Closed: each edge has two triangles, run through in either direction. The outside of both boxes: 2 x 0.14 m^2 and 2 x
  // 0.05 m^2.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  double area_m2 = 0.0;
  for (std::size_t t = 0; t < s.triangle.size(); t += 3) {
    Eigen::Vector3f at[3];
    for (std::size_t k = 0; k < 3; ++k) {
      ++runs[{s.triangle[t + k], s.triangle[t + (k + 1) % 3]}];
      at[k] = s.coords_m.col(s.triangle[t + k]);
    }
    area_m2 += 0.5 * static_cast<double>((at[1] - at[0]).cross(at[2] - at[0]).norm());
  }
  for (const auto& [ends, n] : runs) {
    EXPECT_EQ(n, 1);
    EXPECT_EQ(runs.count({ends.second, ends.first}), 1U);
  }
  EXPECT_NEAR(area_m2, 2 * (0.01 + 2 * 0.03) + 2 * (0.02 + 0.02 + 0.01), 1e-6);
  const auto n = s.node.size();
  EXPECT_LT(n, static_cast<std::size_t>(machine.mesh.n_nodes()));
  for (std::size_t i = 0; i < n; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(s.temperature.scale[0] * s.temperature.value[i], s.coords_m(0, column), 1e-5);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(s.displacement_m.scale[0] * s.displacement_m.value[3 * i + k],
                  s.coords_m(static_cast<Eigen::Index>(k), column), 1e-5);
  }
}

TEST(TwinPage, NamesAreTextWhateverTheyHold) {
  const std::string hostile = "</script><script>alert(1)</script><!-- @SCRIPT@ & \"";
  solver::ReducedSystem system;
  system.mass = system.conduction = Eigen::MatrixXd::Identity(1, 1);
  system.ones = Eigen::VectorXd::Ones(1);
  system.outputs = {
      .name = {hostile}, .unit = {"K"}, .state = Eigen::MatrixXd::Ones(1, 1), .ambient = Eigen::VectorXd::Zero(1)};
  TwinPage page{.name = hostile, .subtitle = hostile, .first = hostile};
  page.model = {.system = system, .start = Eigen::VectorXd::Zero(1), .ambient = {{0.0}, {0.0}}, .notes = {hostile}};
  page.cyclograms = {{.name = hostile, .sections = {{60.0, {}}}}};
  page.check.time_s = {0.0};
  page.check.channels = {{hostile, "degC", {20.0}}};
  page.network = {.node = {hostile, "ambient"}, .link = {{0, 1}}, .temperature = Eigen::MatrixXd::Ones(1, 1)};
  const std::string text = twin_html(page, {"0", hostile});
  EXPECT_THAT(text, Not(HasSubstr("alert(1)<")));
  EXPECT_THAT(text, Not(HasSubstr("<!--")));
  EXPECT_THAT(text, HasSubstr("\\u003c/script>\\u003cscript>alert(1)"));
  std::size_t ends = 0;
  for (std::size_t at = 0; (at = text.find("</script", at)) != std::string::npos; ++at) ++ends;
  EXPECT_EQ(ends, 2U);
  for (const char* loads : {"src=", "http://", "https://", "@import", "fetch(", "url("}) {
    std::string rest = text;
    for (std::size_t at = 0; (at = rest.find("http://www.w3.org/2000/svg")) != std::string::npos;) rest.erase(at, 26);
    EXPECT_THAT(rest, Not(HasSubstr(loads)));
  }
}

}  // namespace
}  // namespace driftwright::output::twin_page_test
