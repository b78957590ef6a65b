#pragma once
// Describes the keys of a file of results, once for two uses: `driftwright schema` prints them as JSON Schema, and the
// documentation as a table.

#include <string>
#include <vector>

namespace driftwright::output {

/// One key of a JSON file of results.
struct ResultKey {
  enum class Kind {
    kText,
    kNumber,
    kCount,   ///< a whole number, 0 or above
    kFlag,    ///< true or false
    kObject,  ///< the keys within it are described by longer paths
    kLike,    ///< a list of objects with the same keys as another path, `like`
  };
  std::string path;  ///< "gain.channels[].rmse_after": [] means every entry of a list
  Kind kind = Kind::kText;
  std::string meaning = {};  ///< a clause, with the unit
  bool is_always = true;     ///< false: the key may be missing from its object
  bool or_null = false;
  std::vector<std::string> words = {};  ///< all possible values of a text; empty: any
  std::string like = {};                ///< "causes[]"
};

/// JSON Schema, draft 7. The schema refuses keys that are not described.
/// @throws std::logic_error  for a path below one that is not described, or described twice
[[nodiscard]] std::string result_schema(const std::vector<ResultKey>& keys, const std::string& title);

/// The same as a Markdown table, one row per key.
[[nodiscard]] std::string result_table(const std::vector<ResultKey>& keys);

}  // namespace driftwright::output
