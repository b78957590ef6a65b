#pragma once
// Carries the values of a file onto the faces of a surface, so that the integral of a film coefficient is kept.

#include <limits>
#include <vector>

#include "effects/surface_field.hpp"
#include "mesh/mesh.hpp"

namespace driftwright::solver {

/// A quadrature point of a face that belongs to one value of the file.
struct FilmPoint {
  int facet = -1;
  int value = -1;                                ///< column of SurfaceField::point_m; -1: the file does not cover it
  Eigen::Vector3d xi = Eigen::Vector3d::Zero();  ///< reference coordinates in the facet
  double area_m2 = 0.0;  ///< weight; negative where a covered part is taken out of a whole face that is not covered
};

/// All faces of a surface, cut into the parts that belong to the values of a file.
struct FilmMapping {
  std::vector<FilmPoint> points;  ///< facet by facet
  double reach_m = 0.0;           ///< that was used
  double area_m2 = 0.0;           ///< of the surface
  double uncovered_m2 = 0.0;      ///< part of it that the file does not cover
  /// Middle of the largest face that is not covered at all or in part.
  Eigen::Vector3d uncovered_at_m = Eigen::Vector3d::Zero();

  /// ∫ h dA over the covered part, of a pattern [W/K].
  [[nodiscard]] double film_W_K(const effects::FieldPart& part) const;
};

/// Cuts each face of a surface into convex pieces, one a value of the file, and places quadrature points in each; they
/// integrate N_i N_j exactly over each piece of a plane face with straight edges. So ∫ h N_i N_j dA holds the file's
/// resolution even in faces that are much larger than its cells (Farrell et al., Comput. Methods Appl. Mech. Engrg. 198
/// (2009) 2632: integration on the intersections of both meshes).
///
/// Cells: a piece is the intersection of the face with a cell, projected along the face's normal. Where both lie in one
/// plane, ∫ h dA = Σ_c h_c A_c, exactly, cell by cell, on triangles and parallelograms. Another face of four corners is cut
/// in reference coordinates, where straight lines are curved: its whole area is exact, and borders between cells within it
/// are shifted. Cells that make an angle of more than 60° with the face, or whose middle is further than `reach` from its
/// plane, do not count. A part of a face at the edge of the file that is no wider than `reach` (its area over the side of a
/// square, or half a square, as large as the face) is covered by the face's other pieces, which count for the whole face; a
/// face without any piece takes the nearest cell within `reach`, and within 60°. Where a cell that faces the other way is
/// nearer to the face, as at a thin wall, the farther one does not count; where other cells overlap, the mean counts.
///
/// Points: a piece is the part of the face that is nearer to a point than to any other and within `reach` of it (in the
/// plane of the face, within the octagon about that circle). ∫ h dA = Σ_p h_p A_p with A_p the area of the faces' parts that
/// are nearest to p, because points have no areas of their own.
///
/// Curved faces are cut as plane ones with the same corners; the points are then on the curved face, with its areas.
/// @param reach_m  > 0; NaN: 2 x the largest distance from a point to its nearest neighbour (on a square grid of points no
///                 place is farther than 0.71 of that; 2 leaves room for grids up to 3.9 times as wide one way as the
///                 other), or the square root of the area of the largest cell
[[nodiscard]] FilmMapping map_film(const mesh::Mesh& mesh, int surface, const effects::SurfaceField& field,
                                   double reach_m = std::numeric_limits<double>::quiet_NaN());

}  // namespace driftwright::solver
