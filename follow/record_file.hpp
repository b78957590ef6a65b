#pragma once
// The rows that were followed as an ordinary record (docs/reference/record.md), which every other verb reads.

#include <cstdio>
#include <memory>
#include <string>

#include "follow/stream_row.hpp"

namespace driftwright::follow {

class RecordFile {
 public:
  /// @param goes_on  rows are added to the file, where it is there: the session has been resumed
  /// @throws InputError  for a file that is there and not gone on with, or that has other columns; when it cannot be written
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
