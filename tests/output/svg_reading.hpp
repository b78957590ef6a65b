#pragma once
// Reads SVG pictures back: what a picture shows, independent of the code that drew it.

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace driftwright::output {

/// The first group of each match. For short texts: std::regex recurses with the length of a match.
inline std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator m(text.begin(), text.end(), regex), end; m != end; ++m) found.push_back((*m)[1]);
  return found;
}

struct SvgElement {
  std::string name = {};
  std::map<std::string, std::string> attributes = {};
  std::string text = {};  ///< its own, with entities resolved
  int parent = -1;        ///< index in the list; -1: none

  [[nodiscard]] double number(const std::string& key) const { return std::strtod(attributes.at(key).c_str(), nullptr); }
};

/// Text of XML without its entities. @throws std::runtime_error  when it has characters that XML does not allow there
inline std::string resolved(const std::string& text) {
  static const std::map<std::string, char> entities = {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}};
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '<' || (static_cast<unsigned char>(text[i]) < ' ' && text[i] != '\n' && text[i] != '\t'))
      throw std::runtime_error("a character that XML does not allow in: " + text);
    if (text[i] != '&') {
      out += text[i];
      continue;
    }
    const std::size_t end = text.find(';', i);
    if (end == std::string::npos) throw std::runtime_error("an open entity in: " + text);
    out += entities.at(text.substr(i + 1, end - i - 1));
    i = end;
  }
  return out;
}

/// All elements of a document in their order. @throws std::exception  when it is not well-formed
inline std::vector<SvgElement> elements_of(const std::string& svg) {
  std::vector<SvgElement> list;
  std::vector<int> open;
  for (std::size_t at = 0; at < svg.size();) {
    if (svg[at] != '<') {
      const std::size_t end = std::min(svg.find('<', at), svg.size());
      const std::string text = resolved(svg.substr(at, end - at));
      if (!open.empty()) list[static_cast<std::size_t>(open.back())].text += text;
      at = end;
      continue;
    }
    if (svg.compare(at, 2, "<?") == 0) {
      at = svg.find("?>", at) + 2;
      continue;
    }
    const std::size_t end = svg.find('>', at);
    if (end == std::string::npos) throw std::runtime_error("an open tag");
    const std::string tag = svg.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag[0] == '/') {
      if (open.empty() || list[static_cast<std::size_t>(open.back())].name != tag.substr(1))
        throw std::runtime_error("this tag closes no element: " + tag);
      open.pop_back();
      continue;
    }
    const bool is_closed = tag.back() == '/';
    SvgElement element{.name = tag.substr(0, tag.find_first_of(" /\n")), .parent = open.empty() ? -1 : open.back()};
    for (std::size_t i = element.name.size(); i < tag.size() - (is_closed ? 1 : 0);) {
      if (std::isspace(static_cast<unsigned char>(tag[i]))) {
        ++i;
        continue;
      }
      const std::size_t equal = tag.find("=\"", i), quote = equal == std::string::npos ? equal : tag.find('"', equal + 2);
      if (quote == std::string::npos) throw std::runtime_error("not an attribute in: " + tag.substr(0, 200));
      if (!element.attributes.emplace(tag.substr(i, equal - i), resolved(tag.substr(equal + 2, quote - equal - 2))).second)
        throw std::runtime_error("an attribute twice in: " + tag.substr(0, 200));
      i = quote + 1;
    }
    list.push_back(std::move(element));
    if (!is_closed) open.push_back(static_cast<int>(list.size()) - 1);
  }
  if (!open.empty()) throw std::runtime_error("an element is not closed");
  return list;
}

/// Elements of a name within a group of a class.
inline std::vector<SvgElement> within(const std::vector<SvgElement>& all, const std::string& group,
                                      const std::string& name) {
  std::vector<SvgElement> found;
  for (const SvgElement& element : all) {
    if (element.name != name) continue;
    for (int i = element.parent; i >= 0; i = all[static_cast<std::size_t>(i)].parent) {
      const auto& attributes = all[static_cast<std::size_t>(i)].attributes;
      const auto its_class = attributes.find("class");
      if (its_class == attributes.end() || its_class->second != group) continue;
      found.push_back(element);
      break;
    }
  }
  return found;
}

struct PathCommand {
  char letter = 'M';
  std::vector<double> numbers = {};
};

/// The commands of a path's `d`.
inline std::vector<PathCommand> path_of(const std::string& d) {
  std::vector<PathCommand> commands;
  for (const char* at = d.c_str(); *at != '\0';) {
    if (std::isalpha(static_cast<unsigned char>(*at))) {
      commands.push_back({*at++});
    } else if (*at == ',' || *at == ' ') {
      ++at;
    } else {
      char* end = nullptr;
      commands.back().numbers.push_back(std::strtod(at, &end));
      if (end == at) throw std::runtime_error("not a path: " + d.substr(0, 200));
      at = end;
    }
  }
  return commands;
}

/// The number that a tick's label says: "−2.5e−7".
inline double number_of(std::string label) {
  for (std::size_t at; (at = label.find("−")) != std::string::npos;) label.replace(at, std::string("−").size(), "-");
  char* end = nullptr;
  const double value = std::strtod(label.c_str(), &end);
  if (label.empty() || *end != '\0') throw std::runtime_error("not a number: " + label);
  return value;
}

}  // namespace driftwright::output
