# Sourced by ./test and bench/ for programs that do not set them themselves (app/library_settings.hpp does): settings that libraries read once, when they are loaded. What the user set stays.

# OpenBLAS of Debian 12 takes processors younger than itself for old ones; this one it knows, and its kernels are as wide.
if [ -z "${OPENBLAS_CORETYPE:-}" ] && grep -qw avx512vl /proc/cpuinfo 2>/dev/null && grep -qw avx512dq /proc/cpuinfo; then
  export OPENBLAS_CORETYPE=SKYLAKEX
fi

# How long a thread that waits turns in a loop before it sleeps. The default of libgomp is milliseconds, which on a busy machine
# are taken from the thread that it waits for.
if [ -z "${OMP_WAIT_POLICY:-}" ]; then export GOMP_SPINCOUNT="${GOMP_SPINCOUNT:-10000}"; fi
