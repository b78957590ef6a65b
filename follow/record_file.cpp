#include "follow/record_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/errors.hpp"

namespace driftwright::follow {
namespace {

std::string header_of(const std::vector<Channel>& channels) {
  std::string text = "time_s";
  for (const Channel& c : channels) text += fmt::format(",{}", c.header());
  return text;
}

/// Removes an incomplete last line. @return the header
std::string mend(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string line, header;
  std::uintmax_t whole = 0;
  while (std::getline(in, line) && !in.eof()) {
    whole += line.size() + 1;
    if (header.empty() && !line.starts_with('#')) header = line;
  }
  in.close();
  std::error_code failed;
  std::filesystem::resize_file(path, whole, failed);
  if (failed) throw InputError(fmt::format("--record {}: {}", path, failed.message()));
  return header;
}

}  // namespace

RecordFile::RecordFile(const std::string& path, const std::vector<Channel>& channels, const std::string& comment,
                       bool goes_on)
    : path_(path) {
  const bool is_there = std::filesystem::exists(path);
  if (is_there && !goes_on)
    throw InputError(fmt::format("--record {}: the file is there already; name another, or go on with it by --state", path));
  if (is_there && !std::filesystem::is_regular_file(path))
    throw InputError(fmt::format("--record {}: a folder, device or pipe of this name exists; it must be a file", path));
  if (is_there && mend(path) != header_of(channels))
    throw InputError(fmt::format("--record {}: it has other columns than the stream", path));
  file_.reset(std::fopen(path.c_str(), "ab"));
  if (!file_) throw InputError(fmt::format("--record {}: cannot be written", path));
  if (!is_there) fmt::print(file_.get(), "# {}\n{}\n", comment, header_of(channels));
}

void RecordFile::add(const StreamRow& row) {
  fmt::print(file_.get(), "{:.10g}", row.time_s);
  for (double value : row.values) {
    if (std::isnan(value)) {
      fmt::print(file_.get(), ",");
    } else {
      fmt::print(file_.get(), ",{:.7g}", value);
    }
  }
  fmt::print(file_.get(), "\n");
}

void RecordFile::flush() {
  if (std::fflush(file_.get()) != 0)
    throw InputError(fmt::format("--record {}: not all could be written; is the disk full?", path_));
}

}  // namespace driftwright::follow
