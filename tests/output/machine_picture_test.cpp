#include "output/machine_picture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "tests/shared/fixtures.hpp"

namespace driftwright::output::machine_picture_test {
namespace {

using ::testing::HasSubstr, ::testing::Not;

mesh::Mesh box() {
  return fixtures::box_mesh({.size_m = {0.1, 0.1, 0.2}, .n = {2, 2, 4}});
}

TEST(MachinePicture, NamesSurfacesAndMarks) {
  mesh::Mesh mesh = box();
  const std::string plain =
      draw_machine({.mesh = &mesh, .marks = {{"t<1>", {0.0, 0.05, 0.1}}, {"nose", {0.1, 0.1, 0.2}, true}}});
  for (const std::string& surface : mesh.surfaces) EXPECT_THAT(plain, HasSubstr(">" + surface + "</text>"));
  EXPECT_THAT(plain, HasSubstr(">t&lt;1&gt;</text>"));
  EXPECT_THAT(plain, HasSubstr(">nose</text>"));
  EXPECT_THAT(plain, Not(HasSubstr("temperature")));
  // A side of a joint lies inside: it has neither a colour nor a name.
  mesh.surfaces.front() = "a/b@a";
  EXPECT_THAT(draw_machine({.mesh = &mesh}), Not(HasSubstr("a/b@a")));
}

TEST(MachinePicture, ShowsTheRangeOfAFieldAndARoundMagnification) {
  const mesh::Mesh mesh = box();
  Eigen::Matrix3Xd up_m = Eigen::Matrix3Xd::Zero(3, mesh.n_nodes());
  up_m.row(2) = 1e-5 / 0.2 * mesh.coords.row(2);
  const std::string drawn =
      draw_machine({.mesh = &mesh,
                    .field = PictureField{"temperature [°C]", 20.0 + 50.0 * mesh.coords.row(2).transpose().array()},
                    .displacement_m = up_m});
  for (const char* tick : {">20.0<", ">22.5<", ">25.0<", ">27.5<", ">30.0<", ">temperature [°C]<"})
    EXPECT_THAT(drawn, HasSubstr(tick));
  // A twentieth of the diagonal, 0.245 m, is 1225 times 10 µm: 1000 of 1, 2 and 5 times a power of ten.
  EXPECT_THAT(drawn, HasSubstr("displacement magnified 1000 times"));
}

// Half of the box has no value: its range is that of the other half.
TEST(MachinePicture, LeavesNodesWithoutAValueOutOfTheRange) {
  const mesh::Mesh mesh = box();
  Eigen::VectorXd value = 20.0 + 50.0 * mesh.coords.row(2).transpose().array();
  const std::string whole = draw_machine({.mesh = &mesh, .field = PictureField{"left [µm]", value}});
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    if (mesh.coords(2, i) > 0.1 + 1e-9) value[i] = std::nan("");
  }
  const std::string half = draw_machine({.mesh = &mesh, .field = PictureField{"left [µm]", value}});
  EXPECT_THAT(whole, HasSubstr(">30.0<"));
  EXPECT_THAT(half, HasSubstr(">25.0<"));
  EXPECT_THAT(half, Not(HasSubstr(">30.0<")));
}

// Nodes on the edge of a surface are nodes of its neighbours, which must not get its colour. Its faces may belong to a surface
// that comes later, too, such as a joint's side.
TEST(MachinePicture, ColoursOneSurfaceAndNoneOfItsNeighbours) {
  mesh::Mesh mesh = box();
  const auto x0 = std::find(mesh.surfaces.begin(), mesh.surfaces.end(), "x0");
  ASSERT_NE(x0, mesh.surfaces.end());
  const auto surface = static_cast<int>(x0 - mesh.surfaces.begin());
  Eigen::VectorXd on_x0 = Eigen::VectorXd::Constant(mesh.n_nodes(), std::nan("")), inside = on_x0;
  for (Eigen::Index i = 0; i < mesh.n_nodes(); ++i) {
    if (mesh.coords(0, i) == 0.0) on_x0[i] = 5.0 + mesh.coords(2, i);
    if ((mesh.coords.col(i) - Eigen::Vector3d(0.05, 0.05, 0.1)).norm() < 1e-9) inside[i] = 5.0;
  }
  const auto views = [&](const PictureField& field) {
    std::vector<std::string> png;
    const std::string drawn = draw_machine({.mesh = &mesh, .field = field}), key = "base64,";
    for (std::size_t at = drawn.find(key); at != std::string::npos; at = drawn.find(key, at + 1))
      png.push_back(drawn.substr(at, drawn.find('"', at) - at));
    return png;
  };
  const std::vector<std::string> one = views({"film", on_x0, surface}), grey = views({"film", inside});
  ASSERT_EQ(one.size(), 2U);
  EXPECT_TRUE(one[0] == grey[0]) << "from +x, +y no face of x0 is seen";
  EXPECT_TRUE(one[1] != grey[1]) << "from -x, -y x0 is seen";
  mesh.surfaces.push_back("a/b@x0");
  for (const int facet : mesh.facets_on(surface)) {
    const auto of_facet = mesh.facets.nodes(facet);
    const std::vector<int> nodes(of_facet.begin(), of_facet.end());  // add() may move them
    mesh.facets.add(mesh.facets.shape[static_cast<std::size_t>(facet)], nodes, static_cast<int>(mesh.surfaces.size()) - 1);
  }
  EXPECT_TRUE(views({"film", on_x0, surface}) == one) << "its faces belong to a side of a joint, too";
}

TEST(MachinePicture, KeepsAllNamesInside) {
  const mesh::Mesh mesh = box();
  std::vector<PictureMark> marks;
  for (int i = 0; i < 80; ++i) marks.push_back({fmt::format("t{}", i), {0.0, 0.05, 0.2 * i / 80.0}});
  const std::string drawn = draw_machine({.mesh = &mesh, .marks = marks});
  const std::regex text("<text x=\"[^\"]*\" y=\"([^\"]*)\"");
  int n = 0;
  for (std::sregex_iterator t(drawn.begin(), drawn.end(), text), end; t != end; ++t, ++n) EXPECT_GT(std::stod((*t)[1]), 8.0);
  EXPECT_GT(n, 60);
  EXPECT_THAT(drawn, HasSubstr(">and 50 more<"));
}

// Names must not be cut at the picture's edge: DejaVu Sans, the widest of the usual fonts, has 6.7 of 11 units a letter
// in the mean of lower case.
TEST(MachinePicture, HasRoomForLongNames) {
  const mesh::Mesh mesh = box();
  const std::string name = "t_headstock_bearing_front_outer_ring";
  const std::string drawn = draw_machine({.mesh = &mesh, .marks = {{name, {0.0, 0.05, 0.1}}, {"drift", {0.1, 0.1, 0.2}}}});
  std::smatch box;
  ASSERT_TRUE(std::regex_search(drawn, box, std::regex("viewBox=\"0 0 ([0-9.]+) ")));
  const double needed = 6.7 * static_cast<double>(name.size()), width = std::stod(box[1]);
  const std::regex text("<text x=\"([^\"]*)\" y=\"[^\"]*\" text-anchor=\"(end|start)\"[^>]*>" + name);
  int n = 0;
  for (std::sregex_iterator t(drawn.begin(), drawn.end(), text), end; t != end; ++t, ++n) {
    const double x = std::stod((*t)[1]);
    EXPECT_GT((*t)[2] == "end" ? x : width - x, needed);
  }
  EXPECT_EQ(n, 2);
}

TEST(MachinePicture, NamesRegions) {
  const mesh::Mesh mesh = fixtures::box_mesh({.size_m = {0.1, 0.1, 0.2}, .n = {2, 2, 4}});
  const std::string drawn = draw_machine({.mesh = &mesh, .by_region = true});
  for (const std::string& region : mesh.regions) EXPECT_THAT(drawn, HasSubstr(">" + region + "</text>"));
  for (const std::string& surface : mesh.surfaces) EXPECT_THAT(drawn, Not(HasSubstr(">" + surface + "</text>")));
  EXPECT_THAT(drawn, Not(HasSubstr("without a name")));
}

TEST(MachinePicture, OfAnotherMeshIsOurMistake) {
  const mesh::Mesh mesh = box();
  EXPECT_THROW((void)draw_machine({.mesh = &mesh, .field = PictureField{"x", Eigen::VectorXd::Zero(3)}}), std::logic_error);
  const mesh::Mesh nothing;
  EXPECT_THROW((void)draw_machine({.mesh = &nothing}), std::logic_error);
}

}  // namespace
}  // namespace driftwright::output::machine_picture_test
