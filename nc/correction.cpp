#include "nc/correction.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "nc/places.hpp"
#include "nc/words.hpp"

namespace driftwright {
namespace {

constexpr double kMillimetre_m = 1e-3;

/// "0.0125", "-3", "10": no trailing zeros, no exponent.
std::string number(double x_m, double unit_m) {
  std::string text = unit_m == kMillimetre_m ? fmt::format("{:.6f}", x_m / unit_m) : fmt::format("{:.7f}", x_m / unit_m);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

/// The work offset's number P: 1 for G54 ... 9 for G59.3.
int offset_number(int system) {
  return system <= 590 ? (system - 540) / 10 + 1 : 6 + system - 590;
}

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

class Writer {
 public:
  Writer(const std::string& bytes, const std::vector<NcStep>& steps, const NcOffsetOptions& options)
      : lines_(lines_of(bytes)), before_(lines_.size()), steps_(steps), options_(options) {}

  /// The offset's own lines, for the axes given.
  std::vector<std::string> offset_lines(const std::array<bool, 3>& axes, const NcModes& modes) const {
    const double unit_m = modes.unit_m;
    const bool absolute = modes.absolute;
    std::vector<std::string> lines;
    std::string words;
    const auto word = [&](int axis) { return number(options_.base_m[axis] + shift_m_[axis], unit_m); };
    switch (options_.dialect) {
      case NcDialect::kLinuxCnc:
        words = fmt::format("G10 L2 P{}", offset_number(options_.work_offset));
        for (int axis = 0; axis < 3; ++axis) {
          if (axes[axis]) words += fmt::format(" {}{}", "XYZ"[axis], word(axis));
        }
        lines.push_back(words);
        break;
      case NcDialect::kSiemens:
        for (int axis = 0; axis < 3; ++axis) {
          if (axes[axis]) lines.push_back(fmt::format("$P_BFRAME[{},TR]={}", "XYZ"[axis], word(axis)));
        }
        break;
      case NcDialect::kHeidenhain:
        words = absolute ? "G54" : "G90 G54";  // its values would be increments in G91
        for (int axis = 0; axis < 3; ++axis) {
          if (!options_.axes[axis]) continue;
          const std::string value = word(axis);
          words += fmt::format(" {}{}{}", "XYZ"[axis], value.front() == '-' ? "" : "+", value);
        }
        lines.push_back(words);
        if (!absolute) lines.emplace_back("G91");
        break;
    }
    return lines;
  }

  /// All axes at once, before a block, without any motion. @returns how many lines stand before it there
  std::size_t set_all(std::size_t step, const std::array<double, 3>& shift_m) {
    shift_m_ = shift_m;
    return insert(step, offset_lines(options_.axes, steps_[step].before));
  }

  /// What is in force once more, before a block.
  void renew(std::size_t step) { insert(step, offset_lines(options_.axes, steps_[step].before)); }

  std::size_t change(const NcOffsetChange& change) {
    const NcStep& step = steps_[change.step];
    std::array<bool, 3> axes = {false, false, false};
    for (int axis = 0; axis < 3; ++axis) {
      axes[axis] = change.shift_m[axis].has_value();
      if (axes[axis]) shift_m_[axis] = *change.shift_m[axis];
    }
    if (change.share > 0.0) insert(change.step, {part(step, change.share)});
    const std::size_t at = insert(change.step, offset_lines(axes, step.before));
    insert(change.step, again(change, axes));
    return at;
  }

  CorrectedNcProgram result(const std::vector<std::pair<std::size_t, std::size_t>>& marks) const {
    CorrectedNcProgram program;
    std::vector<int> first_inserted(lines_.size());  // line in the result of the first line put before line i
    int n = 1;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      first_inserted[i] = n;
      for (const std::string& line : before_[i]) program.text += line + line_end(lines_, i);
      program.text += lines_[i];
      n += static_cast<int>(before_[i].size()) + 1;
    }
    for (const auto& [step, nth] : marks) program.lines.push_back(first_inserted[index(step)] + static_cast<int>(nth));
    return program;
  }

 private:
  std::size_t index(std::size_t step) const { return static_cast<std::size_t>(steps_[step].where.line) - 1; }

  std::size_t insert(std::size_t step, const std::vector<std::string>& lines) {
    std::vector<std::string>& place = before_.at(index(step));
    const std::size_t at = place.size();
    place.insert(place.end(), lines.begin(), lines.end());
    return at;
  }

  static std::string part(const NcStep& step, double share) {
    std::string line = step.kind == NcStepKind::kRapid ? "G0" : "G1";
    for (int axis = 0; axis < 3; ++axis) {
      if (!step.named[axis]) continue;
      const double x_m = step.start_m[axis] + share * (step.end_m[axis] - step.start_m[axis]);
      line += fmt::format(" {}{}", "XYZ"[axis], number(x_m, step.before.unit_m));
    }
    return step.feed_word.empty() ? line : line + " " + step.feed_word;
  }

  /// Commands the axes once more to where they stand, unless the block itself brings them all by rapid.
  std::vector<std::string> again(const NcOffsetChange& change, const std::array<bool, 3>& axes) const {
    const NcStep& step = steps_[change.step];
    const bool on_its_way = change.share > 0.0;
    std::string words;
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
      const double x_m = step.start_m[axis] + change.share * (step.end_m[axis] - step.start_m[axis]);
      words += fmt::format(" {}{}", "XYZ"[axis], number(x_m, step.before.unit_m));
    }
    const std::string line = (in_feed ? "G1" : "G0") + words;
    if (step.before.absolute) return {line};
    return {"G90 " + line, "G91"};
  }

  std::vector<std::string> lines_;
  std::vector<std::vector<std::string>> before_;
  const std::vector<NcStep>& steps_;
  const NcOffsetOptions& options_;
  std::array<double, 3> shift_m_ = {0, 0, 0};
};

void check(const std::vector<NcStep>& steps, const NcOffsetOptions& options) {
  for (const NcStep& step : steps) {
    if (options.dialect == NcDialect::kLinuxCnc) {
      if (step.system && *step.system != options.work_offset) {
        throw InputError(step.where, fmt::format("{}: corrections go into {}, which `work_offset` names, and into no other",
                                                 nc_word_name('G', *step.system), nc_word_name('G', options.work_offset)));
      }
    } else if (step.before.unit_m != kMillimetre_m) {
      throw InputError(step.where, "inches; corrections for this control are written in mm, so G21 is wanted");
    }
    if (options.dialect == NcDialect::kHeidenhain && (step.system || step.kind == NcStepKind::kMachine)) {
      throw InputError(
          step.where,
          "G53 to G59, G28 and G30: datum shifts and other words of this control, which would undo its corrections "
          "or mean something else; leave them out");
    }
  }
}

bool moves(const NcStep& step) {
  return step.kind != NcStepKind::kNone;
}

/// A work offset that nobody names is the one left in force by whoever ran before: G54 after a start, otherwise unknown.
void check_offset_named(const std::vector<NcStep>& steps, const NcOffsetOptions& options) {
  if (options.dialect != NcDialect::kLinuxCnc || options.work_offset == 540) return;
  for (const NcStep& step : steps) {
    if (step.system && !step.deletable) return;
    if (!moves(step)) continue;
    throw InputError(step.where,
                     fmt::format("no work offset is named before this first motion; {}, which `work_offset` names, "
                                 "is wanted in the program",
                                 nc_word_name('G', options.work_offset)));
  }
}

/// The step that the first offset stands before: the first that moves or turns cutter compensation on, which forbids G10.
std::size_t front_of(const std::vector<NcStep>& steps) {
  std::size_t first = 0;
  while (first + 1 < steps.size() && !moves(steps[first]) && !steps[first].compensated) ++first;
  for (std::size_t i = 0; i < first; ++i) {
    if (steps[i].unit_word && !steps[i].deletable) return first;
  }
  throw InputError(
      steps[first].where,
      "no unit is stated before this block, and the offset that stands in front of it needs one; write G21 or G20 "
      "in a block before the first motion, G41 and G42");
}

/// The line that takes corrections back stands before the last block.
void check_end(const NcStep& last, std::vector<std::string>& notes) {
  if (last.before.compensated || last.compensated)
    throw InputError(last.where, "G41 or G42 is still on at the end, where the offset must change; write G40 before it");
  const bool offset_counts = moves(last) && last.kind != NcStepKind::kMachine;
  if (!offset_counts) return;
  if (last.kind != NcStepKind::kRapid && last.duration_s() > 0.0) {
    throw InputError(last.where,
                     "the last block cuts, behind the line that takes corrections back; write M2 or M30 in a block of "
                     "its own");
  }
  notes.push_back(fmt::format("line {}: the last block moves; it goes without corrections", last.where.line));
}

}  // namespace

CorrectedNcProgram corrected_nc_program(const std::string& bytes, const std::vector<NcStep>& steps,
                                        const std::array<double, 3>& initial_m, const std::vector<NcOffsetChange>& changes,
                                        const NcOffsetOptions& options) {
  check(steps, options);
  check_offset_named(steps, options);
  if (changes.empty() && initial_m == std::array<double, 3>{0, 0, 0}) return {bytes, {}};
  if (steps.empty() || !steps.back().ends_program) throw std::logic_error("a program without its last block");
  Writer writer(bytes, steps, options);
  std::vector<std::string> notes;
  check_end(steps.back(), notes);
  const std::size_t first = front_of(steps);
  std::vector<std::pair<std::size_t, std::size_t>> marks;
  (void)writer.set_all(first, initial_m);
  std::size_t next = first;
  const auto renew_until = [&](std::size_t end) {  // a settable offset loads the base frame again (Siemens)
    for (; next < end; ++next) {
      if (options.dialect != NcDialect::kSiemens || !steps[next].system) continue;
      if (moves(steps[next]))
        throw InputError(steps[next].where,
                         "this control may load its base frame again at a work offset, so the offset is wanted "
                         "in a block of its own, before the motion");
      writer.renew(next + 1);
    }
  };
  for (const NcOffsetChange& change : changes) {
    renew_until(change.step);
    marks.emplace_back(change.step, writer.change(change));
  }
  renew_until(steps.size() - 1);
  (void)writer.set_all(steps.size() - 1, {0, 0, 0});
  CorrectedNcProgram corrected = writer.result(marks);
  corrected.notes = std::move(notes);
  return corrected;
}

}  // namespace driftwright
