#pragma once
// A report as one HTML file that needs nothing else: text, tables and plots, for the screen and for paper.

#include <string>
#include <variant>
#include <vector>

#include "output/plot.hpp"

namespace driftwright::output {

struct Heading {
  std::string text = {};
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
  std::vector<std::string> headers = {};
  std::vector<std::vector<std::string>> rows = {};  ///< each as long as headers
};

/// Values of the same kind side by side, one line each; bars begin at zero, those of negative values are not drawn.
struct Bars {
  std::string caption = {};
  struct Bar {
    std::string label = {};
    double value = 0.0;
    std::string text = {};  ///< behind the bar: the value with its unit
  };
  std::vector<Bar> bars = {};
};

using ReportBlock = std::variant<Heading, Paragraph, Verdict, Table, Plot, Preformatted, Bars>;

struct Report {
  std::string title = {};
  std::string subtitle = {};  ///< say version and scenario here
  std::vector<ReportBlock> blocks = {};
};

/// The text of the HTML file. All text is escaped; nothing is loaded from elsewhere. The same report gives
/// the same bytes.
/// @throws std::runtime_error  when plots cannot be drawn, see draw_svgs()
/// @throws std::logic_error    when a table's row has another length than its headers, or a plot is
/// ill-formed
[[nodiscard]] std::string render_html(const Report& report);

}  // namespace driftwright::output
