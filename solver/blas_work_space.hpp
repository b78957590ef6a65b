#pragma once
// Reserves the work space of OpenBLAS.

namespace driftwright::solver {

/// Makes OpenBLAS allocate its work space (128 MB, kept until the program ends) at the first call; later calls do nothing.
/// Without enough memory OpenBLAS would retry forever, so the allocation is tested first. Not thread-safe (see OneThread).
/// @throws std::bad_alloc  if there is not enough memory
void claim_blas_work_space();

}  // namespace driftwright::solver
