#include "effects/flow_path.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace driftwright::effects {

std::string text_of(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<std::string> names_of_text(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find(", ", from), text.size());
    names.push_back(text.substr(from, end - from));
    from = end + 2;
  }
  return names;
}

std::string text_of(const std::vector<Point_mm>& points_mm) {
  std::vector<std::string> points;
  for (const Point_mm& p : points_mm) points.push_back(fmt::format("{} {} {}", p[0], p[1], p[2]));
  return text_of(points);
}

std::vector<Point_mm> points_of_text(const std::string& text) {
  std::vector<Point_mm> points;
  for (const std::string& point : names_of_text(text)) {
    std::istringstream in(point);
    in.imbue(std::locale::classic());
    Point_mm p{};
    if (!(in >> p[0] >> p[1] >> p[2])) throw std::logic_error("points_of_text: '" + point + "' is no point");
    points.push_back(p);
  }
  return points;
}

std::string section_name(const std::string& surface, int i, int n) {
  return fmt::format("{}@{} of {}", surface, i + 1, n);
}

}  // namespace driftwright::effects
