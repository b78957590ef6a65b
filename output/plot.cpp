#include "output/plot.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "base/errors.hpp"

namespace driftwright::output {
namespace {

// Okabe & Ito's colours without yellow, which is faint on white.
constexpr std::array kPalette = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"};
constexpr std::array kBandColors = {"#DCEFE6", "#FBEBCB"};

// Size of a plot [px]. Two half-width plots with the gap between them are as wide as a full one.
constexpr int kWidth = 960, kHalfWidth = 472, kHeight = 340, kHalfHeight = 300;
constexpr double kCharacterWidth = 6.6;  // mean width of a character of the font below [px]

/// A file without a name; the system removes it with this object or with the process.
class NamelessFile {
 public:
  explicit NamelessFile(const char* what) : handle_(memfd_create(what, MFD_CLOEXEC)) {
    if (handle_ < 0) throw InputError(fmt::format("no room for the plots of the report: {}", std::strerror(errno)));
  }
  ~NamelessFile() { close(handle_); }
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;
  [[nodiscard]] int handle() const { return handle_; }

  void write_from_start(std::string_view text) {
    while (!text.empty()) {
      const ssize_t n = ::write(handle_, text.data(), text.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw InputError(fmt::format("no room for the plots of the report: {}", std::strerror(errno)));
      text.remove_prefix(static_cast<std::size_t>(n));
    }
    lseek(handle_, 0, SEEK_SET);
  }
  [[nodiscard]] std::string text() const {
    std::string all(static_cast<std::size_t>(std::max<off_t>(0, lseek(handle_, 0, SEEK_END))), '\0');
    std::size_t n_read = 0;
    for (ssize_t n = 1; n > 0 && n_read < all.size(); n_read += static_cast<std::size_t>(std::max<ssize_t>(0, n)))
      n = pread(handle_, all.data() + n_read, all.size() - n_read, static_cast<off_t>(n_read));
    all.resize(n_read);
    return all;
  }

 private:
  int handle_;
};

/// A gnuplot string literal, in which only the quote itself is special.
std::string quoted(const std::string& text) {
  std::string literal = "'";
  for (const char c : text) {
    if (c == '\'')
      literal += "''";
    else
      literal += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return literal + "'";
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// The range widened by `margin` of its size at both ends; never empty, so that round-off on a constant
  /// curve does not fill the plot.
  [[nodiscard]] Range padded(double margin) const {
    if (low > high) return {0.0, 1.0};
    const double least = std::max(1e-6 * std::max(std::abs(low), std::abs(high)), 1e-12);
    if (high - low < least) {
      const double half = low == 0.0 && high == 0.0 ? 1.0 : 0.05 * std::max(std::abs(low), std::abs(high));
      return {low - half, high + half};
    }
    return {low - margin * (high - low), high + margin * (high - low)};
  }
};

bool is_sample(const Series& s, std::size_t i) {
  return std::isfinite(s.x[i]) && std::isfinite(s.y[i]);
}

/// Samples of a series, a blank line for each gap. With `alone`, only those with a gap on either side, which
/// a line would not show.
std::string data_lines(const Series& s, bool alone) {
  std::string lines;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const bool is_alone = (i == 0 || !is_sample(s, i - 1)) && (i + 1 == s.x.size() || !is_sample(s, i + 1));
    if (is_sample(s, i)) {
      if (!alone || is_alone) lines += fmt::format("{:.9g} {:.9g}\n", s.x[i], s.y[i]);
    } else if (!lines.ends_with("\n\n") && !lines.empty()) {
      lines += "\n";
    }
  }
  return lines.find_first_not_of('\n') == std::string::npos ? "" : lines;
}

std::string style_of(const Series& s, Series::Style style, const std::string& color) {
  switch (style) {
    case Series::Style::kLine:
      return fmt::format("with lines lw {} lc rgb '{}'", s.width, color);
    case Series::Style::kSteps:
      return fmt::format("with steps lw {} lc rgb '{}'", s.width, color);
    case Series::Style::kPoints:
      return fmt::format("with points pt 7 ps {} lc rgb '{}'", 0.2 * s.width, color);
    case Series::Style::kDashed:
      return fmt::format("with lines lw {} dt (7,5) lc rgb '{}'", s.width, color);
  }
  throw std::logic_error("a series of unknown style");
}

/// The row of each mark's label above the frame, from zero, chosen so that neighbouring labels do not overlap.
std::vector<int> label_rows(const std::vector<SectionMark>& marks, const Range& x, double frame_width) {
  std::vector<double> row_end;  // [px]
  std::vector<int> rows;
  for (const SectionMark& mark : marks) {
    const double start = (mark.x - x.low) / (x.high - x.low) * frame_width;
    std::size_t row = 0;
    while (row < row_end.size() && row_end[row] > start) ++row;
    if (row == row_end.size()) row_end.push_back(0.0);
    row_end[row] = start + kCharacterWidth * static_cast<double>(mark.label.size() + 2);
    rows.push_back(static_cast<int>(row));
  }
  return rows;
}

void check(const Plot& plot) {
  for (const Series& s : plot.series) {
    if (s.x.size() != s.y.size()) {
      throw std::logic_error(
          fmt::format("plot '{}': series '{}' has {} x and {} y", plot.title, s.label, s.x.size(), s.y.size()));
    }
  }
  for (const Band& b : plot.bands) {
    if (!std::isfinite(b.low) || !std::isfinite(b.high)) {
      throw std::logic_error(fmt::format("plot '{}': band '{}' is not finite", plot.title, b.label));
    }
  }
}

/// The gnuplot commands that draw one plot to standard output.
std::string script(const Plot& plot) {
  Range x, y;
  for (const Series& s : plot.series) {
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!is_sample(s, i)) continue;
      x.include(s.x[i]);
      y.include(s.y[i]);
    }
  }
  const bool empty = x.low > x.high;
  for (const SectionMark& m : plot.marks) x.include(m.x);
  for (const Band& b : plot.bands) {
    y.include(b.low);
    y.include(b.high);
  }
  x = x.padded(0.0);
  y = y.padded(0.05);

  const int width = plot.half_width ? kHalfWidth : kWidth;
  const std::vector<int> rows = label_rows(plot.marks, x, width - 132);
  const int n_rows = rows.empty() ? 0 : 1 + *std::max_element(rows.begin(), rows.end());

  std::string out = "reset\nunset key\n";
  out += fmt::format("set terminal svg size {},{} fixed noenhanced font 'Arial,13' background '#ffffff'\n", width,
                     (plot.half_width ? kHalfHeight : kHeight) + 16 * n_rows);
  out += "set output\n";
  // The same left margin in every plot, so that plots above each other share their time axis.
  out += fmt::format("set lmargin 11\nset rmargin 3.5\nset bmargin 3\nset tmargin {}\n", 0.8 + n_rows);
  out +=
      "set border 3 lc rgb '#888888' lw 1\nset tics nomirror textcolor rgb '#333333' scale 0.6\nset format "
      "'%g'\n";
  out += "set grid lt 1 lw 0.6 lc rgb '#dddddd'\nset minussign\n";
  out += fmt::format("set xrange [{:.12g}:{:.12g}]\nset yrange [{:.12g}:{:.12g}]\n", x.low, x.high, y.low, y.high);
  out += fmt::format("set xlabel {} offset 0, 0.4 textcolor rgb '#333333'\n", quoted(plot.x_label));
  // A label instead of gnuplot's ylabel, which long tick labels push out of the picture.
  out += fmt::format("set label {} at screen {:.4f}, graph 0.5 center rotate by 90 textcolor rgb '#333333'\n",
                     quoted(plot.y_label), 18.0 / width);
  for (std::size_t b = 0; b < plot.bands.size(); ++b) {
    const Band& band = plot.bands[b];
    if (band.low != band.high) {
      out += fmt::format(
          "set object rectangle from graph 0, first {:.9g} to graph 1, first {:.9g} behind fillcolor rgb "
          "'{}' "
          "fillstyle solid noborder\n",
          band.low, band.high, band_color(b));
    } else {
      out += fmt::format(
          "set arrow from graph 0, first {0:.9g} to graph 1, first {0:.9g} nohead lw 1.2 dt (4,3) lc rgb "
          "'#777777'\n",
          band.low);
    }
  }
  for (std::size_t m = 0; m < plot.marks.size(); ++m) {
    const SectionMark& mark = plot.marks[m];
    out += fmt::format(
        "set arrow from first {0:.9g}, graph 0 to first {0:.9g}, graph 1 nohead lw 1 dt (2,3) lc rgb "
        "'#777777'\n",
        mark.x);
    out += fmt::format("set label {} at first {:.9g}, graph 1 offset 0, {} left font ',11' textcolor rgb '#555555'\n",
                       quoted(mark.label), mark.x, 0.6 + rows[m]);
  }
  if (empty) out += "set label 'no data' at graph 0.5, graph 0.5 center textcolor rgb '#777777'\n";

  std::string curves;
  int n_curves = 0;
  const auto add_curve = [&](const std::string& data, const std::string& style, const std::string& label) {
    if (data.empty()) return;
    const std::string block = fmt::format("$data{}", n_curves++);
    out += fmt::format("{} << END\n{}END\n", block, data);
    curves += fmt::format("{} {} using 1:2 {} title {}", curves.empty() ? "plot" : ",", block, style, quoted(label));
  };
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& s = plot.series[i];
    const std::string color = series_color(plot, i);
    add_curve(data_lines(s, false), style_of(s, drawn_style(plot, i), color), s.label);
    if (s.style != Series::Style::kPoints) {
      add_curve(data_lines(s, true), fmt::format("with points pt 7 ps 0.3 lc rgb '{}'", color), s.label);
    }
  }
  if (curves.empty()) curves = "plot NaN notitle";
  return out + curves + "\nunset output\n";
}

/// The output of gnuplot for `commands`. It uses no disk, so a full disk or a missing TMPDIR does not matter.
/// @throws InputError  when gnuplot is missing or killed; std::runtime_error  when it rejects the commands
std::string drawn_by_gnuplot(const std::string& commands) {
  NamelessFile input("plots.gp"), output("plots.svg"), messages("messages");
  input.write_from_start("set encoding utf8\n" + commands);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input.handle(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output.handle(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, messages.handle(), STDERR_FILENO);
  std::string arguments[] = {"gnuplot", "--default-settings"};  // default: no .gnuplot of the user
  char* argv[] = {arguments[0].data(), arguments[1].data(), nullptr};
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, "gnuplot", &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw InputError(
        fmt::format("gnuplot, which draws the plots of the report, cannot be started: {} (Debian: apt "
                    "install gnuplot-nox)",
                    std::strerror(error)));
  }
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status))
    throw InputError(fmt::format("gnuplot, which draws the plots of the report, was ended: {}; is memory short?",
                                 strsignal(WTERMSIG(status))));
  if (WEXITSTATUS(status) != 0)
    throw std::runtime_error("gnuplot failed to draw the plots of the report: " + messages.text());
  return output.text();
}

/// Splits a stream of documents. @throws InputError  if one is missing or incomplete
std::vector<std::string> whole_documents(const std::string& stream, std::size_t n_wanted) {
  constexpr std::string_view kBegin = "<svg", kEnd = "</svg>";
  std::vector<std::string> found;
  for (std::size_t at = stream.find(kBegin); at != std::string::npos; at = stream.find(kBegin, at)) {
    const std::size_t end = stream.find(kEnd, at);
    if (end == std::string::npos) break;
    found.push_back(stream.substr(at, end + kEnd.size() - at));
    at = end;
  }
  if (found.size() != n_wanted || stream.rfind(kBegin) > stream.rfind(kEnd))
    throw InputError(
        fmt::format("gnuplot drew {} of the report's {} plots to their end; is memory short?", found.size(), n_wanted));
  return found;
}

std::string with_inserted(const std::string& text, std::string_view after, const std::string& insertion) {
  std::string out;
  out.reserve(text.size() + text.size() / 16);
  std::size_t from = 0;
  for (std::size_t at; (at = text.find(after, from)) != std::string::npos; from = at + after.size()) {
    out.append(text, from, at + after.size() - from).append(insertion);
  }
  return out.append(text, from);
}

/// gnuplot's <svg> element, prepared for a page with others: without prologue, with `prefix` on every id and every
/// reference to one, and without the line that names gnuplot's version.
std::string embeddable(std::string svg, const std::string& prefix) {
  const std::size_t title = svg.find("<title>"), title_end = svg.find("</desc>");
  if (title < title_end && title_end != std::string::npos) svg.erase(title, title_end + 7 - title);
  for (const std::string_view after : {" id='", " id=\"", "href='#", "url(#"}) {
    svg = with_inserted(svg, after, prefix);
  }
  return svg;
}

}  // namespace

std::string series_color(const Plot& plot, std::size_t series) {
  const int chosen = plot.series[series].color;
  return kPalette[(chosen >= 0 ? static_cast<std::size_t>(chosen) : series) % kPalette.size()];
}

Series::Style drawn_style(const Plot& plot, std::size_t series) {
  const Series& s = plot.series[series];
  const bool color_is_taken = s.color < 0 && series >= kPalette.size();
  return color_is_taken && s.style == Series::Style::kLine ? Series::Style::kDashed : s.style;
}

std::string band_color(std::size_t band) {
  return kBandColors[band % kBandColors.size()];
}

std::vector<std::string> draw_svgs(std::span<const Plot> plots) {
  if (plots.empty()) return {};
  std::string commands;
  for (std::size_t p = 0; p < plots.size(); ++p) {
    check(plots[p]);
    commands += script(plots[p]);
  }
  std::vector<std::string> svgs = whole_documents(drawn_by_gnuplot(commands), plots.size());
  for (std::size_t p = 0; p < svgs.size(); ++p)
    svgs[p] = embeddable(std::move(svgs[p]), fmt::format("plot{}-", p + 1)) + "\n";
  return svgs;
}

}  // namespace driftwright::output
