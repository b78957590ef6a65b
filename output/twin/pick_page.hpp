#pragma once
// One HTML page with a machine's surface, on which a click gives the text of a scenario for a surface, a thermometer or a
// displacement (docs/how-to/view.md).

#include <map>
#include <string>
#include <vector>

#include "mesh/mesh.hpp"
#include "output/machine_picture.hpp"
#include "output/provenance.hpp"

namespace driftwright::output {

struct PickPage {
  std::string name = {}, subtitle = {};
  const mesh::Mesh* mesh = nullptr;  ///< with cells
  std::string no_names = {};         ///< why the scenario cannot name further surfaces, one sentence; "": it can
  std::map<std::string, std::vector<std::string>> carried = {};  ///< by surface: kinds of its effects of heat or film
  std::vector<std::string> channels = {};                        ///< names of sensors and displacements that are taken
  std::vector<PictureMark> marks = {};
  std::string beginning = {};  ///< YAML of a scenario of this file; "": none
  std::vector<std::string> notes = {};
};

/// The text of the HTML file. It loads nothing; names are inserted as text, never as markup. The same page gives the same
/// bytes. @throws std::logic_error  for a mesh without cells
[[nodiscard]] std::string pick_html(const PickPage& page, const Provenance& made_by);

}  // namespace driftwright::output
