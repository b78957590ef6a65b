// The place of rotary axes as tables of a report, from errors made by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "findings/volume_measurements.hpp"
#include "output/document_csv.hpp"

namespace driftwright::findings::axis_location_test {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

scenarios::MovingAxis turning(const std::string& name, const Vector3d& direction) {
  return {.name = name,
          .moves = {"table"},
          .way = {.direction = direction, .turns = true},
          .is_endless = true,
          .column = {},
          .where = {}};
}

/// Adds the table of an axis whose place has moved by `still` and tilted by `tilt`, while the work on it has moved, too. The
/// tool is on the axis.
void add_location_of(std::size_t axis, const Vector3d& still_m, const Vector3d& tilt_rad, output::Section& body) {
  const std::vector<scenarios::MovingAxis> axes = {turning("b", Vector3d::UnitY()), turning("c", Vector3d::UnitZ())};
  const scenarios::VolumeSettings settings{.cyclogram = {},
                                           .tool = {"head", {0.0, 0.0, 0.0}, {}},
                                           .work = "table",
                                           .positions_SI = {},
                                           .times_s = {},
                                           .where = {}};
  studies::WorkVolume volume{.time_s = {60.0}, .points = {}, .own = {}, .run = {}};
  for (const double angle_deg : {0.0, 90.0, 200.0}) {
    scenarios::Pose pose = {0.0, 0.0};
    pose[axis] = angle_deg * kDegree;
    const Vector3d of_work_m = axes[axis].way.by(pose[axis]).turn * Vector3d(7e-6, 7e-6, 7e-6);
    volume.points.push_back(
        {.pose = pose, .place_m = Vector3d::Zero(), .error_m = {-still_m - of_work_m}, .turn_rad = {-tilt_rad}});
  }
  std::vector<const studies::VolumePoint*> line;
  for (const studies::VolumePoint& p : volume.points) line.push_back(&p);
  output::Section section{.key = "axes", .item = output::Item{"axis", axes[axis].name}};
  add_axis_location(section, volume, line, settings, axes, axis);
  body.sections.push_back(std::move(section));
}

// Axes of other directions have other columns, so each has a file of its own.
TEST(AxisLocation, OfTwoAxesIsInTwoFiles) {
  output::Document document{.made_by = {}, .title = "volume"};
  add_location_of(0, {3e-6, 0.0, -2e-6}, {5e-6, 0.0, 1e-6}, document.body);
  add_location_of(1, {4e-6, 6e-6, 0.0}, {-8e-6, 2e-6, 0.0}, document.body);
  const std::vector<output::CsvFile> files = output::document_csv(document);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].path, "tables/axis_b_location.csv");
  EXPECT_THAT(files[0].text, HasSubstr("axis,time_min,XO_um,ZO_um,AO_urad,CO_urad,left_um\nb,1,3,-2,5,1,"));
  EXPECT_EQ(files[1].path, "tables/axis_c_location.csv");
  EXPECT_THAT(files[1].text, HasSubstr("axis,time_min,XO_um,YO_um,AO_urad,BO_urad,left_um\nc,1,4,6,-8,2,"));
}

}  // namespace
}  // namespace driftwright::findings::axis_location_test
