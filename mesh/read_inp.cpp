#include "mesh/read_inp.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "base/config_map.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "mesh/outer_faces.hpp"
#include "mesh/topology.hpp"

namespace driftwright::mesh {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\""), last = text.find_last_not_of(" \t\r\"");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> words;
  std::size_t start = 0;
  while (start <= line.size()) {
    const auto comma = std::min(line.find(',', start), line.size());
    words.push_back(trimmed(line.substr(start, comma - start)));
    start = comma + 1;
  }
  while (!words.empty() && words.back().empty()) words.pop_back();
  return words;
}

/// The shape of an element type, "c3d20r" for one; nothing for those that are not 3-D.
std::optional<CellShape> shape_of_type(const std::string& type) {
  const auto at = type.find("c3d");
  if (at != 0 && !(at == 1 && type[0] == 'd')) return std::nullopt;
  int n = 0;
  const auto rest = std::from_chars(type.data() + at + 3, type.data() + type.size(), n);
  const std::string suffix(rest.ptr,
                           type.data() + type.size());  // reduced, incompatible, hybrid, thermal, modified, electric
  if (suffix.find_first_not_of("rihtme") != std::string::npos) return std::nullopt;
  switch (n) {
    case 4:
      return CellShape::kTet4;
    case 10:
      return CellShape::kTet10;
    case 8:
      return CellShape::kHex8;
    case 20:
      return CellShape::kHex20;
    case 6:
      return CellShape::kWedge6;
    case 15:
      return CellShape::kWedge15;
    default:
      return std::nullopt;
  }
}

/// Corners of a plane, shell or membrane element of a type such as "cps6" or "s4r", which stands for a face of 3-D elements; 0 for other
/// types.
int facet_corners_of_type(const std::string& type) {
  for (const std::string_view family : {"cps", "cpe", "cax", "sfm3d", "stri", "m3d", "r3d", "ds", "s"}) {
    if (!type.starts_with(family)) continue;
    int n = 0;
    (void)std::from_chars(type.data() + family.size(), type.data() + type.size(), n);
    return n == 3 || n == 6 || n == 65 ? 3 : n == 4 || n == 8 ? 4 : 0;  // STRI65 has six nodes
  }
  return 0;
}

struct Keyword {
  std::string name;                           // "*element", without blanks
  std::map<std::string, std::string> option;  // keys and values in lower case; "" for one without a value
  int line = 0;

  [[nodiscard]] bool has(const std::string& key) const { return option.contains(key); }
  [[nodiscard]] std::string at(const std::string& key) const { return has(key) ? option.at(key) : ""; }
};

class InpReader {
 public:
  explicit InpReader(const std::string& path) {
    raw_.path = path;
    std::istringstream file(read_text_file(path));
    std::string line;
    while (std::getline(file, line)) {
      ++line_;
      line = trimmed(line);
      if (line.empty() || line.starts_with("**")) continue;
      if (line[0] == '*') {
        while (line.ends_with(',') && std::getline(file, more_)) {  // options go on in the next line
          ++line_;
          line += trimmed(more_);
        }
        begin(line);
      } else if (!keyword_.name.empty()) {
        data(line);
      }
    }
    end_element();
    finish_surfaces();
  }

  RawMesh read(const std::vector<std::string>& region_sets) {
    assign_regions(region_sets.empty() ? named_volumes() : region_sets);
    add_facet_surfaces();
    for (const auto& [name, nodes] : node_sets_) {
      RawMesh::NodeSurface surface{name, {}, true};
      for (long n : nodes) surface.nodes.push_back(node_.at(n));
      const bool is_region = std::find(raw_.regions.begin(), raw_.regions.end(), name) != raw_.regions.end();
      const auto has_name = [&, &set = name](const auto& s) { return s.name == set; };
      const bool is_surface = std::any_of(raw_.face_surfaces.begin(), raw_.face_surfaces.end(), has_name) ||
                              std::any_of(raw_.facet_surfaces.begin(), raw_.facet_surfaces.end(), has_name);
      const bool all_nodes = std::set<long>(nodes.begin(), nodes.end()).size() == node_.size();
      if (!is_region && !is_surface && !all_nodes) raw_.node_surfaces.push_back(std::move(surface));
    }
    raw_.coords.resize(3, static_cast<Eigen::Index>(position_.size()));
    for (std::size_t i = 0; i < position_.size(); ++i) raw_.coords.col(static_cast<Eigen::Index>(i)) = position_[i];
    if (const std::size_t n = left_out_.size() - n_facets_taken_; n > 0)
      raw_.notes.push_back(fmt::format("{} elements that are not 3-D were left out", n));
    return std::move(raw_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail(line_, message); }
  [[noreturn]] void fail(int line, const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", raw_.path, line, message));
  }

  [[nodiscard]] long integer(const std::string& word) const {
    long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) fail(fmt::format("'{}' is no integer", word));
    return value;
  }
  [[nodiscard]] double number(std::string word) const {
    std::replace(word.begin(), word.end(), 'd', 'e');  // Fortran's exponent
    std::replace(word.begin(), word.end(), 'D', 'e');
    const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) fail(fmt::format("'{}' is no number", word));
    return value;
  }

  void begin(const std::string& line) {
    end_element();
    std::vector<std::string> words = split(line);
    keyword_ = {};
    keyword_.line = line_;
    for (char c : lower(words[0])) {
      if (c != ' ' && c != '\t') keyword_.name += c;
    }
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto equals = words[i].find('=');
      std::string key = lower(trimmed(words[i].substr(0, equals)));
      keyword_.option[key] = equals == std::string::npos ? "" : lower(trimmed(words[i].substr(equals + 1)));
    }
    if (keyword_.name == "*include") fail("*INCLUDE is not followed; put the mesh into one file");
    if (keyword_.name == "*element") begin_elements();
    if (keyword_.name == "*surface") begin_surface();
    if (keyword_.name == "*nset" && !keyword_.has("nset")) fail("*NSET requires NSET=name");
    if (keyword_.name == "*elset" && !keyword_.has("elset")) fail("*ELSET requires ELSET=name");
  }

  void data(const std::string& line) {
    const std::vector<std::string> words = split(line);
    const std::string& name = keyword_.name;
    if (name == "*node") add_node(words);
    if (name == "*element") add_to_element(words);
    if (name == "*nset") add_to_set(words, node_sets_[keyword_.at("nset")], node_sets_);
    if (name == "*elset") add_to_set(words, element_sets_[keyword_.at("elset")], element_sets_);
    if (name == "*surface" && (words.empty() || words[0].empty()))
      fail("a line of a *SURFACE is: an element or a set of them, its face S1 to S6; or a node or a set of them");
    if (name == "*surface") surface_lines_.push_back({keyword_.at("name"), keyword_.at("type"), words, line_});
    if (name == "*instance") fail("an *INSTANCE that is shifted or turned is not followed; export a flat input file");
  }

  void add_node(const std::vector<std::string>& words) {
    if (words.size() < 2 || words.size() > 4) {
      fail(fmt::format("a node is: number, x, y, z; here are {} values (write decimal points, not commas)", words.size()));
    }
    const long n = integer(words[0]);
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i < std::min<std::size_t>(4, words.size()); ++i)
      x[static_cast<Eigen::Index>(i) - 1] = number(words[i]);
    if (!node_.try_emplace(n, static_cast<int>(position_.size())).second) fail(fmt::format("node {} is defined twice", n));
    position_.push_back(x);
    raw_.node_number.push_back(n);
    if (keyword_.has("nset")) node_sets_[keyword_.at("nset")].push_back(n);
  }

  void begin_elements() {
    const std::string type = keyword_.at("type");
    shape_ = shape_of_type(type);
    facet_corners_ = facet_corners_of_type(type);
    if (!shape_ && (type.find("c3d") != std::string::npos || type.starts_with("sc") || type.starts_with("csc"))) {
      fail(fmt::format("elements of type {} are not computed with; C3D4, C3D10, C3D8, C3D20, C3D6, C3D15 and their DC3D are",
                       type.empty() ? "?" : type));
    }
  }

  void add_to_element(const std::vector<std::string>& words) {  // an element may take several lines
    if (element_words_.empty()) element_line_ = line_;
    element_words_.insert(element_words_.end(), words.begin(), words.end());
    if (!shape_) {
      end_element();
    } else if (element_words_.size() > static_cast<std::size_t>(n_nodes_of(*shape_))) {
      end_element();
    }
  }

  void end_element() {
    if (element_words_.empty()) return;
    const std::vector<std::string> words = std::move(element_words_);
    element_words_.clear();
    if (!shape_) {
      const long n = integer(words[0]);
      left_out_.insert(n);
      if (keyword_.has("elset")) element_sets_[keyword_.at("elset")].push_back(n);
      if (facet_corners_ > 0 && static_cast<int>(words.size()) > facet_corners_) add_facet(n, words);
      return;
    }
    const long n = integer(words[0]);
    if (static_cast<int>(words.size()) - 1 != n_nodes_of(*shape_)) {
      fail(element_line_, fmt::format("element {} has {} nodes; {} are required", n, words.size() - 1, n_nodes_of(*shape_)));
    }
    std::vector<int> nodes;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto hit = node_.find(integer(words[i]));
      if (hit == node_.end()) fail(element_line_, fmt::format("element {}: there is no node {}", n, words[i]));
      nodes.push_back(hit->second);
    }
    if (!element_.try_emplace(n, raw_.cells.size()).second) {
      fail(element_line_, fmt::format("element {} is defined twice", n));
    }
    raw_.cells.add(*shape_, nodes, -1);
    raw_.cell_number.push_back(n);
    const std::string set = keyword_.at("elset");
    set_of_line_.push_back(set);
    if (!set.empty()) element_sets_[set].push_back(n);
  }

  void add_facet(long n, const std::vector<std::string>& words) {
    const auto [facet, is_new] = facet_.try_emplace(n);
    if (!is_new) fail(element_line_, fmt::format("element {} is defined twice", n));
    std::vector<int>& corners = facet->second;
    for (int i = 1; i <= facet_corners_; ++i) {
      const auto hit = node_.find(integer(words[static_cast<std::size_t>(i)]));
      if (hit == node_.end())
        fail(element_line_, fmt::format("element {}: there is no node {}", n, words[static_cast<std::size_t>(i)]));
      corners.push_back(hit->second);
    }
    set_of_facet_line_.insert(keyword_.at("elset"));
  }

  /// ELSETs of 2-D elements that are faces of 3-D ones are surfaces, as Gmsh writes physical surfaces. Those on *ELEMENT lines only where there are no
  /// others: Gmsh names there what the user has not named.
  void add_facet_surfaces() {
    if (facet_.empty()) return;
    const FaceTable faces(raw_.cells);
    std::set<long> taken;
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
        taken.insert(each.begin(), each.end());
        raw_.facet_surfaces.push_back(std::move(surface));
      }
    }
    n_facets_taken_ = taken.size();
  }

  /// The ELSETs that are regions where the *ELEMENT lines name none but Gmsh's Volume1, Volume2 ...: those of 3-D elements alone, if each element lies in
  /// one of them.
  [[nodiscard]] std::vector<std::string> named_volumes() const {
    const auto by_gmsh = [](const std::string& set) {
      return set.starts_with("volume") && set.size() > 6 && set.find_first_not_of("0123456789", 6) == std::string::npos;
    };
    if (!std::all_of(set_of_line_.begin(), set_of_line_.end(), by_gmsh)) return {};
    std::vector<std::string> names;
    std::size_t n_in_one = 0;
    std::set<long> in_some;
    for (const auto& [name, elements] : element_sets_) {
      const bool is_volume = std::all_of(elements.begin(), elements.end(), [&](long n) { return element_.contains(n); });
      if (!is_volume || elements.empty() || by_gmsh(name)) continue;
      names.push_back(name);
      const std::set<long> each(elements.begin(), elements.end());
      n_in_one += each.size();
      in_some.insert(each.begin(), each.end());
    }
    const bool covers_once = n_in_one == element_.size() && in_some.size() == element_.size();
    return covers_once ? names : std::vector<std::string>{};
  }

  using Sets = std::map<std::string, std::vector<long>>;
  void add_to_set(const std::vector<std::string>& words, std::vector<long>& set, const Sets& sets) {
    const bool of_nodes = &sets == &node_sets_;
    if (keyword_.has("generate")) {
      if (words.size() < 2) fail("GENERATE requires: first, last, step");
      const long first = integer(words[0]), last = integer(words[1]), step = words.size() > 2 ? integer(words[2]) : 1;
      if (step <= 0 || last < first || first < 0) fail("GENERATE requires 0 <= first <= last and a step above 0");
      for (long n = first;; n += step) {
        add_member(n, of_nodes, set);
        if (last - n < step) return;
      }
    }
    for (const std::string& word : words) {
      if (word.empty()) continue;
      if (std::isdigit(static_cast<unsigned char>(word[0]))) {
        add_member(integer(word), of_nodes, set);
      } else {
        const auto other = sets.find(lower(word));
        if (other == sets.end()) fail(fmt::format("there is no set '{}' above this line", word));
        const std::vector<long> members = other->second;  // a copy: it may be the set itself
        if (set.size() + members.size() > kMostMembers)
          fail(fmt::format("with the set '{}' the set has {} members; {} are the most", word, set.size() + members.size(),
                           kMostMembers));
        set.insert(set.end(), members.begin(), members.end());
      }
    }
  }
  void add_member(long n, bool of_nodes, std::vector<long>& set) const {
    if (of_nodes && !node_.contains(n)) fail(fmt::format("there is no node {} above this line", n));
    if (!of_nodes && !element_.contains(n) && !left_out_.contains(n))
      fail(fmt::format("there is no element {} above this line", n));
    set.push_back(n);
  }

  void begin_surface() {
    if (!keyword_.has("name")) fail("*SURFACE requires NAME=");
    const std::string type = keyword_.at("type");
    if (!type.empty() && type != "element" && type != "node") fail("*SURFACE must be of TYPE=ELEMENT or TYPE=NODE");
  }

  struct SurfaceLine {
    std::string name, type;
    std::vector<std::string> words;
    int line;
  };

  void finish_surfaces() {  // last, since sets may come after them
    std::map<std::string, RawMesh::FaceSurface> by_face;
    std::map<std::string, RawMesh::NodeSurface> by_node;
    for (const SurfaceLine& s : surface_lines_) {
      line_ = s.line;
      if (s.type == "node") {
        RawMesh::NodeSurface& surface = by_node.try_emplace(s.name, RawMesh::NodeSurface{s.name, {}, false}).first->second;
        for (long n : members(s.words.at(0), node_sets_, "node")) {
          if (!node_.contains(n)) fail(fmt::format("there is no node {}", n));
          surface.nodes.push_back(node_.at(n));
        }
        continue;
      }
      RawMesh::FaceSurface& surface = by_face.try_emplace(s.name, RawMesh::FaceSurface{s.name, {}}).first->second;
      const std::string face = s.words.size() > 1 ? lower(s.words[1]) : "";
      for (long n : members(s.words.at(0), element_sets_, "element")) {
        const auto cell = element_.find(n);
        if (cell == element_.end()) fail(fmt::format("there is no 3-D element {}", n));
        const int n_faces = static_cast<int>(faces_of(raw_.cells.shape[cell->second]).size());
        const int index = face.size() == 2 && face[0] == 's' ? face[1] - '1' : -1;
        if (index < 0 || index >= n_faces) {
          fail(fmt::format("there is no face '{}' of element {}; S1 to S{} are allowed", face, n, n_faces));
        }
        surface.face.emplace_back(cell->second, index);
      }
    }
    for (auto& [name, surface] : by_face) raw_.face_surfaces.push_back(std::move(surface));
    for (auto& [name, surface] : by_node) raw_.node_surfaces.push_back(std::move(surface));
  }

  [[nodiscard]] std::vector<long> members(const std::string& word, const Sets& sets, const std::string& kind) const {
    if (!word.empty() && std::isdigit(static_cast<unsigned char>(word[0]))) return {integer(word)};
    const auto set = sets.find(lower(word));
    if (set == sets.end()) fail(fmt::format("there is no {} set '{}'", kind, word));
    return set->second;
  }

  void assign_regions(const std::vector<std::string>& region_sets) {
    const auto region = [&](const std::string& name) {
      const auto hit = std::find(raw_.regions.begin(), raw_.regions.end(), name);
      if (hit != raw_.regions.end()) return static_cast<int>(hit - raw_.regions.begin());
      raw_.regions.push_back(name);
      return static_cast<int>(raw_.regions.size()) - 1;
    };
    if (region_sets.empty()) {
      const std::string rest = std::filesystem::path(raw_.path).stem().string();
      for (int c = 0; c < raw_.cells.size(); ++c)
        raw_.cells.group[c] = region(set_of_line_[c].empty() ? rest : set_of_line_[c]);
      return;
    }
    for (const std::string& name : region_sets) {
      const auto set = element_sets_.find(lower(name));
      if (set == element_sets_.end()) {
        std::vector<std::string> known;
        for (const auto& [other, elements] : element_sets_) known.push_back(other);
        const std::string near = nearest_word(lower(name), known);
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
      (void)region(name);  // a set without cells is found later
    }
    for (int c = 0; c < raw_.cells.size(); ++c) {
      if (raw_.cells.group[c] < 0) {
        throw InputError(fmt::format("{}: element {} is in none of the regions {}", raw_.path, raw_.cell_number[c],
                                     fmt::join(region_sets, ", ")));
      }
    }
  }

  static constexpr std::size_t kMostMembers =
      20'000'000;  // of a set, counted as often as they are listed: sets of sets double with each line
  RawMesh raw_;
  Keyword keyword_;
  std::string more_;
  int line_ = 0, element_line_ = 0;
  int facet_corners_ = 0;                   // of the type that is read
  std::map<long, std::vector<int>> facet_;  // 2-D elements by number: their corners
  std::set<std::string> set_of_facet_line_;
  std::size_t n_facets_taken_ = 0;
  std::map<long, int> node_, element_;
  std::vector<Eigen::Vector3d> position_;
  std::optional<CellShape> shape_;
  std::vector<std::string> element_words_, set_of_line_;
  Sets node_sets_, element_sets_;
  std::set<long> left_out_;
  std::vector<SurfaceLine> surface_lines_;
};

}  // namespace

RawMesh read_inp(const std::string& path, const std::vector<std::string>& region_sets) {
  return InpReader(path).read(region_sets);
}

}  // namespace driftwright::mesh
