#pragma once
// Converts a model and its fail-safe into the tables that control/drift_correction.c reads, for the program's own use and
// for export.

#include <string>
#include <vector>

#include "compensation/control/drift_correction.h"
#include "compensation/predictors/drift_model.hpp"
#include "compensation/predictors/fail_safe.hpp"

namespace driftwright::compensation {

/// `safe` points into `guards`, and its guards point into the FailSafe that they come from, which must live as long.
struct FailSafeTable {
  std::vector<drift_guard> guards;
  drift_fail_safe safe{};

  FailSafeTable() = default;
  FailSafeTable(const FailSafeTable&) = delete;  // a copy would point into the original
  FailSafeTable& operator=(const FailSafeTable&) = delete;
  FailSafeTable(FailSafeTable&&) = default;
  FailSafeTable& operator=(FailSafeTable&&) = default;
};
[[nodiscard]] FailSafeTable fail_safe_table(const FailSafe& safe);

/// `formula` points into `terms`.
struct FormulaTable {
  std::vector<drift_term> terms;
  drift_formula formula{};

  FormulaTable() = default;
  FormulaTable(const FormulaTable&) = delete;
  FormulaTable& operator=(const FormulaTable&) = delete;
  FormulaTable(FormulaTable&&) = default;
  FormulaTable& operator=(FormulaTable&&) = default;
};
/// @param inputs  names in the order of the readings
/// @throws std::logic_error  when a term reads none of them
[[nodiscard]] FormulaTable formula_table(const DriftModel& model, const std::vector<std::string>& inputs);

}  // namespace driftwright::compensation
