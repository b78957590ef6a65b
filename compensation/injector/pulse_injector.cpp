#include "compensation/injector/pulse_injector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "base/errors.hpp"

namespace driftwright::compensation {

PulseInjector::PulseInjector(const InsertionRules& rules) : rules_(rules) {
  if (rules.quarters != 1 && rules.quarters != 2 && rules.quarters != 4)
    throw RangeError(
        fmt::format("an insertion of {} quarter steps; 4, 2 or 1 make a cycle or a part of it", rules.quarters));
}

bool PulseInjector::is_due() const {
  return !rules_.bypass && std::abs(target_ - inserted_) >= rules_.quarters;
}

Lines* PulseInjector::step(Lines row, Lines* out) {
  const bool first = !encoder_.started();
  const int steps = encoder_.step(row);
  const Lines index = row & kLineIndex;
  if (rules_.bypass || first) {
    out_phase_ = phase_of(row);
    *out++ = row;
    if (rules_.bypass) return out;
  } else {
    for (int i = 0; i < std::abs(steps); ++i) *out++ = lines_of_phase(out_phase_ += steps < 0 ? -1 : +1) | index;
    if (steps == 0) *out++ = lines_of_phase(out_phase_) | index;
  }
  const bool low = (row & kLinesAB) == 0;
  if (!is_due() || !encoder_.trusted() || !(low || rules_.anywhere)) return out;
  const int direction = target_ > inserted_ ? +1 : -1;
  for (int i = 0; i < rules_.quarters; ++i) *out++ = lines_of_phase(out_phase_ += direction) | index;
  inserted_ += direction * rules_.quarters;
  ++n_insertions_;
  return out;
}

std::size_t PulseInjector::run(std::span<const Lines> rows, Lines* out) {
  const Lines* const begin = out;
  if (rules_.bypass && !rows.empty()) {
    std::copy(rows.begin(), rows.end(), out);
    for (Lines row : rows) (void)encoder_.step(row);
    return rows.size();
  }
  for (Lines row : rows) out = step(row, out);
  return static_cast<std::size_t>(out - begin);
}

}  // namespace driftwright::compensation
