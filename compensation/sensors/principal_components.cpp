#include "compensation/sensors/principal_components.hpp"

#include "base/dense.hpp"
#include "compensation/sensors/product_sums.hpp"

namespace driftwright::compensation {

std::vector<double> PrincipalComponents::values(const Record& record, Eigen::Index component) const {
  std::vector<double> result(record.n_samples(), 0.0);
  for (std::size_t j = 0; j < inputs.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    if (share(row, component) == 0.0) continue;
    const std::vector<double>& read = record.at(inputs[j]).values;
    for (std::size_t i = 0; i < read.size(); ++i) result[i] += share(row, component) * (read[i] - mean(row));
  }
  return result;
}

PrincipalComponents principal_components(std::span<const Record> records, const std::vector<std::string>& inputs,
                                         const std::string& target, int n) {
  const ProductSums sums = product_sums(records, inputs, target);
  const auto m = static_cast<Eigen::Index>(inputs.size());
  const dense::SymmetricEigen eigen(Eigen::MatrixXd(sums.total().block(1, 1, m, m)));
  PrincipalComponents c{.inputs = inputs,
                        .share = eigen.eigenvectors().rightCols(n).rowwise().reverse(),
                        .mean = sums.mean.head(m).transpose()};
  for (Eigen::Index k = 0; k < n; ++k) {
    if (c.share.col(k).sum() < 0.0) c.share.col(k) *= -1.0;
  }
  for (Eigen::Index j = 0; j < m; ++j) {
    if (sums.is_constant[static_cast<std::size_t>(j)])
      c.share.row(j).setZero();
    else
      c.share.row(j) /= sums.deviation(j);
  }
  return c;
}

}  // namespace driftwright::compensation
