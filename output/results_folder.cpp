#include "output/results_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/bounded_json.hpp"
#include "base/errors.hpp"

namespace driftwright::output {
namespace {

namespace fs = std::filesystem;

InputError cannot_use(const fs::path& target, const fs::filesystem_error& e) {
  return InputError(fmt::format("-o '{}' cannot be used: {} '{}'; give a folder that can be written to", target.string(),
                                e.code().message(), e.path1().string()));
}

/// Absolute, links resolved, without a slash at its end.
fs::path plain_path(const fs::path& target) {
  const fs::path path = fs::weakly_canonical(fs::absolute(target));
  return path.filename().empty() ? path.parent_path() : path;
}

/// The files in a folder's manifest, and the manifest itself; none if it has no manifest of ours.
std::set<std::string> listed_files(const fs::path& folder) {
  std::ifstream in(folder / kManifestName);
  nlohmann::ordered_json manifest;
  try {
    manifest = parse_json(std::string(std::istreambuf_iterator<char>(in), {}));
  } catch (const InputError&) {
    return {};
  }
  if (!manifest.is_object() || manifest.value("program", nlohmann::ordered_json()) != "driftwright") return {};
  std::set<std::string> listed = {kManifestName};
  for (const auto& file : manifest.value("files", nlohmann::ordered_json::array())) {
    if (file.is_string()) listed.insert(file.get<std::string>());
  }
  return listed;
}

/// All files in a folder, at any depth, that are not listed in its manifest; relative paths, sorted.
std::vector<fs::path> foreign_files(const fs::path& folder) {
  const std::set<std::string> ours = listed_files(folder);
  std::vector<fs::path> foreign;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {  // does not follow links
    const bool is_folder = entry.is_directory() && !entry.is_symlink();
    const fs::path relative = entry.path().lexically_relative(folder);
    if (!is_folder && !ours.contains(relative.generic_string())) foreign.push_back(relative);
  }
  std::sort(foreign.begin(), foreign.end());
  return foreign;
}

bool contains(const fs::path& folder, const fs::path& path) {
  const auto [end, _] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

/// Throws if replacing the folder would do harm that even --force cannot intend.
void refuse_dangerous_target(const fs::path& target) {
  const char* home = std::getenv("HOME");
  if (contains(target, fs::current_path()) ||
      (home != nullptr && *home != '\0' && contains(target, fs::weakly_canonical(home)))) {
    throw InputError(
        fmt::format("-o '{}' is the current or the home folder, or contains it; results replace their folder, "
                    "so give one of their own, such as -o {}",
                    target.string(), (target / "results").string()));
  }
  struct stat here, above;
  if (stat(target.c_str(), &here) == 0 && stat(target.parent_path().c_str(), &above) == 0 && here.st_dev != above.st_dev) {
    throw InputError(fmt::format("-o '{0}' is a mount point and cannot be replaced; give a folder inside it, such as -o {1}",
                                 target.string(), (target / "results").string()));
  }
}

void refuse_foreign_files(const fs::path& target) {
  const std::vector<fs::path> foreign = foreign_files(target);
  if (foreign.empty()) return;
  throw InputError(
      fmt::format("-o '{}' holds {} that {} not results of this program ({}{}); give another folder with -o, or --force "
                  "to replace the folder and delete what it holds",
                  target.string(), foreign.size() == 1 ? "a file" : fmt::format("{} files", foreign.size()),
                  foreign.size() == 1 ? "is" : "are", foreign.front().string(), foreign.size() == 1 ? "" : ", ..."));
}

/// Creates the missing folders on the way to `folder` and returns them, outermost first.
std::vector<fs::path> create_parents(const fs::path& folder) {
  std::vector<fs::path> missing;
  for (fs::path p = folder; !fs::exists(p); p = p.parent_path()) missing.insert(missing.begin(), p);
  fs::create_directories(folder);
  return missing;
}

/// Removes `<target>.partial-<pid>` (and what commit() had set aside) of processes that have ended, and of our own pid:
/// in a container every run may have the same pid.
void remove_stale(const fs::path& target) {
  const std::string prefix = target.filename().string() + ".partial-";
  std::error_code ignored;  // files of another user are skipped
  for (const auto& entry : fs::directory_iterator(target.parent_path())) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix)) continue;
    char* end = nullptr;
    const long pid = std::strtol(name.c_str() + prefix.size(), &end, 10);
    if (pid <= 0 || (*end != '\0' && std::string(end) != "-old")) continue;
    const bool gone = kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH;
    if (gone || pid == getpid()) fs::remove_all(entry.path(), ignored);
  }
}

/// Syncs to disk, so that files are complete after a power cut. @throws InputError  if the disk reports an error
void sync(const fs::path& path) {
  const int handle = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) throw cannot("open", path, errno);
  const int failed = fsync(handle) != 0 ? errno : 0;
  close(handle);
  if (failed != 0 && failed != EINVAL) throw cannot("write", path, failed);  // EINVAL: this file system does not support it
}

/// Puts `work` in the place of `target`. Returns the folder with the previous content of the target, if there was one.
fs::path swap_in(const fs::path& work, const fs::path& target) {
  if (!fs::exists(target)) {
    fs::rename(work, target);
    return {};
  }
  if (renameat2(AT_FDCWD, work.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) return work;
  if (errno != EINVAL && errno != ENOSYS) throw cannot("replace", target, errno);
  const fs::path old = work.string() + "-old";  // for file systems that cannot exchange two folders in one step
  fs::rename(target, old);
  try {
    fs::rename(work, target);
  } catch (const fs::filesystem_error&) {
    fs::rename(old, target);
    throw;
  }
  return old;
}

}  // namespace

InputError cannot(const std::string& what, const fs::path& path, int error) {
  return InputError(fmt::format("cannot {} '{}': {}", what, path.string(), std::strerror(error)));
}

fs::path check_results_folder(const fs::path& target, bool force) {
  if (target.empty()) throw InputError("-o names no folder");
  try {
    const fs::path folder = plain_path(target);
    if (!fs::exists(fs::symlink_status(folder))) return folder;
    if (!fs::is_directory(folder)) {
      throw InputError(fmt::format("-o '{}' exists and is no folder; give another one with -o", folder.string()));
    }
    refuse_dangerous_target(folder);
    if (!force) refuse_foreign_files(folder);
    return folder;
  } catch (const fs::filesystem_error& e) {
    throw cannot_use(target, e);
  }
}

void write_file(const fs::path& file, std::string_view text) {
  std::unique_ptr<FILE, int (*)(FILE*)> out(fopen(file.c_str(), "wb"), &fclose);
  if (!out) throw cannot("write", file, errno);
  if (fwrite(text.data(), 1, text.size(), out.get()) != text.size()) throw cannot("write", file, errno);
  if (fclose(out.release()) != 0) throw cannot("write", file, errno);
}

ResultsFolder::ResultsFolder(const fs::path& target, bool force, Provenance made_by)
    : made_by_(std::move(made_by)), force_(force) {
  target_ = check_results_folder(target, force);
  try {
    created_parents_ = create_parents(target_.parent_path());
    remove_stale(target_);
    work_ = fmt::format("{}.partial-{}", target_.string(), getpid());
    if (!fs::create_directory(work_)) {
      throw fs::filesystem_error("", work_, std::make_error_code(std::errc::file_exists));
    }
  } catch (const fs::filesystem_error& e) {
    throw cannot_use(target, e);
  }
}

ResultsFolder::~ResultsFolder() {
  if (committed_) return;
  std::error_code ignored;  // a destructor cannot report errors
  fs::remove_all(work_, ignored);
  for (auto p = created_parents_.rbegin(); p != created_parents_.rend(); ++p) fs::remove(*p, ignored);  // only empty ones
}

fs::path ResultsFolder::path(const fs::path& relative) {
  const fs::path normal = relative.lexically_normal();
  if (committed_ || normal.filename().empty() || normal.is_absolute() || *normal.begin() == "..") {
    throw std::logic_error(fmt::format("no file '{}' can be made in a folder of results", relative.string()));
  }
  try {
    fs::create_directories((work_ / normal).parent_path());
  } catch (const fs::filesystem_error& e) {
    throw cannot_use(target_, e);
  }
  files_.insert(normal.generic_string());
  return work_ / normal;
}

void ResultsFolder::write_text(const fs::path& relative, std::string_view text) {
  write_file(path(relative), text);
}

void ResultsFolder::sync_all() const {
  sync(work_ / kManifestName);
  for (const std::string& file : files_) sync(work_ / file);
  for (const auto& entry : fs::recursive_directory_iterator(work_)) {
    if (entry.is_directory()) sync(entry.path());
  }
  sync(work_);
}

void ResultsFolder::commit() {
  fs::path old;
  nlohmann::ordered_json manifest = {
      {"program", "driftwright"}, {"version", made_by_.version}, {"scenario", made_by_.scenario}, {"files", files_}};
  write_file(work_ / kManifestName, manifest.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  try {
    sync_all();
    old = swap_in(work_, target_);
  } catch (const fs::filesystem_error& e) {
    throw cannot_use(target_, e);
  }
  committed_ = true;
  if (old.empty()) return;
  if (!force_) {
    for (const fs::path& file : foreign_files(old)) {
      fs::create_directories((target_ / file).parent_path());
      if (!fs::exists(fs::symlink_status(target_ / file))) fs::rename(old / file, target_ / file);
    }
  }
  std::error_code ignored;  // the results are in place; the next run removes what is left of the old ones
  fs::remove_all(old, ignored);
}

}  // namespace driftwright::output
