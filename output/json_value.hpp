#pragma once
// Reads values of a JSON file; errors name the key that is missing or of the wrong kind.

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/errors.hpp"

namespace driftwright::output {

using Json = nlohmann::ordered_json;

/// A JSON number; null if `x` is not finite.
[[nodiscard]] inline Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

/// The value of a key. @throws InputError  naming the key, here and below
template <class T>
[[nodiscard]] T value(const Json& j, const char* key) {
  if (!j.is_object() || !j.contains(key)) throw InputError(fmt::format("key `{}` is missing", key));
  try {
    return j.at(key).get<T>();
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("key `{}` is {}, which is of the wrong kind", key, j.at(key).dump()));
  }
}

[[nodiscard]] inline double finite(const Json& j, const char* key) {
  const auto x = value<double>(j, key);
  if (!std::isfinite(x)) throw InputError(fmt::format("key `{}` is {}; it must be a number", key, j.at(key).dump()));
  return x;
}
[[nodiscard]] inline double positive(const Json& j, const char* key) {
  const double x = finite(j, key);
  if (!(x > 0.0)) throw InputError(fmt::format("key `{}` is {}; it must be above 0", key, x));
  return x;
}
/// The value of a key; `missing` if it is null.
[[nodiscard]] inline double number_or(const Json& j, const char* key, double missing) {
  return j.is_object() && j.contains(key) && j.at(key).is_null() ? missing : finite(j, key);
}
[[nodiscard]] inline Json list(const Json& j, const char* key) {
  auto l = value<Json>(j, key);
  if (!l.is_array()) throw InputError(fmt::format("key `{}` is {}; it must be a list", key, l.dump()));
  return l;
}

}  // namespace driftwright::output
