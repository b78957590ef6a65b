#pragma once
// Writes the followed rows as an ordinary record (docs/reference/record.md), which every other verb reads.

#include <cstdio>
#include <memory>
#include <string>

#include "follow/stream_row.hpp"

namespace driftwright::follow {

class RecordFile {
 public:
  /// @param goes_on  append to an existing file, after the session was resumed
  /// @throws InputError  for an existing file without `goes_on`, for a file with other columns, or if it cannot be
  /// written
  RecordFile(const std::string& path, const std::vector<Channel>& channels, const std::string& comment, bool goes_on);
  void add(const StreamRow& row);
  /// @throws InputError  when not all could be written
  void flush();

 private:
  struct Close {
    void operator()(std::FILE* f) const { (void)std::fclose(f); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace driftwright::follow
