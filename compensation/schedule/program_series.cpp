#include "compensation/schedule/program_series.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace driftwright::compensation {
namespace {

constexpr double kSameDrift_um = 1e-9;
constexpr std::size_t kMostPoints = 40000;  // of one axis over all parts; a picture cannot show more
constexpr std::size_t kFewestPoints = 200;  // of one part

bool agree(const std::vector<ProgramAxis>& a, const std::vector<ProgramAxis>& b, double resolution_um) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < a[i].drift_um.size(); ++k) {
      if (!(std::abs(a[i].drift_um[k] - b[i].drift_um[k]) <= resolution_um + kSameDrift_um)) return false;
    }
  }
  return true;
}

}  // namespace

double SharedPlan::peak_before_um(std::size_t axis) const {
  double most_um = 0.0;
  for (const std::vector<AxisCourse>& part : courses) most_um = std::max(most_um, part[axis].peak_drift_um);
  return most_um;
}

double SharedPlan::peak_after_um(std::size_t axis) const {
  double most_um = 0.0;
  for (const std::vector<AxisCourse>& part : courses) most_um = std::max(most_um, part[axis].worst_um);
  return most_um;
}

AxisCourse thinned(const AxisCourse& course, std::size_t most) {
  constexpr std::size_t kPerGroup = 4;
  const std::size_t n = course.time_s.size();
  if (n <= most) return course;
  const std::size_t group = kPerGroup * n / most + 1;
  AxisCourse thin;
  thin.peak_drift_um = course.peak_drift_um;
  thin.worst_um = course.worst_um;
  for (std::size_t begin = 0; begin < n; begin += group) {
    const auto from = course.residual_um.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = course.residual_um.begin() + static_cast<std::ptrdiff_t>(std::min(n, begin + group));
    const auto [low, high] = std::minmax_element(from, to);
    for (const std::size_t i : std::set<std::size_t>{begin, static_cast<std::size_t>(low - course.residual_um.begin()),
                                                     static_cast<std::size_t>(high - course.residual_um.begin()),
                                                     std::min(n, begin + group) - 1}) {
      thin.time_s.push_back(course.time_s[i]);
      thin.drift_um.push_back(course.drift_um[i]);
      thin.correction_um.push_back(course.correction_um[i]);
      thin.residual_um.push_back(course.residual_um[i]);
    }
  }
  return thin;
}

std::vector<SharedPlan> plan_series(const std::vector<NcStep>& steps, std::span<const double> time_s,
                                    const std::vector<std::vector<ProgramAxis>>& parts,
                                    const ProgramScheduleOptions& options) {
  const std::size_t most_points = std::max(kFewestPoints, kMostPoints / std::max<std::size_t>(1, parts.size()));
  const auto kept = [&](std::vector<AxisCourse> courses) {
    if (parts.size() > 1) {
      for (AxisCourse& course : courses) course = thinned(course, most_points);
    }
    return courses;
  };
  std::vector<SharedPlan> plans;
  for (int part = 0; part < static_cast<int>(parts.size()); ++part) {
    const std::vector<ProgramAxis>& axes = parts[static_cast<std::size_t>(part)];
    if (!plans.empty() && agree(plans.back().axes, axes, options.resolution_um)) {
      SharedPlan& shared = plans.back();
      shared.last_part = part;
      shared.courses.push_back(kept(courses_of(shared.plan, steps, time_s, axes)));
      continue;
    }
    SharedPlan own{.first_part = part, .last_part = part, .axes = axes, .plan = {}, .courses = {}};
    own.plan = plan_program(steps, time_s, axes, options);
    own.courses.push_back(kept(std::move(own.plan.courses)));
    own.plan.courses.clear();
    plans.push_back(std::move(own));
  }
  return plans;
}

}  // namespace driftwright::compensation
