#include "output/schema_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

namespace driftwright::output {
namespace {

using schema::Group, schema::Key, schema::Map, schema::Value;
using ValueKind = Value::Kind;

constexpr std::size_t kMostWords = 12;  // most words that a cell lists

/// The anchor of a heading, as GitHub makes it.
std::string anchor(const std::string& heading) {
  std::string text;
  for (char c : heading) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-') text += static_cast<char>(std::tolower(c));
    if (c == ' ') text += '-';
  }
  return text;
}

std::string escaped(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.replace(at, 1, "\\|");
  return text;
}

class Tables {
 public:
  explicit Tables(std::string page_of_effects) : page_of_effects_(std::move(page_of_effects)) {}

  std::string of(const std::vector<Map>& files) {
    for (const Map& file : files) {
      for (const Key& key : file.keys) {
        for (const Value& way : key.values) note(maps_of(way));
      }
    }
    std::string text;
    for (const Map& file : files) {
      text += table(file);
      for (const Key& key : file.keys) {
        for (const Value& way : key.values) {
          for (const Map& map : maps_of(way)) {
            if (map.when_key != "type" && written_.insert(map.name).second) text += table(map);
          }
        }
      }
    }
    return text;
  }

 private:
  static const std::vector<Map>& maps_of(const Value& value) {
    return value.kind == ValueKind::kList || value.kind == ValueKind::kRow ? maps_of(value.items.front()) : value.maps;
  }

  void note(const std::vector<Map>& maps) {
    for (const Map& map : maps) has_table_.insert(map.name);
  }

  std::string table(const Map& map) {
    groups_.clear();
    std::string rows;
    add_rows(map, "", rows);
    std::string text = fmt::format("### {}\n\n", map.name);
    if (!map.about.empty()) text += map.about + "\n\n";
    text += "| key | value | left out | what |\n|---|---|---|---|\n" + rows + "\n";
    for (const std::string& group : groups_) text += "- " + group + "\n";
    return text + (groups_.empty() ? "" : "\n");
  }

  void add_rows(const Map& map, const std::string& prefix, std::string& rows) {
    for (const Key& key : map.keys) add_key(key, prefix + key.name, rows);
    for (const Key& key : map.others) add_key(key, fmt::format("{}<{}>", prefix, key.name), rows);
    for (const Group& group : map.groups) {
      const std::string text =
          prefix.empty() ? group.message : fmt::format("`{}`: {}", prefix.substr(0, prefix.size() - 1), group.message);
      if (group.rule != Group::Rule::kAllOrNone) {
        groups_.push_back(text);
      } else {
        groups_.push_back(fmt::format("`{}{}` go together", prefix, fmt::join(group.keys, "`, `" + prefix)));
      }
    }
  }

  void add_key(const Key& key, const std::string& address, std::string& rows) {
    std::vector<std::string> ways;
    for (const Value& way : key.values) ways.push_back(in_words(way));
    const std::string shown = key.is_compulsory ? fmt::format("**`{}`**", address) : fmt::format("`{}`", address);
    std::string otherwise = schema::otherwise(key);
    if (key.word) otherwise = fmt::format("`{}`", otherwise);
    rows += fmt::format("| {} | {} | {} | {} |\n", shown, escaped(fmt::format("{}", fmt::join(ways, "; or "))), otherwise,
                        escaped(key.meaning));
    for (const Value& way : key.values) {
      const bool is_list = way.kind == ValueKind::kList;
      std::set<std::string> written;  // keys that several forms share are written once
      for (const Map& map : maps_of(way)) {
        if (has_table_.contains(map.name) || map.when_key == "type") continue;
        Map rest = map;
        std::erase_if(rest.keys, [&](const Key& k) { return !written.insert(k.name + k.meaning).second; });
        add_rows(rest, address + (is_list ? "[]." : "."), rows);
      }
    }
  }

  [[nodiscard]] std::string in_words(const Value& v) const {
    const std::string range = schema::range(v);
    switch (v.kind) {
      case ValueKind::kAnything:
        return "anything";
      case ValueKind::kText:
        return "text";
      case ValueKind::kName:
        return "name";
      case ValueKind::kChoice:
        return v.options.size() > kMostWords ? fmt::format("one of {} words", v.options.size())
                                             : fmt::format("`{}`", fmt::join(v.options, "`, `"));
      case ValueKind::kInteger:
        return "whole number, " + range;
      case ValueKind::kQuantity:
        if (v.unit.empty()) return "number with its unit";
        if (v.unit == "1") return range.empty() ? "number" : "number, " + range;
        if (v.low == schema::kColdest_K && v.high == schema::kHottest_K && v.unit == "degC") return "temperature";
        return range.empty() ? "in " + v.unit : range;
      case ValueKind::kList:
        return "list of " + (maps_of(v).empty() ? in_words(v.items.front()) : of_maps(v, "maps"));
      case ValueKind::kRow: {
        std::vector<std::string> items;
        for (const Value& item : v.items) items.push_back(in_words(item));
        if (items.size() == 3 && items[0] == items[1] && items[1] == items[2])
          return fmt::format("[x, y, z], each {}", items[0]);
        return fmt::format("[{}]", fmt::join(items, "; "));
      }
      case ValueKind::kMap:
        return of_maps(v, "map");
    }
    return "";
  }

  /// Links to the tables of its forms.
  [[nodiscard]] std::string of_maps(const Value& value, const std::string& word) const {
    const std::vector<Map>& maps = maps_of(value);
    if (maps.front().when_key == "type") return fmt::format("[{}]({})", word, page_of_effects_);
    std::vector<std::string> links;
    for (const Map& map : maps) {
      if (has_table_.contains(map.name)) links.push_back(fmt::format("[{}](#{})", map.name, anchor(map.name)));
    }
    return links.empty() ? word : fmt::format("{}: {}", word, fmt::join(links, ", "));
  }

  std::string page_of_effects_;
  std::set<std::string> has_table_, written_;
  std::vector<std::string> groups_;  // of the current table
};

}  // namespace

std::string schema_tables(const std::vector<Map>& files, const std::string& page_of_effects) {
  return Tables(page_of_effects).of(files);
}

}  // namespace driftwright::output
