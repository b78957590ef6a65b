#!/usr/bin/env python3
"""Makes the pictures of this folder anew, from figures and pages of the program: make.py PROGRAM   (in the folder of the project; pages need chromium)"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
PICTURES = {  # name: what the program is asked, and which of its figures
    "fp3_spindle": (["run", "scenarios/fp3_spindle.yaml"], "*_stored_*"),
    "cnc_mill_13": (["run", "scenarios/cnc_mill_13.yaml"], "*_stored_*"),
    "cnc_mill_13_drift": (["run", "scenarios/cnc_mill_13.yaml"], "drift_z_*"),
    "c_frame": (["simulate", "scenarios/c_frame.yaml", "--cyclogram", "warm_up"], "*_stored_*"),
    "gantry_table": (["run", "scenarios/gantry_table.yaml"], "*_stored_*"),
    "gantry_table_error": (["run", "scenarios/gantry_table.yaml"], "largest_position_error*"),
    "first_machine": (["predict", "scenarios/first_machine.yaml", "--cyclogram", "shift"], "displacements.svg"),
    "lumped_spindle": (["simulate", "scenarios/lumped_spindle.yaml"], "temperatures.svg"),
    "lumped_sweep": (["sweep", "scenarios/lumped_sweep.yaml"], "*nose_z_peak_um_over_preload.svg"),
}

with tempfile.TemporaryDirectory() as folder:
    results = {}  # by what was asked, so that nothing is computed twice
    for name, (words, pattern) in PICTURES.items():
        if tuple(words) not in results:
            out = results[tuple(words)] = pathlib.Path(folder, name)
            subprocess.run([PROGRAM, *words, "-o", out, "--quiet"], check=True, cwd=HERE.parent.parent)
        (figure,) = sorted((results[tuple(words)] / "figures").glob(pattern))
        shutil.copy(figure, HERE / f"{name}.svg")
    subprocess.run([PROGRAM, "view", "scenarios/fp3_spindle.yaml", "-o", f"{folder}/twin.html"], check=True, cwd=HERE.parent.parent, stdout=subprocess.DEVNULL)
    subprocess.run(["chromium", "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars",
                    f"--user-data-dir={folder}/profile", "--window-size=1200,1300", f"--screenshot={HERE}/view.png", f"file://{folder}/twin.html"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    # The page of a followed machine, after the rows of an afternoon.
    sys.path.insert(0, str(HERE.parent.parent / "tests/follow"))
    from browser import Browser
    subprocess.run([PROGRAM, "predict", "scenarios/fp3_spindle.yaml", "--cyclogram", "chaotic", "-o", f"{folder}/chaotic", "--quiet"], check=True, cwd=HERE.parent.parent)
    follow = subprocess.Popen([PROGRAM, "follow", "scenarios/fp3_spindle.yaml", "--serve", "0"], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              text=True, cwd=HERE.parent.parent)
    address = follow.stderr.readline().split("the page is at ")[1].strip()
    follow.stdin.write(pathlib.Path(folder, "chaotic/record.csv").read_text())
    follow.stdin.flush()
    browser = Browser()
    page = browser.open(address, height=1330)
    page.wait("live.fields && live.fields.state && live.points.length > 50")
    page.screenshot(HERE / "follow.png")
    follow.kill()

    # The page for picking, after a click on the table.
    subprocess.run([PROGRAM, "view", "--pick", "scenarios/c_frame.yaml", "-o", f"{folder}/pick.html"], check=True, cwd=HERE.parent.parent, stdout=subprocess.DEVNULL)
    page = browser.open(f"file://{folder}/pick.html", height=1250)
    page.wait("window.pick && pick.scene && pick.scene.aspect")
    page.value("pick.pickAt(...pick.scene.project([0.15, -0.05, 0.32]))")
    page.wait("!pick.isDue")
    page.screenshot(HERE / "pick.png")
    browser.close()
