#!/usr/bin/env python3
"""`import driftwright` from the sources, before anything is built, says how to build it.   python_not_built_test.py FOLDER_OF_THE_PROJECT"""

import os
import subprocess
import sys
import tempfile

with tempfile.TemporaryDirectory() as stubs:  # the tables' packages may not be there either
    for name in ("numpy", "pandas"):
        open(os.path.join(stubs, name + ".py"), "w").close()
    outcome = subprocess.run([sys.executable, "-S", "-c", "import driftwright"], capture_output=True, text=True,
                             env={"PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": stubs + os.pathsep + os.path.join(sys.argv[1], "python")})
    without = subprocess.run([sys.executable, "-S", "-c", "import driftwright"], capture_output=True, text=True,
                             env={"PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": os.path.join(sys.argv[1], "python")})
for words in ("ImportError", "not built for this Python", "-DDRIFTWRIGHT_PYTHON=ON", "PYTHONPATH="):
    if words not in outcome.stderr:
        sys.exit(f"'{words}' is not said:\n{outcome.stderr}")
if "takes numpy, which is not installed" not in without.stderr:
    sys.exit(without.stderr)
