#include "base/config_tree.hpp"

#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <sstream>
#include <utility>

#include "base/characters.hpp"
#include "base/config_text.hpp"
#include "base/delimited_text.hpp"

namespace driftwright {
namespace {

Where where_in(const ConfigSource& source, int line, int column, const std::string& key) {
  const bool inside = line >= 1 && line <= static_cast<int>(source.lines.size());
  return {source.path, line, column, key, inside ? source.lines[static_cast<std::size_t>(line) - 1] : ""};
}

constexpr std::size_t kMostNodes = 1000000, kDeepest = 200;

std::string too_deep() {
  return fmt::format("lists and maps are nested more than {} deep, which is the most", kDeepest);
}

/// Size of a node with its aliases expanded.
struct Extent {
  std::size_t size = 1, depth = 1;
};

/// Builds the tree from the parser's events. yaml-cpp's own nodes would accept duplicate keys and keys that are lists or
/// maps, and lose their lines when copied.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::shared_ptr<const ConfigSource> source) : source_(std::move(source)) {}

  [[nodiscard]] const ConfigNodePtr& root() const { return root_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (std::exchange(has_begun_, true))
      throw InputError(where_in(*source_, mark.line + 1, mark.column + 1, ""),
                       "a second YAML document begins here; a file must have one. If this belongs to the first, remove the "
                       "line '---' or '...' before it, else write it into a file of its own");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(std::make_shared<ConfigNode>(make(ConfigNode::Kind::kNull, mark)), anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = anchors_.find(anchor);
    if (known == anchors_.end())
      throw InputError(where_in(*source_, mark.line + 1, mark.column + 1, ""), "an alias is used inside its own anchor");
    add(known->second.node, 0, known->second.extent);
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string& value) override {
    ConfigNode node = make(ConfigNode::Kind::kScalar, mark);
    node.text = value;
    add(std::make_shared<ConfigNode>(std::move(node)), anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open_.push_back({make(ConfigNode::Kind::kList, mark), anchor, false, {}});
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    open_.push_back({make(ConfigNode::Kind::kMap, mark), anchor, true, {}});
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    ConfigNode node;
    YAML::anchor_t anchor;
    bool wants_key;
    Extent extent;
  };
  struct Anchored {
    ConfigNodePtr node;
    Extent extent;
  };

  [[nodiscard]] ConfigNode make(ConfigNode::Kind kind, const YAML::Mark& mark) const {
    ConfigNode node;
    node.kind = kind;
    node.source = source_;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    add(std::make_shared<ConfigNode>(std::move(done.node)), done.anchor, done.extent);
  }

  /// A few lines of aliases of aliases can expand to billions of values.
  void require_bearable(const Extent& extent, const ConfigNode& node) const {
    if (extent.size > kMostNodes)
      throw InputError(
          where_in(*source_, node.line, node.column, ""),
          fmt::format("with its aliases written out, this holds more than {} values, which is the most", kMostNodes));
    if (extent.depth > kDeepest) throw InputError(where_in(*source_, node.line, node.column, ""), too_deep());
  }

  void add(ConfigNodePtr node, YAML::anchor_t anchor, const Extent& extent = {}) {
    if (anchor != 0) anchors_[anchor] = {node, extent};
    if (!open_.empty()) {
      Extent& around = open_.back().extent;
      around.size += extent.size;
      around.depth = std::max(around.depth, extent.depth + 1);
      require_bearable(around, open_.back().node);
    }
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.is_map() && parent.wants_key) {
      add_key(parent.node, *node);
    } else {
      parent.node.items.push_back(std::move(node));
    }
    parent.wants_key = !parent.wants_key;
  }

  void add_key(ConfigNode& map, const ConfigNode& key) const {
    if (!key.is_scalar())
      throw InputError(where_in(*source_, key.line, key.column, ""), "a key must be a word, not a list, a map or nothing");
    if (map.index_of(key.text))
      throw InputError(where_in(*source_, key.line, key.column, key.text), fmt::format("key '{}' appears twice", key.text));
    map.keys.push_back({key.text, key.line, key.column});
  }

  std::shared_ptr<const ConfigSource> source_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Anchored> anchors_;
  ConfigNodePtr root_;
  bool has_begun_ = false;
};

}  // namespace

std::optional<std::size_t> ConfigNode::index_of(const std::string& key) const {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.text == key; });
  if (found == keys.end()) return std::nullopt;
  return static_cast<std::size_t>(found - keys.begin());
}

const ConfigNode* ConfigNode::find(const std::string& key) const {
  const auto index = index_of(key);
  return index ? items[*index].get() : nullptr;
}

Where ConfigNode::where(const std::string& key) const {
  return where_in(*source, line, column, key);
}

ConfigNodePtr read_config_tree(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  for (const char* geometry : {".step", ".stp", ".msh", ".inp", ".vtu"}) {
    if (extension == geometry)
      throw InputError(fmt::format(
          "{}: this is a machine's geometry, but must be a scenario; `driftwright init NAME --from {}` makes one of it",
          path, path));
  }
  return read_config_text(read_text_file(path), path);
}

ConfigNodePtr read_config_text(const std::string& whole, const std::string& path) {
  auto source = std::make_shared<ConfigSource>();
  source->path = path;
  std::string text, line;
  std::istringstream lines(whole);
  while (std::getline(lines, line)) {
    text += line + "\n";
    source->lines.push_back(line);
  }
  TreeBuilder builder(source);
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::DeepRecursion& e) {  // yaml-cpp's own limit, which it reaches before the tree is complete
    throw InputError(where_in(*source, e.mark.line + 1, e.mark.column + 1, ""), too_deep());
  } catch (const YAML::ParserException& e) {
    for (int n = std::min(e.mark.line, static_cast<int>(source->lines.size()) - 1); n >= 0; --n) {
      const std::string& at = source->lines[static_cast<std::size_t>(n)];
      const std::size_t tab = at.find('\t');
      if (tab < at.find_first_not_of(" \t"))
        throw InputError(where_in(*source, n + 1, static_cast<int>(tab) + 1, ""),
                         "this line begins with a tab; YAML allows only blanks as indentation");
    }
    throw InputError(where_in(*source, e.mark.line + 1, e.mark.column + 1, ""), "this is not valid YAML: " + e.msg);
  } catch (const YAML::Exception& e) {
    throw InputError(fmt::format("{}: this is not valid YAML: {}", path, e.msg));
  }
  if (builder.root()) return builder.root();
  ConfigNode empty;
  empty.source = source;
  return std::make_shared<ConfigNode>(std::move(empty));
}

ConfigNodePtr replaced(const ConfigNodePtr& root, std::span<const std::size_t> steps, ConfigNodePtr value) {
  if (steps.empty()) return value;
  auto copy = std::make_shared<ConfigNode>(*root);
  ConfigNodePtr& child = copy->items.at(steps[0]);
  child = replaced(child, steps.subspan(1), std::move(value));
  return copy;
}

std::string written(const ConfigNode& node) {
  if (node.is_scalar()) return fmt::format("{:?}", node.text);
  if (!node.is_list() && !node.is_map()) return "~";
  std::string text = node.is_list() ? "[" : "{";
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (i > 0) text += ", ";
    if (node.is_map()) text += fmt::format("{:?}: ", node.keys[i].text);
    text += written(*node.items[i]);
  }
  return text + (node.is_list() ? "]" : "}");
}

ConfigNodePtr scalar_at(const ConfigNode& place, std::string text) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kScalar;
  node.text = std::move(text);
  node.source = place.source;
  node.line = place.line;
  node.column = place.column;
  return std::make_shared<ConfigNode>(std::move(node));
}

}  // namespace driftwright
