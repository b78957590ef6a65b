#pragma once
// Figures of a page as separate SVG files, with title and legend, which the page has as text beside them.

#include <set>
#include <string>
#include <vector>

#include "output/html_report.hpp"
#include "output/plot.hpp"

namespace driftwright::output {

/// An <svg> element as a file of its own, with the namespace and size that a file needs.
[[nodiscard]] std::string svg_file(const std::string& svg);
/// A plot drawn by draw_svgs() with its title above and its legend below it.
[[nodiscard]] std::string plot_file(const Plot& plot, const std::string& svg);

/// Collects figures and gives each a unique name.
class FigureFiles {
 public:
  void add(const std::string& title, std::string svg);
  [[nodiscard]] std::vector<html::Figure> take() && { return std::move(figures_); }

 private:
  std::set<std::string> names_;
  std::vector<html::Figure> figures_;
};

}  // namespace driftwright::output
