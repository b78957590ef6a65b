#include "diagnosis/some_records.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include "effects/lasting.hpp"

namespace driftwright::diagnosis {
namespace {

constexpr double kWorthAChoice = 0.5;  // nats that a choice must bring beyond its price
constexpr double kSeen = 1e-12;  // squares of a signature in a record that tells of it

using Choice = std::vector<char>;  // of records: whether it acts there

/// A signature record by record, and what the numbers fitted beside it leave of that.
class InRecords {
 public:
  InRecords(const Comparison& comparison, std::size_t n_runs, const Eigen::VectorXd& column, const Projection& projection) {
    const auto n = static_cast<Eigen::Index>(n_runs);
    Eigen::MatrixXd along(projection.slopes.cols(), n);
    own_.resize(n);
    products_.resize(n);
    for (Eigen::Index r = 0; r < n; ++r) {
      const auto [first, n_rows] = comparison.condensed_rows(static_cast<std::size_t>(r));
      const auto part = column.segment(first, n_rows);
      own_[r] = part.squaredNorm();
      products_[r] = part.dot(projection.rest.segment(first, n_rows));
      along.col(r).noalias() = projection.slopes.middleRows(first, n_rows).transpose() * part;
    }
    squares_ = -along.transpose() * projection.factor.solve(along);
    squares_.diagonal() += own_;
  }
  [[nodiscard]] bool is_seen_in(std::size_t run) const { return own_[static_cast<Eigen::Index>(run)] > kSeen; }
  /// By linear theory, the choice not paid [nats].
  [[nodiscard]] double gain(const Variant& law, const Choice& in) const {
    const Eigen::VectorXd m =
        Eigen::Map<const Eigen::Vector<char, Eigen::Dynamic>>(in.data(), squares_.rows()).cast<double>();
    const double ss = m.dot(squares_ * m);
    return ss > kSeen ? linear_gain(law, ss, m.dot(products_)).gain : -1e300;
  }

 private:
  Eigen::VectorXd own_, products_;
  Eigen::MatrixXd squares_;
};

struct Chosen {
  Choice in;
  double gain = -1e300;  ///< the choice paid
  double price = 0.0;
};

/// The best choice that one record more or fewer at a time leads to.
Chosen climbed(const InRecords& parts, const Variant& law, Choice in) {
  double gain = parts.gain(law, in);
  for (std::size_t r = 0; r < in.size();) {
    in[r] = !in[r];
    const double other = parts.is_seen_in(r) ? parts.gain(law, in) : -1e300;
    if (other > gain) {
      gain = other;
      r = 0;
    } else {
      in[r] = !in[r];
      ++r;
    }
  }
  return {.in = std::move(in), .gain = gain, .price = 0.0};
}

/// What one shape of a law brings in all records, and in the best choice of those that tell of it.
struct OfShape {
  double of_all = -1e300;
  Chosen some;
};

OfShape of_shape(const InRecords& parts, const Variant& law, std::size_t n_runs) {
  Choice all(n_runs, 0), one(n_runs, 0);
  double best_of_one = -1e300, price = 0.0;
  for (std::size_t r = 0; r < n_runs; ++r) {
    if (!parts.is_seen_in(r)) continue;
    all[r] = 1;
    price += std::numbers::ln2;
    Choice alone(n_runs, 0);
    alone[r] = 1;
    if (const double gain = parts.gain(law, alone); gain > best_of_one) {
      best_of_one = gain;
      one = alone;
    }
  }
  OfShape shape{.of_all = parts.gain(law, all), .some = {}};
  for (const Choice& from : {all, one}) {
    Chosen chosen = climbed(parts, law, from);
    chosen.gain -= price;
    chosen.price = price;
    if (chosen.in != all && chosen.gain > shape.some.gain) shape.some = std::move(chosen);
  }
  return shape;
}

bool has_law_of(const Candidate& candidate, const Variant& law, const std::set<std::string>& runs) {
  return std::any_of(candidate.variants.begin(), candidate.variants.end(), [&](const Variant& v) {
    return v.of_some_runs && v.of_some_runs->law == law.of_some_runs->law && effects::runs_of(*v.of_some_runs) == runs;
  });
}

}  // namespace

std::vector<Law> add_of_chosen_records(const Fitter& fitter, std::vector<Candidate>& candidates,
                                       const std::vector<Signature>& columns, const Projection& projection) {
  const std::size_t n_runs = fitter.runs().size();
  if (n_runs < 2) return {};
  std::vector<OfShape> shapes(columns.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Variant& law = candidates[columns[i].candidate].variants[columns[i].variant];
    if (!law.of_some_runs || !law.in.empty()) continue;
    shapes[i] = of_shape(InRecords(fitter.comparison(), n_runs, columns[i].column, projection), law, n_runs);
  }
  std::map<std::pair<std::size_t, std::size_t>, OfShape> of_law;  // the best of its shapes, in all and in some
  for (std::size_t i = 0; i < columns.size(); ++i) {
    OfShape& best = of_law[{columns[i].candidate, columns[i].variant}];
    best.of_all = std::max(best.of_all, shapes[i].of_all);
    if (shapes[i].some.gain > best.some.gain) best.some = shapes[i].some;
  }
  std::vector<Law> added;
  for (const auto& [law, best] : of_law) {
    if (!(best.some.gain > std::max(0.0, best.of_all) + kWorthAChoice)) continue;
    std::vector<std::string> names;
    for (std::size_t r = 0; r < n_runs; ++r) {
      if (best.some.in[r]) names.push_back(fitter.runs()[r].name);
    }
    Candidate& candidate = candidates[law.first];
    const Variant& of_all = candidate.variants[law.second];
    if (has_law_of(candidate, of_all, {names.begin(), names.end()})) continue;
    Variant chosen = law_of(effects::of_runs(*of_all.of_some_runs, names));
    chosen.price_nats += best.some.price;
    chosen.of_chosen_records = true;
    chosen.seen = true;
    candidate.variants.push_back(std::move(chosen));
    added.push_back({law.first, candidate.variants.size() - 1});
  }
  return added;
}

}  // namespace driftwright::diagnosis
