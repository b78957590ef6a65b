#include "base/yaml_text.hpp"

#include <algorithm>
#include <set>

#include "base/config_text.hpp"
#include "base/errors.hpp"

namespace driftwright {
namespace {

/// Finds nodes that occur at more than one place of the tree.
void find_shared(const ConfigNode& node, std::set<const ConfigNode*>& seen, std::set<const ConfigNode*>& shared) {
  if (!seen.insert(&node).second) {
    shared.insert(&node);
    return;
  }
  for (const ConfigNodePtr& item : node.items) find_shared(*item, seen, shared);
}

bool contains(const ConfigNode& tree, const ConfigNode& node) {
  if (&tree == &node) return true;
  return std::any_of(tree.items.begin(), tree.items.end(), [&](const ConfigNodePtr& i) { return contains(*i, node); });
}

bool says_nothing(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos || line[first] == '#' || line.starts_with("...") || line.starts_with("---");
}

/// Index after the quotes that open at `begin`, or npos if they do not close on this line.
std::size_t behind_quotes(const std::string& line, std::size_t begin) {
  const char quote = line[begin];
  for (std::size_t i = begin + 1; i < line.size(); ++i) {
    if (quote == '"' && line[i] == '\\') {
      ++i;
    } else if (line[i] == quote) {
      if (quote == '"' || i + 1 >= line.size() || line[i + 1] != quote) return i + 1;
      ++i;  // '' means one '
    }
  }
  return std::string::npos;
}

}  // namespace

YamlText::YamlText(const std::string& path) : root_(read_config_tree(path)) {
  if (root_->source) lines_ = root_->source->lines;
  for (std::string& line : lines_) {
    if (line.ends_with('\r')) line.pop_back();
  }
  while (!lines_.empty() && lines_.back().empty()) lines_.pop_back();
}

bool YamlText::stands_here(const ConfigNode& node) const {
  std::set<const ConfigNode*> seen, shared;
  find_shared(*root_, seen, shared);
  return std::none_of(shared.begin(), shared.end(), [&](const ConfigNode* s) { return contains(*s, node); });
}

char YamlText::at(Spot spot) const {
  if (spot.line < 1 || spot.line > static_cast<int>(lines_.size())) return '\0';
  const std::string& line = lines_[static_cast<std::size_t>(spot.line) - 1];
  const auto column = static_cast<std::size_t>(spot.column) - 1;
  return spot.column >= 1 && column < line.size() ? line[column] : '\0';
}

std::optional<std::size_t> YamlText::length_at(Spot spot, const std::string& scalar) const {
  if (at(spot) == '\0') return std::nullopt;
  const std::string& line = lines_[static_cast<std::size_t>(spot.line) - 1];
  const auto begin = static_cast<std::size_t>(spot.column) - 1;
  if (line[begin] != '"' && line[begin] != '\'') {
    if (scalar.empty() || line.compare(begin, scalar.size(), scalar) != 0) return std::nullopt;
    return scalar.size();
  }
  const std::size_t end = behind_quotes(line, begin);
  if (end == std::string::npos) return std::nullopt;
  try {
    if (read_config_text(line.substr(begin, end - begin), root_->source->path)->text != scalar) return std::nullopt;
  } catch (const InputError&) {  // it is not a quoted scalar
    return std::nullopt;
  }
  return end - begin;
}

bool YamlText::follows_comma(Spot bracket) const {
  for (int line = bracket.line; line >= 1; --line) {
    std::string before = lines_[static_cast<std::size_t>(line) - 1];
    if (line == bracket.line) before.resize(static_cast<std::size_t>(bracket.column) - 1);
    if (const std::size_t comment = before.find(" #"); comment != std::string::npos) before.resize(comment);
    if (says_nothing(before)) continue;
    return before[before.find_last_not_of(" \t")] == ',';
  }
  return false;
}

YamlText::Spot YamlText::closing(Spot open) const {
  int depth = 0;
  char quote = '\0';
  for (Spot s = open; s.line <= static_cast<int>(lines_.size()); s = {s.line + 1, 1}) {
    char before = ' ';
    for (; at(s) != '\0'; ++s.column) {
      const char c = at(s);
      if (quote != '\0') {
        if (quote == '"' && c == '\\') {
          ++s.column;
        } else if (c == quote && quote == '\'' && at({s.line, s.column + 1}) == quote) {
          ++s.column;  // '' means one '
        } else if (c == quote) {
          quote = '\0';
        }
      } else if ((c == '"' || c == '\'') && std::string(" [{,:").find(before) != std::string::npos) {
        quote = c;
      } else if (c == '#' && before == ' ') {
        break;
      } else if (c == '[' || c == '{') {
        ++depth;
      } else if (c == ']' || c == '}') {
        if (--depth == 0) return s;
      }
      before = c;
    }
  }
  return {0, 0};
}

int YamlText::next_line(const ConfigNode& parent, int line) const {
  int next = static_cast<int>(lines_.size()) + 1;
  for (const ConfigNode::Key& key : parent.keys) {
    if (key.line > line) next = std::min(next, key.line);
  }
  return next;
}

int YamlText::last_line(int end_line) const {
  int last = end_line - 1;
  while (last > 1 && says_nothing(lines_[static_cast<std::size_t>(last) - 1])) --last;
  return last;
}

int YamlText::end_line(const ConfigNode& node) const {
  return last_line(next_line(*root_, node.line));
}

std::string YamlText::current(const ConfigNode& scalar) const {
  const auto edited = replacements_.find({scalar.line, scalar.column});
  return edited != replacements_.end() ? edited->second.text : scalar.text;
}

bool YamlText::replace(const ConfigNode& scalar, const std::string& text) {
  if (!scalar.is_scalar() || !stands_here(scalar)) return false;
  const std::optional<std::size_t> length = length_at({scalar.line, scalar.column}, scalar.text);
  if (!length) return false;
  replacements_[{scalar.line, scalar.column}] = {*length, text};
  return true;
}

bool YamlText::add_pair(const ConfigNode& map, const std::string& key, const std::string& value) {
  if (!map.is_map() || map.keys.empty() || !stands_here(map)) return false;
  const Spot open{map.line, map.column};
  if (at(open) == '{') {
    const Spot close = closing(open);
    if (close.line == 0) return false;
    Replacement& r = replacements_[close];
    if (r.text.empty()) r = {1, "}"};
    r.text.insert(r.text.size() - 1, ", " + key + ": " + value);
    return true;
  }
  // Insert before the first key, so that no value of several lines has to be skipped.
  const ConfigNode::Key& first = map.keys.front();
  const std::optional<std::size_t> length = length_at({first.line, first.column}, first.text);
  if (!length) return false;
  Replacement& r = replacements_[{first.line, first.column}];
  if (r.text.empty())
    r = {*length,
         lines_[static_cast<std::size_t>(first.line) - 1].substr(static_cast<std::size_t>(first.column) - 1, *length)};
  r.text = key + ": " + value + "\n" + std::string(static_cast<std::size_t>(first.column) - 1, ' ') + r.text;
  return true;
}

bool YamlText::append(const ConfigNode& list, const std::string& entry, const std::string& comment) {
  if (!(list.is_list() || list.is_map()) || !stands_here(list)) return false;
  const Spot open{list.line, list.column};
  if (at(open) == '[' || at(open) == '{') {
    const Spot close = closing(open);
    if (close.line == 0) return false;
    Replacement& r = replacements_[close];
    const std::string bracket(1, at(close));
    if (r.text.empty()) r = {1, bracket};
    const bool is_first = (list.items.empty() || follows_comma(close)) && r.text == bracket;
    r.text.insert(r.text.size() - 1,
                  (is_first ? "\n  " : ",\n  ") + entry + (comment.empty() ? "\n" : "   # " + comment + "\n"));
    return true;
  }
  const std::string indent(static_cast<std::size_t>(list.column) - 1, ' ');
  behind_[end_line(list)].push_back(indent + (list.is_list() ? "- " : "") + entry +
                                    (comment.empty() ? "" : "   # " + comment));
  return true;
}

bool YamlText::comment_out(const ConfigNode& list, std::size_t entry) {
  if (!list.is_list() || at({list.line, list.column}) != '-' || !stands_here(list) || !stands_here(*list.items[entry]))
    return false;
  const auto line_of = [&](std::size_t i) { return list.items[i]->line; };
  const int first = line_of(entry);
  const int end = entry + 1 < list.items.size() ? line_of(entry + 1) : next_line(*root_, first);
  const std::string& text = lines_[static_cast<std::size_t>(first) - 1];
  if (text[text.find_first_not_of(' ')] != '-') return false;  // the dash is on an earlier line
  for (int line = first; line <= last_line(end); ++line) dead_.push_back(line);
  return true;
}

bool YamlText::remove(const std::string& top_key) {
  if (at({root_->line, root_->column}) == '{') return false;
  for (const ConfigNode::Key& key : root_->keys) {
    if (key.text != top_key) continue;
    for (int line = key.line; line <= last_line(next_line(*root_, key.line)); ++line) removed_.push_back(line);
    return true;
  }
  return false;
}

void YamlText::comment(int line, const std::string& text) {
  std::string& c = comments_[line];
  c += (c.empty() ? "" : "; ") + text;
}

std::string YamlText::text(const std::vector<std::string>& head) const {
  std::string out;
  for (const std::string& line : head) out += line.empty() ? "#\n" : "# " + line + "\n";
  for (int n = 1; n <= static_cast<int>(lines_.size()); ++n) {
    if (std::find(removed_.begin(), removed_.end(), n) != removed_.end()) continue;
    std::string line = lines_[static_cast<std::size_t>(n) - 1];
    for (auto r = replacements_.rbegin(); r != replacements_.rend(); ++r) {
      if (r->first.line == n) line.replace(static_cast<std::size_t>(r->first.column) - 1, r->second.length, r->second.text);
    }
    if (std::find(dead_.begin(), dead_.end(), n) != dead_.end()) line = "# " + line;
    if (const auto c = comments_.find(n); c != comments_.end()) line += "   # " + c->second;
    out += line + "\n";
    if (const auto more = behind_.find(n); more != behind_.end()) {
      for (const std::string& inserted : more->second) out += inserted + "\n";
    }
  }
  return out;
}

}  // namespace driftwright
