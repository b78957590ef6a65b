#include "nc/heidenhain/klartext_cycles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/characters.hpp"

namespace driftwright {
namespace {

/// Index after the words of a title: where the first value begins.
std::size_t title_end(const std::string& t, std::size_t i) {
  while (i < t.size()) {
    const std::size_t begin = t.find_first_not_of(' ', i);
    if (begin == std::string::npos) return t.size();
    const std::size_t end = std::min(t.find(' ', begin), t.size());
    const std::string word = t.substr(begin, end - begin);
    if (word.size() <= 1 || word.find_first_of("+-#0123456789") != std::string::npos) return begin;
    i = end;
  }
  return t.size();
}

double last_number(const HeidenhainExecution& tnc, const HeidenhainLine& line, std::size_t i) {
  const std::string& t = line.text;
  const std::size_t begin = t.find_first_of("+-0123456789", i);
  if (begin == std::string::npos) tnc.fail(line, "the cycle has no number");
  std::size_t k = begin;
  if (k > 0 && t[k - 1] == 'Q') --k;
  return tnc.value(line, t, k);
}

/// The words of cycle 7, such as X+10 IY-5.
void shift_by_words(const HeidenhainLine& line, HeidenhainExecution& tnc, double unit_m, std::size_t i) {
  const std::string& t = line.text;
  i = title_end(t, i);
  bool any = false;
  while (i < t.size()) {
    if (t[i] == ' ') {
      ++i;
      continue;
    }
    if (t[i] == '#') return tnc.other_datum("CYCL DEF 7 #");
    const bool incremental = t[i] == 'I';
    if (incremental) ++i;
    if (i >= t.size() || t[i] < 'X' || t[i] > 'Z') tnc.fail(line, fmt::format("'{}' is no shift of X, Y or Z", t.substr(i)));
    const int axis = t[i++] - 'X';
    tnc.shift_datum(axis, tnc.value(line, t, i) * unit_m, incremental);
    any = true;
  }
  if (!any) tnc.fail(line, "the datum shift has no X, Y or Z");
}

}  // namespace

void define_klartext_cycle(const HeidenhainLine& line, HeidenhainExecution& tnc, NcExecution& run) {
  const std::string& t = line.text;
  std::size_t i = 9;
  int number = 0;
  while (i < t.size() && is_digit(t[i])) number = 10 * std::min(number, 100000) + (t[i++] - '0');
  if (i < t.size() && t[i] == '.') {
    while (i < t.size() && t[i] != ' ') ++i;
  }
  switch (number) {
    case 7:
      return shift_by_words(line, tnc, run.unit_m, i);
    case 8:
      return tnc.mirror(std::any_of(t.begin() + static_cast<std::ptrdiff_t>(title_end(t, i)), t.end(),
                                    [](char c) { return c >= 'X' && c <= 'Z'; }),
                        "CYCL DEF 8");
    case 9:
      return run.motion.wait(last_number(tnc, line, i));
    case 10:
      return tnc.turn(t.find("ROT", t.find("ROT", i) + 3) != std::string::npos
                          ? last_number(tnc, line, t.rfind("ROT")) != 0.0
                          : last_number(tnc, line, i) != 0.0,
                      "CYCL DEF 10");
    case 11:
      if (last_number(tnc, line, i) != 1.0)
        tnc.fail(line, "scaling is not computed here; let the post-processor write lengths as they are");
      return;
    case 13:
      run.motion.turning = false;
      return;
    case 32:
      return;
    case 247:
      return tnc.other_datum("CYCL DEF 247");
    default:
      break;
  }
  if (number < 200)
    tnc.fail(
        line,
        fmt::format("CYCL DEF {} is not known here; cycles 7 to 11, 13, 32, 247, 200, 201, 202, 203, 206, 207 and 240 are",
                    number));
  HeidenhainCycle cycle{.number = number, .q = {}};
  for (std::size_t q = t.find(" Q", i); q != std::string::npos; q = t.find(" Q", q + 1)) {
    std::size_t k = q + 2;
    int n = 0;
    while (k < t.size() && is_digit(t[k])) n = 10 * std::min(n, 100000) + (t[k++] - '0');
    while (k < t.size() && t[k] == ' ') ++k;
    if (k == q + 2 || k >= t.size() || t[k] != '=') continue;  // part of the title
    ++k;
    cycle.q[n] = tnc.value(line, t, k);
    tnc.set_q(fmt::format("Q{}", n), cycle.q[n]);
  }
  if (cycle.q.empty()) tnc.fail(line, fmt::format("CYCL DEF {} has no Q parameters", number));
  if (std::set<int>{200, 201, 202, 203, 206, 207, 240}.contains(number)) return tnc.define(cycle);
  tnc.fail(line,
           fmt::format("CYCL DEF {}: of the cycles from 200 on only 200, 201, 202, 203, 206, 207 and 240 are computed here; "
                       "write the others out",
                       number));
}

}  // namespace driftwright
