#pragma once
// Logs of a control: one tag's value at one time in each row, written when it changes.

#include "base/logger_header.hpp"
#include "base/mapped_record.hpp"

namespace driftwright {

/// A record of them. A value holds until the next of its tag; before its first it is missing. One row at each time of the log, or every
/// `map.tags->every_s`, the last of them at or behind the log's end. @throws InputError  as read_record(), and for a tag that never comes
[[nodiscard]] ReadRecord read_tag_log(const std::string& path, const std::vector<std::string>& lines,
                                      const LoggerHeader& header, const ColumnMap& map);

}  // namespace driftwright
