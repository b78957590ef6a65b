#include "output/result_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace driftwright::output {
namespace {

using Json = nlohmann::ordered_json;
using ResultKind = ResultKey::Kind;

const std::string kEntries = "[]";

bool ends_with_entries(const std::string& path) {
  return path.size() >= 2 && path.compare(path.size() - 2, 2, kEntries) == 0;
}

Json allowing_null(Json schema) {
  return {{"anyOf", {std::move(schema), {{"type", "null"}}}}};
}

/// Splits a path into that of the surrounding object and the key's own name with its brackets: {"gain.channels[]",
/// "name"}.
std::pair<std::string, std::string> divided(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? std::pair{std::string(), path} : std::pair{path.substr(0, dot), path.substr(dot + 1)};
}

class Writer {
 public:
  explicit Writer(const std::vector<ResultKey>& keys) : keys_(keys) {
    for (const ResultKey& key : keys) {
      const std::string around = divided(key.path).first;
      bool is_known = around.empty();
      int n = 0;
      for (const ResultKey& other : keys) {
        is_known |= other.kind == ResultKind::kObject && other.path == around;
        n += other.path == key.path ? 1 : 0;
      }
      if (!is_known) throw std::logic_error(fmt::format("'{}' lies in no object that is described", key.path));
      if (n != 1) throw std::logic_error(fmt::format("'{}' is described {} times", key.path, n));
    }
  }

  [[nodiscard]] Json object(const std::string& path) {
    Json properties = Json::object(), required = Json::array();
    for (const ResultKey& key : keys_) {
      auto [around, name] = divided(key.path);
      if (around != path) continue;
      int depth = 0;
      for (; ends_with_entries(name); ++depth) name.erase(name.size() - 2);
      Json schema = kind_of(key);
      if (key.or_null) schema = allowing_null(std::move(schema));
      for (; depth > 0; --depth) schema = {{"type", "array"}, {"items", std::move(schema)}};
      if (!key.meaning.empty()) schema["description"] = key.meaning;
      properties[name] = std::move(schema);
      if (key.is_always) required.push_back(name);
    }
    return {{"type", "object"}, {"properties", properties}, {"required", required}, {"additionalProperties", false}};
  }

  [[nodiscard]] const Json& definitions() const { return definitions_; }

 private:
  Json kind_of(const ResultKey& key) {
    switch (key.kind) {
      case ResultKind::kText:
        return key.words.empty() ? Json{{"type", "string"}} : Json{{"enum", key.words}};
      case ResultKind::kNumber:
        return {{"type", "number"}};
      case ResultKind::kCount:
        return {{"type", "integer"}, {"minimum", 0}};
      case ResultKind::kFlag:
        return {{"type", "boolean"}};
      case ResultKind::kObject:
        return object(key.path);
      case ResultKind::kLike: {
        if (!definitions_.contains(key.like)) {
          definitions_[key.like] = nullptr;  // set first, since it may contain itself
          definitions_[key.like] = object(key.like);
        }
        return {{"type", "array"}, {"items", {{"$ref", "#/definitions/" + pointer(key.like)}}}};
      }
    }
    throw std::logic_error("a kind of result that nobody describes");
  }

  /// A JSON pointer as an address fragment, in which brackets are not allowed.
  static std::string pointer(std::string path) {
    for (std::size_t at = 0; (at = path.find(kEntries, at)) != std::string::npos;) path.replace(at, 2, "%5B%5D");
    return path;
  }

  const std::vector<ResultKey>& keys_;
  Json definitions_ = Json::object();
};

std::string kind_words(const ResultKey& key) {
  std::string words;
  switch (key.kind) {
    case ResultKind::kText: {
      std::vector<std::string> quoted;
      for (const std::string& word : key.words) quoted.push_back(fmt::format("`{}`", word));
      words = quoted.empty() ? "text" : fmt::format("{}", fmt::join(quoted, ", "));
      break;
    }
    case ResultKind::kNumber:
      words = "number";
      break;
    case ResultKind::kCount:
      words = "count";
      break;
    case ResultKind::kFlag:
      words = "true or false";
      break;
    case ResultKind::kObject:
      words = "object";
      break;
    case ResultKind::kLike:
      words = fmt::format("list, each as `{}`", key.like);
  }
  return words + (key.or_null ? ", or null" : "") + (key.is_always ? "" : "; may be missing");
}

}  // namespace

std::string result_schema(const std::vector<ResultKey>& keys, const std::string& title) {
  Writer writer(keys);
  Json json = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  json.update(writer.object(""));
  json["definitions"] = writer.definitions();
  return json.dump(1) + "\n";
}

std::string result_table(const std::vector<ResultKey>& keys) {
  std::string text = "| key | what it holds | meaning |\n|---|---|---|\n";
  for (const ResultKey& key : keys) text += fmt::format("| `{}` | {} | {} |\n", key.path, kind_words(key), key.meaning);
  return text;
}

}  // namespace driftwright::output
