#pragma once
// The files of page/ as text; pages contain them unchanged.

#include <string>
#include <vector>

namespace driftwright::output {

struct PageFile {
  std::string name;  ///< "model.js"
  std::string text;
};
[[nodiscard]] const std::vector<PageFile>& twin_page_files();

}  // namespace driftwright::output
