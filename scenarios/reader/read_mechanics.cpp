#include "scenarios/reader/read_mechanics.hpp"

namespace driftwright::scenarios {
namespace {

/// Softer springs vanish in the rounding error of the machine's stiffness; with stiffer ones the machine's stiffness
/// vanishes.
constexpr double kSoftest_N_m = 1e3, kStiffest_N_m = 1e13;

schema::Value stiffness() {
  return schema::quantity_or_zero("N/m", kSoftest_N_m, kStiffest_N_m);
}

}  // namespace

schema::Map support_schema() {
  using namespace schema;
  return {.name = "supports",
          .keys = {compulsory("surface", text(), "of the mesh; one surface may have several supports"),
                   schema::optional("fixed", list(choice({"x", "y", "z"})), "axes along which it does not move"),
                   schema::optional("sliding", flag(), "true: it does not move along its normal; plane or curved"),
                   schema::optional("springs", row({stiffness(), stiffness(), stiffness()}),
                                    "stiffness of the whole surface along x, y, z; 0 N/m: none")},
          .groups = {{Group::Rule::kAtLeastOne,
                      {"fixed", "sliding", "springs"},
                      "how is this surface held? Write `fixed: [x, y, z]`, `sliding: true` or `springs: [kx, ky, kz]`"}}};
}

schema::Map joint_schema() {
  using namespace schema;
  return {
      .name = "joints",
      .keys = {compulsory("name", text(), "of the joint, as `column/knee`"),
               schema::optional("mechanics", choice({"tied", "sliding", "none"}),
                                "what the joint passes on; joints that are not listed are tied"),
               schema::optional("normal_stiffness", stiffness(),
                                "of a guideway or bolted joint: force per opening, of the whole joint"),
               schema::optional("tangential_stiffness", stiffness(), "the same along the joint"),
               schema::optional("axis", choice({"x", "y", "z"}), "of a ring, such as a bearing"),
               schema::optional("axial_stiffness", stiffness(), "of the ring, along its axis; 0 N/m: a floating bearing"),
               schema::optional("radial_stiffness", stiffness(), "of the ring: force per sideways displacement")},
      .groups = {{Group::Rule::kExactlyOne,
                  {"mechanics", "normal_stiffness", "axis"},
                  "exactly one of `mechanics: tied | sliding | none`, `normal_stiffness` with `tangential_stiffness`, and "
                  "`axis` with `axial_stiffness` and `radial_stiffness` is required"},
                 {Group::Rule::kAllOrNone, {"normal_stiffness", "tangential_stiffness"}, "both are required"},
                 {Group::Rule::kAllOrNone, {"axis", "axial_stiffness", "radial_stiffness"}, "all three are required"}}};
}

SupportEntry read_support(const ConfigMap& in) {
  SupportEntry entry{{in.text("surface"), {false, false, false}}, in.where("surface")};
  solver::Support& support = entry.support;
  if (in.has("fixed")) {
    for (const std::string& direction : in.texts("fixed")) support.fixed[direction[0] - 'x'] = true;
  }
  if (in.has("sliding")) support.sliding = in.flag("sliding");
  if (in.has("springs")) {
    const Eigen::Vector3d springs_N_m = in.vector3("springs");
    for (int i = 0; i < 3; ++i) support.springs_N_m[i] = springs_N_m[i];
  }
  in.reject_unknown_keys();
  return entry;
}

JointEntry read_joint(const ConfigMap& in) {
  JointEntry entry{{in.text("name"), {}}, in.where("name")};
  solver::JointKind& kind = entry.mechanics.kind;
  const bool springs = in.has("normal_stiffness") && in.has("tangential_stiffness");
  const bool ring = in.has("axis") && in.has("axial_stiffness") && in.has("radial_stiffness");
  if (springs) kind = solver::NormalSprings{in.quantity("normal_stiffness"), in.quantity("tangential_stiffness")};
  if (ring)
    kind = solver::RingSprings{Eigen::Vector3d::Unit(in.choice("axis")[0] - 'x'), in.quantity("axial_stiffness"),
                               in.quantity("radial_stiffness")};
  if (in.has("mechanics")) {
    const std::string word = in.choice("mechanics");
    if (word == "tied") kind = solver::Tied{};
    if (word == "sliding") kind = solver::Sliding{};
    if (word == "none") kind = solver::NoMechanics{};
  }
  in.reject_unknown_keys();
  return entry;
}

}  // namespace driftwright::scenarios
