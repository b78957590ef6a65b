#include "base/errors.hpp"
#include "solver/on_all_ranks.hpp"

namespace driftwright::solver {

void on_all_ranks(const std::string&, const std::function<void(const Ranks&)>&,
                  const std::function<int(const std::exception_ptr&)>&) {
  throw InputError(
      "--distributed: this program was built without MPI. Install packages-mpi.txt and build with -DDRIFTWRIGHT_MPI=ON "
      "(docs/how-to/distributed.md), or leave --distributed out");
}

}  // namespace driftwright::solver
