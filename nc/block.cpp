#include "nc/block.hpp"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>

#include "base/delimited_text.hpp"

namespace driftwright {
namespace {

constexpr const char* kExpanded = "let the CAM system or post-processor write the program out in plain words";

struct Character {
  char c;
  int column;
};

class LineReader {
 public:
  LineReader(const std::string& path, int number, const std::string& line) : where_{path, number, 1, "", line} {}

  [[noreturn]] void fail(int column, const std::string& message) const {
    Where where = where_;
    where.column = column;
    throw InputError(where, message);
  }

  /// The line in upper case without blanks and comments.
  std::vector<Character> characters() const {
    std::vector<Character> kept;
    int comment_column = 0;  // 0: outside
    for (std::size_t i = 0; i < where_.excerpt.size(); ++i) {
      const char c = where_.excerpt[i];
      const int column = static_cast<int>(i) + 1;
      if (comment_column > 0) {
        if (c == ')') comment_column = 0;
      } else if (c == '(') {
        comment_column = column;
      } else if (c == ';') {
        return kept;
      } else if (std::isspace(static_cast<unsigned char>(c)) == 0) {
        kept.push_back({static_cast<char>(std::toupper(static_cast<unsigned char>(c))), column});
      }
    }
    if (comment_column > 0) fail(comment_column, "a comment that does not end on its line; a ')' is wanted");
    return kept;
  }

  std::vector<NcWord> words(const std::vector<Character>& line) const {
    std::vector<NcWord> words;
    for (std::size_t i = 0; i < line.size();) {
      const auto [letter, column] = line[i++];
      if (letter == '#' || letter == '[' || letter == ']' || letter == '=')
        fail(column, fmt::format("parameters and expressions ('{}') are not computed here; {}", letter, kExpanded));
      if (letter < 'A' || letter > 'Z')
        fail(column, fmt::format("'{}' cannot stand here; words of a letter and a number are wanted", letter));
      std::string digits;
      while (i < line.size() && (std::isdigit(static_cast<unsigned char>(line[i].c)) != 0 || line[i].c == '.' ||
                                 (digits.empty() && (line[i].c == '-' || line[i].c == '+')))) {
        digits += line[i++].c;
      }
      words.push_back({letter, number(letter, digits, i < line.size() ? line[i].c : ' ', column), letter + digits, column});
    }
    return words;
  }

  const Where& where() const { return where_; }

 private:
  double number(char letter, const std::string& digits, char next, int column) const {
    if (digits.empty() && (next == '#' || next == '[' || next == '<'))
      fail(column, fmt::format("parameters and expressions ('{}{}') are not computed here; {}", letter, next, kExpanded));
    const char* begin = digits.data() + (digits.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(begin, digits.data() + digits.size(), value, std::chars_format::fixed);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
      fail(column, fmt::format("'{}{}' is no word; a number is wanted after the letter", letter, digits));
    return value;
  }

  Where where_;
};

}  // namespace

Where NcBlock::at(const NcWord& word) const {
  Where place = where;
  place.column = word.column;
  return place;
}

std::vector<NcBlock> read_nc_blocks(const std::string& path) {
  std::vector<NcBlock> blocks;
  bool started = false;
  int number = 0;
  for (const std::string& text : read_text_lines(path)) {
    ++number;
    const LineReader reader(path, number, text);
    std::vector<Character> line = reader.characters();
    if (line.empty()) continue;
    if (line[0].c == '%') {
      if (line.size() > 1) reader.fail(line[1].column, "'%' stands alone on its line");
      if (started || !blocks.empty()) {
        NcBlock end;  // means the same as M2: nothing after it is read
        end.where = reader.where();
        end.words.push_back({'%', 0.0, "%", line[0].column});
        blocks.push_back(end);
        return blocks;
      }
      started = true;
      continue;
    }
    if (line[0].c == '/') line.erase(line.begin());
    if (!line.empty() && line[0].c == 'O') {
      for (std::size_t i = 1; i < line.size(); ++i) {
        if (std::isdigit(static_cast<unsigned char>(line[i].c)) == 0)
          reader.fail(line[0].column,
                      fmt::format("subprograms, loops and branches (O words) are not run here; {}", kExpanded));
      }
      continue;
    }
    NcBlock block;
    block.words = reader.words(line);
    if (!block.words.empty() && block.words[0].letter == 'N') block.words.erase(block.words.begin());
    if (block.words.empty()) continue;
    block.where = reader.where();
    block.where.column = block.words[0].column;
    blocks.push_back(std::move(block));
  }
  return blocks;
}

}  // namespace driftwright
