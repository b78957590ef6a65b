#include "output/twin/pick_page.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <tuple>

#include "mesh/machine_skin.hpp"
#include "mesh/outer_planes.hpp"
#include "mesh/pickable_faces.hpp"
#include "mesh/quality.hpp"
#include "output/twin/page_parts.hpp"
#include "output/twin/pick_text.hpp"

namespace driftwright::output {
namespace {

/// A part of the outside that is one face and has one set of names.
struct PickPatch {
  int face;
  std::vector<int> surfaces;
  bool touches;
  bool operator<(const PickPatch& other) const {
    return std::tie(face, surfaces, touches) < std::tie(other.face, other.surfaces, other.touches);
  }
};

/// The outside, with nodes that belong to one patch each.
struct PatchedSurface {
  TwinSurface surface;
  std::vector<std::int32_t> patch_of_node;
  std::vector<PickPatch> patches;
  std::vector<double> unnamed_m2;  ///< of each region
};

PatchedSurface patched_surface(const mesh::Mesh& m, const std::vector<mesh::PickableFace>& faces) {
  const std::vector<mesh::OuterFacet> facets = mesh::outer_facets(m);
  std::vector<int> face_of(facets.size(), -1);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    for (int f : faces[k].facets) face_of[static_cast<std::size_t>(f)] = static_cast<int>(k);
  }
  const mesh::MachineSkin skin = mesh::skin_of(m);
  PatchedSurface out;
  out.unnamed_m2.resize(m.regions.size(), 0.0);
  for (const mesh::OuterFacet& f : facets) {
    if (f.surfaces.empty() && !f.in_joint) out.unnamed_m2[static_cast<std::size_t>(f.region)] += f.area_m2;
  }
  std::map<PickPatch, std::int32_t> number;
  std::map<std::pair<int, std::int32_t>, std::uint32_t> place;
  std::vector<int> drawn_part;
  for (std::size_t t = 0; t < skin.triangle.size(); ++t) {
    const auto f = static_cast<std::size_t>(skin.face[t]);
    const PickPatch patch{face_of[f], facets[f].surfaces, facets[f].in_joint};
    const std::int32_t at = number.try_emplace(patch, static_cast<std::int32_t>(number.size())).first->second;
    if (static_cast<std::size_t>(at) == out.patches.size()) out.patches.push_back(patch);
    for (int node : skin.triangle[t]) {
      const auto [found, is_new] = place.try_emplace({node, at}, static_cast<std::uint32_t>(out.surface.node.size()));
      if (is_new) {
        out.surface.node.push_back(node);
        out.patch_of_node.push_back(at);
      }
      out.surface.triangle.push_back(found->second);
    }
    drawn_part.push_back(skin.region[t]);
  }
  out.surface.coords_m.resize(3, static_cast<Eigen::Index>(out.surface.node.size()));
  for (std::size_t i = 0; i < out.surface.node.size(); ++i)
    out.surface.coords_m.col(static_cast<Eigen::Index>(i)) = m.coords.col(out.surface.node[i]).cast<float>();
  out.surface.edge = drawn_edges(out.surface, drawn_part);
  return out;
}

}  // namespace

std::string pick_html(const PickPage& page, const Provenance& made_by) {
  using Json = nlohmann::ordered_json;
  if (page.mesh == nullptr || page.mesh->cells.size() == 0) throw std::logic_error("pick_html: a mesh without cells");
  const mesh::Mesh& m = *page.mesh;
  const std::vector<mesh::PickableFace> faces = mesh::pickable_faces(m);
  const PatchedSurface outside = patched_surface(m, faces);

  Json regions = Json::array(), face_list = Json::array(), surfaces = Json::array(), patches = Json::array();
  for (std::size_t r = 0; r < m.regions.size(); ++r)
    regions.push_back({{"name", m.regions[r]}, {"yaml", yaml_word(m.regions[r])}, {"unnamed_m2", outside.unnamed_m2[r]}});
  for (const mesh::PickableFace& face : faces) {
    face_list.push_back({{"region", face.region},
                         {"area_m2", face.area_m2},
                         {"words", face.pick ? pick_words(*face.pick) : "neither a plane nor a cylinder"}});
    if (face.pick) face_list.back()["pick"] = pick_text(m.regions[static_cast<std::size_t>(face.region)], *face.pick);
  }
  std::vector<std::string> taken = page.channels;
  std::map<int, int> place_of;  // in the list, without the sides of joints
  for (std::size_t s = 0; s < m.surfaces.size(); ++s) {
    if (m.surfaces[s].find('@') != std::string::npos) continue;
    place_of[static_cast<int>(s)] = static_cast<int>(surfaces.size());
    const auto carried = page.carried.find(m.surfaces[s]);
    surfaces.push_back({{"name", m.surfaces[s]},
                        {"area_m2", mesh::area_m2(m, static_cast<int>(s))},
                        {"carries", carried == page.carried.end() ? std::vector<std::string>{} : carried->second}});
    taken.push_back(m.surfaces[s]);
  }
  for (const PickPatch& patch : outside.patches) {
    std::vector<int> places;
    for (int s : patch.surfaces) places.push_back(place_of.at(s));
    patches.push_back({{"face", patch.face}, {"surfaces", places}, {"touches", patch.touches}});
  }
  const Json data = {{"name", page.name},
                     {"subtitle", page.subtitle},
                     {"notes", page.notes},
                     {"made_by", fmt::format("Made by Driftwright {} from {}.", made_by.version, made_by.scenario)},
                     {"may_name", page.no_names.empty()},
                     {"no_names", page.no_names},
                     {"beginning", page.beginning},
                     {"taken", taken},
                     {"regions", regions},
                     {"faces", face_list},
                     {"surfaces", surfaces},
                     {"patches", patches},
                     {"surface", surface_json(outside.surface)},
                     {"vertex_patch", text_of(outside.patch_of_node)},
                     {"marks", marks_json(page.marks, outside.surface)}};
  return page_text("pick.html", page.name, {"page.css", "pick.css"}, data,
                   {"fields.js", "scene.js", "picture.js", "pick.js"});
}

}  // namespace driftwright::output
