#pragma once
// Text as markup takes it.

#include <string>

namespace driftwright::output {

/// With &, <, > and quotation marks as entities: text of HTML, XML and SVG, and of their attributes in quotation marks.
[[nodiscard]] std::string escaped(const std::string& text);
/// The same as one line: control characters, which XML does not allow, become spaces.
[[nodiscard]] std::string escaped_line(const std::string& text);

}  // namespace driftwright::output
