// One reader of one language: parameters, calls and loops change the same place in the program.
#include "nc/iso_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/delimited_text.hpp"
#include "nc/iso_lines.hpp"
#include "nc/operators.hpp"

namespace driftwright {
namespace {

constexpr std::size_t kDeepestSubroutine = 10;  // nested subroutines, LinuxCNC's limit
constexpr int kLocals = 30;

/// Upper case without blanks; [ ], #1, #<NAME>, ** MOD EQ NE GT GE LT LE AND OR XOR, SIN[ ] in degrees, ATAN[ ]/[ ].
/// Source: LinuxCNC documentation "G-code Overview" (Parameters, Expressions, Binary Operators, Functions).
const NcSyntax& iso_syntax() {
  static const NcSyntax syntax = {
      .operators = {{"**", 5, op::power},
                    {"*", 4, op::product},
                    {"/", 4, op::quotient},
                    {"MOD", 4, op::modulus},
                    {"+", 3, op::plus},
                    {"-", 3, op::minus},
                    {"EQ", 2, op::equal},
                    {"NE", 2, op::unequal},
                    {"GT", 2, op::greater},
                    {"GE", 2, op::at_least},
                    {"LT", 2, op::less},
                    {"LE", 2, op::at_most},
                    {"AND", 1, op::both},
                    {"OR", 1, op::either},
                    {"XOR", 1, op::one_of}},
      .functions = {{"FIX", [](double x) { return std::floor(x); }}, {"FUP", [](double x) { return std::ceil(x); }}},
      .angle_of_ratio = "ATAN",
      .open = '[',
      .close = ']',
      .has_numbered = true,
      .is_joined = true};
  return syntax;
}

struct File {
  std::vector<IsoLine> lines;
};

struct Frame {
  const File* file = nullptr;
  std::size_t at = 0;
  std::map<int, NcValue> locals = {};
  std::map<std::string, NcValue> names = {};
  std::string label = {};                    ///< of the routine
  std::map<std::string, long> repeats = {};  ///< runs left of each REPEAT under way
  std::set<std::string> dos = {};            ///< DO loops under way
  bool fanuc = false;                        ///< M98
  long runs_left = 0;                        ///< M98 L
};

}  // namespace

class IsoSource::Impl {
 public:
  Impl(const std::string& path, const std::vector<std::string>& lines, NcExecution& run, NcMachineParameters machine)
      : path_(path), run_(run), machine_(std::move(machine)) {
    const File& file = load(path, lines);
    run_.expect(file.lines.size());
    frames_.push_back({.file = &file});
  }

  std::optional<NcBlock> next() {
    while (frame().at < frame().file->lines.size()) {
      const IsoLine& line = frame().file->lines[frame().at++];
      run_.count(line.where);
      switch (line.kind) {
        case IsoLine::kPercent: {
          if (frames_.size() > 1) fail(line, 0, "'%' within a subroutine");
          NcBlock end;  // has the effect of M2: nothing after it is read
          end.where = line.where;
          end.words.push_back({.letter = '%', .value = 0.0, .text = "%", .column = line.columns[0]});
          return end;
        }
        case IsoLine::kFlow:
          flow(line);
          break;
        case IsoLine::kBlock:
          if (auto block = ready(line, line.block)) return block;
          break;
        case IsoLine::kComputed:
          if (auto block = ready(line, computed(line))) return block;
          break;
      }
    }
    if (frames_.size() > 1)
      throw InputError(fmt::format("{}: a subroutine ends with its file; write ENDSUB or M99 at its end", path_));
    return std::nullopt;
  }

 private:
  Frame& frame() { return frames_.back(); }

  [[noreturn]] static void fail(const IsoLine& line, std::size_t i, const std::string& message) {
    Where where = line.where;
    where.column = line.columns[std::min(i, line.columns.size() - 1)];
    throw InputError(where, message);
  }

  const File& load(const std::string& path, const std::vector<std::string>& lines) {
    return *files_.emplace(path, std::make_unique<File>(File{read_iso_lines(path, lines)})).first->second;
  }
  const File& load(const std::string& path) {
    const auto found = files_.find(path);
    return found != files_.end() ? *found->second : load(path, read_text_lines(path));
  }

  // --- numbers

  NcValue look_up(const std::string& name) {
    if (name[0] == '<') {
      const auto& names = name[1] == '_' ? globals_ : frame().names;
      const auto found = names.find(name);
      if (found != names.end()) return found->second;
      if (const auto known = machine_(name)) return *known;
      throw RangeError(fmt::format("#{} has no value yet", name));
    }
    const int number = std::stoi(name);
    const auto& numbered = number <= kLocals ? frame().locals : numbered_;
    if (number == 0) throw RangeError("#0 holds nothing");
    const auto found = numbered.find(number);
    if (found != numbered.end()) return found->second;
    if (const auto known = machine_(name)) return *known;
    return {0.0};
  }

  NcLookup lookup() {
    return [this](const std::string& name) { return look_up(name); };
  }

  void assign(const std::string& name, NcValue value) {
    if (name[0] == '<') {
      (name[1] == '_' ? globals_ : frame().names)[name] = value;
      return;
    }
    const int number = std::stoi(name);
    (number <= kLocals ? frame().locals : numbered_)[number] = value;
  }

  NcValue value(const IsoLine& line, std::size_t& i, bool whole) {
    try {
      return evaluate(line.text, i, iso_syntax(), lookup(), whole);
    } catch (const RangeError& e) {
      fail(line, i, e.what());
    }
  }

  /// The condition after an O word's keyword. @returns its value; notes if the value is known only at the machine
  bool condition(const IsoLine& line) {
    std::size_t i = line.rest;
    if (i >= line.text.size() || line.text[i] != '[') fail(line, i, "a condition in [ ] is expected");
    const NcValue c = value(line, i, false);
    if (!c.certain)
      run_.note_at(
          line.where, line.keyword,
          fmt::format("this is decided at the machine; it is planned as if it were {}", c.value != 0.0 ? "true" : "false"));
    return c.value != 0.0;
  }

  NcBlock computed(const IsoLine& line) {
    NcBlock block;
    block.where = line.where;
    const std::string& text = line.text;
    std::vector<std::pair<std::string, NcValue>> assigned;  // apply from the next line on
    for (std::size_t i = 0; i < text.size();) {
      const std::size_t begin = i;
      if (text[i] == '#') {
        ++i;
        std::string name;
        try {
          name = parameter_name(text, i, iso_syntax(), lookup());
        } catch (const RangeError& e) {
          fail(line, i, e.what());
        }
        if (i >= text.size() || text[i] != '=') fail(line, i, "'=' is expected after a parameter");
        ++i;
        assigned.emplace_back(name, value(line, i, false));
        continue;
      }
      NcWord word;
      word.letter = text[i];
      word.column = line.columns[i];
      if (word.letter < 'A' || word.letter > 'Z')
        fail(line, i, fmt::format("'{}' is not allowed here; words of a letter and a number are expected", word.letter));
      ++i;
      const NcValue number = value(line, i, false);
      word.value = number.value;
      word.certain = number.certain;
      word.computed = true;
      word.text = text.substr(begin, i - begin);
      block.words.push_back(std::move(word));
    }
    for (const auto& [name, number] : assigned) assign(name, number);
    return block;
  }

  /// Executes M98 and M99 of a block. @returns the rest of the block, if anything remains
  std::optional<NcBlock> ready(const IsoLine& line, NcBlock block) {
    const auto find = [&](char letter, double number) {
      return std::find_if(block.words.begin(), block.words.end(),
                          [&](const NcWord& w) { return w.letter == letter && (number < 0.0 || w.value == number); });
    };
    const auto call = find('M', 98.0), back = find('M', 99.0);
    if (back != block.words.end()) {
      block.words.erase(back);
      return_from_fanuc(line, block);
    } else if (call != block.words.end()) {
      block.words.erase(call);
      long number = -1, times = 1;
      for (const char letter : {'P', 'L'}) {
        const auto word = find(letter, -1.0);
        if (word == block.words.end()) continue;
        (letter == 'P' ? number : times) = std::lround(word->value);
        block.words.erase(word);
      }
      call_fanuc(line, number, times);
    }
    if (block.words.empty()) return std::nullopt;
    return block;
  }

  // --- order of execution

  void enter(const IsoLine& line, Frame next) {
    if (frames_.size() > kDeepestSubroutine)
      fail(line, 0, fmt::format("subroutines are nested more than {} deep", kDeepestSubroutine));
    frames_.push_back(std::move(next));
  }

  void call_fanuc(const IsoLine& line, long number, long times) {
    if (number < 0) fail(line, 0, "M98 without its P");
    const std::string label = fmt::format("{}", number);
    if (times < 1) return;
    const std::vector<IsoLine>& lines = frame().file->lines;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].kind != IsoLine::kFlow || !lines[i].keyword.empty() || lines[i].label != label) continue;
      enter(line, {.file = frame().file, .at = i + 1, .label = label, .fanuc = true, .runs_left = times - 1});
      return;
    }
    fail(line, 0, fmt::format("there is no subprogram O{} in the program", number));
  }

  void return_from_fanuc(const IsoLine& line, NcBlock& block) {
    if (frames_.size() == 1) {
      run_.note_at(line.where, "M99", "the program begins again at the control; it is planned once, up to here");
      block.where = line.where;
      block.words.push_back({.letter = '%', .value = 0.0, .text = "M99", .column = line.columns[0]});
      std::swap(block.words.front(), block.words.back());
      block.words.resize(1);
      return;
    }
    if (!frame().fanuc) fail(line, 0, "M99 is not allowed within a subroutine of O words; write ENDSUB or RETURN instead");
    if (frame().runs_left-- > 0) {
      const std::vector<IsoLine>& lines = frame().file->lines;
      for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i].kind == IsoLine::kFlow && lines[i].keyword.empty() && lines[i].label == frame().label)
          frame().at = i + 1;
      }
      return;
    }
    frames_.pop_back();
  }

  /// The line with one of these keywords and this label: forward from `from`, or backward.
  std::size_t find(const IsoLine& line, std::size_t from, const std::set<std::string>& keywords, bool onward) {
    const std::vector<IsoLine>& lines = frame().file->lines;
    const auto is_it = [&](const IsoLine& l) {
      return l.kind == IsoLine::kFlow && l.label == line.label && keywords.contains(l.keyword);
    };
    if (onward) {
      for (std::size_t i = from; i < lines.size(); ++i)
        if (is_it(lines[i])) return i;
    } else {
      for (std::size_t i = from; i-- > 0;)
        if (is_it(lines[i])) return i;
    }
    fail(line, 0, fmt::format("O{} {} has nothing that {} it", line.label, line.keyword, onward ? "ends" : "begins"));
  }

  void flow(const IsoLine& line) {
    const std::string& k = line.keyword;
    std::size_t& at = frame().at;
    if (k.empty()) return;  // the program number
    if (k == "SUB") {
      at = find(line, at, {"ENDSUB"}, true) + 1;
    } else if (k == "CALL") {
      call(line);
    } else if (k == "ENDSUB" || k == "RETURN") {
      if (frames_.size() == 1 || frame().fanuc)
        fail(line, 0, fmt::format("O{} {} is outside of a subroutine", line.label, k));
      std::size_t i = line.rest;
      if (i < line.text.size()) globals_["<_VALUE>"] = value(line, i, false);
      frames_.pop_back();
    } else if (k == "IF") {
      if (!condition(line)) skip_branch(line);
    } else if (k == "ELSEIF" || k == "ELSE") {  // reached after the branch that was run
      at = find(line, at, {"ENDIF"}, true) + 1;
    } else if (k == "DO") {
      frame().dos.insert(line.label);
    } else if (k == "WHILE") {
      if (frame().dos.contains(line.label)) {
        if (condition(line)) {
          at = find(line, at - 1, {"DO"}, false) + 1;
        } else {
          frame().dos.erase(line.label);
        }
      } else if (!condition(line)) {
        at = find(line, at, {"ENDWHILE"}, true) + 1;
      }
    } else if (k == "ENDWHILE") {
      at = find(line, at - 1, {"WHILE"}, false);
    } else if (k == "REPEAT") {
      std::size_t i = line.rest;
      if (i >= line.text.size()) fail(line, i, "a count in [ ] is expected");
      const NcValue n = value(line, i, false);
      if (!n.certain)
        run_.note_at(line.where, k, fmt::format("the count is known only at the machine; it is planned as {:g}", n.value));
      const long times = std::lround(std::min(n.value, 1e9));
      if (times < 1) {
        at = find(line, at, {"ENDREPEAT"}, true) + 1;
      } else {
        frame().repeats[line.label] = times;
      }
    } else if (k == "ENDREPEAT") {
      if (--frame().repeats[line.label] > 0) at = find(line, at - 1, {"REPEAT"}, false) + 1;
    } else if (k == "BREAK") {
      const std::size_t end = loop_end(line);
      frame().dos.erase(line.label);
      at = end + 1;
    } else if (k == "CONTINUE") {
      at = loop_end(line);
    }
  }

  /// The line that closes the loop of that label: ENDWHILE, or the WHILE of a DO. LinuxCNC cannot leave a REPEAT early.
  std::size_t loop_end(const IsoLine& line) {
    if (frame().dos.contains(line.label)) return find(line, frame().at, {"WHILE"}, true);
    return find(line, frame().at, {"ENDWHILE"}, true);
  }

  void skip_branch(const IsoLine& line) {
    std::size_t i = frame().at;
    while (true) {
      i = find(line, i, {"ELSEIF", "ELSE", "ENDIF"}, true);
      const IsoLine& next = frame().file->lines[i++];
      run_.count(next.where);
      if (next.keyword != "ELSEIF" || condition(next)) break;
    }
    frame().at = i;
  }

  void call(const IsoLine& line) {
    std::string label = line.label;
    std::size_t i = line.rest;
    if (label.empty()) {
      label = fmt::format("{}", std::lround(value(line, i, false).value));
      if (line.text.compare(i, 4, "CALL") != 0) fail(line, i, "CALL is expected here");
      i += 4;
    }
    Frame next;
    next.label = label;
    for (int n = 1; i < line.text.size() && n <= kLocals; ++n) {
      if (line.text[i] != '[') fail(line, i, "arguments must be written in [ ]");
      next.locals[n] = value(line, i, false);
    }
    const auto begins = [&](const File& file) -> std::optional<std::size_t> {
      for (std::size_t k = 0; k < file.lines.size(); ++k) {
        if (file.lines[k].kind == IsoLine::kFlow && file.lines[k].keyword == "SUB" && file.lines[k].label == label) return k;
      }
      return std::nullopt;
    };
    next.file = frame().file;
    auto begin = begins(*next.file);
    if (!begin && next.file != frames_.front().file) {
      next.file = frames_.front().file;
      begin = begins(*next.file);
    }
    if (!begin) {
      std::string name = label[0] == '<' ? label.substr(1, label.size() - 2) : label;
      for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      const bool plain =
          !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
      const std::filesystem::path path = std::filesystem::path(path_).parent_path() / (name + ".ngc");
      if (!plain || !std::filesystem::exists(path))
        fail(line, 0, fmt::format("there is no subroutine O{} in the program, nor {}.ngc beside it", label, name));
      next.file = &load(path.string());
      begin = begins(*next.file);
      if (!begin) fail(line, 0, fmt::format("there is no subroutine O{} in {}", label, path.string()));
    }
    next.at = *begin + 1;
    enter(line, std::move(next));
  }

  std::string path_;
  NcExecution& run_;
  NcMachineParameters machine_;
  std::map<std::string, std::unique_ptr<File>> files_;
  std::vector<Frame> frames_;
  std::map<int, NcValue> numbered_;
  std::map<std::string, NcValue> globals_;
};

IsoSource::IsoSource(const std::string& path, const std::vector<std::string>& lines, NcExecution& run,
                     NcMachineParameters machine)
    : impl_(std::make_unique<Impl>(path, lines, run, std::move(machine))) {}
IsoSource::~IsoSource() = default;
std::optional<NcBlock> IsoSource::next() {
  return impl_->next();
}

}  // namespace driftwright
