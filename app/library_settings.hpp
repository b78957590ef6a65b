#pragma once
// Settings that libraries read once, when they are loaded, and that make the program faster: how OpenMP waits, and which
// kernels OpenBLAS uses.

namespace driftwright::app {

/// Restarts the program with these settings in its environment, for verbs that compute (the first argument is the verb).
/// Variables that the user set are kept. Returns if no setting is missing, or if the restart fails: the program is then
/// slower but computes the same. Call it first. Verbs that only read and show are not restarted, since loading the
/// libraries twice takes 0.15 s.
///
/// - GOMP_SPINCOUNT, unless it or OMP_WAIT_POLICY is set: how many turns a waiting thread spins before it sleeps. The
///   default of libgomp lasts milliseconds, which on a busy machine are taken from the thread that it waits for.
/// - OPENBLAS_CORETYPE=SKYLAKEX on processors with AVX-512: OpenBLAS of Debian 12 does not know newer processors and uses
///   slow kernels on them; it knows SKYLAKEX, whose kernels use vectors of the same width.
void restart_with_library_settings(char** argv);

/// With a limited address space (`ulimit -v`), reduces OpenMP's threads to one per 256 MB; `--threads` overrides this.
/// Without it, OpenMP's library ends the program, as if by a bug of ours, when the system has no room for a thread's
/// stack.
void take_threads_that_fit();

}  // namespace driftwright::app
