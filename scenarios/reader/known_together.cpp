#include "scenarios/reader/known_together.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace driftwright::scenarios {

schema::Map known_together_schema() {
  return {
      .name = "known_together",
      .keys = {schema::compulsory("numbers", schema::list(schema::text(), 1), "what was fitted, by effect, place and name"),
               schema::compulsory("values", schema::list(schema::quantity("1"), 1),
                                  "the fitted numbers in SI units, for a check that they have not been changed since"),
               schema::compulsory("factor", schema::list(schema::quantity("1"), 1),
                                  "of the covariance of their logarithms: its lower Cholesky factor row by row, each row up "
                                  "to the diagonal")},
      .about =
          "How well numbers are known together after a fit; `calibrate` writes it, and the bands of `predict` use it "
          "(docs/how-to/prediction.md)."};
}

KnownTogether read_known_together(const ConfigMap& in) {
  KnownTogether known{.numbers = in.texts("numbers"), .values = in.quantities("values"), .factor = {}};
  const std::vector<double> entries = in.quantities("factor");
  for (auto n = known.numbers.begin(); n != known.numbers.end(); ++n) {
    if (std::find(known.numbers.begin(), n, *n) != n) in.fail("numbers", fmt::format("'{}' is listed twice", *n));
  }
  const std::size_t size = known.numbers.size();
  if (known.values.size() != size)
    in.fail("values", fmt::format("{} numbers need {} values, and there are {}; run `calibrate` again, or delete "
                                  "`known_together`",
                                  size, size, known.values.size()));
  if (entries.size() != size * (size + 1) / 2)
    in.fail("factor",
            fmt::format("{} numbers need {} entries, row by row up to the diagonal, and there are {}; run `calibrate` "
                        "again, or delete `known_together`",
                        size, size * (size + 1) / 2, entries.size()));
  known.factor.setZero(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size));
  auto entry = entries.begin();
  for (Eigen::Index i = 0; i < known.factor.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) known.factor(i, j) = *entry++;
    if (known.factor.row(i).isZero(0.0))
      in.fail("factor", fmt::format("row {} has only zeros, so '{}' would be known exactly; leave it out of both lists",
                                    i + 1, known.numbers[static_cast<std::size_t>(i)]));
  }
  in.reject_unknown_keys();
  return known;
}

std::string yaml_of(const KnownTogether& known) {
  std::vector<std::string> rows;
  for (Eigen::Index i = 0; i < known.factor.rows(); ++i) {
    std::vector<std::string> row;
    for (Eigen::Index j = 0; j <= i; ++j) row.push_back(fmt::format("{:.7g}", known.factor(i, j)));
    rows.push_back(fmt::format("{}", fmt::join(row, ", ")));
  }
  std::vector<std::string> names;
  for (const std::string& name : known.numbers) names.push_back(fmt::format("\"{}\"", name));
  std::vector<std::string> values;
  for (const double value : known.values) values.push_back(fmt::format("{:.7g}", value));
  return fmt::format("known_together:\n  numbers: [{}]\n  values: [{}]\n  factor: [{}]\n",
                     fmt::join(names, ",\n            "), fmt::join(values, ", "), fmt::join(rows, ",\n           "));
}

}  // namespace driftwright::scenarios
