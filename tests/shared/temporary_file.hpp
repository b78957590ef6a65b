#pragma once
// Files that tests write. Each process has its own folder, since CTest runs many at once, and removes it at its end.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace driftwright {

/// This process's folder for temporary files.
inline const std::filesystem::path& temporary_folder() {
  struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("driftwright_test-" + std::to_string(getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

/// Writes `text` to a file of that name and returns its path.
inline std::string write_file(const std::string& name, const std::string& text) {
  const std::filesystem::path path = temporary_folder() / name;
  std::ofstream(path) << text;
  return path.string();
}

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// An empty folder of this test's own.
inline std::filesystem::path fresh_folder(const std::string& name) {
  const std::filesystem::path folder = temporary_folder() / name;
  std::filesystem::create_directories(folder);
  return folder;
}

}  // namespace driftwright
