#include "compensation/program_series.hpp"

#include <algorithm>
#include <cmath>

namespace driftwright::compensation {
namespace {

constexpr double kRounding_um = 1e-9;

bool agree(const std::vector<ProgramAxis>& a, const std::vector<ProgramAxis>& b, double resolution_um) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < a[i].drift_um.size(); ++k) {
      if (!(std::abs(a[i].drift_um[k] - b[i].drift_um[k]) <= resolution_um + kRounding_um)) return false;
    }
  }
  return true;
}

}  // namespace

double SharedPlan::peak_before_um(std::size_t axis) const {
  double most_um = 0.0;
  for (const std::vector<AxisCourse>& part : courses) {
    for (double d_um : part[axis].drift_um) most_um = std::max(most_um, std::abs(d_um));
  }
  return most_um;
}

double SharedPlan::peak_after_um(std::size_t axis) const {
  double most_um = 0.0;
  for (const std::vector<AxisCourse>& part : courses) most_um = std::max(most_um, part[axis].worst_um);
  return most_um;
}

std::vector<SharedPlan> plan_series(const std::vector<NcStep>& steps, std::span<const double> time_s,
                                    const std::vector<std::vector<ProgramAxis>>& parts,
                                    const ProgramScheduleOptions& options) {
  std::vector<SharedPlan> plans;
  for (int part = 0; part < static_cast<int>(parts.size()); ++part) {
    const std::vector<ProgramAxis>& axes = parts[static_cast<std::size_t>(part)];
    if (!plans.empty() && agree(plans.back().axes, axes, options.resolution_um)) {
      SharedPlan& shared = plans.back();
      shared.last_part = part;
      shared.courses.push_back(courses_of(shared.plan, steps, time_s, axes));
      continue;
    }
    SharedPlan own{.first_part = part, .last_part = part, .axes = axes, .plan = {}, .courses = {}};
    own.plan = plan_program(steps, time_s, axes, options);
    own.courses.push_back(own.plan.courses);
    plans.push_back(std::move(own));
  }
  return plans;
}

}  // namespace driftwright::compensation
