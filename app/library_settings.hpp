#pragma once
// Settings that libraries read once, when they are loaded, and that make the program faster: OpenMP's waiting, OpenBLAS's kernels.

namespace driftwright::app {

/// Where a verb computes (its name is the first argument), starts the program anew with those settings in its environment where they are missing; what the user set stays. Returns where nothing is
/// missing, or where it cannot be started anew: it is then slower and as right. Call it first.
/// Loading the libraries twice takes 0.15 s: verbs that only read and show are left alone.
///
/// - GOMP_SPINCOUNT, unless OMP_WAIT_POLICY or itself is set: how long a thread that waits turns in a loop before it sleeps. The default of libgomp is
///   milliseconds, which on a busy machine are taken from the thread that it waits for.
/// - OPENBLAS_CORETYPE: OpenBLAS of Debian 12 takes processors younger than itself for old ones; SKYLAKEX it knows, and its kernels are as wide.
void restart_with_library_settings(char** argv);

/// Where the address space is limited (`ulimit -v`), no more threads than one for each 256 MB; `--threads` has the last word. OpenMP's library ends the
/// program, as if by a bug of ours, where the system has no room for a thread's stack.
void take_threads_that_fit();

}  // namespace driftwright::app
