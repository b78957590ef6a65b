#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "app/progress.hpp"
#include "app/verbs.hpp"
#include "base/config_map.hpp"
#include "machine/runnable.hpp"
#include "output/machine_picture.hpp"
#include "output/results_folder.hpp"
#include "studies/machine_draft_text.hpp"

namespace driftwright::app {
namespace {

namespace fs = std::filesystem;

/// The folder in preparation, beside its target; it is removed unless keep() is called.
class NewFolder {
 public:
  explicit NewFolder(const fs::path& target)
      : target_(target), work_(fmt::format("{}.partial-{}", target.string(), getpid())) {
    if (fs::exists(target_))
      throw InputError(
          fmt::format("'{}' is there already, and nothing in it is overwritten; take another name", target_.string()));
    std::error_code failed;
    fs::create_directories(work_, failed);
    if (failed) throw InputError(fmt::format("the folder '{}' cannot be made: {}", target_.string(), failed.message()));
  }
  ~NewFolder() {
    std::error_code ignored;
    fs::remove_all(work_, ignored);
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  [[nodiscard]] const fs::path& work() const { return work_; }
  void keep() {
    std::error_code failed;
    fs::rename(work_, target_, failed);
    if (failed) throw InputError(fmt::format("the folder '{}' cannot be made: {}", target_.string(), failed.message()));
  }

 private:
  fs::path target_, work_;
};

constexpr const char* kPicture = "regions.svg";

/// A picture with each region in its own colour, named at its thermometer.
std::string regions_picture(const studies::MachineDraft& draft, const mesh::Mesh& mesh) {
  std::vector<output::PictureMark> marks;
  for (const auto& point : draft.thermometers) marks.push_back({.name = point.region, .at_m = point.at_m});
  return output::draw_machine({.mesh = &mesh, .by_region = true, .marks = marks});
}

/// The error that the scenario gives when it is read, with the file's final path; "" if there is none.
std::string complaint(const fs::path& file) {
  try {
    const scenarios::Scenario scenario = scenarios::read_scenario(file.string());
    scenarios::require_runnable(scenario, scenarios::place(*scenario.machine));
    return "";
  } catch (const InputError& e) {
    return e.what();
  }
}

}  // namespace

void init(const InitOptions& options) {
  fs::path target = fs::path(options.folder).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();  // "name/"
  const std::string name = target.filename().string();
  if (!is_name(name))
    throw InputError(fmt::format("'{}' names no scenario; letters, digits, '_' and '-' are allowed, 200 at most", name));
  const bool is_lumped = options.from == "lumped";
  if (is_lumped && !options.units.empty()) throw InputError("--units is allowed only with a mesh file");
  NewFolder folder(target);
  Progress progress(false);
  const std::string file = name + ".yaml";
  std::vector<std::string> remarks;
  if (is_lumped) {
    output::write_file(folder.work() / file, studies::lumped_scenario_text(name));
  } else {
    progress.begin("reading " + options.from);
    const mesh::UnnamedGeometry geometry = mesh::read_unnamed_geometry(options.from, options.units);
    const fs::path source = options.from;
    std::error_code failed;
    fs::copy_file(source, folder.work() / source.filename(), failed);
    if (failed) throw InputError(fmt::format("'{}' cannot be copied: {}", options.from, failed.message()));
    const studies::MachineDraft draft = studies::draft_of(geometry);
    progress.begin("drawing");
    output::write_file(folder.work() / kPicture, regions_picture(draft, geometry.mesh));
    remarks = draft.remarks;
    output::write_file(folder.work() / file, studies::scenario_text(draft, geometry, name, source.filename().string()));
  }
  progress.begin("checking");
  const std::string wrong = complaint(folder.work() / file);
  progress.end();
  folder.keep();
  for (const std::string& remark : remarks) fmt::print(stderr, "note: {}\n", remark);
  if (!wrong.empty())
    throw InputError(
        fmt::format("{} is written, and needs changes by hand before it runs: {}", (target / file).string(), wrong));
  if (!is_lumped) fmt::print("{} shows which region is which.\n", (target / kPicture).string());
  fmt::print("{} is written. What it says is a guess where a comment says so.\n  driftwright run {}\n",
             (target / file).string(), (target / file).string());
}

}  // namespace driftwright::app
