#include "base/eigen_kernels.hpp"

namespace Eigen::internal {

DRIFTWRIGHT_EIGEN_KERNELS(template struct)

}  // namespace Eigen::internal
