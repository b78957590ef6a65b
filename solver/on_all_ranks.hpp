#pragma once
// Runs work on all processes of `mpirun`, in a build with -DDRIFTWRIGHT_MPI=ON.

#include <exception>
#include <functional>
#include <string>

#include "solver/share.hpp"

namespace driftwright::solver {

/// Starts MPI and PETSc, calls work(ranks) on each process, and ends them. A process that fails ends all of them: the first
/// one prints its failure, another one only if the first is still there a second later.
/// @param build    name of this build; all processes must be of one
/// @param say      prints a failure and returns its exit code
/// @throws InputError  in a build without MPI, before any work
void on_all_ranks(const std::string& build, const std::function<void(const Ranks& ranks)>& work,
                  const std::function<int(const std::exception_ptr& failure)>& say);

}  // namespace driftwright::solver
