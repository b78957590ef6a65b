#include "output/machine_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/characters.hpp"
#include "mesh/machine_skin.hpp"
#include "output/base64.hpp"
#include "output/markup.hpp"
#include "output/surface_view.hpp"

namespace driftwright::output {
namespace {

constexpr int kViewWidth = 300, kViewHeight = 420, kDense = 2;  // units of the SVG; pixels a unit
constexpr double kShownBend = 0.05;  // largest displacement in the picture over the machine's size

std::string hex(const std::array<float, 3>& colour) {
  const auto byte = [](float v) { return static_cast<int>(std::lround(255.0F * v)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour[0]), byte(colour[1]), byte(colour[2]));
}

/// A side of a joint lies inside the machine; the reader of a mesh names it a/b@a.
bool is_joint_side(const mesh::Mesh& mesh, int surface) {
  return surface >= 0 && mesh.surfaces[static_cast<std::size_t>(surface)].find('@') != std::string::npos;
}

constexpr std::array<float, 3> kWithoutValue = {0.82F, 0.84F, 0.86F};  // grey; also of faces without a name

/// The dark end of the map would hide how a cold body is shaped.
std::array<float, 3> colour_of(double share) {
  if (std::isnan(share)) return kWithoutValue;
  return inferno(0.15 + 0.85 * share);
}

/// About the width of a text in the picture, of a wide sans-serif font [units of the SVG].
double drawn_width(const std::string& text) {
  constexpr double kOfLetter = 6.8;
  return kOfLetter * static_cast<double>(n_characters(text));
}

/// Beside each view, so that the longest name has room.
double margin_for(const std::vector<PictureMark>& marks) {
  constexpr double kLeast = 100.0;
  double margin = kLeast;
  for (const PictureMark& mark : marks) margin = std::max(margin, std::ceil(drawn_width(mark.name)) + 12.0);
  return margin;
}

/// Labels in a column beside a view, each with a line to its point; none covers another.
std::string labels(const std::vector<PictureMark>& marks, const DrawnView& drawn, double left, double slack) {
  struct Label {
    const PictureMark* mark;
    double x, y, shown_y = 0.0;
    bool hidden;
  };
  std::array<std::vector<Label>, 2> sides;
  for (const PictureMark& mark : marks) {
    const Eigen::Vector2d p = drawn.pixel(mark.at_m) / kDense;
    sides[p.x() < 0.5 * kViewWidth ? 0 : 1].push_back({&mark, left + p.x(), p.y(), 0.0, drawn.hides(mark.at_m, slack)});
  }
  constexpr double kLabelStep = 13.0;
  constexpr std::size_t kMostNames = 30;  // of a side
  std::string out;
  for (int side = 0; side < 2; ++side) {
    auto& list = sides[side];
    std::sort(list.begin(), list.end(), [](const Label& a, const Label& b) { return a.y < b.y; });
    // More than fit are dots without names.
    for (std::size_t i = kMostNames; i < list.size(); ++i)
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\" fill=\"#ffffff\" stroke=\"#1d2329\"/>\n", list[i].x,
                         list[i].y);
    if (list.size() > kMostNames) {
      out += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"{}\">and {} more</text>\n",
                         side == 0 ? left - 6.0 : left + kViewWidth + 6.0, kViewHeight + 10, side == 0 ? "end" : "start",
                         list.size() - kMostNames);
      list.resize(kMostNames);
    }
    double next = kLabelStep;
    for (Label& l : list) next = (l.shown_y = std::max(l.y, next)) + kLabelStep;
    double last = kViewHeight - 4.0;
    for (auto l = list.rbegin(); l != list.rend(); ++l) last = (l->shown_y = std::min(l->shown_y, last)) - kLabelStep;
    const double text_x = side == 0 ? left - 6.0 : left + kViewWidth + 6.0;
    for (const Label& l : list) {
      const char* tone = l.hidden ? "#98a2ab" : "#1d2329";
      out += fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"0.6\" fill=\"none\"/>\n",
                         text_x, l.shown_y - 4.0, l.x, l.y, tone);
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.2\"/>\n",
                         l.x, l.y, l.mark->is_indicator ? 4.5 : 3.0, l.mark->is_indicator ? "none" : "#ffffff",
                         l.mark->is_indicator && !l.hidden ? "#00a0c0" : tone);
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", text_x, l.shown_y,
                         side == 0 ? "end" : "start", tone, escaped(l.mark->name));
    }
  }
  return out;
}

std::string colour_bar(const PictureField& field, double low, double high, double x, double y, double width) {
  constexpr int kSteps = 64;
  std::string out;
  for (int i = 0; i < kSteps; ++i) {
    out += fmt::format("<rect x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"12\" fill=\"{}\"/>\n",
                       x + width * i / kSteps, y, width / kSteps + 0.3, hex(colour_of((i + 0.5) / kSteps)));
  }
  const int decimals = std::clamp(static_cast<int>(std::ceil(1.0 - std::log10((high - low) / 4.0))), 0, 3);
  for (int i = 0; i <= 4; ++i) {
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.{}f}</text>\n", x + width * i / 4.0,
                       y + 26.0, low + (high - low) * i / 4.0, decimals);
  }
  return out + fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", x + 0.5 * width, y - 6.0,
                           escaped(field.label));
}

}  // namespace

std::string draw_machine(const MachinePicture& picture) {
  const mesh::Mesh& mesh = *picture.mesh;
  if (mesh.cells.size() == 0) throw std::logic_error("draw_machine: a mesh without cells");
  if (picture.field && picture.field->value.size() != mesh.n_nodes())
    throw std::logic_error("draw_machine: a field of another mesh");
  mesh::MachineSkin skin = mesh::skin_of(mesh, picture.field ? picture.field->surface : -1);
  if (picture.field) {  // kept machines know regions alone, and a picture must not tell whether the machine was known
    for (std::size_t i = 0; i < skin.part.size(); ++i) skin.part[i] = skin.region[i];
  }
  ColouredSurface surface{.point = mesh.coords, .triangle = skin.triangle, .colour = {}, .part = skin.part};
  const double size_m = (mesh.coords.rowwise().maxCoeff() - mesh.coords.rowwise().minCoeff()).norm();
  double magnified = 0.0;
  if (picture.displacement_m.cols() == mesh.n_nodes()) {
    const double most_m = picture.displacement_m.colwise().norm().maxCoeff();
    if (most_m > 0.0) {
      const double exact = kShownBend * size_m / most_m, decade = std::pow(10.0, std::floor(std::log10(exact)));
      magnified = decade * (exact >= 5 * decade ? 5 : exact >= 2 * decade ? 2 : 1);  // 1, 2 or 5
      surface.point += magnified * picture.displacement_m;
    }
  }
  double low = 0.0, high = 1.0;
  std::set<int> shown;  // surfaces or regions
  const std::vector<std::string>& names = picture.by_region ? mesh.regions : mesh.surfaces;
  if (picture.field) {
    low = picture.field->value.minCoeff<Eigen::PropagateNumbers>();
    high = std::max(picture.field->value.maxCoeff<Eigen::PropagateNumbers>(),
                    low + 0.01);  // what differs by less has one colour
    for (double v : picture.field->value) surface.colour.push_back(colour_of((v - low) / (high - low)));
    // Nodes on the edge of a surface belong to its neighbours, too: these get grey points of their own.
    const Eigen::Index n = surface.point.cols();
    if (const int only = picture.field->surface; only >= 0) {
      surface.point.conservativeResize(Eigen::NoChange, 2 * n);
      surface.point.rightCols(n) = surface.point.leftCols(n).eval();
      surface.colour.resize(static_cast<std::size_t>(2 * n), kWithoutValue);
      for (std::size_t i = 0; i < skin.triangle.size(); ++i) {
        if (skin.surface[i] == only) continue;
        for (int& corner : surface.triangle[i]) corner += static_cast<int>(n);
      }
    }
  } else {
    // Points that surfaces share would mix their colours: each triangle has points of its own.
    Eigen::Matrix3Xd own(3, 3 * static_cast<Eigen::Index>(skin.triangle.size()));
    for (std::size_t i = 0; i < skin.triangle.size(); ++i) {
      const int surface_name = is_joint_side(mesh, skin.surface[i]) ? -1 : skin.surface[i];
      const int name = picture.by_region ? skin.region[i] : surface_name;
      if (name >= 0) shown.insert(name);
      for (int k = 0; k < 3; ++k) {
        const auto to = static_cast<int>(3 * i) + k;
        own.col(to) = surface.point.col(skin.triangle[i][k]);
        surface.triangle[i][k] = to;
        surface.colour.push_back(name >= 0 ? distinct_colour(name) : kWithoutValue);
      }
    }
    surface.point = own;
  }
  const bool in_colours_of_names = !picture.field;
  const double margin = margin_for(picture.marks), width = 2.0 * kViewWidth + 4.0 * margin;
  std::vector<std::pair<std::string, std::string>> legend;  // colour and name
  for (int i : shown) legend.emplace_back(hex(distinct_colour(i)), names[static_cast<std::size_t>(i)]);
  if (!picture.by_region) legend.emplace_back("#d1d6db", "without a name");
  double longest = 200.0;
  for (const auto& [colour, name] : legend) longest = std::max(longest, drawn_width(name));
  const int columns_of_names = std::max(1, static_cast<int>((width - 30.0) / (longest + 40.0)));
  const int rows_of_names =
      in_colours_of_names ? (static_cast<int>(legend.size()) + columns_of_names - 1) / columns_of_names : 0;
  const int height = kViewHeight + (in_colours_of_names ? 20 + 16 * rows_of_names : 62);
  std::string body;
  const View views[2] = {{.towards = {1.0, 1.2, 0.7}}, {.towards = {-1.0, -1.2, 0.7}}};
  const double left_of[2] = {margin, kViewWidth + 3.0 * margin};
  for (int v = 0; v < 2; ++v) {
    const DrawnView drawn = draw_surface(surface, views[v], kDense * kViewWidth, kDense * kViewHeight);
    body += fmt::format("<image x=\"{}\" y=\"0\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n",
                        left_of[v], kViewWidth, kViewHeight, base64(drawn.png));
    std::vector<PictureMark> marks = picture.marks;
    if (magnified > 0.0) {  // where the nearest node went
      for (PictureMark& mark : marks) {
        Eigen::Index nearest = 0;
        (mesh.coords.colwise() - mark.at_m).colwise().squaredNorm().minCoeff(&nearest);
        mark.at_m += magnified * picture.displacement_m.col(nearest);
      }
    }
    body += labels(marks, drawn, left_of[v], 0.01 * size_m);
    body += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"#5b6670\">{}</text>\n",
                        left_of[v] + kViewWidth / 2, kViewHeight + 12, v == 0 ? "from +x, +y" : "from −x, −y");
  }
  if (picture.field) {
    body += colour_bar(*picture.field, low, high, 0.5 * width - 150.0, kViewHeight + 30.0, 300.0);
    if (magnified > 0.0)
      body += fmt::format("<text x=\"30\" y=\"{}\" fill=\"#5b6670\">displacement magnified {:.0f} times</text>\n",
                          height - 6, magnified);
  } else {
    const int column_width = static_cast<int>(width - 30.0) / columns_of_names;
    for (int i = 0; i < static_cast<int>(legend.size()); ++i) {
      const auto& [colour, name] = legend[static_cast<std::size_t>(i)];
      const int x = 30 + column_width * (i % columns_of_names), y = kViewHeight + 30 + 16 * (i / columns_of_names);
      body +=
          fmt::format("<rect x=\"{}\" y=\"{}\" width=\"10\" height=\"10\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
                      x, y - 9, colour, x + 15, y, escaped(name));
    }
  }
  return fmt::format(
      "<svg viewBox=\"0 0 {} {}\" xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"the machine\" "
      "font-family=\"sans-serif\" font-size=\"11\" fill=\"#1d2329\">\n{}</svg>\n",
      width, height, body);
}

}  // namespace driftwright::output
