#pragma once
// A report as one HTML file that needs nothing else: text, tables and plots, for the screen and for paper.

#include <string>
#include <variant>
#include <vector>

#include "output/plot.hpp"

namespace driftwright::output::html {

struct Heading {
  std::string text = {};
  int level = 2;  ///< 2 or 3: a section, or one within it
};
struct Paragraph {
  std::string text = {};
};
struct Preformatted {
  std::string text = {};
};

/// What the reader should take home, in a coloured box.
struct Verdict {
  enum class Kind { kGood, kBad, kNeutral };
  Kind kind = Kind::kNeutral;
  std::string title = {};  ///< a few words: "Safe to use"
  std::string text = {};   ///< a sentence or two, may be empty
};

/// Cells are text, formatted by the caller (the same number of decimals down a column, units in the header).
/// Columns whose filled cells all begin like a number are aligned right.
struct Table {
  std::string caption = {};
  std::vector<std::string> headers = {};            ///< none: the first cells say what stands in the others
  std::vector<std::vector<std::string>> rows = {};  ///< each as long as headers
  bool folded = false;  ///< on the screen its caption alone stands there until it is asked for; on paper it is whole
};

/// An <svg> element as it is.
struct Picture {
  std::string title = {};
  std::string svg = {};
};

using ReportBlock = std::variant<Heading, Paragraph, Verdict, Table, Plot, Preformatted, Bars, Picture>;

/// A figure of a report as a file of its own.
struct Figure {
  std::string name;  ///< of its title, unlike all others of the report; without extension
  std::string svg;   ///< a whole SVG file, with title and legend
};

struct Rendered {
  std::string page;  ///< the text of the HTML file
  std::vector<Figure> figures;
};

struct Report {
  std::string title = {};
  std::string subtitle = {};  ///< say version and scenario here
  std::vector<ReportBlock> blocks = {};
};

/// The page and its figures. All text is escaped; nothing is loaded from elsewhere. The same report gives
/// the same bytes.
/// @throws std::runtime_error  when plots cannot be drawn, see draw_svgs()
/// @throws std::logic_error    when a table's row has another length than its headers, or a plot is
/// ill-formed
[[nodiscard]] Rendered render_html(const Report& report);

}  // namespace driftwright::output::html
