#include "output/twin/live_page.hpp"

namespace driftwright::output {

std::string live_html(const LivePage& page) {
  nlohmann::ordered_json data = {{"name", page.name},
                                 {"subtitle", page.subtitle},
                                 {"note", page.note},
                                 {"made_by", page.made_by},
                                 {"reference_degC", page.reference_degC},
                                 {"palette", palette_text()}};
  if (page.surface) {
    data["surface"] = surface_json(*page.surface);
    data["marks"] = marks_json(page.marks, *page.surface);
  } else if (page.network) {
    data["network"] = network_json(*page.network);
  }
  return page_text("live.html", page.name, {"page.css", "live.css"}, data,
                   {"fields.js", "scene.js", "network.js", "charts.js", "picture.js", "live.js"});
}

}  // namespace driftwright::output
