#include "mesh/read_inp.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "base/characters.hpp"
#include "base/config_map.hpp"
#include "base/errors.hpp"
#include "mesh/inp_deck.hpp"
#include "mesh/outer_faces.hpp"
#include "mesh/topology.hpp"

namespace driftwright::mesh {
namespace {

/// Looks up what a deck lists.
class MeshOfDeck {
 public:
  explicit MeshOfDeck(InpDeck deck) : deck_(std::move(deck)) {
    raw_.path = deck_.path;
    raw_.node_number = deck_.node_number;
    finish_elements();
    finish_sets();
    finish_surfaces();
  }

  RawMesh read(const std::vector<std::string>& region_sets) {
    if (region_sets.empty()) {
      assign_regions_of_lines();
    } else {
      assign_regions(region_sets);
    }
    add_facet_surfaces();
    for (const auto& [name, nodes] : node_sets_) {
      RawMesh::NodeSurface surface{name, {}, true};
      for (long n : nodes) surface.nodes.push_back(deck_.node.at(n));
      const bool is_region = std::find(raw_.regions.begin(), raw_.regions.end(), name) != raw_.regions.end();
      const auto has_name = [&, &set = name](const auto& s) { return s.name == set; };
      const bool is_surface = std::any_of(raw_.face_surfaces.begin(), raw_.face_surfaces.end(), has_name) ||
                              std::any_of(raw_.facet_surfaces.begin(), raw_.facet_surfaces.end(), has_name);
      const bool all_nodes = std::set<long>(nodes.begin(), nodes.end()).size() == deck_.node.size();
      if (!is_region && !is_surface && !all_nodes) raw_.node_surfaces.push_back(std::move(surface));
    }
    raw_.coords.resize(3, static_cast<Eigen::Index>(deck_.position.size()));
    for (std::size_t i = 0; i < deck_.position.size(); ++i)
      raw_.coords.col(static_cast<Eigen::Index>(i)) = deck_.position[i];
    if (const std::size_t n = deck_.left_out.size() - facets_taken_.size(); n > 0)
      raw_.notes.push_back(fmt::format("{} elements that are not 3-D were left out", n));
    return std::move(raw_);
  }

 private:
  void finish_elements() {
    std::size_t next = 0;
    std::vector<int> nodes;
    for (const InpDeck::Element& e : deck_.elements) {
      nodes.clear();
      for (int i = 0; i < e.n_nodes; ++i) {
        const long number = deck_.element_nodes[next++];
        const auto hit = deck_.node.find(number);
        if (hit == deck_.node.end())
          fail_in(deck_, e.line, fmt::format("element {}: there is no node {}", e.number, number));
        nodes.push_back(hit->second);
      }
      const std::string& set = deck_.set_names[static_cast<std::size_t>(e.set)];
      const bool is_new =
          e.shape ? element_.try_emplace(e.number, raw_.cells.size()).second : facet_.try_emplace(e.number, nodes).second;
      if (!is_new) fail_in(deck_, e.line, fmt::format("element {} is defined twice", e.number));
      if (!e.shape) {
        set_of_facet_line_.insert(set);
        continue;
      }
      raw_.cells.add(*e.shape, nodes, -1);
      raw_.cell_number.push_back(e.number);
      set_of_line_.push_back(set);
    }
    deck_.element_nodes = {};
    deck_.elements = {};
  }

  /// ELSETs of 2-D elements that are faces of 3-D ones become surfaces, because Gmsh writes physical surfaces so. Those on
  /// *ELEMENT lines are used only if there are no others: Gmsh names there what the user has not named.
  void add_facet_surfaces() {
    if (facet_.empty()) return;
    const FaceTable faces(raw_.cells);
    for (const bool on_element_line : {false, true}) {
      if (on_element_line && !raw_.facet_surfaces.empty()) break;
      for (const auto& [name, elements] : element_sets_) {
        if (name.empty() || set_of_facet_line_.contains(name) != on_element_line) continue;
        RawMesh::FacetSurface surface{name, {}, {}};
        const std::set<long> each(elements.begin(), elements.end());
        for (const long n : each) {
          const auto facet = facet_.find(n);
          if (facet == facet_.end() || !faces.find(face_key(facet->second))) break;
          surface.corners.push_back(facet->second);
          surface.number.push_back(n);
        }
        if (surface.number.empty() || surface.number.size() != each.size()) continue;
        facets_taken_.insert(each.begin(), each.end());
        raw_.facet_surfaces.push_back(std::move(surface));
      }
    }
  }

  /// For each cell the set among `names` that it lies in; nothing unless each lies in exactly one.
  [[nodiscard]] std::optional<std::vector<std::string>> divided_by(const std::vector<std::string>& names) const {
    std::vector<std::string> set_of_cell(static_cast<std::size_t>(raw_.cells.size()));
    for (const std::string& name : names) {
      const auto set = element_sets_.find(name);
      if (set == element_sets_.end()) continue;
      for (long n : set->second) {
        const auto cell = element_.find(n);
        if (cell == element_.end()) continue;
        std::string& of = set_of_cell[static_cast<std::size_t>(cell->second)];
        if (!of.empty() && of != name) return std::nullopt;
        of = name;
      }
    }
    for (const std::string& of : set_of_cell) {
      if (of.empty()) return std::nullopt;
    }
    return set_of_cell;
  }

  /// For each cell the ELSET of its *ELEMENT line. Where these are Gmsh's Volume1, Volume2 ... alone: the sets of 3-D
  /// elements that somebody has named, if each cell lies in one of them.
  [[nodiscard]] std::vector<std::string> sets_of_lines() const {
    const auto by_gmsh = [](const std::string& set) {
      return set.starts_with("volume") && set.size() > 6 && set.find_first_not_of("0123456789", 6) == std::string::npos;
    };
    if (!std::all_of(set_of_line_.begin(), set_of_line_.end(), by_gmsh)) return set_of_line_;
    std::vector<std::string> names;
    for (const auto& [name, elements] : element_sets_) {
      const bool is_volume = std::all_of(elements.begin(), elements.end(), [&](long n) { return element_.contains(n); });
      if (is_volume && !name.empty() && !elements.empty() && !by_gmsh(name)) names.push_back(name);
    }
    return divided_by(names).value_or(set_of_line_);
  }

  void finish_sets() {
    std::vector<long> nodes, elements;
    for (const auto& [number, index] : deck_.node) nodes.push_back(number);
    for (const auto& [number, index] : element_) elements.push_back(number);
    elements.insert(elements.end(), deck_.left_out.begin(), deck_.left_out.end());
    std::sort(elements.begin(), elements.end());
    for (const auto& [name, set] : deck_.node_sets) node_sets_[name] = members_of(name, deck_.node_sets, nodes, "node");
    for (const auto& [name, set] : deck_.element_sets)
      element_sets_[name] = members_of(name, deck_.element_sets, elements, "element");
  }

  /// Members of a set and of all sets that it holds, each once, in increasing order.
  /// @param known  numbers that exist, in increasing order
  [[nodiscard]] std::vector<long> members_of(const std::string& name, const InpDeck::Sets& sets,
                                             const std::vector<long>& known, const std::string& kind) const {
    std::vector<long> members;
    std::set<std::string> seen = {name};
    std::vector<std::string> open = {name};
    while (!open.empty()) {
      const InpDeck::Set& set = sets.at(open.back());
      open.pop_back();
      for (const InpDeck::Listed& range : set.numbers) {
        auto at = std::lower_bound(known.begin(), known.end(), range.first);
        if (range.first == range.last && (at == known.end() || *at != range.first))
          fail_in(deck_, range.line, fmt::format("there is no {} {}", kind, range.first));
        for (; at != known.end() && *at <= range.last; ++at) {
          if ((*at - range.first) % range.step == 0) members.push_back(*at);
        }
      }
      for (const std::string& other : set.sets) {
        if (seen.insert(other).second) open.push_back(other);
      }
    }
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    return members;
  }

  void finish_surfaces() {
    std::map<std::string, RawMesh::FaceSurface> by_face;
    std::map<std::string, RawMesh::NodeSurface> by_node;
    std::map<std::string, int> n_left_out;
    std::optional<FaceTable> faces;
    if (!deck_.surface_lines.empty()) faces.emplace(raw_.cells);
    for (const InpDeck::SurfaceLine& s : deck_.surface_lines) {
      if (s.type == "node") {
        RawMesh::NodeSurface& surface = by_node.try_emplace(s.name, RawMesh::NodeSurface{s.name, {}, false}).first->second;
        for (long n : members_on(s, node_sets_, "node")) {
          const auto node = deck_.node.find(n);
          if (node == deck_.node.end()) fail_in(deck_, s.line, fmt::format("there is no node {}", n));
          surface.nodes.push_back(node->second);
        }
        continue;
      }
      RawMesh::FaceSurface& surface = by_face.try_emplace(s.name, RawMesh::FaceSurface{s.name, {}}).first->second;
      const std::vector<long> numbers = members_on(s, element_sets_, "element");
      for (long n : numbers) n_left_out[s.name] += add_face(*faces, s, n, surface) ? 0 : 1;
      if (s.face.empty()) add_free_faces(*faces, numbers, surface);
    }
    for (auto& [name, surface] : by_face) {
      if (const int n = n_left_out[name]; n > 0)
        raw_.notes.push_back(fmt::format("surface '{}' lost {} elements that are on no 3-D element{}", name, n,
                                         surface.face.empty() ? "; nothing is left of it" : ""));
      if (!surface.face.empty() || n_left_out[name] == 0) raw_.face_surfaces.push_back(std::move(surface));
    }
    for (auto& [name, surface] : by_node) raw_.node_surfaces.push_back(std::move(surface));
  }

  /// Adds the face of one element of a line that names a face; of a 2-D element, the cell's face that it covers.
  /// @returns  false where the element is not 3-D and covers no face
  bool add_face(const FaceTable& faces, const InpDeck::SurfaceLine& s, long n, RawMesh::FaceSurface& surface) {
    const auto cell = element_.find(n);
    if (cell == element_.end() && !deck_.left_out.contains(n))
      fail_in(deck_, s.line, fmt::format("there is no element {}", n));
    if (cell == element_.end()) {
      const auto facet = facet_.find(n);
      const CellFace* at = facet == facet_.end() ? nullptr : faces.find(face_key(facet->second));
      if (!at) return false;
      surface.face.emplace_back(at->cell, at->face);
      facets_taken_.insert(n);
      return true;
    }
    if (s.face.empty()) return true;
    const int n_faces = static_cast<int>(faces_of(raw_.cells.shape[cell->second]).size());
    const int index = s.face.size() == 2 && s.face[0] == 's' ? s.face[1] - '1' : -1;
    if (index < 0 || index >= n_faces)
      fail_in(deck_, s.line, fmt::format("there is no face '{}' of element {}; S1 to S{} are allowed", s.face, n, n_faces));
    surface.face.emplace_back(cell->second, index);
    return true;
  }

  /// Of a line that names no face: those faces of the elements that no other cell shares.
  void add_free_faces(const FaceTable& faces, const std::vector<long>& numbers, RawMesh::FaceSurface& surface) const {
    std::vector<bool> is_member(static_cast<std::size_t>(raw_.cells.size()), false);
    for (long n : numbers) {
      if (const auto cell = element_.find(n); cell != element_.end())
        is_member[static_cast<std::size_t>(cell->second)] = true;
    }
    faces.for_each([&](const FaceKey&, std::span<const FaceTable::Entry> at) {
      if (at.size() == 1 && is_member[static_cast<std::size_t>(at.front().at.cell)])
        surface.face.emplace_back(at.front().at.cell, at.front().at.face);
    });
  }

  using Sets = std::map<std::string, std::vector<long>>;
  [[nodiscard]] std::vector<long> members_on(const InpDeck::SurfaceLine& s, const Sets& sets,
                                             const std::string& kind) const {
    if (s.number) return {*s.number};
    const auto set = sets.find(s.set);
    if (set == sets.end()) fail_in(deck_, s.line, fmt::format("there is no {} set '{}'", kind, s.set));
    return set->second;
  }

  int region(const std::string& name) {
    const auto hit = std::find(raw_.regions.begin(), raw_.regions.end(), name);
    if (hit != raw_.regions.end()) return static_cast<int>(hit - raw_.regions.begin());
    raw_.regions.push_back(name);
    return static_cast<int>(raw_.regions.size()) - 1;
  }

  /// Regions where the scenario names none: cells that an ELSET of an *ELEMENT line and one of a *SOLID SECTION have in
  /// common, by the name of the smaller of the two. Sections that do not divide the mesh are passed over.
  void assign_regions_of_lines() {
    const std::vector<std::string> lines = sets_of_lines();
    const std::vector<std::string> sections = divided_by(deck_.section_sets).value_or(lines);
    std::map<std::string, int> n_of_line, n_of_section;
    for (std::size_t c = 0; c < lines.size(); ++c) {
      ++n_of_line[lines[c]];
      ++n_of_section[sections[c]];
    }
    const std::string rest = std::filesystem::path(raw_.path).stem().string();
    for (std::size_t c = 0; c < lines.size(); ++c) {
      const bool by_section = lines[c].empty() || n_of_section[sections[c]] < n_of_line[lines[c]];
      const std::string& name = by_section ? sections[c] : lines[c];
      raw_.cells.group[c] = region(name.empty() ? rest : name);
    }
  }

  void assign_regions(const std::vector<std::string>& region_sets) {
    for (const std::string& name : region_sets) {
      const auto set = element_sets_.find(lower_case(name));
      if (set == element_sets_.end()) {
        std::vector<std::string> known;
        for (const auto& [other, elements] : element_sets_) known.push_back(other);
        const std::string near = nearest_word(lower_case(name), known);
        throw InputError(fmt::format("{}: there is no ELSET '{}' for the region; there are {}.{}", raw_.path, name,
                                     fmt::join(known, ", "), near.empty() ? "" : fmt::format(" Did you mean '{}'?", near)));
      }
      for (long n : set->second) {
        const auto cell = element_.find(n);
        if (cell == element_.end()) continue;  // a 2-D element
        int& group = raw_.cells.group[cell->second];
        if (group >= 0 && group != region(name)) {
          throw InputError(fmt::format("{}: element {} is in the regions '{}' and '{}'; one is allowed", raw_.path, n,
                                       raw_.regions[group], name));
        }
        group = region(name);
      }
      (void)region(name);  // a set without cells is detected later
    }
    for (int c = 0; c < raw_.cells.size(); ++c) {
      if (raw_.cells.group[c] < 0) {
        throw InputError(fmt::format("{}: element {} is in none of the regions {}", raw_.path, raw_.cell_number[c],
                                     fmt::join(region_sets, ", ")));
      }
    }
  }

  InpDeck deck_;
  RawMesh raw_;
  std::map<long, std::vector<int>> facet_;  // 2-D elements by number: their corners
  std::set<std::string> set_of_facet_line_;
  std::set<long> facets_taken_;  // into surfaces
  std::map<long, int> element_;
  std::vector<std::string> set_of_line_;
  Sets node_sets_, element_sets_;
};

}  // namespace

RawMesh read_inp(const std::string& path, const std::vector<std::string>& region_sets) {
  return MeshOfDeck(read_inp_deck(path)).read(region_sets);
}

}  // namespace driftwright::mesh
