#include "output/surface_view.hpp"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace driftwright::output {
namespace {

constexpr int kFiner = 2;  // samples per pixel along each side
constexpr float kNothing = -std::numeric_limits<float>::infinity();

/// The nearest triangle at each sample.
struct Samples {
  int width, height;
  std::vector<float> depth;
  std::vector<std::array<float, 3>> colour;
  std::vector<int> triangle;

  Samples(int w, int h)
      : width(w),
        height(h),
        depth(static_cast<std::size_t>(w) * h, kNothing),
        colour(depth.size()),
        triangle(depth.size(), -1) {}
  [[nodiscard]] std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
};

struct Projection {
  Eigen::Vector3d right, up, towards;
  double scale = 1.0;
  Eigen::Vector2d shift;
};

Projection project(const ColouredSurface& surface, const View& view, int width, int height) {
  Projection p;
  p.towards = view.towards.normalized();
  p.right = view.up.cross(p.towards).normalized();
  p.up = p.towards.cross(p.right);
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& t : surface.triangle) {
    for (int n : t) {
      const Eigen::Vector3d x = surface.point.col(n);
      const Eigen::Vector2d q(p.right.dot(x), -p.up.dot(x));
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
  }
  const Eigen::Vector2d size = (high - low).cwiseMax(1e-12);
  constexpr double kFilled = 0.96;
  p.scale = kFilled * std::min(width / size[0], height / size[1]);
  p.shift = 0.5 * Eigen::Vector2d(width, height) - 0.5 * p.scale * (low + high);
  return p;
}

/// Fills a triangle's samples; light comes from the eye, from above and from the right.
void fill(Samples& samples, const ColouredSurface& surface, int index, const Projection& p, int finer) {
  const auto& t = surface.triangle[static_cast<std::size_t>(index)];
  std::array<Eigen::Vector2d, 3> q;
  std::array<double, 3> depth{};
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d x = surface.point.col(t[i]);
    q[i] = finer * (p.scale * Eigen::Vector2d(p.right.dot(x), -p.up.dot(x)) + p.shift);
    depth[i] = p.towards.dot(x);
  }
  const Eigen::Vector3d a = surface.point.col(t[0]), b = surface.point.col(t[1]), c = surface.point.col(t[2]);
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  const Eigen::Vector3d light = (p.towards + 0.5 * p.up + 0.3 * p.right).normalized();
  const auto shade = static_cast<float>(0.5 + 0.5 * std::abs(normal.dot(light)));
  const double area = (q[1] - q[0]).x() * (q[2] - q[0]).y() - (q[1] - q[0]).y() * (q[2] - q[0]).x();
  if (std::abs(area) < 1e-12) return;
  const auto [x_low, x_high] = std::minmax({q[0].x(), q[1].x(), q[2].x()});
  const auto [y_low, y_high] = std::minmax({q[0].y(), q[1].y(), q[2].y()});
  for (int y = std::max(0, static_cast<int>(y_low)); y <= std::min(samples.height - 1, static_cast<int>(y_high)); ++y) {
    for (int x = std::max(0, static_cast<int>(x_low)); x <= std::min(samples.width - 1, static_cast<int>(x_high)); ++x) {
      const Eigen::Vector2d s(x + 0.5, y + 0.5);
      const auto part = [&](int i, int j) {
        return ((q[j] - q[i]).x() * (s - q[i]).y() - (q[j] - q[i]).y() * (s - q[i]).x()) / area;
      };
      const double w2 = part(0, 1), w0 = part(1, 2), w1 = 1.0 - w0 - w2;
      constexpr double kRounding = -1e-9;  // leaves no gap between neighbouring triangles
      if (w0 < kRounding || w1 < kRounding || w2 < kRounding) continue;
      const auto here = static_cast<float>(w0 * depth[0] + w1 * depth[1] + w2 * depth[2]);
      const std::size_t at = samples.at(x, y);
      if (here <= samples.depth[at]) continue;
      samples.depth[at] = here;
      samples.triangle[at] = index;
      for (int k = 0; k < 3; ++k) {
        const auto mixed =
            static_cast<float>(w0 * surface.colour[t[0]][k] + w1 * surface.colour[t[1]][k] + w2 * surface.colour[t[2]][k]);
        samples.colour[at][k] = shade * mixed;
      }
    }
  }
}

/// Darkens samples at the border of another part, or of a face at another angle, so that the shape can be seen.
void draw_edges(Samples& samples, const ColouredSurface& surface) {
  std::vector<Eigen::Vector3d> normal;
  for (const auto& t : surface.triangle) {
    const Eigen::Vector3d a = surface.point.col(t[0]), b = surface.point.col(t[1]), c = surface.point.col(t[2]);
    normal.push_back((b - a).cross(c - a).normalized());
  }
  const double size = (surface.point.rowwise().maxCoeff() - surface.point.rowwise().minCoeff()).norm();
  constexpr double kCosine = 0.87;  // 30 degrees
  const auto differ = [&](std::size_t a, std::size_t b) {
    const int i = samples.triangle[a], j = samples.triangle[b];
    if (i == j) return false;
    if (i < 0 || j < 0) return true;
    if (std::abs(samples.depth[a] - samples.depth[b]) > 0.02 * size) return true;
    return surface.part[i] != surface.part[j] || normal[i].dot(normal[j]) < kCosine;
  };
  std::vector<bool> is_edge(samples.depth.size(), false);
  for (int y = 0; y + 1 < samples.height; ++y) {
    for (int x = 0; x + 1 < samples.width; ++x) {
      const std::size_t at = samples.at(x, y);
      if (differ(at, at + 1) || differ(at, at + static_cast<std::size_t>(samples.width))) is_edge[at] = true;
    }
  }
  for (std::size_t i = 0; i < is_edge.size(); ++i) {
    if (!is_edge[i]) continue;
    if (samples.triangle[i] < 0) {
      samples.colour[i] = {0.25F, 0.25F, 0.25F};
      samples.triangle[i] = 0;  // makes an outline opaque
    } else {
      for (float& k : samples.colour[i]) k *= 0.45F;
    }
  }
}

std::string png_of(const Samples& samples, int width, int height) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(width, height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::array<float, 3> sum{};
      int n = 0;
      for (int k = 0; k < kFiner * kFiner; ++k) {
        const std::size_t at = samples.at(kFiner * x + k % kFiner, kFiner * y + k / kFiner);
        if (samples.triangle[at] < 0) continue;
        ++n;
        for (int c = 0; c < 3; ++c) sum[c] += samples.colour[at][c];
      }
      auto* pixel =
          static_cast<unsigned char*>(image->GetScalarPointer(x, height - 1 - y, 0));  // VTK counts rows from the bottom
      for (int c = 0; c < 3; ++c) {
        const float mean = n > 0 ? sum[c] / static_cast<float>(n) : 0.0F;
        pixel[c] = static_cast<unsigned char>(std::lround(255.0F * std::clamp(mean, 0.0F, 1.0F)));
      }
      pixel[3] = static_cast<unsigned char>(255 * n / (kFiner * kFiner));
    }
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  const vtkUnsignedCharArray* bytes = writer->GetResult();
  auto* result = const_cast<vtkUnsignedCharArray*>(bytes);
  return {reinterpret_cast<const char*>(result->GetPointer(0)), static_cast<std::size_t>(result->GetNumberOfTuples())};
}

}  // namespace

bool DrawnView::hides(const Eigen::Vector3d& point, double slack) const {
  const Eigen::Vector2d at = pixel(point);
  const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
  if (x < 0 || y < 0 || x >= width || y >= height) return false;
  return nearest[static_cast<std::size_t>(y) * width + x] > (depth * point).value() + slack;
}

DrawnView draw_surface(const ColouredSurface& surface, const View& view, int width, int height) {
  if (surface.triangle.empty()) throw std::logic_error("draw_surface: there is no triangle");
  for (const auto& t : surface.triangle) {
    for (int n : t) {
      if (n < 0 || n >= surface.point.cols())
        throw std::logic_error("draw_surface: a triangle of a point that does not exist");
    }
  }
  const Projection p = project(surface, view, width, height);
  Samples samples(kFiner * width, kFiner * height);
  for (int i = 0; i < static_cast<int>(surface.triangle.size()); ++i) fill(samples, surface, i, p, kFiner);
  DrawnView drawn{
      .width = width, .height = height, .png = {}, .to_pixel = {}, .depth = p.towards.transpose(), .nearest = {}};
  drawn.to_pixel.row(0) << p.scale * p.right.transpose(), p.shift[0];
  drawn.to_pixel.row(1) << -p.scale * p.up.transpose(), p.shift[1];
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) drawn.nearest.push_back(samples.depth[samples.at(kFiner * x, kFiner * y)]);
  }
  draw_edges(samples, surface);
  drawn.png = png_of(samples, width, height);
  return drawn;
}

std::array<float, 3> inferno(double share) {
  constexpr std::array<std::array<float, 3>, 9> kStops = {{{0.001F, 0.000F, 0.014F},
                                                           {0.122F, 0.047F, 0.283F},
                                                           {0.341F, 0.062F, 0.429F},
                                                           {0.536F, 0.134F, 0.415F},
                                                           {0.736F, 0.216F, 0.330F},
                                                           {0.894F, 0.347F, 0.198F},
                                                           {0.978F, 0.557F, 0.035F},
                                                           {0.975F, 0.786F, 0.168F},
                                                           {0.988F, 0.998F, 0.645F}}};
  const double at = std::clamp(share, 0.0, 1.0) * 8.0;
  const auto low = static_cast<std::size_t>(std::min(7.0, std::floor(at)));
  const auto part = static_cast<float>(at - static_cast<double>(low));
  std::array<float, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k) colour[k] = kStops[low][k] + part * (kStops[low + 1][k] - kStops[low][k]);
  return colour;
}

std::array<float, 3> distinct_colour(int index) {
  constexpr std::array<std::array<float, 3>, 7> kColours = {{{0.337F, 0.706F, 0.914F},
                                                             {0.902F, 0.624F, 0.000F},
                                                             {0.000F, 0.620F, 0.451F},
                                                             {0.941F, 0.894F, 0.259F},
                                                             {0.800F, 0.475F, 0.655F},
                                                             {0.835F, 0.369F, 0.000F},
                                                             {0.000F, 0.447F, 0.698F}}};
  std::array<float, 3> colour = kColours[static_cast<std::size_t>(index) % kColours.size()];
  const float lighter = 1.0F - 1.0F / (1.0F + 0.6F * static_cast<float>(index / static_cast<int>(kColours.size())));
  for (float& k : colour) k += lighter * (1.0F - k);
  return colour;
}

}  // namespace driftwright::output
