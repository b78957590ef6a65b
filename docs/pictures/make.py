#!/usr/bin/env python3
"""Makes the pictures of this folder anew, from reports and pages of the program: make.py PROGRAM   (in the folder of the project; pages need chromium)"""
import pathlib, subprocess, sys, tempfile

HERE = pathlib.Path(__file__).resolve().parent
PICTURES = {"fp3_spindle": ["run", "scenarios/fp3_spindle.yaml"]}

for name, words in PICTURES.items():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], *words, "-o", f"{folder}/out", "--quiet"], check=True, cwd=HERE.parent.parent)
        page = pathlib.Path(folder, "out/report.html").read_text()
        begin = page.index("<svg viewBox")
        (HERE / f"{name}.svg").write_text(page[begin:page.index("</svg>", begin) + 6] + "\n")

with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.argv[1], "view", "scenarios/fp3_spindle.yaml", "-o", f"{folder}/twin.html"], check=True, cwd=HERE.parent.parent, stdout=subprocess.DEVNULL)
    subprocess.run(["chromium", "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars",
                    f"--user-data-dir={folder}/profile", "--window-size=1200,1300", f"--screenshot={HERE}/view.png", f"file://{folder}/twin.html"], check=True)
