#pragma once
// `driftwright inject` between two files, for the tests of the verb and of what real programs make of its output.

#include <sys/wait.h>

#include <array>
#include <string>
#include <vector>

#include "compensation/injector/quadrature.hpp"
#include "tests/command_line.hpp"

namespace driftwright {

struct Filtered {
  int exit_code = -1;
  std::string rows;   ///< standard output
  std::string words;  ///< standard error
};

/// Feeds text to the filter.
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

/// Legs of so many quarter steps each, from 00 on; 00 is the first row.
inline std::vector<compensation::Lines> legs(const std::vector<int>& quarters) {
  std::vector<compensation::Lines> rows = {0};
  for (int n : quarters) {
    const auto leg = compensation::motion_rows(rows.back(), n);
    rows.insert(rows.end(), leg.begin(), leg.end());
  }
  return rows;
}

/// What a x4 or x1 counter makes of rows of text that begin anywhere; a jump fails the test that calls.
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
