#pragma once
// A report as one HTML file without other files: text, tables and plots, for screen and paper.

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

/// The main conclusion for the reader, in a coloured box.
struct Verdict {
  enum class Kind { kGood, kBad, kNeutral };
  Kind kind = Kind::kNeutral;
  std::string title = {};  ///< a few words: "Safe to use"
  std::string text = {};   ///< a sentence or two, may be empty
};

/// Cells are text, formatted by the caller (the same number of decimals down a column, units in the header).
/// Columns in which all filled cells begin like a number are aligned right.
struct Table {
  std::string caption = {};
  std::vector<std::string> headers = {};            ///< none: the first cells are the headings of the others
  std::vector<std::vector<std::string>> rows = {};  ///< each as long as headers
  bool folded = false;     ///< only its title is shown until the reader opens it; browsers since 2025 print the whole table
  std::string title = {};  ///< of a folded table; "": its caption
};

/// An <svg> element, used as it is.
struct Picture {
  std::string title = {};
  std::string svg = {};
};

/// Folds all blocks until the matching FoldEnd: only the title is shown until the reader opens it.
struct FoldBegin {
  std::string title = {};
};
struct FoldEnd {};

using ReportBlock = std::variant<Heading, Paragraph, Verdict, Table, Plot, Preformatted, Bars, Picture, FoldBegin, FoldEnd>;

/// A figure of a report as a separate file.
struct Figure {
  std::string name;  ///< made from its title, unique in the report; without extension
  std::string svg;   ///< a whole SVG file, with title and legend
};

struct Rendered {
  std::string page;  ///< the text of the HTML file
  std::vector<Figure> figures;
};

struct Report {
  std::string title = {};
  std::string subtitle = {};  ///< should name version and scenario
  std::vector<ReportBlock> blocks = {};
};

/// The page and its figures. All text is escaped, and nothing is loaded from elsewhere. The same report gives the same
/// bytes.
/// @throws std::logic_error  when a table's row has another length than its headers, or a plot is ill-formed
[[nodiscard]] Rendered render_html(const Report& report);

}  // namespace driftwright::output::html
