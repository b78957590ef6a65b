#include "compensation/grey_relational.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "compensation/complete_rows.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kNearZero = 0.05;     // of the span: kAutomatic divides by nothing smaller
constexpr double kUndefined = 1.0e-9;  // of the span: nobody divides by anything smaller
constexpr double kConstant = 1.0e-12;  // span over largest magnitude: rounding, not movement

double span_of(const Eigen::VectorXd& x) {
  return x.maxCoeff() - x.minCoeff();
}

bool is_constant(const Eigen::VectorXd& x) {
  return span_of(x) <= kConstant * x.cwiseAbs().maxCoeff();
}

bool is_temperature(const std::string& unit) {
  return unit == "degC" || unit == "K";
}

struct Choice {
  Image image;
  std::string reason;
};

Choice choose_image(Image wanted, const std::vector<std::string>& names, const CompleteRows& rows) {
  if (wanted != Image::kAutomatic) return {wanted, "This image was asked for."};
  for (std::size_t j = 0; j < names.size(); ++j) {
    const Eigen::VectorXd x = rows.values.col(static_cast<Eigen::Index>(j));
    if (is_temperature(rows.units[j])) {
      return {Image::kRange, fmt::format("'{}' is a temperature, and its ratio to its first value depends on whether it "
                                         "is in degC or K, so the range image is used.",
                                         names[j])};
    }
    if (std::abs(x(0)) < kNearZero * span_of(x)) {
      return {Image::kRange, fmt::format("'{}' starts near 0 ({:.3g} {}) and cannot be divided by its first value, so the "
                                         "range image is used.",
                                         names[j], x(0), rows.units[j])};
    }
  }
  return {Image::kInitialValue, "No series starts near 0 and none is a temperature, so each is divided by its first value."};
}

/// The dimensionless series, or none where its divisor vanishes.
std::optional<Eigen::VectorXd> image_of(const Eigen::VectorXd& x, Image image) {
  if (image == Image::kRange) return ((x.array() - x.minCoeff()) / span_of(x)).matrix();
  const double divisor = image == Image::kInitialValue ? x(0) : x.mean();
  if (std::abs(divisor) < kUndefined * span_of(x)) return std::nullopt;
  return x / divisor;
}

const char* missing_divisor(Image image) {
  return image == Image::kInitialValue ? "its first value is 0" : "its mean is 0";
}

bool falls_against(const Eigen::VectorXd& x, const Eigen::VectorXd& reference) {
  return (x.array() - x.mean()).matrix().dot((reference.array() - reference.mean()).matrix()) < 0.0;
}

}  // namespace

Ranking rank_channels(std::span<const Record> records, const std::string& reference,
                      const std::vector<std::string>& candidates, const GreyOptions& options) {
  if (!(options.rho > 0.0 && options.rho <= 1.0)) {
    throw RangeError(fmt::format("rho = {} lies outside (0, 1]", options.rho));
  }
  if (candidates.empty()) throw InputError("no candidate channels were given to rank");

  std::vector<std::string> names = {reference};
  names.insert(names.end(), candidates.begin(), candidates.end());
  const CompleteRows rows = complete_rows(records, names);
  if (rows.values.rows() < 2) {
    throw InputError(fmt::format("{} rows have a value in all of '{}' and the candidates, {} have not; two are needed",
                                 rows.values.rows(), reference, rows.n_left_out));
  }
  if (is_constant(rows.values.col(0))) {
    throw InputError(fmt::format("the reference '{}' never changes; nothing can be ranked against it", reference));
  }

  Ranking ranking;
  const Choice choice = choose_image(options.image, names, rows);
  ranking.image = choice.image;
  ranking.reason = choice.reason;
  ranking.n_samples = static_cast<int>(rows.values.rows());
  ranking.n_left_out = rows.n_left_out;

  const std::optional<Eigen::VectorXd> x0 = image_of(rows.values.col(0), ranking.image);
  if (!x0) {
    throw InputError(fmt::format("the reference '{}' has no such image: {}; use the range image", reference,
                                 missing_divisor(ranking.image)));
  }

  std::vector<Eigen::VectorXd> distance(candidates.size());  // empty where the candidate has no image
  double smallest = INFINITY;
  double largest = 0.0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    RankedChannel& channel = ranking.channels.emplace_back();
    channel.name = candidates[i];
    const Eigen::VectorXd x = rows.values.col(static_cast<Eigen::Index>(i) + 1);
    if (is_constant(x)) {
      channel.note = "it never changes";
      continue;
    }
    std::optional<Eigen::VectorXd> image = image_of(x, ranking.image);
    if (!image) {
      channel.note = missing_divisor(ranking.image);
      continue;
    }
    if (options.reverse_falling && falls_against(*image, *x0)) {
      channel.reversed = true;
      *image = ((ranking.image == Image::kRange ? 1.0 : 2.0) - image->array()).matrix();
    }
    distance[i] = (*image - *x0).cwiseAbs();
    smallest = std::min(smallest, distance[i].minCoeff());
    largest = std::max(largest, distance[i].maxCoeff());
  }

  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (distance[i].size() == 0) continue;
    const double floor = options.rho * largest;
    ranking.channels[i].grade = largest == 0.0 ? 1.0 : ((smallest + floor) / (distance[i].array() + floor)).mean();
  }
  std::stable_sort(ranking.channels.begin(), ranking.channels.end(),
                   [](const RankedChannel& a, const RankedChannel& b) { return a.grade > b.grade; });
  return ranking;
}

std::vector<std::string> best(const Ranking& ranking, int n) {
  std::vector<std::string> names;
  for (const RankedChannel& channel : ranking.channels) {
    if (channel.grade && static_cast<int>(names.size()) < n) names.push_back(channel.name);
  }
  return names;
}

}  // namespace driftwright::compensation
