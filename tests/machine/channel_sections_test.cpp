// Surfaces cut into the sections of a channel: which face belongs to which section, and what is refused.

#include "machine/channel_sections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "effects/flow_path.hpp"
#include "mesh/quality.hpp"
#include "tests/shared/fixtures.hpp"
#include "tests/shared/temporary_file.hpp"

namespace driftwright::scenarios::channel_sections_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

effects::Effect channel(const std::string& along, int sections) {
  return effects::read_effect(
      ConfigMap::read_file(write_file("channel.yaml",
                                      "{type: coolant_channel, surface: z0, flow: 1 L/min, diameter: 8 mm, length: 100 mm, "
                                      "set_point: 20 degC, sections: " +
                                          std::to_string(sections) + ", along: " + along + "}")));
}
/// 80 x 20 x 10 mm in 8 x 2 x 1 bricks.
mesh::Mesh plate() {
  return fixtures::box_mesh({{0, 0, 0}, {0.08, 0.02, 0.01}, {8, 2, 1}, mesh::CellShape::kHex8});
}
constexpr const char* kForward = "[[0 mm, 10 mm, 0 mm], [80 mm, 10 mm, 0 mm]]";
constexpr const char* kBack = "[[80 mm, 10 mm, 0 mm], [0 mm, 10 mm, 0 mm]]";

/// The mean x of a section's facets [mm].
double middle_mm(const mesh::Mesh& m, const std::string& surface) {
  double sum = 0.0;
  const std::vector<int> facets = m.facets_on(m.surface(surface));
  for (const int f : facets) {
    for (const int n : m.facets.nodes(f)) sum += 1e3 * m.coords(0, n) / 4.0;
  }
  return sum / static_cast<double>(facets.size());
}

TEST(ChannelSections, FollowTheLineAndCoverTheSurface) {
  for (const char* along : {kForward, kBack}) {
    MachineModel model;
    model.effects = {channel(along, 4)};
    mesh::Mesh m = plate();
    const int whole = m.surface("z0");
    add_channel_sections(model, m);
    EXPECT_EQ(m.facets_on(whole).size(), 16u);
    double area_m2 = 0.0;
    for (int i = 0; i < 4; ++i) {
      const std::string name = effects::section_name("z0", i, 4);
      ASSERT_GE(m.surface(name), 0);
      area_m2 += mesh::area_m2(m, m.surface(name));
      EXPECT_NEAR(middle_mm(m, name), along == kForward ? 10.0 + 20.0 * i : 70.0 - 20.0 * i, 1e-9);
    }
    EXPECT_NEAR(area_m2, 0.08 * 0.02, 1e-12);
  }
}

TEST(ChannelSections, GoRoundACorner) {
  // Along one row of faces and back along the other: 160 mm of line.
  MachineModel model;
  model.effects = {channel("[[0 mm, 5 mm, 0 mm], [80 mm, 5 mm, 0 mm], [80 mm, 15 mm, 0 mm], [0 mm, 15 mm, 0 mm]]", 2)};
  mesh::Mesh m = plate();
  add_channel_sections(model, m);
  for (int i = 0; i < 2; ++i) {
    for (const int f : m.facets_on(m.surface(effects::section_name("z0", i, 2)))) {
      for (const int n : m.facets.nodes(f)) EXPECT_TRUE(i == 0 ? m.coords(1, n) < 0.011 : m.coords(1, n) > 0.009);
    }
  }
}

TEST(ChannelSections, OfOneSurfaceAreSharedByEntriesOfOneLine) {
  MachineModel model;
  model.effects = {channel(kForward, 4), channel(kForward, 4)};
  mesh::Mesh m = plate();
  const std::size_t before = m.surfaces.size();
  add_channel_sections(model, m);
  EXPECT_EQ(m.surfaces.size(), before + 4);
  model.effects = {channel(kForward, 4), channel(kBack, 4)};
  EXPECT_THAT(
      [&] {
        mesh::Mesh other = plate();
        add_channel_sections(model, other);
      },
      ThrowsMessage<InputError>(HasSubstr("along another line")));
}

TEST(ChannelSections, WithoutAFaceAreRefused) {
  MachineModel model;
  model.effects = {channel(kForward, 9)};
  EXPECT_THAT(
      [&] {
        mesh::Mesh m = plate();
        add_channel_sections(model, m);
      },
      ThrowsMessage<InputError>(
          AllOf(HasSubstr("of 9 of surface 'z0' has no face"), HasSubstr("`sections: 8`"), HasSubstr("channel.yaml"))));
}

}  // namespace
}  // namespace driftwright::scenarios::channel_sections_test
