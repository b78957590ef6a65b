#include "diagnosis/some_records.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "effects/lasting.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kBetter = 0.5;  // nats beyond the price of the choice

using Choice = std::vector<char>;  // of records: whether it acts there

/// A signature record by record, and what the numbers fitted beside it leave of that.
class InRecords {
 public:
  InRecords(const Comparison& comparison, std::size_t n_runs, const Eigen::VectorXd& column, const Projection& projection)
      : parts_(Eigen::MatrixXd::Zero(column.size(), static_cast<Eigen::Index>(n_runs))) {
    for (std::size_t r = 0; r < n_runs; ++r) {
      const auto [first, n] = comparison.condensed_rows(r);
      parts_.col(static_cast<Eigen::Index>(r)).segment(first, n) = column.segment(first, n);
    }
    const Eigen::MatrixXd along = projection.slopes.transpose() * parts_;
    squares_ = parts_.transpose() * parts_ - along.transpose() * projection.factor.solve(along);
    products_ = parts_.transpose() * projection.rest;
  }
  [[nodiscard]] bool is_seen_in(std::size_t run) const {
    return parts_.col(static_cast<Eigen::Index>(run)).squaredNorm() > 1e-12;
  }
  [[nodiscard]] double gain(const Variant& law, const Choice& in) const {
    const Eigen::VectorXd m =
        Eigen::Map<const Eigen::Vector<char, Eigen::Dynamic>>(in.data(), squares_.rows()).cast<double>();
    const double ss = m.dot(squares_ * m);
    return ss > 1e-12 ? linear_gain(law, ss, m.dot(products_)).gain : -1e300;
  }
  [[nodiscard]] Eigen::VectorXd column(const Choice& in) const {
    return parts_ * Eigen::Map<const Eigen::Vector<char, Eigen::Dynamic>>(in.data(), squares_.rows()).cast<double>();
  }

 private:
  Eigen::MatrixXd parts_, squares_;
  Eigen::VectorXd products_;
};

/// The best choice that one record more or fewer at a time leads to.
std::pair<Choice, double> climbed(const InRecords& in, const Variant& law, Choice choice) {
  double gain = in.gain(law, choice);
  for (std::size_t r = 0; r < choice.size();) {
    choice[r] = !choice[r];
    const double other = in.is_seen_in(r) ? in.gain(law, choice) : -1e300;
    if (other > gain) {
      gain = other;
      r = 0;
    } else {
      choice[r] = !choice[r];
      ++r;
    }
  }
  return {choice, gain};
}

struct Found {
  Choice in;
  double gain = -1e300;  // over the law of all records, the price of the choice paid
};

Found best_choice(const InRecords& in, const Variant& law, std::size_t n_runs) {
  const Choice all(n_runs, 1);
  Choice one(n_runs, 0);
  double best_of_one = -1e300;
  for (std::size_t r = 0; r < n_runs; ++r) {
    Choice alone(n_runs, 0);
    alone[r] = 1;
    if (const double gain = in.gain(law, alone); gain > best_of_one) {
      best_of_one = gain;
      one = alone;
    }
  }
  const double of_all = in.gain(law, all), price = static_cast<double>(n_runs) * std::numbers::ln2;
  Found found;
  for (const Choice& from : {all, one}) {
    const auto [choice, gain] = climbed(in, law, from);
    if (choice != all && gain - price - of_all > found.gain) found = {choice, gain - price - of_all};
  }
  return found;
}

/// The same law of other records, unless the candidate has it.
std::optional<Variant> law_in(const Candidate& candidate, const Variant& law, const std::vector<std::string>& names) {
  const std::set<std::string> wanted(names.begin(), names.end());
  for (const Variant& v : candidate.variants) {
    if (v.of_some_runs && v.of_some_runs->law == law.of_some_runs->law && effects::runs_of(*v.of_some_runs) == wanted)
      return std::nullopt;
  }
  return law_of(effects::of_runs(*law.of_some_runs, names));
}

}  // namespace

std::vector<Signature> of_some_records(const Fitter& fitter, std::vector<Candidate>& candidates,
                                       const std::vector<Signature>& columns, const Projection& projection) {
  const std::size_t n_runs = fitter.runs().size();
  if (n_runs < 2) return {};
  std::vector<Found> found(columns.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Variant& law = candidates[columns[i].candidate].variants[columns[i].variant];
    if (!law.of_some_runs || !law.in.empty()) continue;
    found[i] = best_choice(InRecords(fitter.comparison(), n_runs, columns[i].column, projection), law, n_runs);
  }
  std::vector<Signature> added;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Signature& of_all = columns[i];
    const bool is_better = found[i].gain > kBetter;
    // one law of all records, one of some: that of its best shape
    const bool is_best_shape = std::none_of(columns.begin(), columns.end(), [&](const Signature& s) {
      return s.candidate == of_all.candidate && s.variant == of_all.variant &&
             found[static_cast<std::size_t>(&s - columns.data())].gain > found[i].gain;
    });
    if (!is_better || !is_best_shape) continue;
    std::vector<std::string> names;
    for (std::size_t r = 0; r < n_runs; ++r) {
      if (found[i].in[r]) names.push_back(fitter.runs()[r].name);
    }
    Candidate& candidate = candidates[of_all.candidate];
    std::optional<Variant> law = law_in(candidate, candidate.variants[of_all.variant], names);
    if (!law) continue;
    law->price_nats += static_cast<double>(n_runs) * std::numbers::ln2;
    law->seen = true;
    candidate.variants.push_back(std::move(*law));
    const InRecords parts(fitter.comparison(), n_runs, of_all.column, projection);
    added.push_back({of_all.candidate, candidate.variants.size() - 1, of_all.shape, parts.column(found[i].in)});
  }
  return added;
}

}  // namespace driftwright::diagnosis
