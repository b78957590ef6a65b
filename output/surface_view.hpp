#pragma once
// Draws a body's surface from one side, by a depth buffer into pixels: without display or driver, with the same bytes
// everywhere. (VTK of Debian 12 draws only through an X server.)

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace driftwright::output {

/// Triangles with a colour at each corner.
struct ColouredSurface {
  Eigen::Matrix3Xd point;                    ///< 3 x n_points, any unit of length
  std::vector<std::array<int, 3>> triangle;  ///< counterclockwise from outside
  std::vector<std::array<float, 3>> colour;  ///< of each point: red, green, blue, 0 to 1
  std::vector<int> part;                     ///< of each triangle; edges are drawn where parts meet
};

/// An orthographic view: `towards` points from the body to the eye, `up` is the picture's upward direction as far as
/// possible.
struct View {
  Eigen::Vector3d towards = {1.0, 1.0, 0.6};
  Eigen::Vector3d up = {0.0, 0.0, 1.0};
};

/// A drawn view.
struct DrawnView {
  int width = 0, height = 0;             ///< pixels
  std::string png;                       ///< bytes of a PNG; the background is transparent
  Eigen::Matrix<double, 2, 4> to_pixel;  ///< maps a homogeneous point
  Eigen::Matrix<double, 1, 3> depth;     ///< maps a point; larger means nearer to the eye

  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& point) const {
    return to_pixel.leftCols<3>() * point + to_pixel.col(3);
  }
  /// Whether the surface hides a point that lies more than `slack` behind it [unit of the points].
  [[nodiscard]] bool hides(const Eigen::Vector3d& point, double slack) const;

  std::vector<float> nearest;  ///< depth buffer, row by row from the top; -infinity where nothing is
};

/// @param width, height  of the picture; the surface fills it except for a margin
/// @throws std::logic_error  for a surface without triangles, or a triangle with missing points
[[nodiscard]] DrawnView draw_surface(const ColouredSurface& surface, const View& view, int width, int height);

/// A colour of the map "inferno" (Smith & van der Walt, 2015), from dark to bright; suitable for the colour-blind.
/// @param share  0 to 1
[[nodiscard]] std::array<float, 3> inferno(double share);
/// Colours for categories, Okabe & Ito 2008; lighter with each repetition.
[[nodiscard]] std::array<float, 3> distinct_colour(int index);

}  // namespace driftwright::output
