#include "scenarios/reader/former_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <mutex>
#include <set>

#include "effects/effect.hpp"
#include "effects/heat_balance.hpp"

namespace driftwright::scenarios {
namespace {

constexpr const char* kFormer = "hall";
constexpr const char* kPresent = effects::kAmbientName;
/// End of the name of an exchange with the ambient, such as `link housing - ambient`.
const std::string kFormerEnd = std::string(" - ") + kFormer, kPresentEnd = std::string(" - ") + kPresent;

using Found = std::vector<FormerWord>;

bool is_former(const ConfigNode& node) {
  return node.is_scalar() && node.text == kFormer;
}

ConfigNodePtr present_scalar(const std::string& key, const ConfigNode& node, Found& found) {
  const std::string text = name_in_present_words(node.text);
  found.push_back({node.where(key), fmt::format("{}: {}", key, text)});
  return scalar_at(node, text);
}

/// The same map or list with some values replaced: `make` returns the value for a key ("" for entries of a list).
ConfigNodePtr with_values(const ConfigNodePtr& node,
                          const std::function<ConfigNodePtr(const std::string& key, const ConfigNodePtr& value)>& make) {
  auto next = std::make_shared<ConfigNode>(*node);
  for (std::size_t i = 0; i < node->items.size(); ++i)
    next->items[i] = make(node->is_map() ? node->keys[i].text : "", node->items[i]);
  return next;
}

/// Present words below a list of sensors, displacements or tilts: `node: hall` at any depth.
ConfigNodePtr outputs_in_present_words(const ConfigNodePtr& node, Found& found) {
  return with_values(node, [&](const std::string& key, const ConfigNodePtr& value) {
    if (key == "node" && is_former(*value)) return present_scalar(key, *value, found);
    return outputs_in_present_words(value, found);
  });
}

const effects::EffectKind* kind_of_entry(const ConfigNode& entry) {
  const ConfigNode* type = entry.find("type");
  if (!type || !type->is_scalar()) return nullptr;
  for (const effects::EffectKind& kind : effects::catalogue()) {
    if (kind.key == type->text) return &kind;
  }
  return nullptr;
}

/// Whether a key of an effect takes the name of a lumped node, or the ambient as one of its words.
bool takes_ambient(const effects::EffectKind& kind, const std::string& key) {
  const auto is_node = [&](const effects::Reference& r) {
    return r.name == key && r.kinds.front() == effects::BodyKind::kNode;
  };
  const auto is_word = [&](const effects::Choice& c) {
    return c.name == key && std::find(c.options.begin(), c.options.end(), kPresent) != c.options.end();
  };
  return key == effects::place_key(effects::Place::kNode) ||
         std::any_of(kind.references.begin(), kind.references.end(), is_node) ||
         std::any_of(kind.choices.begin(), kind.choices.end(), is_word);
}

ConfigNodePtr effect_in_present_words(const ConfigNodePtr& entry, Found& found) {
  const effects::EffectKind* kind = entry->is_map() ? kind_of_entry(*entry) : nullptr;
  if (!kind) return entry;
  return with_values(entry, [&](const std::string& key, const ConfigNodePtr& value) {
    const bool is_law =
        key == effects::place_key(effects::Place::kLaw) && value->is_scalar() && value->text.ends_with(kFormerEnd);
    if (is_law || (takes_ambient(*kind, key) && is_former(*value))) return present_scalar(key, *value, found);
    if (!value->is_map()) return value;
    return with_values(value, [&](const std::string& inner, const ConfigNodePtr& body) {
      return inner == effects::place_key(effects::Place::kNode) && is_former(*body) ? present_scalar(inner, *body, found)
                                                                                    : body;
    });
  });
}

/// Prints each note once per run of the program, which may read a scenario several times: by file, line and key.
void tell(const FormerWord& word) {
  static std::mutex mutex;
  static std::set<std::string> told;
  const std::lock_guard lock(mutex);
  if (!told.insert(fmt::format("{}:{}:{}", word.where.file, word.where.line, word.where.key)).second) return;
  fmt::print(stderr, "note: {}:{}: `{}` is now called `{}`; write `{}` (the former word is read in this release alone)\n",
             word.where.file, word.where.line, kFormer, kPresent, word.present);
}

}  // namespace

ConfigNodePtr in_present_words(const ConfigNodePtr& root, std::vector<FormerWord>& found) {
  if (!root || !root->is_map()) return root;
  const auto former = root->index_of(kFormer);
  if (former && root->find("machine") && root->index_of(kPresent)) {
    const ConfigNode::Key& key = root->keys[*former];
    Where where = root->items[*former]->where(key.text);
    where.line = key.line;
    where.column = key.column;
    throw InputError(
        where, fmt::format("`{}` is the former name of `{}`, and both are here; leave out one of them", kFormer, kPresent));
  }
  const auto next = std::make_shared<ConfigNode>(*root);
  for (std::size_t i = 0; i < next->keys.size(); ++i) {
    std::string& key = next->keys[i].text;
    ConfigNodePtr& value = next->items[i];
    if (key == kFormer && root->find("machine")) {
      Where where = value->where(key);
      where.line = next->keys[i].line;
      found.push_back({where, std::string(kPresent) + ": ..."});
      key = kPresent;
    } else if (key == "start" && is_former(*value)) {
      value = present_scalar(key, *value, found);
    } else if (key == "effects" && value->is_list()) {
      value =
          with_values(value, [&](const std::string&, const ConfigNodePtr& e) { return effect_in_present_words(e, found); });
    } else if (key == "sensors" || key == "displacements" || key == "tilts") {
      value = outputs_in_present_words(value, found);
    }
  }
  return next;
}

ConfigNodePtr read_scenario_tree(const std::string& path) {
  Found found;
  ConfigNodePtr tree = in_present_words(read_config_tree(path), found);
  for (const FormerWord& word : found) tell(word);
  return tree;
}

std::string address_in_present_words(const std::string& address, const Where& where) {
  std::string present = address;
  const auto is_end = [](char c) { return c == '.' || c == '[' || c == ']' || c == '@'; };
  const std::size_t n = std::string(kFormer).size();
  for (std::size_t at = present.find(kFormer); at != std::string::npos; at = present.find(kFormer, at + 1)) {
    const bool begins = at == 0 || present[at - 1] == '@' || present[at - 1] == '[';
    if (begins && (at + n == present.size() || is_end(present[at + n]))) present.replace(at, n, kPresent);
  }
  if (present != address) tell({where, present});
  return present;
}

ConfigNodePtr value_in_present_words(const ConfigNodePtr& value, const std::string& address) {
  Found found;
  const std::string top = address.substr(0, address.find_first_of(".["));
  const std::string key =
      address.substr(address.find_last_of(".[") == std::string::npos ? 0 : address.find_last_of(".[") + 1);
  const bool is_entry = address == top + "[" + key;  // an entry of a list
  ConfigNodePtr present = value;
  if (address == top || is_entry) {
    ConfigNode list = *value, root = *value;
    list.kind = ConfigNode::Kind::kList;
    list.items = {value};
    root.kind = ConfigNode::Kind::kMap;
    root.keys = {{top, value->line, value->column}};
    root.items = {is_entry ? std::make_shared<const ConfigNode>(list) : value};
    present = in_present_words(std::make_shared<const ConfigNode>(root), found)->items.front();
    if (is_entry) present = present->items.front();
  } else if (const auto& kinds = effects::catalogue(); is_former(*value)) {
    const bool takes = std::any_of(kinds.begin(), kinds.end(), [&](const auto& kind) { return takes_ambient(kind, key); });
    if (takes) present = present_scalar(key, *value, found);
  }
  for (const FormerWord& word : found) tell(word);
  return present;
}

std::string name_in_present_words(std::string name) {
  if (name == kFormer) return kPresent;
  if (name.ends_with(kFormerEnd)) name.replace(name.size() - kFormerEnd.size(), std::string::npos, kPresentEnd);
  return name;
}

}  // namespace driftwright::scenarios
