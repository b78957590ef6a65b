#pragma once
// The files of page/ as text: what the page is made of is, to the byte, what stands there.

#include <string>
#include <vector>

namespace driftwright::output {

struct PageFile {
  std::string name;  ///< "model.js"
  std::string text;
};
[[nodiscard]] const std::vector<PageFile>& twin_page_files();

}  // namespace driftwright::output
