#pragma once
// A long record as runs: where the drive starts anew after a rest, and from where on what came before matters.

#include "base/cyclogram.hpp"
#include "base/record.hpp"

namespace driftwright::scenarios {

/// Rows [first, last) of a record as a run, and the row from which on its history counts.
struct RunRows {
  std::size_t history = 0, first = 0, last = 0;  ///< history <= first < last
  bool operator==(const RunRows&) const = default;
};

/// What is known of a record where it is cut.
struct CutRecord {
  const Record& record;
  const Cyclogram& cyclogram;  ///< the drive, from the record's first row on; no section: unknown
  const TimeSeries& ambient;   ///< the same; no knot: unknown
};

/// The rows in [first, last) at which the drive starts anew after it has rested for at least ten minutes. It rests where the spindle turns no faster
/// than at 1 % of its top speed, and nothing feeds or cuts.
[[nodiscard]] std::vector<std::size_t> starts_after_rests(const CutRecord& cut, std::size_t first, std::size_t last);

/// True where at `row` all temperatures (over the ambient, where it is known) and displacements are back where they were in the record's first rows:
/// within 5 % of the way they have gone in between, or within 0.2 K and 0.5 um.
[[nodiscard]] bool is_back_in_balance(const CutRecord& cut, std::size_t row);

/// The rows [first, last) as one run. Its history begins at the last start after a rest that had let the machine come back to balance, else at the
/// record's first row.
[[nodiscard]] RunRows whole_run(const CutRecord& cut, std::size_t first, std::size_t last);

/// The rows [first, last) as runs that begin where the drive starts anew after rests; at most eight, cut at the longest of them. One run where there
/// is no such rest, or the drive is not known.
[[nodiscard]] std::vector<RunRows> runs_between_rests(const CutRecord& cut, std::size_t first, std::size_t last);

/// The part of a cyclogram between two times; it keeps its name.
[[nodiscard]] Cyclogram part_of(const Cyclogram& cyclogram, double from_s, double until_s);
/// The part of a series between two times, from 0 on; nothing of nothing.
[[nodiscard]] TimeSeries part_of(const TimeSeries& series, double from_s, double until_s);

}  // namespace driftwright::scenarios
