#include "output/surface_view.hpp"

#include <gmock/gmock.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <cmath>

namespace driftwright::output::surface_view_test {
namespace {

/// A unit cube, each face in the colour of its direction and a part of its own.
ColouredSurface cube() {
  ColouredSurface s;
  s.point.resize(3, 24);
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const double side = face % 2;
    for (int k = 0; k < 4; ++k) {
      Eigen::Vector3d x;
      x[axis] = side;
      x[u] = k == 1 || k == 2 ? 1.0 : 0.0;
      x[v] = k >= 2 ? 1.0 : 0.0;
      s.point.col(4 * face + k) = x;
      std::array<float, 3> colour{};
      colour[static_cast<std::size_t>(axis)] = 1.0F;
      s.colour.push_back(colour);
    }
    const int n = 4 * face;
    if (face % 2 == 1) {
      s.triangle.push_back({n, n + 1, n + 2});
      s.triangle.push_back({n, n + 2, n + 3});
    } else {
      s.triangle.push_back({n, n + 2, n + 1});
      s.triangle.push_back({n, n + 3, n + 2});
    }
    s.part.insert(s.part.end(), 2, face);
  }
  return s;
}

struct Pixels {
  int width, height;
  std::vector<std::array<int, 4>> rgba;  ///< row by row from the top
  [[nodiscard]] const std::array<int, 4>& at(int x, int y) const { return rgba[static_cast<std::size_t>(y) * width + x]; }
};

Pixels decoded(const std::string& png) {
  vtkNew<vtkPNGReader> reader;
  reader->SetMemoryBuffer(png.data());
  reader->SetMemoryBufferLength(static_cast<vtkIdType>(png.size()));
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  Pixels p{image->GetDimensions()[0], image->GetDimensions()[1], {}};
  for (int y = p.height - 1; y >= 0; --y) {
    for (int x = 0; x < p.width; ++x) {
      const auto* v = static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0));
      p.rgba.push_back({v[0], v[1], v[2], v[3]});
    }
  }
  return p;
}

TEST(SurfaceView, ACubeFromItsCornerIsAHexagonOfThreeColours) {
  // Along the diagonal a unit cube is a regular hexagon of side sqrt(2/3), area sqrt(3); it fills 96 % of the height 2
  // sqrt(2/3).
  const DrawnView drawn = draw_surface(cube(), {.towards = {1.0, 1.0, 1.0}}, 400, 400);
  const Pixels p = decoded(drawn.png);
  ASSERT_EQ(p.width, 400);
  double covered = 0.0;
  for (const auto& c : p.rgba) covered += c[3] / 255.0;
  const double scale = 0.96 * 400.0 / (2.0 * std::sqrt(2.0 / 3.0));
  EXPECT_NEAR(covered, std::sqrt(3.0) * scale * scale, 0.01 * covered);  // its outline is half a pixel wide
  // x to the right in front? +x and +y faces side by side below, +z above.
  EXPECT_GT(p.at(200, 100)[2], 100);
  EXPECT_EQ(p.at(200, 100)[0] + p.at(200, 100)[1], 0);
  const auto left = p.at(110, 260), right = p.at(290, 260);
  EXPECT_GT(left[0], 80);  // looking against (1, 1, 1) with z up, +x is to the left
  EXPECT_GT(right[1], 80);
  EXPECT_EQ(p.at(3, 3)[3], 0);
}

TEST(SurfaceView, PointsAreWhereTheyAreDrawnAndHiddenWhereABodyIsBefore) {
  const DrawnView drawn = draw_surface(cube(), {.towards = {0.0, 0.0, 1.0}, .up = {0.0, 1.0, 0.0}}, 200, 100);
  EXPECT_LT((drawn.pixel({0.5, 0.5, 0.3}) - Eigen::Vector2d(100, 50)).norm(), 1e-9);
  EXPECT_LT((drawn.pixel({1.0, 1.0, 0.0}) - Eigen::Vector2d(148, 2)).norm(), 1e-9);  // 96 px a unit, up is up
  EXPECT_TRUE(drawn.hides({0.5, 0.5, 0.5}, 0.01));
  EXPECT_FALSE(drawn.hides({0.5, 0.5, 1.0}, 0.01));
  EXPECT_FALSE(drawn.hides({1.2, 0.5, 0.0}, 0.01));
}

TEST(SurfaceView, EdgesAreDarkerThanFaces) {
  const DrawnView drawn = draw_surface(cube(), {.towards = {1.0, 1.0, 1.0}}, 400, 400);
  const Pixels p = decoded(drawn.png);
  int darkest = 255;  // along a row that crosses the edge between +x and +y
  for (int x = 190; x < 210; ++x) darkest = std::min(darkest, std::max(p.at(x, 300)[0], p.at(x, 300)[1]));
  EXPECT_LT(darkest, 0.8 * p.at(110, 300)[0]);
}

TEST(SurfaceView, RefusesWhatIsNoSurface) {
  ColouredSurface s = cube();
  s.triangle[0][1] = 99;
  EXPECT_THROW((void)draw_surface(s, {}, 10, 10), std::logic_error);
  EXPECT_THROW((void)draw_surface({}, {}, 10, 10), std::logic_error);
}

TEST(Inferno, BrightensAllTheWay) {
  double before = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const auto c = inferno(i / 100.0);
    const double luminance = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    EXPECT_GT(luminance, before - 1e-3) << i;
    before = luminance;
  }
}

}  // namespace
}  // namespace driftwright::output::surface_view_test
