// A process that claims to be of another build than the one beside it: distributed_test.py starts it as one of `mpirun`.
#include <cstdio>

#include "solver/on_all_ranks.hpp"

int main() {
  driftwright::solver::on_all_ranks(
      "0.0.0 of other sources", [](const driftwright::solver::Ranks&) { std::puts("it computes"); },
      [](const std::exception_ptr& failure) {
        try {
          std::rethrow_exception(failure);
        } catch (const std::exception& e) {
          std::fprintf(stderr, "%s\n", e.what());
        }
        return 2;
      });
}
