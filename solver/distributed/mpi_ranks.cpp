#include <fmt/format.h>
#include <mpi.h>
#include <omp.h>
#include <petscsys.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "base/errors.hpp"
#include "solver/distributed/mpi_share.hpp"
#include "solver/on_all_ranks.hpp"

namespace driftwright::solver {
namespace {

class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
  }
  std::shared_ptr<const Share> split(const mesh::Mesh& whole, const effects::HeatBalance& balance) const override {
    return std::make_shared<MpiShare>(MPI_COMM_WORLD, whole, balance);
  }
};

void require_one_build(const MpiRanks& ranks, const std::string& build) {
  constexpr int kLength = 256;
  char own[kLength] = {}, first[kLength] = {};
  build.copy(own, kLength - 1);
  std::copy(own, own + kLength, first);
  MPI_Bcast(first, kLength, MPI_CHAR, 0, MPI_COMM_WORLD);
  int odd = std::equal(own, own + kLength, first) ? ranks.size : ranks.rank;
  MPI_Allreduce(MPI_IN_PLACE, &odd, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (odd == ranks.size) return;
  char other[kLength] = {};
  std::copy(own, own + kLength, other);
  MPI_Bcast(other, kLength, MPI_CHAR, odd, MPI_COMM_WORLD);
  throw InputError(
      fmt::format("--distributed: process 0 is Driftwright {}, process {} is Driftwright {}; all must be of one build",
                  first, odd, other));
}

/// The processes of one machine share its cores, unless OMP_NUM_THREADS says otherwise.
void share_cores() {
  const char* said = std::getenv("OMP_NUM_THREADS");
  if (said && *said) return;
  MPI_Comm here = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  int n_here = 1;
  MPI_Comm_size(here, &n_here);
  MPI_Comm_free(&here);
  omp_set_num_threads(std::max(1, static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)) / n_here));
}

}  // namespace

void on_all_ranks(const std::string& build, const std::function<void(const Ranks& ranks)>& work,
                  const std::function<int(const std::exception_ptr& failure)>& say) {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  const MpiRanks ranks;
  try {
    require_one_build(ranks, build);
    share_cores();
    PetscOptionsSetValue(nullptr, "-no_signal_handler", "1");  // a signal ends the process, and mpirun the others
    if (PetscInitializeNoArguments() != 0) throw SolveError("PETSc cannot be started");
    PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
    work(ranks);
  } catch (...) {
    // Most failures are those of all processes: the first one says it for them.
    if (ranks.rank > 0) sleep(1);
    MPI_Abort(MPI_COMM_WORLD, say(std::current_exception()));
  }
  PetscFinalize();
  MPI_Finalize();
}

}  // namespace driftwright::solver
