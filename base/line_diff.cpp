#include "base/line_diff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace driftwright {
namespace {

constexpr std::size_t kContext = 3;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

struct Step {
  char kind;                  ///< ' ', '-' or '+'
  std::size_t before, after;  ///< number of lines of each text before it
};

/// The longest common subsequence, removed lines before added ones.
std::vector<Step> steps(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::vector<std::vector<int>> common(a.size() + 1, std::vector<int>(b.size() + 1, 0));
  for (std::size_t i = a.size(); i-- > 0;) {
    for (std::size_t j = b.size(); j-- > 0;) {
      common[i][j] = a[i] == b[j] ? common[i + 1][j + 1] + 1 : std::max(common[i + 1][j], common[i][j + 1]);
    }
  }
  std::vector<Step> list;
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    if (i < a.size() && j < b.size() && a[i] == b[j]) {
      list.push_back({' ', i++, j++});
    } else if (j == b.size() || (i < a.size() && common[i + 1][j] >= common[i][j + 1])) {
      list.push_back({'-', i++, j});
    } else {
      list.push_back({'+', i, j++});
    }
  }
  return list;
}

}  // namespace

std::string unified_diff(const std::string& before, const std::string& after, const std::string& before_name,
                         const std::string& after_name) {
  if (before == after) return "";
  const std::vector<std::string> a = lines_of(before), b = lines_of(after);
  const std::vector<Step> list = steps(a, b);
  std::string out = fmt::format("--- {}\n+++ {}\n", before_name, after_name);
  for (std::size_t s = 0; s < list.size();) {
    if (list[s].kind == ' ') {
      ++s;
      continue;
    }
    const std::size_t first = s - std::min(s, kContext);
    std::size_t last_change = s;
    for (std::size_t t = s; t < list.size() && t - last_change <= 2 * kContext; ++t) {
      if (list[t].kind != ' ') last_change = t;
    }
    const std::size_t end = std::min(list.size(), last_change + 1 + kContext);
    std::size_t n_before = 0, n_after = 0;
    std::string body;
    for (std::size_t t = first; t < end; ++t) {
      n_before += list[t].kind != '+';
      n_after += list[t].kind != '-';
      body += list[t].kind + (list[t].kind == '+' ? b[list[t].after] : a[list[t].before]) + "\n";
    }
    out += fmt::format("@@ -{},{} +{},{} @@\n", list[first].before + (n_before > 0), n_before,
                       list[first].after + (n_after > 0), n_after) +
           body;
    s = end;
  }
  return out;
}

}  // namespace driftwright
