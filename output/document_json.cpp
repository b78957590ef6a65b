#include "output/document_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace driftwright::output {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Datum& datum) {
  return std::visit(
      [](const auto& held) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>)
          return nullptr;
        else
          return held;
      },
      datum.held);
}

/// Sets "a.b" within the object.
void put(Json& object, const std::string& key, Json value) {
  const std::size_t dot = key.find('.');
  if (dot != std::string::npos) return put(object[key.substr(0, dot)], key.substr(dot + 1), std::move(value));
  if (object.contains(key)) throw std::logic_error(fmt::format("a document with two values of the key '{}'", key));
  object[key] = std::move(value);
}

Json rows_of(const Table& table) {
  Json list = Json::array();
  for (const std::vector<Datum>& row : table.rows) {
    if (row.size() != table.columns.size())
      throw std::logic_error(
          fmt::format("table '{}': {} cells under {} headers", table.title, row.size(), table.columns.size()));
    Json object = Json::object();
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (!table.columns[c].key.empty()) put(object, table.columns[c].key, json_of(row[c]));
    }
    list.push_back(std::move(object));
  }
  return list;
}

const char* word(Verdict::Kind kind) {
  return kind == Verdict::Kind::kGood ? "good" : kind == Verdict::Kind::kBad ? "bad" : "neutral";
}

void put_block(Json& object, const Block& block) {
  std::visit(
      [&](const auto& b) {
        using T = std::decay_t<decltype(b)>;
        if constexpr (requires { b.key; }) {
          if (b.key.empty()) return;
          if constexpr (std::is_same_v<T, Value>) put(object, b.key, json_of(b.datum));
          if constexpr (std::is_same_v<T, Table>) put(object, b.key, rows_of(b));
          if constexpr (std::is_same_v<T, Verdict>)
            put(object, b.key, {{"standing", word(b.kind)}, {"title", b.title}, {"text", b.text}});
          if constexpr (std::is_same_v<T, Text>) put(object, b.key, b.words);
          if constexpr (std::is_same_v<T, Notes>) put(object, b.key, b.lines);
        }
      },
      block);
}

void put_section(Json& object, const Section& section) {
  for (const Block& block : section.blocks) put_block(object, block);
  for (const Section& part : section.sections) {
    if (part.key.empty()) {
      put_section(object, part);
      continue;
    }
    Json inner = Json::object();
    if (part.item) inner[part.item->key] = part.item->name;
    put_section(inner, part);
    if (part.item)
      object[part.key].push_back(std::move(inner));
    else
      put(object, part.key, std::move(inner));
  }
}

}  // namespace

Json document_json(const Document& document) {
  Json json = {{"program", "driftwright"}, {"version", document.made_by.version}, {"scenario", document.made_by.scenario}};
  put_section(json, document.body);
  return json;
}

}  // namespace driftwright::output
