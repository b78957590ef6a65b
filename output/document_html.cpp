#include "output/document_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace driftwright::output {
namespace {

html::Table page_table(const Table& table) {
  html::Table page{.caption = table.title, .folded = table.detail};
  if (table.detail && !table.title.empty()) {
    page.title = table.title;  // the explanation is inside
    page.caption = table.caption;
  } else if (!table.caption.empty()) {
    page.caption += (page.caption.empty() ? "" : ". ") + table.caption;
  }
  for (const Column& column : table.columns) {
    if (!column.title.empty()) page.headers.push_back(heading_of(column));
  }
  for (const std::vector<Datum>& row : table.rows) {
    if (row.size() != table.columns.size())
      throw std::logic_error(
          fmt::format("table '{}': {} cells under {} headers", table.title, row.size(), table.columns.size()));
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const Column& column = table.columns[c];
      if (column.title.empty()) continue;
      const std::string cell = shown(row[c], column.digits);
      cells.push_back(column.key == "unit" ? shown_unit(cell) : cell);
    }
    page.rows.push_back(std::move(cells));
  }
  return page;
}

class Page {
 public:
  void add_section(const Section& section, int level) {
    const bool has_title = !section.title.empty(), folds = section.detail && has_title;
    if (folds)
      blocks_.emplace_back(html::FoldBegin{section.title});
    else if (has_title)
      blocks_.emplace_back(html::Heading{section.title, std::min(level, 3)});
    const std::size_t n_before = blocks_.size();
    for (const Block& block : section.blocks) std::visit([&](const auto& b) { add(b); }, block);
    for (const Section& part : section.sections) add_section(part, has_title ? level + 1 : level);
    if (has_title && blocks_.size() == n_before)
      blocks_.pop_back();  // a heading over nothing
    else if (folds)
      blocks_.emplace_back(html::FoldEnd{});
  }
  [[nodiscard]] std::vector<html::ReportBlock> blocks() && { return std::move(blocks_); }

 private:
  /// Consecutive values form one table.
  void add(const Value& value) {
    if (value.words.empty()) return;
    const std::string unit =
        value.unit.empty() && value.digits.kind == Digits::Kind::kPercent ? "%" : shown_unit(value.unit);
    const std::string text = shown(value.datum, value.digits) + (unit.empty() ? "" : " " + unit);
    auto* last = blocks_.empty() ? nullptr : std::get_if<html::Table>(&blocks_.back());
    if (!last || !last->headers.empty()) {
      blocks_.emplace_back(html::Table{});
      last = &std::get<html::Table>(blocks_.back());
    }
    last->rows.push_back({value.words, text});
  }
  void add(const Table& table) {
    if (table.rows.empty()) return;
    html::Table page = page_table(table);
    if (!page.headers.empty()) blocks_.emplace_back(std::move(page));
  }
  void add(const Verdict& verdict) {
    const html::Verdict::Kind kind = verdict.kind == Verdict::Kind::kGood  ? html::Verdict::Kind::kGood
                                     : verdict.kind == Verdict::Kind::kBad ? html::Verdict::Kind::kBad
                                                                           : html::Verdict::Kind::kNeutral;
    blocks_.emplace_back(html::Verdict{kind, verdict.title, verdict.text});
  }
  void add(const Text& text) { blocks_.emplace_back(html::Paragraph{text.words}); }
  void add(const Notes& notes) {
    for (const std::string& line : notes.lines) {
      std::string words = notes.sort.empty() ? line : notes.sort + ": " + line;
      if (words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
      blocks_.emplace_back(html::Paragraph{words.ends_with('.') ? words : words + "."});
    }
  }
  void add(const Preformatted& text) {
    if (!text.title.empty()) blocks_.emplace_back(html::Paragraph{text.title});
    blocks_.emplace_back(html::Preformatted{text.text});
  }
  void add(const Plot& plot) { blocks_.emplace_back(plot); }
  void add(const Bars& bars) { blocks_.emplace_back(bars); }
  void add(const Picture& picture) { blocks_.emplace_back(html::Picture{picture.title, picture.svg}); }

  std::vector<html::ReportBlock> blocks_;
};

}  // namespace

std::vector<html::ReportBlock> page_blocks(const Section& section) {
  Page page;
  page.add_section(section, 2);
  return std::move(page).blocks();
}

html::Rendered document_html(const Document& document) {
  const std::string& before = document.subtitle;
  return html::render_html({.title = document.title,
                            .subtitle = fmt::format("{}{}Driftwright {}, scenario {}", before, before.empty() ? "" : "; ",
                                                    document.made_by.version, document.made_by.scenario),
                            .blocks = page_blocks(document.body)});
}

}  // namespace driftwright::output
