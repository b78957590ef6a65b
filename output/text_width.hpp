#pragma once
// How wide a text is drawn, for pictures that are laid out before a font is known.

#include <string>

namespace driftwright::output {

/// About the width of one line of UTF-8 in a sans-serif font [same unit as font_size]. The advance widths are those of
/// DejaVu Sans, the widest of the usual fonts: text takes this room or less.
[[nodiscard]] double text_width(const std::string& text, double font_size);

}  // namespace driftwright::output
