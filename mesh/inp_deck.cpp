#include "mesh/inp_deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>

#include "base/characters.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"

namespace driftwright::mesh {
namespace {

constexpr double kDegree_rad = EIGEN_PI / 180.0;

/// Without blanks and quotes at either end.
std::string bare(const std::string& text) {
  return trimmed(text, " \t\r\"");
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> words;
  std::size_t start = 0;
  while (start <= line.size()) {
    const auto comma = std::min(line.find(',', start), line.size());
    words.push_back(bare(line.substr(start, comma - start)));
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

/// Corners of a plane, shell or membrane element of a type such as "cps6" or "s4r", which marks a face of 3-D elements; 0
/// for other types.
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

class InpParser {
 public:
  explicit InpParser(const std::string& path) {
    deck_.path = path;
    std::istringstream file(read_text_file(path));
    std::string line;
    while (std::getline(file, line)) {
      ++line_;
      line = bare(line);
      if (line.empty() || line.starts_with("**")) continue;
      if (line[0] == '*') {
        while (line.ends_with(',') && std::getline(file, more_)) {  // options go on in the next line
          ++line_;
          line += bare(more_);
        }
        begin(line);
      } else if (!keyword_.name.empty()) {
        data(line);
      }
    }
    end_element();
  }
  InpDeck take() { return std::move(deck_); }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail(line_, message); }
  [[noreturn]] void fail(int line, const std::string& message) const { fail_in(deck_, line, message); }

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
    for (char c : lower_case(words[0])) {
      if (c != ' ' && c != '\t') keyword_.name += c;
    }
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto equals = words[i].find('=');
      std::string key = lower_case(bare(words[i].substr(0, equals)));
      keyword_.option[key] = equals == std::string::npos ? "" : lower_case(bare(words[i].substr(equals + 1)));
    }
    if (keyword_.name == "*include") fail("*INCLUDE is not followed; put the mesh into one file");
    for (const char* of_mesh : {"*node", "*element", "*nset", "*elset", "*surface"}) {
      if (keyword_.name == of_mesh && keyword_.has("input")) fail("INPUT= is not followed; put the mesh into one file");
    }
    for (const char* maker : {"*ngen", "*nfill", "*ncopy", "*nmap", "*elgen", "*elcopy", "*system"}) {
      if (keyword_.name != maker) continue;
      fail(fmt::format("{} makes or moves nodes and elements, which is not followed; export a flat input file",
                       upper_case(maker)));
    }
    if (keyword_.name == "*node") begin_nodes();
    if (keyword_.name == "*element") begin_elements();
    if (keyword_.name == "*surface") begin_surface();
    if (keyword_.name == "*solidsection" && keyword_.has("elset")) deck_.section_sets.push_back(keyword_.at("elset"));
    if (keyword_.name == "*nset" && !keyword_.has("nset")) fail("*NSET requires NSET=name");
    if (keyword_.name == "*elset" && !keyword_.has("elset")) fail("*ELSET requires ELSET=name");
  }

  void data(const std::string& line) {
    const std::vector<std::string> words = split(line);
    const std::string& name = keyword_.name;
    if (name == "*node") add_node(words);
    if (name == "*element") add_to_element(words);
    if (name == "*nset") add_to_set(words, deck_.node_sets[keyword_.at("nset")], deck_.node_sets);
    if (name == "*elset") add_to_set(words, deck_.element_sets[keyword_.at("elset")], deck_.element_sets);
    if (name == "*surface" && (words.empty() || words[0].empty()))
      fail("a line of a *SURFACE is: an element or a set of them, its face S1 to S6; or a node or a set of them");
    if (name == "*surface") add_to_surface(words);
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
    if (is_cylindrical_) x.head<2>() = x[0] * Eigen::Vector2d(std::cos(x[1] * kDegree_rad), std::sin(x[1] * kDegree_rad));
    if (!deck_.node.try_emplace(n, static_cast<int>(deck_.position.size())).second)
      fail(fmt::format("node {} is defined twice", n));
    deck_.position.push_back(x);
    deck_.node_number.push_back(n);
    if (keyword_.has("nset")) deck_.node_sets[keyword_.at("nset")].numbers.push_back({n, n, 1, line_});
  }

  void begin_nodes() {
    const std::string system = keyword_.has("system") ? keyword_.at("system") : "r";
    if (system != "r" && system != "c")
      fail(fmt::format("nodes in SYSTEM={} are not read; R (x, y, z) and C (radius, angle in degrees, z) are", system));
    is_cylindrical_ = system == "c";
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

  /// An element whose line has ended. Its nodes are looked up when all are known: blocks may come in any order.
  void end_element() {
    if (element_words_.empty()) return;
    const std::vector<std::string> words = std::move(element_words_);
    element_words_.clear();
    const long n = integer(words[0]);
    if (keyword_.has("elset")) deck_.element_sets[keyword_.at("elset")].numbers.push_back({n, n, 1, element_line_});
    if (!shape_) deck_.left_out.insert(n);
    const int n_nodes = shape_ ? n_nodes_of(*shape_) : facet_corners_;
    if (shape_ && static_cast<int>(words.size()) - 1 != n_nodes)
      fail(element_line_, fmt::format("element {} has {} nodes; {} are required", n, words.size() - 1, n_nodes));
    if (n_nodes == 0 || static_cast<int>(words.size()) <= n_nodes) return;
    deck_.elements.push_back({n, shape_, n_nodes, element_line_, set_index(keyword_.at("elset"))});
    for (int i = 1; i <= n_nodes; ++i) deck_.element_nodes.push_back(integer(words[static_cast<std::size_t>(i)]));
  }

  int set_index(const std::string& name) {
    if (deck_.set_names.empty() || deck_.set_names.back() != name) deck_.set_names.push_back(name);
    return static_cast<int>(deck_.set_names.size()) - 1;
  }

  void add_to_set(const std::vector<std::string>& words, InpDeck::Set& set, const InpDeck::Sets& sets) {
    if (keyword_.has("generate")) {
      if (words.size() < 2) fail("GENERATE requires: first, last, step");
      const long first = integer(words[0]), last = integer(words[1]), step = words.size() > 2 ? integer(words[2]) : 1;
      if (step <= 0 || last < first || first < 0) fail("GENERATE requires 0 <= first <= last and a step above 0");
      set.numbers.push_back({first, last, step, line_});
      return;
    }
    for (const std::string& word : words) {
      if (word.empty()) continue;
      if (std::isdigit(static_cast<unsigned char>(word[0]))) {
        const long n = integer(word);
        set.numbers.push_back({n, n, 1, line_});
      } else {
        if (!sets.contains(lower_case(word))) fail(fmt::format("there is no set '{}' above this line", word));
        set.sets.insert(lower_case(word));
      }
    }
  }

  void begin_surface() {
    if (!keyword_.has("name")) fail("*SURFACE requires NAME=");
    const std::string type = keyword_.at("type");
    if (!type.empty() && type != "element" && type != "node") fail("*SURFACE must be of TYPE=ELEMENT or TYPE=NODE");
  }

  void add_to_surface(const std::vector<std::string>& words) {
    InpDeck::SurfaceLine line{keyword_.at("name"), keyword_.at("type"), {}, lower_case(words[0]), {}, line_};
    if (std::isdigit(static_cast<unsigned char>(words[0][0]))) line.number = integer(words[0]);
    if (words.size() > 1) line.face = lower_case(words[1]);
    deck_.surface_lines.push_back(std::move(line));
  }

  InpDeck deck_;
  Keyword keyword_;
  std::string more_;
  int line_ = 0, element_line_ = 0;
  std::optional<CellShape> shape_;  // of the type that is read
  int facet_corners_ = 0;
  bool is_cylindrical_ = false;
  std::vector<std::string> element_words_;
};

}  // namespace

void fail_in(const InpDeck& deck, int line, const std::string& message) {
  throw InputError(fmt::format("{}:{}: {}", deck.path, line, message));
}

InpDeck read_inp_deck(const std::string& path) {
  return InpParser(path).take();
}

}  // namespace driftwright::mesh
