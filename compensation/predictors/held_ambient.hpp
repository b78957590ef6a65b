#pragma once
// The ambient that an observer uses at each row.

#include <deque>
#include <string>

#include "compensation/predictors/observed_run.hpp"

namespace driftwright::compensation {

/// A thermometer that jumps by more than 3 K from row to row (for rows more than 10 min apart: in 10 min) may not show the
/// ambient: its last reading is used until it returns near it, or believe() is called. Keeps the last kRowsBack rows.
class HeldAmbient {
 public:
  /// The next row. @returns whether doubt begins with it
  bool take(const ObservedRun& run, std::size_t row);
  /// Uses from that row until `last` what the thermometer shows.
  void believe(const ObservedRun& run, std::size_t from, std::size_t last);

  /// As used at a row [K above the reference].
  [[nodiscard]] double at(std::size_t row) const { return used_K_[row - first_row_]; }
  [[nodiscard]] double last() const { return used_K_.back(); }
  /// Between the row before and that row.
  [[nodiscard]] double between_rows(const ObservedRun& run, std::size_t row, double t_s) const;
  [[nodiscard]] bool is_doubted() const { return is_doubted_.back(); }
  [[nodiscard]] std::string words() const;  ///< since when it is doubted

  /// After a recall of the row before `row`.
  void recall(std::size_t row, double used_K, bool is_doubted);

  std::size_t doubted_row = 0;  ///< where doubt began, or was last found justified
  double doubted_s = 0.0;       ///< when it began

 private:
  std::deque<double> used_K_;  // of the last rows
  std::deque<bool> is_doubted_;
  std::size_t first_row_ = 0;
};

}  // namespace driftwright::compensation
