#include "base/config_address.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/config_map.hpp"

namespace driftwright {
namespace {

/// Keys whose values name an entry of a list.
constexpr std::array<const char*, 8> kNamingKeys = {"type", "name", "region", "surface", "joint", "node", "tank", "to"};

std::vector<std::string> words_of(const ConfigNode& entry) {
  std::vector<std::string> words;
  for (const char* key : kNamingKeys) {
    const ConfigNode* value = entry.find(key);
    if (value && value->is_scalar()) words.push_back(value->text);
  }
  return words;
}

std::vector<std::string> split_words(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find('@', begin);
    words.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return words;
}

std::string meant(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = nearest_word(word, known);
  return near.empty() ? "" : fmt::format(". Did you mean '{}'?", near);
}

/// The walk so far.
struct Walk {
  const ConfigNode* node;
  std::string path;  ///< in numbers and keys, "effects[3]"; empty at the root
  const Where& asked;

  [[noreturn]] void fail(const std::string& message) const { throw InputError(asked, message); }
  [[nodiscard]] std::string here() const {
    return path.empty() ? fmt::format("'{}'", node->source->path) : fmt::format("'{}'", path);
  }
};

std::size_t entry_by_number(const Walk& walk, const std::string& number) {
  const std::size_t n = walk.node->items.size();
  const std::size_t index = number.size() > 9 ? n : std::stoul(number);
  if (index < n) return index;
  if (n == 0) walk.fail(fmt::format("{} is an empty list", walk.here()));
  walk.fail(fmt::format("{} has {} entries, [0] to [{}]", walk.here(), n, n - 1));
}

std::size_t entry_by_words(const Walk& walk, const std::string& text) {
  const auto& items = walk.node->items;
  const auto carrying = [&](const std::vector<std::string>& wanted) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::vector<std::string> words = words_of(*items[i]);
      if (std::all_of(wanted.begin(), wanted.end(),
                      [&](const auto& w) { return std::find(words.begin(), words.end(), w) != words.end(); }))
        found.push_back(i);
    }
    return found;
  };
  std::vector<std::size_t> found = carrying({text});  // a name that holds an '@' itself comes first
  if (found.empty()) found = carrying(split_words(text));
  if (found.size() == 1) return found[0];
  std::vector<std::string> shown, known;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::vector<std::string> words = words_of(*items[i]);
    if (words.empty() || (!found.empty() && std::find(found.begin(), found.end(), i) == found.end())) continue;
    known.push_back(fmt::format("{}", fmt::join(words, "@")));
    if (words.size() > 2) known.push_back(words[0] + "@" + words[1]);
    known.insert(known.end(), words.begin(), words.end());
    shown.push_back(fmt::format("[{}] {} (line {})", i, fmt::join(words, "@"), items[i]->line));
  }
  if (shown.empty()) walk.fail(fmt::format("entries of {} have no names; take their number, from [0]", walk.here()));
  if (found.empty()) {
    walk.fail(fmt::format("no entry of {} is named '{}'; there are {}{}", walk.here(), text, fmt::join(shown, ", "),
                          meant(text, known)));
  }
  walk.fail(fmt::format("{} entries of {} are named '{}': {}; add a word with '@', or take the number", found.size(),
                        walk.here(), text, fmt::join(shown, ", ")));
}

/// Longest key of the map that `rest` begins with.
std::size_t key_at_front(const Walk& walk, const std::string& rest) {
  std::optional<std::size_t> best;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < walk.node->keys.size(); ++i) {
    const std::string& key = walk.node->keys[i].text;
    known.push_back(key);
    const bool fits =
        rest.starts_with(key) && (rest.size() == key.size() || rest[key.size()] == '.' || rest[key.size()] == '[');
    if (fits && (!best || key.size() > walk.node->keys[*best].text.size())) best = i;
  }
  if (best) return *best;
  const std::string word = rest.substr(0, rest.find_first_of(".["));
  if (!walk.node->is_map()) walk.fail(fmt::format("{} is no map and has no key '{}'", walk.here(), word));
  walk.fail(fmt::format("{} has no key '{}'; there are {}{} (a key left to its default must be written there to be varied)",
                        walk.here(), word, fmt::join(known, ", "), meant(word, known)));
}

}  // namespace

ConfigSteps find_address(const ConfigNode& root, const std::string& address, const Where& asked) {
  ConfigSteps steps;
  Walk walk{&root, "", asked};
  std::string rest = address;
  while (!rest.empty() || steps.empty()) {
    if (rest.starts_with('[')) {
      const std::size_t end = rest.find(']');
      if (end == std::string::npos || end == 1)
        walk.fail(fmt::format("'{}': a number or a name is required between [ and ]", address));
      if (!walk.node->is_list()) walk.fail(fmt::format("{} is no list", walk.here()));
      const std::string inside = rest.substr(1, end - 1);
      const bool is_number = inside.find_first_not_of("0123456789") == std::string::npos;
      steps.push_back(is_number ? entry_by_number(walk, inside) : entry_by_words(walk, inside));
      walk.path += fmt::format("[{}]", steps.back());
      rest.erase(0, end + 1);
    } else {
      steps.push_back(key_at_front(walk, rest));
      const std::string& key = walk.node->keys[steps.back()].text;
      walk.path += (walk.path.empty() ? "" : ".") + key;
      rest.erase(0, key.size());
    }
    walk.node = walk.node->items[steps.back()].get();
    if (rest.starts_with('.')) {
      rest.erase(0, 1);
      if (rest.empty() || rest[0] == '[') walk.fail(fmt::format("'{}': a key is required after each dot", address));
    } else if (!rest.empty() && rest[0] != '[') {
      walk.fail(fmt::format("'{}': a dot is required before '{}'", address, rest));
    }
  }
  return steps;
}

}  // namespace driftwright
