#pragma once
// Texts with one part replaced, and texts as lines.

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace driftwright::fixtures {

/// The text with the first occurrence of a part replaced. The test fails for a text that lacks it.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace driftwright::fixtures
