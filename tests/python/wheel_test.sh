#!/bin/bash
# The wheel in an environment of its own: installed without network, it imports, agrees with the program, and loads no library of the system but glibc's and
# the compiler's: wheel_test.sh BUILD_FOLDER FOLDER_OF_THE_PROJECT PYTHON
set -eu
build=$(realpath "$1") top=$(realpath "$2") python=$3
skip() { echo "skipped: $*"; exit 77; }
fail() { echo "$*"; exit 1; }
command -v patchelf >/dev/null || skip "patchelf is not installed"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$python" -m venv --system-site-packages "$work/venv" >"$work/log" 2>&1 || skip "$python makes no environment (python3-venv)"
"$python" "$top/cmake/bundle.py" wheel "$build" "$work"
"$work/venv/bin/python" -m pip install --no-index --no-deps --quiet "$work"/driftwright-*.whl || fail "pip refuses the wheel"
cd "$top"
unset PYTHONPATH
"$work/venv/bin/driftwright" check scenarios/first_machine.yaml || fail "the command of the wheel"
"$work/venv/bin/driftwright" check no_such.yaml 2>/dev/null && fail "a scenario that is not there must end with an exit code"
cat >"$work/loaded.py" <<'PY'
import re, sys
from pathlib import Path
import numpy, pandas
def loaded():
    return set(re.findall(r"(/\S+\.so[.\d]*)$", Path("/proc/self/maps").read_text(), re.M))
before = loaded()
import driftwright as dw
dw.Machine("scenarios/cnc_mill_13.yaml").mesh()  # a drawing: OpenCASCADE and Gmsh
new = loaded() - before
own = {f for f in new if f.startswith(sys.prefix)}
# TBB also asks for its allocator by name while it runs, and does without.
allowed = re.compile(r"/(ld-linux-x86-64|libc|libm|libmvec|libpthread|libdl|librt|libresolv|libstdc\+\+|libgcc_s|libtbbmalloc)\.so")
others = sorted(f for f in new - own if not allowed.search(f))
if len(own) < 50 or others:
    sys.exit(f"{len(own)} files of the wheel and these of the system are loaded: {others}")
PY
"$work/venv/bin/python" "$work/loaded.py" || fail "libraries of the system are loaded"
"$work/venv/bin/python" tests/python/python_test.py "$build/app/driftwright"
if "$python" -c 'import nbconvert, meshio, matplotlib' 2>/dev/null; then
  PYTHONPATH=$("$work/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("platlib"))') tests/python/notebooks_test.sh "$top"
fi
echo "wheel: all pass"
