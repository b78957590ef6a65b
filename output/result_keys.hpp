#pragma once
// The keys of a file of results, described once: `driftwright schema` prints them as JSON Schema, the documentation holds them as a table.

#include <string>
#include <vector>

namespace driftwright::output {

/// One key of a JSON file of results.
struct ResultKey {
  enum class Kind {
    kText,
    kNumber,
    kCount,   ///< a whole number from 0
    kFlag,    ///< true or false
    kObject,  ///< whose keys are described by paths below its own
    kLike,    ///< a list of objects like those of another path, `like`
  };
  std::string path;  ///< "gain.channels[].rmse_after": [] stands for every entry of a list
  Kind kind = Kind::kText;
  std::string meaning = {};  ///< a clause, with the unit
  bool is_always = true;     ///< false: the key may be missing from its object
  bool or_null = false;
  std::vector<std::string> words = {};  ///< of a text: all there are; empty: any
  std::string like = {};                ///< "causes[]"
};

/// JSON Schema, draft 7, which refuses keys that are not described.
/// @throws std::logic_error  where a path lies below one that is not described, or is described twice
[[nodiscard]] std::string result_schema(const std::vector<ResultKey>& keys, const std::string& title);

/// The same as a table in Markdown, a row a key.
[[nodiscard]] std::string result_table(const std::vector<ResultKey>& keys);

}  // namespace driftwright::output
