#!/usr/bin/python3
"""Tests `driftwright view --pick` in a real browser: clicks on faces, and the text that they give, read back by the program.

    pick_test.py PROGRAM FOLDER_OF_THE_PROJECT
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "follow"))
sys.dont_write_bytecode = True
import browser as chromium  # noqa: E402

SIZE_MM = (100.0, 60.0, 40.0)  # of the box
SIDES = {"x": (60 * 40, [100, 30, 20]), "y": (100 * 40, [50, 60, 20]), "z": (100 * 60, [50, 30, 40])}  # seen from +x, +y, +z: area [mm^2], centre
failures = []


def expect(holds, what):
    print(("" if holds else "FAILED: ") + what, flush=True)
    if not holds:
        failures.append(what)


def box_msh():
    """A box of 2 x 2 x 2 hexahedra in mm, as Gmsh 2.2 writes it."""
    number = lambda i, j, k: 1 + i + 3 * j + 9 * k
    nodes = [f"{number(i, j, k)} {i * 50} {j * 30} {k * 20}" for k in range(3) for j in range(3) for i in range(3)]
    cells = []
    for k in range(2):
        for j in range(2):
            for i in range(2):
                low = [number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k)]
                cells.append(f"{len(cells) + 1} 5 2 1 1 " + " ".join(map(str, low + [n + 9 for n in low])))
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "1", '3 1 "block"', "$EndPhysicalNames", "$Nodes", str(len(nodes)), *nodes,
                      "$EndNodes", "$Elements", str(len(cells)), *cells, "$EndElements", ""])


class Picked:
    """The page in the browser, clicked as a person does."""

    def __init__(self, browser, path):
        self.browser, self.page = browser, browser.open(f"file://{path}", 1200, 1400)
        self.page.wait("window.pick && pick.scene && pick.scene.aspect", 120)

    def value(self, script):
        return self.page.value(script)

    def at(self, point_mm):
        """Where a point of the machine is in the window."""
        return self.value(f"(() => {{ const box = pick.scene.canvas.getBoundingClientRect(), at = pick.scene.project({json.dumps([x / 1000 for x in point_mm])}); "
                          "return [box.left + at[0], box.top + at[1]]; })()")

    def mouse(self, kind, x, y):
        still = kind == "mouseMoved"
        self.browser.ask("Input.dispatchMouseEvent", self.page.session, type=kind, x=x, y=y, button="none" if still else "left", clickCount=0 if still else 1)

    def click(self, point_mm):
        x, y = self.at(point_mm)
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.mouse(kind, x, y)
        return {name: self.value(f"byId('{name}-text').value") for name in ("surface", "sensor", "drift")}


def numbers(text):
    return [float(x) for x in re.findall(r"(-?[0-9.]+) mm", text)]


def main():
    program, top = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="driftwright_pick-"))
    try:
        return check(program, top, folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def check(program, top, folder):
    env = dict(os.environ, XDG_CACHE_HOME=os.environ.get("DRIFTWRIGHT_TEST_STORE", str(folder / "cache")))

    def call(*words):
        return subprocess.run([program, *map(str, words)], capture_output=True, text=True, cwd=folder, env=env)

    def area_m2(scenario, surface):
        """Of a surface, as `driftwright mesh` names it."""
        done = call("mesh", scenario, "-o", f"{scenario}_mesh", "--json", "--force")
        expect(done.returncode == 0, f"mesh {scenario}: exit {done.returncode}, {done.stderr.strip()[:200]}")
        return next((row["area_m2"] for row in json.loads(done.stdout)["surfaces"] if row["surface"] == surface), None) if done.returncode == 0 else None

    refuse(call, top, folder)
    (folder / "box.msh").write_text(box_msh())
    made = call("view", "--pick", "box.msh", "-o", "box.html")
    expect(made.returncode == 0, f"view --pick box.msh: {made.stderr.strip()[-300:]}")
    again = call("view", "--pick", "box.msh", "-o", "again.html")
    expect(again.returncode == 0 and (folder / "again.html").read_bytes() == (folder / "box.html").read_bytes(), "the same file gives the same bytes")
    shutil.copy(top / "scenarios/c_frame.yaml", folder)
    shutil.copytree(top / "scenarios/parts", folder / "parts")
    made = call("view", "--pick", "c_frame.yaml", "-o", "c_frame.html")
    expect(made.returncode == 0, f"view --pick c_frame.yaml: {made.stderr.strip()[-300:]}")
    made = call("view", "--pick", "parts/c_frame.step", "-o", "drawing.html")
    expect(made.returncode == 0, f"view --pick c_frame.step: {made.stderr.strip()[-300:]}")
    if failures or not chromium.found():
        print("no chromium here; Debian's chromium runs the pages")
        return 1 if failures else 77
    browser = chromium.Browser()
    try:
        pick_box(browser, folder, call, area_m2)
        pick_drawing(browser, folder, area_m2)
        pick_scenario(browser, folder, call, area_m2)
    finally:
        browser.close()
    return 1 if failures else 0


def refuse(call, top, folder):
    lumped, box = top / "scenarios/first_machine.yaml", folder / "box.msh"
    box.write_text(box_msh())
    (folder / "empty.msh").write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n0\n$EndElements\n")
    (folder / "note.txt").write_text("no scenario\n")
    call("view", "--pick", "none.step")
    expect(not (folder / "results").exists(), "a file that is missing leaves no folder of results")
    for words, says in [(("--pick", "none.step"), "none.step"), (("--pick", "none.yaml"), "none.yaml"), (("--pick", "note.txt"), "note.txt"), (("--pick", "empty.msh"), "empty.msh"),
                        (("--pick", lumped), "lumped"), (("--pick", lumped, "--units", "mm"), "--units"), (("--pick", box, "--units", "furlong"), "furlong"),
                        (("--pick", box, "--cyclogram", "shift"), "--cyclogram"), ((lumped, "--units", "mm"), "--units"), (("--pick", box, "-o", "page.txt"), ".html is required"),
                        ((box,), "--pick")]:
        done = call("view", *words)
        expect(done.returncode == 2 and says in done.stderr, f"view {' '.join(map(str, words))}: exit {done.returncode}, {done.stderr.strip()[:120]}")
    expect(not list(folder.glob("**/*.html*")), "no page is left of what was refused")


def pick_box(browser, folder, call, area_m2):
    page = Picked(browser, folder / "box.html")
    expect(page.value("pick.bare") == ["block, no name yet"], f"a mesh without names is listed as such: {page.value('pick.bare')}")
    expect(page.value("pick.data.faces.length") == 6, "a box has six faces")
    beginning, texts = page.value("byId('beginning-text').value"), {}
    for side, (area_mm2, centre_mm) in SIDES.items():
        texts[side] = page.click(centre_mm)
        expect(f"normal: {json.dumps([int(a == side) for a in 'xyz'])}" in texts[side]["surface"], f"the side in {side}: {texts[side]['surface']}")
        for text in ("sensor", "drift"):
            off = max((abs(a - b) for a, b in zip(numbers(texts[side][text]), centre_mm)), default=1e9)
            expect(off < 0.4, f"the side in {side}: {texts[side][text]} is {off:.2f} mm from the click")  # a pixel has 0.3 mm
        expect(f"along: {side}," in texts[side]["drift"], f"along its normal: {texts[side]['drift']}")
        face = page.value("pick.data.faces[pick.picked.face].area_m2")
        expect(abs(1e6 * face - area_mm2) < 1e-6, f"the side in {side} has {1e6 * face:.3f} mm2 of {area_mm2}")
    names = {side: re.search(r"name: (\w+)", texts[side]["surface"])[1] for side in SIDES}
    (folder / "box.yaml").write_text(beginning + "".join(f"    {t['surface']}\n" for t in texts.values()) + "sensors:\n  " + texts["x"]["sensor"] + "\ndisplacements:\n  " +
                                     texts["z"]["drift"] + "\n")
    for side, (area_mm2, _) in SIDES.items():
        found = area_m2("box.yaml", names[side])
        expect(found is not None and abs(1e6 * found - area_mm2) < 1e-3, f"the text of the side in {side} names {found} m2 of {1e-6 * area_mm2}")

    corner = page.click([99.5, 59.8, 40])  # 0.5 mm are two pixels
    expect(numbers(corner["sensor"]) == list(SIZE_MM), f"a click near a corner takes the corner: {corner['sensor']}")
    page.value("byId('table-here').click()")
    page.click([50, 30, 40])
    expect(page.value("byId('drift-text').value").endswith(", table: {region: block, at: [100.00 mm, 60.00 mm, 40.00 mm]}}"), f"the table: {page.value('byId(`drift-text`).value')}")

    before = page.value("byId('face').textContent")
    x, y = page.at([50, 60, 20])
    page.mouse("mousePressed", x, y)
    page.browser.ask("Input.dispatchMouseEvent", page.page.session, type="mouseMoved", x=x + 40, y=y, button="left", buttons=1)
    page.mouse("mouseReleased", x + 40, y)
    expect(page.value("byId('face').textContent") == before and abs(page.value("pick.scene.yaw") - 0.7) > 0.1, "dragging turns the machine and picks nothing")
    page.mouse("mouseMoved", *page.at([50, 30, 40]))
    expect("normal [0, 0, 1]" in page.value("byId('under').textContent") and page.value("pick.hovered") >= 0, f"the face under the mouse: {page.value('byId(`under`).textContent')}")
    page.value("document.querySelector('[data-copies=surface-text]').click()")
    name = page.value("byId('surface-name').value")
    page.page.wait(f"pick.taken.has('{name}')", 20)
    page.click([50, 30, 40])
    expect(page.value("byId('surface-name').value") == f"{name}_2", f"a copied name is taken: {page.value('byId(`surface-name`).value')}")


def pick_drawing(browser, folder, area_m2):
    """A drawing whose solids have no names, with the beginning of a scenario that the page gives."""
    page = Picked(browser, folder / "drawing.html")
    texts = [page.click([200, -200, 320])["surface"]]
    page.value("pick.scene.turnBy(0, -0.8)")
    texts.append(page.click([32, -21.6, 670])["surface"])
    (folder / "drawing.yaml").write_text(page.value("byId('beginning-text').value") + "".join(f"    {text}\n" for text in texts))
    for text, exact_m2, tolerance in zip(texts, (0.5 * 0.35, None), (1e-5, 0.02)):  # the table; the mesh of the round spindle may be another one
        face = page.value(f"pick.data.faces.find(f => {json.dumps(text)}.includes(f.pick)).area_m2")
        found = area_m2("drawing.yaml", re.search(r"name: (\w+)", text)[1])
        expect(found is not None and abs(found - face) <= tolerance * face and (exact_m2 is None or abs(found - exact_m2) < 1e-5), f"{text}: {found} m2 in `mesh`, {face} in the page")


def pick_scenario(browser, folder, call, area_m2):
    page = Picked(browser, folder / "c_frame.html")
    expect(page.value("pick.bare") == ["feet"], f"c_frame.yaml has neither heat nor film on its feet alone: {page.value('pick.bare')}")
    expect(page.value("byId('beginning').hidden"), "a scenario needs no beginning")
    kinds = page.value("pick.data.patches.map((p, i) => [p.surfaces.map(s => pick.data.surfaces[s].name).join(), pick.kindOf(i)])")
    expect(all(kind == (1 if names == "feet" else 2 if names else 3) for names, kind in kinds), f"colours of surfaces: {[k for k in kinds if k[1] == 0][:5]}")

    expect(page.value("pick.taken.has('tilt_x')"), "the name of a tilt is taken, too")
    top = page.click([200, -200, 320])
    carries = page.value("byId('facts').textContent")
    expect("table_top (cutting_heat, natural_convection, radiation)" in carries, f"what the table's top carries: {carries}")
    page.value("pick.scene.turnBy(0, -0.8)")  # from below: the spindle beneath the head
    round_ = page.click([32, -21.6, 670])
    expect("cylinder" in round_["surface"] and "diameter: 100 mm" in round_["surface"], f"the spindle: {round_['surface']}")
    text = (folder / "c_frame.yaml").read_text()
    for line, new in [("  surfaces:\n", [top["surface"].replace("face_", "picked_top_", 1), round_["surface"].replace("face_", "picked_round_", 1)]),
                      ("sensors:\n", [top["sensor"]]), ("displacements:\n", [round_["drift"]])]:
        blanks = "    " if line.startswith(" ") else "  "
        expect(text.count(line) == 1, f"c_frame.yaml has one line {line.strip()}")
        text = text.replace(line, line + "".join(f"{blanks}{entry}\n" for entry in new))
    (folder / "pasted.yaml").write_text(text)
    names = [re.search(rf"name: (picked_{kind}_\w+)", text)[1] for kind in ("top", "round")]
    faces = [page.value(f"pick.data.faces.find(f => {json.dumps(t['surface'])}.includes(f.pick)).area_m2") for t in (top, round_)]
    for name, face in zip(names, faces):
        found = area_m2("pasted.yaml", name)
        expect(found is not None and abs(found - face) < 1e-5 * face, f"{name}: {found} m2 in `mesh`, {face} in the page")
    expect(abs(faces[0] - area_m2("pasted.yaml", "table_top")) < 1e-9, "the picked top is table_top")
    done = call("check", "pasted.yaml")
    expect(done.returncode == 0, f"check of the scenario with what was pasted: exit {done.returncode}, {done.stderr.strip()[:300]}")
    (folder / "moved.yaml").write_text(text.replace(top["sensor"], top["sensor"].replace("region: table", "region: column")))
    done = call("check", "moved.yaml")
    expect(done.returncode == 2, f"the same point on another region is refused: exit {done.returncode}")


if __name__ == "__main__":
    sys.exit(main())
