#pragma once
// Runs `driftwright inject` between two files, for tests of the verb and of real programs that read its output.

#include <sys/wait.h>

#include <array>
#include <string>
#include <vector>

#include "compensation/injector/quadrature.hpp"
#include "tests/shared/command_line.hpp"

namespace driftwright {

struct Filtered {
  int exit_code = -1;
  std::string rows;   ///< standard output
  std::string words;  ///< standard error
};

/// Runs the filter on a text.
inline Filtered inject(const std::string& name, const std::string& arguments, const std::string& rows) {
  const auto folder = fresh_folder(name);
  const std::string base = folder.string();
  write_file(name + "/in.txt", rows);
  const int status = std::system(
      ("cd " + base + " && " + DRIFTWRIGHT_PROGRAM + " inject " + arguments + " <in.txt >out.txt 2>err.txt").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder / "out.txt"), read_text(folder / "err.txt")};
}

/// Rows as text, each `times` times.
inline std::string row_text(const std::vector<compensation::Lines>& rows, int times = 1) {
  std::string text;
  for (compensation::Lines row : rows) {
    for (int i = 0; i < times; ++i) text += std::string(row & 1 ? "1 " : "0 ") + (row & 2 ? "1\n" : "0\n");
  }
  return text;
}

/// Legs with these numbers of quarter steps, from 00; 00 is the first row.
inline std::vector<compensation::Lines> legs(const std::vector<int>& quarters) {
  std::vector<compensation::Lines> rows = {0};
  for (int n : quarters) {
    const auto leg = compensation::motion_rows(rows.back(), n);
    rows.insert(rows.end(), leg.begin(), leg.end());
  }
  return rows;
}

/// The count of an x4 or x1 counter over rows of text with any first row; a jump fails the calling test.
inline compensation::QuadratureCounter counted(const std::string& text,
                                               compensation::Counting counting = compensation::Counting::kX4) {
  const auto lines = [&](std::size_t at) {
    return static_cast<compensation::Lines>((text[at] & 1) | (text[at + 2] & 1) << 1);
  };
  compensation::QuadratureCounter counter(lines(0), counting);
  for (std::size_t at = 0; at < text.size(); at += 4) counter.step(lines(at));
  return counter;
}

}  // namespace driftwright
