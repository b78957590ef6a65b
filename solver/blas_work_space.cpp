#include "solver/blas_work_space.hpp"

#include <Eigen/CholmodSupport>
#include <new>

namespace driftwright::solver {

void claim_blas_work_space() {
  static bool is_claimed = false;
  if (is_claimed) return;
  // Debian's: 2^27 bytes and a page; never touched, so this takes no time.
  constexpr std::size_t kWorkSpace = std::size_t(129) << 20;
  ::operator delete(::operator new(kWorkSpace));
  Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long> one(1, 1);
  one.insert(0, 0) = 1.0;
  (void)Eigen::CholmodSupernodalLLT<decltype(one), Eigen::Lower>(one);  // calls dpotrf
  is_claimed = true;
}

}  // namespace driftwright::solver
