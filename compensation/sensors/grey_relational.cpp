#include "compensation/sensors/grey_relational.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/record_channel.hpp"
#include "compensation/sensors/complete_rows.hpp"

namespace driftwright::compensation {
namespace {

constexpr double kNearZero = 0.05;         // of the span: kAutomatic avoids smaller divisors
constexpr double kUndefined = 1.0e-9;      // of the span: below this an image is undefined
constexpr double kConstantSpan = 1.0e-12;  // span over largest magnitude: below it a series is constant up to rounding

double span_of(const Eigen::VectorXd& x) {
  return x.maxCoeff() - x.minCoeff();
}

bool is_constant(const Eigen::VectorXd& x) {
  return span_of(x) <= kConstantSpan * x.cwiseAbs().maxCoeff();
}

struct Choice {
  Image image;
  std::string reason;
};

void count_from_start(CompleteRows& rows) {
  for (std::size_t r = 0; r + 1 < rows.first.size(); ++r) {
    const Eigen::Index from = rows.first[r], n = rows.first[r + 1] - from;
    if (n == 0) continue;
    const Eigen::RowVectorXd start = rows.values.row(from);
    rows.values.middleRows(from, n).rowwise() -= start;
  }
}

Choice choose_image(const GreyOptions& options, const std::vector<std::string>& names, const CompleteRows& rows) {
  if (options.image != Image::kAutomatic) return {options.image, "This image was asked for."};
  if (options.quantity == Quantity::kRise) {
    return {Image::kRange, "Rises start at 0 and cannot be divided by their first value, so the range image is used."};
  }
  for (std::size_t j = 0; j < names.size(); ++j) {
    const Eigen::VectorXd x = rows.values.col(static_cast<Eigen::Index>(j));
    if (is_temperature_unit(rows.units[j])) {
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

/// The dimensionless series, or none if its divisor vanishes.
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

GreyImages grey_images(std::span<const Record> records, const std::string& reference,
                       const std::vector<std::string>& candidates, const GreyOptions& options) {
  if (!(options.rho > 0.0 && options.rho <= 1.0)) {
    throw RangeError(fmt::format("rho = {} lies outside (0, 1]", options.rho));
  }
  if (candidates.empty()) throw InputError("no candidate channels were given to rank");

  std::vector<std::string> names = {reference};
  names.insert(names.end(), candidates.begin(), candidates.end());
  CompleteRows rows = complete_rows(records, names);
  if (rows.values.rows() < 2) {
    throw InputError(fmt::format("{} rows have a value in all of '{}' and the candidates, {} have not; two are needed",
                                 rows.values.rows(), reference, rows.n_left_out));
  }
  if (options.quantity == Quantity::kRise) count_from_start(rows);
  if (is_constant(rows.values.col(0))) {
    throw InputError(fmt::format("the reference '{}' never changes; nothing can be ranked against it", reference));
  }

  const Choice choice = choose_image(options, names, rows);
  GreyImages images{.reference = {},
                    .candidates = Eigen::MatrixXd::Zero(rows.values.rows(), static_cast<Eigen::Index>(candidates.size())),
                    .first = rows.first,
                    .reversed = std::vector<bool>(candidates.size()),
                    .note = std::vector<std::string>(candidates.size()),
                    .image = choice.image,
                    .reason = choice.reason,
                    .n_left_out = rows.n_left_out};
  const std::optional<Eigen::VectorXd> x0 = image_of(rows.values.col(0), images.image);
  if (!x0) {
    throw InputError(fmt::format("the reference '{}' has no such image: {}; use the range image", reference,
                                 missing_divisor(images.image)));
  }
  images.reference = *x0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Eigen::VectorXd x = rows.values.col(static_cast<Eigen::Index>(i) + 1);
    if (is_constant(x)) {
      images.note[i] = "it never changes";
      continue;
    }
    std::optional<Eigen::VectorXd> image = image_of(x, images.image);
    if (!image) {
      images.note[i] = missing_divisor(images.image);
      continue;
    }
    if (options.reverse_falling && falls_against(*image, *x0)) {
      images.reversed[i] = true;
      *image = ((images.image == Image::kRange ? 1.0 : 2.0) - image->array()).matrix();
    }
    images.candidates.col(static_cast<Eigen::Index>(i)) = *image;
  }
  return images;
}

Eigen::VectorXd deng_grades(const Eigen::MatrixXd& reference, const Eigen::MatrixXd& candidates, double rho) {
  const Eigen::MatrixXd distance = (candidates.colwise() - reference.col(0)).cwiseAbs();
  const double largest = distance.maxCoeff(), floor = rho * largest;
  if (largest == 0.0) return Eigen::VectorXd::Ones(candidates.cols());
  return ((distance.minCoeff() + floor) / (distance.array() + floor)).colwise().mean().transpose();
}

Eigen::VectorXd absolute_grades(const GreyImages& images) {
  const auto area = [&](const auto& x) {
    double sum = 0.0;
    for (std::size_t r = 0; r + 1 < images.first.size(); ++r) {
      const Eigen::Index from = images.first[r], n = images.first[r + 1] - from;
      if (n < 2) continue;
      const auto rise = x.segment(from, n).array() - x(from);
      sum += rise.sum() - 0.5 * rise(n - 1);
    }
    return sum / static_cast<double>(x.size());
  };
  const double s0 = area(images.reference.col(0));
  Eigen::VectorXd grades(images.candidates.cols());
  for (Eigen::Index i = 0; i < grades.size(); ++i) {
    const double si = area(images.candidates.col(i)), both = 1.0 + std::abs(s0) + std::abs(si);
    grades(i) = both / (both + std::abs(si - s0));
  }
  return grades;
}

Eigen::VectorXd slope_grades(const GreyImages& images) {
  Eigen::VectorXd grades = Eigen::VectorXd::Zero(images.candidates.cols());
  double n_slopes = 0.0;
  for (std::size_t r = 0; r + 1 < images.first.size(); ++r) {
    const Eigen::Index from = images.first[r], n = images.first[r + 1] - from - 1;
    if (n < 1) continue;
    const auto per_length = static_cast<double>(n);
    const Eigen::ArrayXd d0 =
        per_length * (images.reference.col(0).segment(from + 1, n) - images.reference.col(0).segment(from, n)).array();
    for (Eigen::Index i = 0; i < grades.size(); ++i) {
      const auto x = images.candidates.col(i);
      const Eigen::ArrayXd di = per_length * (x.segment(from + 1, n) - x.segment(from, n)).array();
      grades(i) += ((1.0 + d0.abs()) / (1.0 + d0.abs() + (d0 - di).abs())).sum();
    }
    n_slopes += per_length;
  }
  if (n_slopes > 0.0) grades /= n_slopes;
  return grades;
}

Ranking rank_channels(std::span<const Record> records, const std::string& reference,
                      const std::vector<std::string>& candidates, const GreyOptions& options) {
  GreyImages images = grey_images(records, reference, candidates, options);
  Ranking ranking{.channels = {},
                  .image = images.image,
                  .reason = images.reason,
                  .n_samples = static_cast<int>(images.reference.rows()),
                  .n_left_out = images.n_left_out};
  // candidates without an image are left out of the extremes
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    RankedChannel& channel = ranking.channels.emplace_back();
    channel.name = candidates[i];
    channel.reversed = images.reversed[i];
    channel.note = images.note[i];
    if (channel.note.empty()) kept.push_back(static_cast<Eigen::Index>(i));
  }
  images.candidates = Eigen::MatrixXd(images.candidates(Eigen::all, kept));
  if (!kept.empty()) {
    const Eigen::VectorXd deng = deng_grades(images.reference, images.candidates, options.rho),
                          absolute = absolute_grades(images), slope = slope_grades(images);
    for (std::size_t k = 0; k < kept.size(); ++k) {
      RankedChannel& channel = ranking.channels[static_cast<std::size_t>(kept[k])];
      const auto i = static_cast<Eigen::Index>(k);
      channel.grade = deng(i);
      channel.absolute = absolute(i);
      channel.slope = slope(i);
    }
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
