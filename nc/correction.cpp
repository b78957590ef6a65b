#include "nc/correction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>

#include "base/characters.hpp"
#include "nc/places.hpp"
#include "nc/units.hpp"
#include "nc/written_words.hpp"

namespace driftwright {
namespace {

/// Lines of a text with their ends.
std::vector<std::string> lines_of(const std::string& bytes) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = bytes.find('\n', begin);
    const std::size_t next = end == std::string::npos ? bytes.size() : end + 1;
    lines.push_back(bytes.substr(begin, next - begin));
    begin = next;
  }
  return lines;
}

std::string line_end(const std::vector<std::string>& lines, std::size_t i) {
  const std::string& like = lines[i].ends_with('\n') ? lines[i] : lines[0];
  return like.ends_with("\r\n") ? "\r\n" : "\n";
}

/// Block number and end of inserted lines, as in the program.
struct BlockStyle {
  bool numbered = false;
  std::string letter = {};  ///< before the number: "N" or none
  std::string end = {};     ///< such as " *"
};

/// Position of the digits of a line's block number, or none.
std::optional<std::pair<std::size_t, std::size_t>> block_number(const std::string& line, const std::string& letter) {
  std::size_t i = line.find_first_not_of(" \t/");
  if (i == std::string::npos || line.compare(i, letter.size(), letter) != 0) return std::nullopt;
  i += letter.size();
  std::size_t end = i;
  while (end < line.size() && is_digit(line[end])) ++end;
  if (end == i || end - i > 9) return std::nullopt;
  return std::pair{i, end};
}

BlockStyle style_of(const std::vector<std::string>& lines, const std::vector<NcStep>& steps, const NcBlockForm& form) {
  BlockStyle style;
  if (!form.number_letter && form.end.empty()) return style;
  const std::string& line = lines[static_cast<std::size_t>(steps[steps.size() / 2].where.line) - 1];
  style.letter = form.number_letter.value_or("");
  style.numbered = form.number_letter && block_number(line, style.letter);
  const std::string block = line.substr(0, line.find_last_not_of(" \t\r\n") + 1);
  if (!form.end.empty() && block.ends_with(form.end)) style.end = " " + form.end;
  return style;
}

class Writer {
 public:
  Writer(const std::string& bytes, const std::vector<NcStep>& steps, const NcOffsetOptions& options)
      : lines_(lines_of(bytes)),
        before_(lines_.size() + 1),
        steps_(steps),
        options_(options),
        language_(*options.language),
        style_(style_of(lines_, steps, language_.block_form())) {}

  void put(std::size_t step, const std::vector<std::string>& lines) { insert(index(step), lines); }

  /// Sets all axes at once, before a block, without motion.
  void set_all(std::size_t step, const std::array<double, 3>& shift_m) {
    const NcModes& modes = steps_[step].before;
    const std::array<double, 3> from_m = written_m_;
    for (int axis = 0; axis < 3; ++axis) written_m_[axis] = as_written_m(shift_m[axis], modes.unit_m);
    insert(index(step), language_.offset_lines(options_, {options_.axes, from_m, written_m_, modes}));
  }

  /// Sets the present corrections again, after a block that has removed them.
  void renew(std::size_t step) {
    const NcStep& own = steps_[step];
    std::array<bool, 3> axes = {false, false, false};
    std::array<double, 3> from_m = written_m_;
    bool any = false;
    for (int axis = 0; axis < 3; ++axis) {
      axes[axis] = options_.axes[axis] && own.resets[axis];
      if (axes[axis]) from_m[axis] = 0.0;
      any = any || axes[axis];
    }
    if (!any) return;
    NcModes modes = own.before;
    if (step + 1 < steps_.size()) modes = steps_[step + 1].before;
    const std::vector<std::string> lines = language_.offset_lines(options_, {axes, from_m, written_m_, modes});
    const auto [place, is_new] = renewed_.emplace(own.where.line, lines);
    if (is_new) {
      insert(static_cast<std::size_t>(std::max(own.where.line, own.last_line)), lines);
    } else if (place->second != lines) {
      throw InputError(
          own.where,
          "this block takes corrections away, and is run again when others are in force; write its part of the program out");
    }
  }

  /// Position of an inserted line: the lines before it at its place; for a block that runs several times, the run in which
  /// it applies.
  struct Mark {
    std::size_t step = 0, nth = 0;
    std::optional<std::size_t> group = {};
  };

  Mark change(const NcOffsetChange& change) {
    const NcStep& step = steps_[change.step];
    std::array<bool, 3> axes = {false, false, false};
    const std::array<double, 3> from_m = written_m_;
    for (int axis = 0; axis < 3; ++axis) {
      axes[axis] = change.shift_m[axis].has_value();
      if (axes[axis]) written_m_[axis] = as_written_m(*change.shift_m[axis], step.before.unit_m);
    }
    std::vector<std::string> lines;
    if (change.share > 0.0) lines = part(step, change.share);
    const std::size_t before = lines.size();
    for (const std::vector<std::string>& more :
         {language_.offset_lines(options_, {axes, from_m, written_m_, step.before}), again(change, axes)})
      lines.insert(lines.end(), more.begin(), more.end());
    if (step.n_runs == 1) return {change.step, insert(index(change.step), lines) + before};
    std::vector<Counted>& groups = counted_[index(change.step)];
    if (groups.empty() || groups.back().nth_run != step.nth_run) groups.push_back({step.nth_run, {}});
    const std::size_t nth = groups.back().lines.size() + before;
    groups.back().lines.insert(groups.back().lines.end(), lines.begin(), lines.end());
    return {change.step, nth, groups.size() - 1};
  }

  /// Sets the counters of blocks that run several times to zero, before the program.
  void begin_counters(std::size_t front) {
    std::vector<std::string>& place = before_.at(index(front));
    std::size_t at = 0;
    for (const auto& [line, groups] : counted_)
      place.insert(place.begin() + static_cast<std::ptrdiff_t>(at++), counter(line, groups.front()).zero);
    n_counters_ = {index(front), at};
    for (const auto& [line, groups] : counted_) {
      std::vector<std::string> lines = {counter(line, groups.front()).count};
      for (const Counted& group : groups) {
        const NcRunCounter words = counter(line, group);
        lines.push_back(words.open);
        lines.insert(lines.end(), group.lines.begin(), group.lines.end());
        lines.push_back(words.close);
      }
      insert(line, lines);
    }
  }

  CorrectedNcProgram result(const std::vector<Mark>& marks) const {
    CorrectedNcProgram program;
    std::vector<int> first_inserted(lines_.size());  // line in the result of the first line inserted before line i
    int n = 1;
    long number = -1;  // of the previous block
    for (std::size_t i = 0; i <= lines_.size(); ++i) {
      if (i < lines_.size()) first_inserted[i] = n;
      for (const std::string& line : before_[i]) {
        if (style_.numbered) program.text += fmt::format("{}{} ", style_.letter, ++number);
        program.text += line + style_.end + line_end(lines_, std::min(i, lines_.size() - 1));
      }
      n += static_cast<int>(before_[i].size()) + 1;
      if (i < lines_.size()) program.text += numbered(lines_[i], number);
    }
    for (const Mark& mark : marks) {
      const std::size_t line = index(mark.step);
      std::size_t n_before = mark.nth;
      if (mark.group) {  // after the counter, the groups before it and its own `if`
        n_before += 2;
        for (std::size_t g = 0; g < *mark.group; ++g) n_before += counted_.at(line)[g].lines.size() + 2;
      } else if (line == n_counters_.first) {
        n_before += n_counters_.second;
      }
      program.lines.push_back(first_inserted[line] + static_cast<int>(n_before));
    }
    return program;
  }

 private:
  struct Counted {
    int nth_run = 1;
    std::vector<std::string> lines;
  };

  NcRunCounter counter(std::size_t line, const Counted& group) const {
    return language_.run_counter(line + 1, group.nth_run).value();
  }

  std::size_t index(std::size_t step) const { return static_cast<std::size_t>(steps_[step].where.line) - 1; }

  /// A line of the program, with its block number increased if an inserted line has taken it.
  std::string numbered(const std::string& line, long& number) const {
    const auto place = style_.numbered ? block_number(line, style_.letter) : std::nullopt;
    if (!place) return line;
    const long own = std::stol(line.substr(place->first, place->second - place->first));
    number = std::max(number + 1, own);
    if (number == own) return line;
    return line.substr(0, place->first) + fmt::format("{}", number) + line.substr(place->second);
  }

  std::size_t insert(std::size_t line, const std::vector<std::string>& lines) {
    std::vector<std::string>& place = before_.at(line);
    const std::size_t at = place.size();
    place.insert(place.end(), lines.begin(), lines.end());
    return at;
  }

  std::vector<std::string> part(const NcStep& step, double share) const {
    std::array<std::optional<double>, 3> to_m{};
    for (int axis = 0; axis < 3; ++axis) {
      if (step.named[axis]) to_m[axis] = step.start_m[axis] + share * (step.end_m[axis] - step.start_m[axis]);
    }
    return language_.straight_lines({step.kind == NcStepKind::kRapid, to_m, step.feed_word, step.before});
  }

  /// Commands the axes to their present position once more, unless the block itself moves them all by rapid.
  std::vector<std::string> again(const NcOffsetChange& change, const std::array<bool, 3>& axes) const {
    const NcStep& step = steps_[change.step];
    const bool on_its_way = change.share > 0.0;
    std::array<std::optional<double>, 3> to_m{};
    bool in_feed = false;
    const std::array<NcEntry, 3> entries = nc_entries(steps_, change.step);
    bool wanted = false;
    for (int axis = 0; axis < 3; ++axis) wanted = wanted || (axes[axis] && entries[axis] != NcEntry::kAlongRapid);
    if (!wanted) return {};
    for (int axis = 0; axis < 3; ++axis) {
      if (!axes[axis] || (entries[axis] == NcEntry::kAlongRapid && !step.known[axis])) continue;
      if (!on_its_way && entries[axis] == NcEntry::kNever)
        throw std::logic_error(fmt::format("an offset of {} may not change before line {}", "XYZ"[axis], step.where.line));
      in_feed = on_its_way ? step.kind == NcStepKind::kLine : in_feed || entries[axis] == NcEntry::kStepInFeed;
      to_m[axis] = step.start_m[axis] + change.share * (step.end_m[axis] - step.start_m[axis]);
    }
    return language_.straight_lines({!in_feed, to_m, "", step.before});
  }

  std::vector<std::string> lines_;
  std::vector<std::vector<std::string>> before_;  // inserted before each line, and after the last
  const std::vector<NcStep>& steps_;
  const NcOffsetOptions& options_;
  const NcLanguage& language_;
  BlockStyle style_;
  std::array<double, 3> written_m_ = {0, 0, 0};  // corrections in force
  std::map<int, std::vector<std::string>> renewed_;
  std::map<std::size_t, std::vector<Counted>> counted_;  // of each line that runs several times
  std::pair<std::size_t, std::size_t> n_counters_ = {0, 0};
};

void check_unit(const std::vector<NcStep>& steps) {
  for (const NcStep& step : steps) {
    if (step.before.unit_m != kMillimetre_m)
      throw InputError(
          step.where,
          "the program is in inches; corrections for this control are written in mm, so write the program in mm");
  }
}

/// The step before which the first offset is inserted: the first that moves or turns on cutter compensation, which forbids
/// offsets, or the last step before it that runs only once.
std::size_t front_of(const std::vector<NcStep>& steps, const NcLanguage& language) {
  std::size_t first = 0;
  while (first + 1 < steps.size() && !steps[first].moves() && !steps[first].compensated) ++first;
  std::size_t front = first;
  while (front > 0 && (steps[front].n_runs > 1 || steps[front].where.file != steps.back().where.file)) --front;
  for (std::size_t i = 0; i < front; ++i) {
    if (steps[i].unit_word && !steps[i].deletable) return front;
  }
  throw InputError(steps[front].where, fmt::format("no unit is stated before this block, and the offset written in front of "
                                                   "it needs one; write {} in a block before the first motion, G41 and G42",
                                                   language.unit_words()));
}

/// The line that removes corrections is inserted before the last block.
void check_end(const NcStep& last, std::vector<std::string>& notes) {
  if (last.before.compensated || last.compensated)
    throw InputError(
        last.where,
        "cutter compensation (G41, G42, RL, RR) is still on at the end, where the offset must change; end it before");
  if (last.no_place || last.n_runs > 1)
    throw InputError(last.where,
                     "the offset must change at the end, but the end lies in a subprogram or another file, or a mirror, a "
                     "rotation or a modal cycle is still on there");
  const bool offset_counts = last.moves() && last.kind != NcStepKind::kMachine;
  if (!offset_counts) return;
  if (last.kind != NcStepKind::kRapid && last.duration_s() > 0.0) {
    throw InputError(
        last.where,
        "the last block cuts, after the line that takes corrections back; write M2 or M30 in a block of its own");
  }
  notes.push_back(fmt::format("line {}: the last block moves; it goes without corrections", last.where.line));
}

/// The comment at the start of the program, for its user.
std::string remark(const NcOffsetOptions& options) {
  if (!options.absolute) return options.language->remark(options);
  std::string values;
  for (int axis = 0; axis < 3; ++axis) {
    if (options.axes[axis]) values += fmt::format(" {}{:g}", "XYZ"[axis], options.base_m[axis] / kMillimetre_m);
  }
  return fmt::format(
      "driftwright: ABSOLUTE OFFSETS. {} is overwritten, from{} mm on; what the operator has set there is lost",
      options.language->offset_name(options), values);
}

}  // namespace

CorrectedNcProgram corrected_nc_program(const std::string& bytes, const std::vector<NcStep>& steps,
                                        const std::array<double, 3>& initial_m, const std::vector<NcOffsetChange>& changes,
                                        const NcOffsetOptions& asked) {
  if (asked.language == nullptr) throw std::logic_error("corrections without the language of their program");
  const NcLanguage& language = *asked.language;
  NcOffsetOptions options = asked;
  options.shares_shift = language.shares_shift(steps);
  if (!language.writes_inches()) check_unit(steps);
  language.check(steps, options);
  if (changes.empty() && initial_m == std::array<double, 3>{0, 0, 0}) return {bytes, {}};
  if (steps.empty() || !steps.back().ends_program) throw std::logic_error("a program without its last block");
  Writer writer(bytes, steps, options);
  std::vector<std::string> notes;
  check_end(steps.back(), notes);
  const std::size_t first = front_of(steps, language);
  language.check_written(steps, first, options);
  std::vector<Writer::Mark> marks;
  writer.put(first, {language.remark_line(remark(options))});
  for (const std::string& text : options.remarks) writer.put(first, {language.remark_line("driftwright: " + text)});
  writer.put(first, language.guard_lines(options));
  writer.set_all(first, initial_m);
  std::size_t next = first;
  const auto renew_until = [&](std::size_t end) {
    for (; next < end; ++next) writer.renew(next);
  };
  for (const NcOffsetChange& change : changes) {
    renew_until(change.step);
    marks.push_back(writer.change(change));
  }
  renew_until(steps.size() - 1);
  writer.set_all(steps.size() - 1, {0, 0, 0});
  writer.begin_counters(first);
  CorrectedNcProgram corrected = writer.result(marks);
  corrected.notes = std::move(notes);
  return corrected;
}

}  // namespace driftwright
