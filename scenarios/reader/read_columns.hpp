#pragma once
// The key `columns`: the format of records that a logger wrote (docs/reference/record.md).

#include "base/column_map.hpp"
#include "base/config_map.hpp"

namespace driftwright::scenarios {

/// The schema of the key `columns`.
[[nodiscard]] schema::Map columns_schema();
/// @throws InputError  file, line and key: for units that no record has, channels named twice, a time given in no way or
/// in two ways, columns by position if a header names them, or by name if there is no header
[[nodiscard]] ColumnMap read_columns(const ConfigMap& in);

}  // namespace driftwright::scenarios
