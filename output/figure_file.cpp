#include "output/figure_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cstdio>

#include "output/markup.hpp"
#include "output/plot_legend.hpp"
#include "output/text_width.hpp"

namespace driftwright::output {
namespace {

constexpr const char* kHead = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
constexpr double kTitle = 34, kMargin = 16, kTitleFont = 16, kBold = 1.1;  // bold letters are a tenth wider [px, -]

/// Width and height from its viewBox.
std::array<double, 2> size_of(const std::string& svg) {
  const std::size_t at = svg.find("viewBox=\"");
  std::array<double, 2> size = {1000, 600};
  double x = 0.0, y = 0.0;
  if (at != std::string::npos)
    (void)std::sscanf(svg.c_str() + at, "viewBox=\"%lf %lf %lf %lf\"", &x, &y, &size[0], &size[1]);
  return size;
}

/// Inserts `text` after the name of the first tag, and removes the tag's own size.
std::string with_attribute(std::string svg, const std::string& text) {
  for (const char* key : {" width=\"", " height=\""}) {
    const std::size_t at_key = svg.find(key);
    if (at_key < svg.find('>')) svg.erase(at_key, svg.find('"', at_key + std::string(key).size()) + 1 - at_key);
  }
  const std::size_t at = svg.find("<svg") + 4;
  return fmt::format("{} {}{}", svg.substr(0, at), text, svg.substr(at));
}

/// Smaller where the title is longer than the room.
double title_font(const std::string& title, double room) {
  const double width = kBold * text_width(title, kTitleFont);
  return width > room ? kTitleFont * room / width : kTitleFont;
}

}  // namespace

std::string svg_file(const std::string& svg) {
  const bool has_namespace = svg.substr(0, svg.find('>')).find("xmlns=") != std::string::npos;
  return fmt::format("{}{}", kHead, has_namespace ? svg : with_attribute(svg, "xmlns=\"http://www.w3.org/2000/svg\""));
}

std::string plot_file(const Plot& plot, const std::string& svg) {
  const auto [width, height] = size_of(svg);
  const double top = plot.title.empty() ? 0.0 : kTitle;
  const DrawnLegend legend = drawn_legend(legend_entries(plot), width, top + height);
  const double bottom = top + height + legend.height + (legend.height > 0.0 ? kMargin / 2.0 : 0.0);
  const std::string title =
      plot.title.empty() ? ""
                         : fmt::format("<text x=\"{:.0f}\" y=\"23\" font-weight=\"600\" font-size=\"{:.3g}\">{}</text>\n",
                                       kMargin, title_font(plot.title, width - 2.0 * kMargin), escaped_line(plot.title));
  return fmt::format(
      "{}<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"system-ui, Arial, "
      "sans-serif\" "
      "font-size=\"14\" fill=\"#1d2329\">\n<rect width=\"{:.0f}\" height=\"{:.0f}\" fill=\"#ffffff\"/>\n{}{}\n{}</svg>\n",
      kHead, width, bottom, width, bottom, title,
      with_attribute(svg, fmt::format("y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\"", top, width, height)), legend.svg);
}

void FigureFiles::add(const std::string& title, std::string svg) {
  std::string name;
  for (char c : title) {
    if (name.size() >= 48) break;
    if (std::isalnum(static_cast<unsigned char>(c)))
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  const std::string base = name.empty() ? "figure" : name;
  name = base;
  for (int i = 2; !names_.insert(name).second; ++i) name = fmt::format("{}_{}", base, i);
  figures_.push_back({name, std::move(svg)});
}

}  // namespace driftwright::output
