#pragma once
// Logs of a control: one tag's value at one time in each row, written when it changes.

#include "base/logger_header.hpp"
#include "base/mapped_record.hpp"

namespace driftwright {

/// Reads such a log into a record. A value applies until the next one of its tag; before the first one it is missing. One
/// row at each time of the log, or every `map.tags->every_s`; then the last row is at or after the log's end. @throws
/// InputError as read_record(), and for a tag that never occurs
[[nodiscard]] ReadRecord read_tag_log(const std::string& path, const std::vector<std::string>& lines,
                                      const LoggerHeader& header, const ColumnMap& map);

}  // namespace driftwright
