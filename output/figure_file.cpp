#include "output/figure_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cstdio>

#include "output/markup.hpp"

namespace driftwright::output {
namespace {

constexpr const char* kHead = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
constexpr double kTitle = 34, kLine = 24, kLetter = 7.4, kMargin = 16;

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

std::string swatch(const Plot& plot, std::size_t series, double x, double y) {
  const std::string color = series_color(plot, series);
  const Series::Style style = drawn_style(plot, series);
  if (style == Series::Style::kPoints)
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>", x + 12.0, y, color);
  return fmt::format("<path d=\"M{:.1f} {:.1f}h24\" stroke=\"{}\" stroke-width=\"3\"{}/>", x, y, color,
                     style == Series::Style::kDashed ? " stroke-dasharray=\"7 4\"" : "");
}

std::size_t n_letters(const std::string& text) {
  std::size_t n = 0;
  for (char c : text) n += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1U : 0U;
  return n;
}

}  // namespace

std::string svg_file(const std::string& svg) {
  const bool has_namespace = svg.substr(0, svg.find('>')).find("xmlns=") != std::string::npos;
  return fmt::format("{}{}", kHead, has_namespace ? svg : with_attribute(svg, "xmlns=\"http://www.w3.org/2000/svg\""));
}

std::string plot_file(const Plot& plot, const std::string& svg) {
  const auto [width, height] = size_of(svg);
  const double top = plot.title.empty() ? 0.0 : kTitle;
  std::string legend;
  double x = kMargin, y = top + height + 0.5 * kLine;
  const auto add = [&](const auto& drawn, const std::string& label) {
    if (label.empty()) return;
    const double wide = 32.0 + kLetter * static_cast<double>(n_letters(label)) + 22.0;
    if (x > kMargin && x + wide > width) {
      x = kMargin;
      y += kLine;
    }
    legend += fmt::format("{}<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", drawn(x, y), x + 32.0, y + 5.0, escaped(label));
    x += wide;
  };
  for (std::size_t s = 0; s < plot.series.size(); ++s)
    add([&](double at_x, double at_y) { return swatch(plot, s, at_x, at_y); }, plot.series[s].label);
  for (std::size_t b = 0; b < plot.bands.size(); ++b) {
    const bool is_line = plot.bands[b].low == plot.bands[b].high;
    add(
        [&](double at_x, double at_y) {
          return is_line
                     ? fmt::format(
                           "<path d=\"M{:.1f} {:.1f}h24\" stroke=\"#777777\" stroke-width=\"2\" stroke-dasharray=\"6 4\"/>",
                           at_x, at_y)
                     : fmt::format(
                           "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"24\" height=\"14\" fill=\"{}\" stroke=\"#c3ccd3\"/>",
                           at_x, at_y - 7.0, band_color(b));
        },
        plot.bands[b].label);
  }
  const double bottom = legend.empty() ? top + height : y + kLine;
  const std::string title = plot.title.empty()
                                ? ""
                                : fmt::format("<text x=\"{:.0f}\" y=\"23\" font-weight=\"600\" font-size=\"16\">{}</text>\n",
                                              kMargin, escaped(plot.title));
  return fmt::format(
      "{}<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"system-ui, Arial, "
      "sans-serif\" "
      "font-size=\"14\" fill=\"#1d2329\">\n<rect width=\"{:.0f}\" height=\"{:.0f}\" fill=\"#ffffff\"/>\n{}{}\n{}</svg>\n",
      kHead, width, bottom, width, bottom, title,
      with_attribute(svg, fmt::format("y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\"", top, width, height)), legend);
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
