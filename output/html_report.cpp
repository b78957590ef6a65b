#include "output/html_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "output/figure_file.hpp"
#include "output/markup.hpp"
#include "output/plot_legend.hpp"

namespace driftwright::output::html {
namespace {

/// Text with what is between two grave accents as code: commands, files and keys.
std::string prose(const std::string& text) {
  std::string out;
  std::size_t from = 0;
  for (;;) {
    const std::size_t open = text.find('`', from);
    const std::size_t close = open == std::string::npos ? open : text.find('`', open + 1);
    if (close == std::string::npos) return out + escaped(text.substr(from));
    out += escaped(text.substr(from, open - from)) + "<code>" + escaped(text.substr(open + 1, close - open - 1)) + "</code>";
    from = close + 1;
  }
}

constexpr std::string_view kStyle = R"css(
:root { color-scheme: light dark; --text: #1d2329; --soft: #5b6670; --line: #d9dee3; --page: #ffffff; --card: #f5f7f9;
  --good: #00704f; --bad: #b34700; --neutral: #005f94; }
@media (prefers-color-scheme: dark) { :root { --text: #e4e7ea; --soft: #a3adb6; --line: #3a424a; --page: #171b1f;
  --card: #21272d; --good: #35c499; --bad: #ff9350; --neutral: #63b8ee; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 40px 20px 64px; max-width: 1000px; background: var(--page); color: var(--text);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; }
header { border-bottom: 2px solid var(--text); margin-bottom: 28px; padding-bottom: 12px; }
h1 { font-size: 28px; line-height: 1.2; margin: 0; }
header p { color: var(--soft); margin: 6px 0 0; max-width: none; overflow-wrap: anywhere; }
h2 { font-size: 20px; line-height: 1.3; margin: 40px 0 12px; }
h3 { font-size: 17px; line-height: 1.3; margin: 28px 0 8px; }
p { margin: 12px 0; max-width: 46em; }
code { font: 0.92em ui-monospace, SFMono-Regular, Menlo, monospace; overflow-wrap: anywhere; }
.verdict { margin: 20px 0; padding: 14px 18px; background: var(--card); border-left: 6px solid var(--tone);
  border-radius: 4px; }
.verdict strong { color: var(--tone); font-size: 18px; }
.verdict p { margin: 4px 0 0; }
.good { --tone: var(--good); } .bad { --tone: var(--bad); } .neutral { --tone: var(--neutral); }
.table { overflow-x: auto; margin: 20px 0; }
table { border-collapse: collapse; font-size: 15px; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--soft); padding-bottom: 6px; }
th, td { padding: 6px 10px; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
th { border-bottom: 2px solid var(--soft); vertical-align: bottom; }
.number { text-align: right; }
td.number { white-space: nowrap; }
.wide table { font-size: 13px; } .wide th, .wide td { padding: 5px 7px; }
.wide th, .wide td:not(.number) { overflow-wrap: anywhere; min-width: 5em; }
details { margin: 14px 0; } details > summary { cursor: pointer; color: var(--neutral); } details > .table { margin-top: 4px; }
details.part { border-top: 1px solid var(--line); padding-top: 10px; } details.part > summary { font-size: 17px; font-weight: 600; }
details.part[open] > summary { margin-bottom: 12px; } details.part details.part { border-top: 0; padding: 0 0 0 12px; }
.plots { display: grid; grid-template-columns: 1fr 1fr; gap: 20px 16px; margin: 20px 0; }
figure { margin: 0; padding: 12px 0 10px; background: #ffffff; color: #1d2329; border: 1px solid #d9dee3;
  border-radius: 4px; grid-column: 1 / -1; min-width: 0; break-inside: avoid; }
figure + figure { margin-top: 20px; } .plots figure + figure { margin-top: 0; }
figure.half { grid-column: auto; }
figcaption { font-weight: 600; padding: 0 16px 6px; }
figure svg { display: block; width: 100%; height: auto; }
.legend { list-style: none; display: flex; flex-wrap: wrap; gap: 2px 22px; margin: 6px 16px 0; padding: 0;
  font-size: 14px; }
.legend li { display: flex; align-items: center; gap: 8px; }
.legend i { flex: none; width: 24px; border-top: 3px solid var(--c); }
.legend i.dashed { border-top-style: dashed; }
.legend i.points { width: 8px; height: 8px; border: 0; border-radius: 50%; background: var(--c); margin: 0 8px; }
.legend i.band { height: 14px; border: 1px solid #c3ccd3; background: var(--c); }
.legend i.limit { border-top: 2px dashed var(--c); }
.bars td { border: 0; padding: 2px 10px; } .bars td.long { width: 45%; }
.bars { width: 100%; } .bars i { display: block; height: 14px; margin-top: 5px; background: var(--neutral); border-radius: 2px; }
pre { background: var(--card); border: 1px solid var(--line); border-radius: 4px; padding: 12px 16px; overflow-x: auto;
  font: 13px/1.45 ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace; }
@media (max-width: 640px) { figure.half { grid-column: 1 / -1; } }
@media print { .table { overflow: visible; } .table table { max-width: 100%; } .table:not(.wide) td:not(.number), .table:not(.wide) th { overflow-wrap: break-word; }
  .wide table { font-size: 7pt; } .wide th, .wide td { padding: 3px 4px; min-width: 0; } details > summary { color: var(--soft); list-style: none; }
  details::details-content { content-visibility: visible; height: auto; }
  body { padding: 0; max-width: none; font-size: 11pt; } table { font-size: 9pt; } th, td { padding: 4px 6px; } h2, h3 { break-after: avoid; }
  tr, .verdict { break-inside: avoid; } pre { white-space: pre-wrap; } * { print-color-adjust: exact; } }
)css";

/// Does a cell begin like a number: a digit, perhaps after signs, dots and spaces?
bool looks_numeric(const std::string& cell) {
  std::string_view rest = cell;
  for (bool skipped = true; skipped;) {
    skipped = false;
    for (const std::string_view lead : {"+", "-", "−", "±", "<", ">", "≤", "≥", "≈", ".", " "}) {
      if (rest.starts_with(lead)) {
        rest.remove_prefix(lead.size());
        skipped = true;
      }
    }
  }
  return !rest.empty() && rest.front() >= '0' && rest.front() <= '9';
}

bool is_blank(const std::string& cell) {
  return cell.empty() || cell == "-" || cell == "–" || cell == "—";
}

bool is_number_column(const Table& table, std::size_t column) {
  bool any = false;
  for (const auto& row : table.rows) {
    if (is_blank(row[column])) continue;
    if (!looks_numeric(row[column])) return false;
    any = true;
  }
  return any;
}

std::string html(const Heading& heading) {
  return fmt::format("<h{0}>{1}</h{0}>\n", heading.level, escaped(heading.text));
}
std::string html(const Paragraph& paragraph) {
  return fmt::format("<p>{}</p>\n", prose(paragraph.text));
}
std::string html(const Preformatted& text) {
  return fmt::format("<pre>{}</pre>\n", escaped(text.text));
}

std::string html(const FoldBegin& fold) {
  return fmt::format("<details class=\"part\"><summary>{}</summary>\n", prose(fold.title));
}
std::string html(const FoldEnd&) {
  return "</details>\n";
}

std::string html(const Verdict& verdict) {
  const char* kind = verdict.kind == Verdict::Kind::kGood ? "good" : verdict.kind == Verdict::Kind::kBad ? "bad" : "neutral";
  return fmt::format("<div class=\"verdict {}\"><strong>{}</strong>{}</div>\n", kind, escaped(verdict.title),
                     verdict.text.empty() ? "" : fmt::format("<p>{}</p>", prose(verdict.text)));
}

constexpr std::size_t kWide = 8;  // most columns that fit a page at normal size

std::string html(const Table& table) {
  const bool has_headers = !table.headers.empty();
  const std::size_t n_columns = has_headers ? table.headers.size() : table.rows.empty() ? 0 : table.rows.front().size();
  for (const auto& row : table.rows) {
    if (row.size() != n_columns) {
      throw std::logic_error(fmt::format("table '{}': {} cells under {} headers", table.caption, row.size(), n_columns));
    }
  }
  std::vector<std::string> attribute;  // for the cells of each column
  for (std::size_t c = 0; c < n_columns; ++c) {
    attribute.emplace_back(is_number_column(table, c) ? " class=\"number\"" : "");
  }
  std::string out;
  const std::string& fold = table.title.empty() ? table.caption : table.title;
  const bool folds = table.folded && !fold.empty(), has_caption = !table.caption.empty() && !(folds && table.title.empty());
  if (folds) out += fmt::format("<details><summary>{}</summary>\n", prose(fold));
  out += fmt::format("<div class=\"table{}\"><table>\n", n_columns > kWide ? " wide" : "");
  if (has_caption) out += fmt::format("<caption>{}</caption>\n", prose(table.caption));
  if (has_headers) out += "<thead><tr>";
  for (std::size_t c = 0; c < table.headers.size(); ++c) {
    out += fmt::format("<th{}>{}</th>", attribute[c], escaped(table.headers[c]));
  }
  out += has_headers ? "</tr></thead>\n<tbody>\n" : "<tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) out += fmt::format("<td{}>{}</td>", attribute[c], prose(row[c]));
    out += "</tr>\n";
  }
  return out + (folds ? "</tbody></table></div></details>\n" : "</tbody></table></div>\n");
}

std::string html(const Bars& bars) {
  double longest = 0.0;
  for (const Bars::Bar& b : bars.bars) longest = std::max(longest, b.value);
  std::string out = "<div class=\"table\"><table class=\"bars\">\n";
  if (!bars.caption.empty()) out += fmt::format("<caption>{}</caption>\n", escaped(bars.caption));
  for (const Bars::Bar& b : bars.bars) {
    const double percent = longest > 0.0 ? 100.0 * std::max(0.0, b.value) / longest : 0.0;
    out += fmt::format("<tr><td>{}</td><td class=\"long\"><i style=\"width:{:.1f}%\"></i></td><td>{}</td></tr>\n",
                       escaped(b.label), percent, escaped(b.text));
  }
  return out + "</table></div>\n";
}

std::string html(const Picture& picture) {
  return fmt::format("<figure>{}\n{}</figure>\n",
                     picture.title.empty() ? "" : fmt::format("<figcaption>{}</figcaption>", escaped(picture.title)),
                     picture.svg);
}

/// The class of a swatch in the style sheet.
const char* class_of(LegendEntry::Swatch swatch) {
  switch (swatch) {
    case LegendEntry::Swatch::kLine:
      return "line";
    case LegendEntry::Swatch::kDashed:
      return "dashed";
    case LegendEntry::Swatch::kPoints:
      return "points";
    case LegendEntry::Swatch::kBand:
      return "band";
    case LegendEntry::Swatch::kLimit:
      return "limit";
  }
  throw std::logic_error("a legend entry of unknown kind");
}

std::string legend(const Plot& plot) {
  std::string items;
  for (const LegendEntry& entry : legend_entries(plot))
    items += fmt::format("<li><i class=\"{}\" style=\"--c:{}\"></i>{}</li>", class_of(entry.swatch), entry.color,
                         escaped(entry.label));
  return items.empty() ? "" : fmt::format("<ul class=\"legend\">{}</ul>", items);
}

std::string html(const Plot& plot, const std::string& svg) {
  const std::string caption = plot.title.empty() ? "" : fmt::format("<figcaption>{}</figcaption>", escaped(plot.title));
  return fmt::format("<figure{}>{}\n{}{}</figure>\n", plot.half_width ? " class=\"half\"" : "", caption, svg, legend(plot));
}

}  // namespace

Rendered render_html(const Report& report) {
  std::vector<Plot> plots;
  for (const ReportBlock& block : report.blocks) {
    if (const auto* plot = std::get_if<Plot>(&block)) plots.push_back(*plot);
  }
  const std::vector<std::string> svgs = draw_svgs(plots);

  std::string body;
  std::size_t n_drawn = 0;
  FigureFiles figures;
  bool in_plots = false;  // consecutive plots share a grid, so that half-width plots pair up
  for (const ReportBlock& block : report.blocks) {
    const auto* plot = std::get_if<Plot>(&block);
    if ((plot != nullptr) != in_plots) body += in_plots ? "</div>\n" : "<div class=\"plots\">\n";
    in_plots = plot != nullptr;
    if (plot != nullptr) {
      figures.add(plot->title, plot_file(*plot, svgs[n_drawn]));
      body += html(*plot, svgs[n_drawn++]);
    } else {
      std::visit(
          [&](const auto& other) {
            using Kind = std::decay_t<decltype(other)>;
            if constexpr (std::is_same_v<Kind, Picture>) figures.add(other.title, svg_file(other.svg));
            if constexpr (!std::is_same_v<Kind, Plot>) body += html(other);
          },
          block);
    }
  }
  if (in_plots) body += "</div>\n";

  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n"
      "<style>{1}</style>\n</head>\n<body>\n<header><h1>{0}</h1>{2}</header>\n{3}</body>\n</html>\n",
      escaped(report.title), kStyle, report.subtitle.empty() ? "" : fmt::format("<p>{}</p>", escaped(report.subtitle)),
      body);
  return {std::move(page), std::move(figures).take()};
}

}  // namespace driftwright::output::html
