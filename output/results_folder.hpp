#pragma once
// The folder that a command writes its results to. It appears complete or not at all: files are written to a folder
// beside it, which takes its place at the end, and files of the user are not lost.

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.hpp"
#include "output/provenance.hpp"

namespace driftwright::output {

/// Name of the file, inside a folder of results, that lists the files which the program wrote:
///     { "program": "driftwright", "version": ..., "scenario": ..., "files": ["report.html", ...] }
inline constexpr const char* kManifestName = "driftwright-manifest.json";

/// "cannot WHAT 'PATH': REASON". @param error  of the system, as errno
[[nodiscard]] InputError cannot(const std::string& what, const std::filesystem::path& path, int error);

/// Writes `text` to `file`, replacing it. Every step is checked, also closing: a full disk may show only there.
/// @throws InputError  naming the file and the system's reason
void write_file(const std::filesystem::path& file, std::string_view text);

/// Checks whether results may take the place of `target`, as the constructor below does, and changes nothing.
/// @returns the target: absolute, links resolved
/// @throws InputError  as the constructor, except for a parent that cannot be written to
std::filesystem::path check_results_folder(const std::filesystem::path& target, bool force);

/// A folder of results in preparation. Construct it before anything is computed, since its constructor may refuse; write
/// through path() or write_text(); call commit() last. Without commit, its destructor removes everything.
///
/// Only one process may work on one target at a time. Links are never followed when files are deleted.
class ResultsFolder {
 public:
  /// Checks `target` and creates the folder `<target>.partial-<pid>` to work in.
  ///
  /// Allowed are: a target that does not exist (missing parents are created), an empty folder, and a folder in which
  /// every file is listed in its own manifest. With `force`, also a folder with other files: commit() deletes them.
  /// Partial folders beside the target, left by processes that have ended, are removed.
  /// @throws InputError  saying what to do, when the target holds other files and `force` is false; and always when it is
  /// no folder, is the current or the home folder or one that contains them, is a mount point, or when its parent cannot
  /// be created or written to
  ResultsFolder(const std::filesystem::path& target, bool force, Provenance made_by);
  ~ResultsFolder();
  ResultsFolder(const ResultsFolder&) = delete;
  ResultsFolder& operator=(const ResultsFolder&) = delete;

  /// The final place of the results: absolute, links resolved.
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }
  [[nodiscard]] const Provenance& made_by() const { return made_by_; }
  /// The files that path() was called for so far, sorted.
  [[nodiscard]] const std::set<std::string>& files() const { return files_; }

  /// Where to write the file `relative` ("fields/fields_0000.vtu") until commit(). Creates its subfolder and adds it to
  /// the manifest.
  /// @throws std::logic_error  when `relative` is empty, absolute or leads out of the folder, or after commit()
  [[nodiscard]] std::filesystem::path path(const std::filesystem::path& relative);

  /// write_file() to path(relative).
  void write_text(const std::filesystem::path& relative, std::string_view text);

  /// Writes the manifest, syncs everything to disk, and puts the folder in place of the target. Files of others that
  /// appeared in the target since the constructor checked it (a ParaView state saved during a long run) are moved into
  /// the new folder.
  /// @throws InputError  naming what could not be written or renamed; the target is then unchanged
  void commit();

 private:
  void sync_all() const;

  std::filesystem::path target_;
  std::filesystem::path work_;
  std::vector<std::filesystem::path> created_parents_;  // innermost last; removed again without a commit
  std::set<std::string> files_;                         // sorted, so that the manifest's bytes do not depend on order
  Provenance made_by_;
  bool force_;
  bool committed_ = false;
};

}  // namespace driftwright::output
