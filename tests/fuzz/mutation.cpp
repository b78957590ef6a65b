#include "tests/fuzz/mutation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/errors.hpp"
#include "base/file_bytes.hpp"
#include "base/random.hpp"

namespace driftwright::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 400000;

const std::vector<std::string>& numbers() {
  static const std::vector<std::string> list = {"0",      "-1",   "1",     "-0.0",       "1e308",      "-1e308",
                                                "1e-320", "nan",  "inf",   "-inf",       "2147483647", "-2147483649",
                                                "1e10",   "010",  "0x1F",  "4294967296", "1e99999",    "9223372036854775808",
                                                "1_000",  "1,5",  "0.1.2", "1e",         "-",          ".",
                                                "",       "1e-9", "65536", "1000000007", "3.5"};
  return list;
}

std::size_t place_in(Random& random, std::size_t size) {
  return size == 0 ? 0 : static_cast<std::size_t>(random.below(static_cast<int>(size)));
}

/// Where a stretch of bytes begins and ends.
std::pair<std::size_t, std::size_t> stretch_of(Random& random, const std::string& bytes, std::size_t most) {
  const std::size_t begin = place_in(random, bytes.size());
  return {begin, std::min(bytes.size(), begin + 1 + place_in(random, most))};
}

/// The line around a place, with its break.
std::pair<std::size_t, std::size_t> line_around(const std::string& bytes, std::size_t at) {
  const std::size_t before = at == 0 ? std::string::npos : bytes.rfind('\n', at - 1), after = bytes.find('\n', at);
  return {before == std::string::npos ? 0 : before + 1, after == std::string::npos ? bytes.size() : after + 1};
}

void replace_number(Random& random, std::string& bytes) {
  const auto is_part = [](unsigned char c) { return std::isdigit(c) || c == '.' || c == '-' || c == '+' || c == 'e'; };
  const std::size_t start = place_in(random, bytes.size());
  const auto found = std::find_if(bytes.begin() + static_cast<std::ptrdiff_t>(start), bytes.end(),
                                  [](unsigned char c) { return std::isdigit(c); });
  if (found == bytes.end()) return;
  const auto end = std::find_if_not(found, bytes.end(), is_part);
  const auto begin = static_cast<std::size_t>(found - bytes.begin());
  bytes.replace(begin, static_cast<std::size_t>(end - found), random.one_of(numbers()));
}

void mutate(Random& random, std::string& bytes, const std::vector<Sample>& corpus, const std::vector<std::string>& words) {
  if (bytes.empty()) bytes = "\n";
  switch (random.below(13)) {
    case 0: {
      char& byte = bytes[place_in(random, bytes.size())];
      byte = static_cast<char>(byte ^ (1 << random.below(8)));
      break;
    }
    case 1:
      bytes[place_in(random, bytes.size())] = static_cast<char>(random.below(256));
      break;
    case 2: {
      const auto [begin, end] = stretch_of(random, bytes, random.chance(0.8) ? 16 : 4000);
      bytes.erase(begin, end - begin);
      break;
    }
    case 3: {
      const auto [begin, end] = stretch_of(random, bytes, random.chance(0.8) ? 16 : 4000);
      bytes.insert(place_in(random, bytes.size()), bytes.substr(begin, end - begin));
      break;
    }
    case 4: {
      std::string more;
      for (int i = random.below(8); i >= 0; --i) more += static_cast<char>(random.below(256));
      bytes.insert(place_in(random, bytes.size()), more);
      break;
    }
    case 5:
    case 6:
    case 7:
      replace_number(random, bytes);
      break;
    case 8: {
      const auto [begin, end] = line_around(bytes, place_in(random, bytes.size()));
      bytes.erase(begin, end - begin);
      break;
    }
    case 9: {
      const auto [begin, end] = line_around(bytes, place_in(random, bytes.size()));
      const std::string line = bytes.substr(begin, end - begin);
      bytes.insert(line_around(bytes, place_in(random, bytes.size())).first, line);
      break;
    }
    case 10: {
      const std::string& other = random.one_of(corpus).bytes;
      bytes.resize(place_in(random, bytes.size()));
      bytes.append(other, place_in(random, other.size()), std::string::npos);
      break;
    }
    case 11:
      bytes.resize(place_in(random, bytes.size()));
      break;
    default:
      if (!words.empty()) bytes.insert(place_in(random, bytes.size()), random.one_of(words));
      break;
  }
  if (bytes.size() > kMostBytes) bytes.resize(kMostBytes);
}

}  // namespace

std::vector<Sample> read_corpus(const std::vector<fs::path>& places, const std::vector<std::string>& extensions) {
  std::vector<fs::path> files;
  const auto add = [&](const fs::path& path) {
    if (std::find(extensions.begin(), extensions.end(), path.extension()) != extensions.end()) files.push_back(path);
  };
  for (const fs::path& place : places) {
    if (!fs::is_directory(place)) {
      add(place);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(place)) {
      if (entry.is_regular_file()) add(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<Sample> corpus;
  for (const fs::path& file : files) {
    std::string bytes = read_bytes(file);
    if (bytes.size() <= kMostBytes) corpus.push_back({file.extension().string(), std::move(bytes)});
  }
  if (corpus.empty()) throw InputError(fmt::format("no file to begin with in {}", places.front().string()));
  return corpus;
}

Sample mutated(const std::vector<Sample>& corpus, const std::vector<std::string>& words, std::uint64_t seed,
               std::uint64_t number) {
  Random random(seed, number);
  Sample sample = random.one_of(corpus);
  if (random.chance(0.01)) return sample;
  for (int n = 1 + random.below(8); n > 0; --n) mutate(random, sample.bytes, corpus, words);
  return sample;
}

}  // namespace driftwright::fuzz
