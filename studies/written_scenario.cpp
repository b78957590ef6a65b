#include "studies/written_scenario.hpp"

#include <fmt/format.h>

#include "base/config_text.hpp"
#include "base/delimited_text.hpp"
#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/line_diff.hpp"
#include "effects/former_words.hpp"
#include "scenarios/reader/moved_paths.hpp"

namespace driftwright::studies {

WrittenScenario written_scenario(const MeasuredTwin& m, const std::vector<diagnosis::StatedChange>& changes,
                                 std::vector<std::string> head, const std::filesystem::path& file,
                                 const std::optional<scenarios::KnownTogether>& known_together) {
  const std::filesystem::path folder = file.parent_path();
  WrittenScenario written{
      diagnosis::extended_scenario(m.scenario, *m.twin, m.runs, changes, std::move(head), folder, known_together), {}, {}};
  const std::string name = file.filename().string();
  try {
    std::vector<effects::FormerWord> former;  // in the user's text; they are kept
    ConfigNodePtr tree = effects::in_present_words(read_config_text(written.extended.text, file.string()), former);
    if (!folder.empty()) tree = scenarios::with_absolute_paths(tree, folder);
    written.effects = scenarios::read_scenario(ConfigMap::of_tree(tree)).machine->effects;
  } catch (const InputError& e) {
    written.extended.not_written.push_back(fmt::format("{} as a whole: it could not be read back: {}", name, e.what()));
    return written;
  }
  written.difference =
      unified_diff(read_bytes(m.scenario.path), written.extended.text, name_in_comments(m.scenario.path), name);
  return written;
}

std::string name_in_comments(const std::string& path) {
  return clean_name(std::filesystem::path(path).filename().string());
}

}  // namespace driftwright::studies
