#pragma once
// The key `columns`: how the records of a scenario are written where a logger wrote them (docs/reference/record.md).

#include "base/column_map.hpp"
#include "base/config_map.hpp"

namespace driftwright::scenarios {

/// What the key `columns` may hold.
[[nodiscard]] schema::Map columns_schema();
/// @throws InputError  file, line and key, for units that no record carries, channels named twice, a time that is told in no way or in two,
///                     columns by position where a header names them, or by name where there is none
[[nodiscard]] ColumnMap read_columns(const ConfigMap& in);

}  // namespace driftwright::scenarios
