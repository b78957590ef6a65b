#include "scenarios/reader/read_mechanics.hpp"

#include <fmt/format.h>

namespace driftwright::scenarios {
namespace {

/// Softer springs drown in the rounding of the machine's own stiffness, stiffer ones drown it.
constexpr double kSoftest_N_m = 1e3, kStiffest_N_m = 1e13;

void check_stiffness(const ConfigMap& in, const std::string& key, double stiffness_N_m) {
  if (stiffness_N_m == 0.0 || (stiffness_N_m >= kSoftest_N_m && stiffness_N_m <= kStiffest_N_m)) return;
  in.fail(key, fmt::format("{:g} N/m lies outside what is allowed, 0 N/m or {:g} to {:g} N/m", stiffness_N_m, kSoftest_N_m,
                           kStiffest_N_m));
}

double read_stiffness_N_m(const ConfigMap& in, const std::string& key) {
  const double stiffness_N_m = in.quantity(key, "N/m", -kNoLimit, kNoLimit);
  check_stiffness(in, key, stiffness_N_m);
  return stiffness_N_m;
}

bool is_ring(const ConfigMap& in) {
  const bool axis = in.has("axis"), axial = in.has("axial_stiffness"), radial = in.has("radial_stiffness");
  return axis || axial || radial;
}

bool has_normal_springs(const ConfigMap& in) {
  const bool normal = in.has("normal_stiffness"), tangential = in.has("tangential_stiffness");
  return normal || tangential;
}

}  // namespace

SupportEntry read_support(const ConfigMap& in) {
  SupportEntry entry{{in.text("surface"), {false, false, false}}, in.where("surface")};
  solver::Support& support = entry.support;
  const bool has_fixed = in.has("fixed"), has_sliding = in.has("sliding"), has_springs = in.has("springs");
  if (!has_fixed && !has_sliding && !has_springs) {
    in.fail("surface", "how is this surface held? `fixed: [x, y, z]`, `sliding: true` or `springs: [kx, ky, kz]` is wanted");
  }
  if (has_fixed) {
    for (const std::string& direction : in.texts("fixed")) {
      if (direction != "x" && direction != "y" && direction != "z") {
        in.fail("fixed", fmt::format("'{}' is no direction; a list of x, y, z is wanted", direction));
      }
      support.fixed[direction[0] - 'x'] = true;
    }
  }
  if (has_sliding) support.sliding = in.choice("sliding", {"true", "false"}) == "true";
  if (has_springs) {
    const Eigen::Vector3d springs_N_m = in.vector3("springs", "N/m");
    for (int i = 0; i < 3; ++i) {
      check_stiffness(in, "springs", springs_N_m[i]);
      support.springs_N_m[i] = springs_N_m[i];
    }
  }
  in.reject_unknown_keys();
  return entry;
}

JointEntry read_joint(const ConfigMap& in) {
  JointEntry entry{{in.text("name"), {}}, in.where("name")};
  solver::JointKind& kind = entry.mechanics.kind;
  const bool plain = in.has("mechanics"), springs = has_normal_springs(in), ring = is_ring(in);
  if (plain + springs + ring != 1) {
    in.fail("name",
            "one of `mechanics: tied | sliding | none`, `normal_stiffness` with `tangential_stiffness`, and `axis` with "
            "`axial_stiffness` and `radial_stiffness` is wanted");
  }
  if (springs) {
    kind = solver::NormalSprings{read_stiffness_N_m(in, "normal_stiffness"), read_stiffness_N_m(in, "tangential_stiffness")};
  } else if (ring) {
    kind = solver::RingSprings{in.choice("axis", {"x", "y", "z"})[0] - 'x', read_stiffness_N_m(in, "axial_stiffness"),
                               read_stiffness_N_m(in, "radial_stiffness")};
  } else {
    const std::string word = in.choice("mechanics", {"tied", "sliding", "none"});
    if (word == "tied") kind = solver::Tied{};
    if (word == "sliding") kind = solver::Sliding{};
    if (word == "none") kind = solver::NoMechanics{};
  }
  in.reject_unknown_keys();
  return entry;
}

}  // namespace driftwright::scenarios
