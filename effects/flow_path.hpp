#pragma once
// The way of a liquid as an effect names it: bodies in the order of flow, or points along which a surface is cut into
// sections. An effect's `words` hold both as text; this reads and writes it.

#include <array>
#include <string>
#include <vector>

namespace driftwright::effects {

using Point_mm = std::array<double, 3>;

/// "front, middle, rear" and back. A name must not contain a comma.
[[nodiscard]] std::string text_of(const std::vector<std::string>& names);
[[nodiscard]] std::vector<std::string> names_of_text(const std::string& text);
/// "0 0 0, 100 0 25" [mm] and back. @throws std::logic_error  for a text that is not of this form
[[nodiscard]] std::string text_of(const std::vector<Point_mm>& points_mm);
[[nodiscard]] std::vector<Point_mm> points_of_text(const std::string& text);

/// The name of section i of n of a surface, i from 0. The '@' keeps it apart from surfaces that a scenario may name.
[[nodiscard]] std::string section_name(const std::string& surface, int i, int n);

}  // namespace driftwright::effects
