#pragma once
// The work space of OpenBLAS, without which its calls do not return.

namespace driftwright::solver {

/// Lets OpenBLAS take its work space (128 MB, kept until the program ends) at the first call; later calls do nothing. Where there is no
/// such memory, OpenBLAS asks for it again and again, for ever: it is tried before. Not for two threads at once (OneThread).
/// @throws std::bad_alloc  where there is not so much memory
void claim_blas_work_space();

}  // namespace driftwright::solver
