#pragma once
// Eigen's kernels of dense products and triangular solves in double precision, compiled once, in eigen_kernels.cpp, with
// full optimisation. Every other file calls them: it compiles faster, and of these kernels a file that is compiled with less
// optimisation (cmake/target.cmake, NUMERIC) has no slower copy, which the linker could take for all. Of other templates of
// Eigen, such as LDLT, it may have one.

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace Eigen::internal {

using DriftwrightColumns = const_blas_data_mapper<double, Eigen::Index, ColMajor>;
using DriftwrightRows = const_blas_data_mapper<double, Eigen::Index, RowMajor>;
using DriftwrightTraits = gebp_traits<double, double>;

// clang-format off
#define DRIFTWRIGHT_EIGEN_KERNELS(TEMPLATE) \
  TEMPLATE gebp_kernel<double, double, Eigen::Index, blas_data_mapper<double, Eigen::Index, ColMajor, Unaligned, 1>, \
                       DriftwrightTraits::mr, DriftwrightTraits::nr, false, false>; \
  TEMPLATE gemm_pack_lhs<double, Eigen::Index, DriftwrightColumns, DriftwrightTraits::mr, DriftwrightTraits::LhsProgress, \
                         DriftwrightTraits::LhsPacket4Packing, ColMajor, false, false>; \
  TEMPLATE gemm_pack_lhs<double, Eigen::Index, DriftwrightRows, DriftwrightTraits::mr, DriftwrightTraits::LhsProgress, \
                         DriftwrightTraits::LhsPacket4Packing, RowMajor, false, false>; \
  TEMPLATE gemm_pack_rhs<double, Eigen::Index, DriftwrightColumns, DriftwrightTraits::nr, ColMajor, false, false>; \
  TEMPLATE gemm_pack_rhs<double, Eigen::Index, DriftwrightRows, DriftwrightTraits::nr, RowMajor, false, false>; \
  TEMPLATE general_matrix_vector_product<Eigen::Index, double, DriftwrightColumns, ColMajor, false, double, DriftwrightColumns, false, 0>; \
  TEMPLATE general_matrix_vector_product<Eigen::Index, double, DriftwrightColumns, ColMajor, false, double, DriftwrightRows, false, 0>; \
  TEMPLATE general_matrix_vector_product<Eigen::Index, double, DriftwrightRows, RowMajor, false, double, DriftwrightColumns, false, 0>; \
  TEMPLATE general_matrix_vector_product<Eigen::Index, double, DriftwrightRows, RowMajor, false, double, DriftwrightRows, false, 0>; \
  TEMPLATE triangular_solve_matrix<double, Eigen::Index, OnTheRight, Upper, false, RowMajor, ColMajor, 1>; \
  TEMPLATE triangular_solve_matrix<double, Eigen::Index, OnTheLeft, Lower, false, ColMajor, ColMajor, 1>; \
  TEMPLATE triangular_solve_matrix<double, Eigen::Index, OnTheLeft, Upper, false, RowMajor, ColMajor, 1>;
// clang-format on

DRIFTWRIGHT_EIGEN_KERNELS(extern template struct)

}  // namespace Eigen::internal
