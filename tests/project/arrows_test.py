#!/usr/bin/python3
"""Checks the dependencies between rooms: a file includes only headers of its own room and of rooms that its CMakeLists.txt links, no room depends on itself,
and the library does not depend on the command line. A folder without a
CMakeLists.txt belongs to the room around it, and no file outside of it includes its headers: the room does not know what is special there (the controls of nc/).
The C of a functional mock-up unit (output/fmu/sources), which is no C++ room, is compiled into the program as well.

CONTRIBUTING.md has a picture of the rooms, which must be the one that this makes; --write puts it there.

    arrows_test.py FOLDER_OF_THE_PROJECT [--write]
"""
import pathlib
import re
import sys

TARGET = re.compile(r"driftwright_target\(driftwright_(\w+)")
LINKS = re.compile(r"target_link_libraries\(driftwright_(\w+)((?:[^()]|\([^()]*\))*)\)")
INCLUDE = re.compile(r'^#include "([^"]+)/[^"/]+"', re.M)


def is_special(folder):
    return folder.is_dir() and not (folder / "CMakeLists.txt").exists() and any(folder.glob("*.hpp"))


def rooms_of(top):
    """The target of each folder, and the targets that each target links."""
    target, links = {}, {}
    for cmake in top.glob("**/CMakeLists.txt"):
        folder = cmake.parent.relative_to(top).as_posix()
        if folder.split("/")[0] in ("build", "tests", "bench"):
            continue
        text = cmake.read_text()
        found = [n for n in TARGET.findall(text) if f"add_library(driftwright_{n}" in text]
        if found:
            target[folder] = found[0]
        for name, linked in LINKS.findall(text):
            links.setdefault(name, set()).update(re.findall(r"driftwright_(\w+)", linked))
    return target, links


def room_around(folder, target):
    """The room that a folder belongs to, or ""."""
    while folder and folder not in target:
        folder = folder.rpartition("/")[0]
    return folder


def below(name, links, seen):
    """All targets that a target depends on. It exits if a target depends on itself."""
    for n in links.get(name, ()):
        if n in seen:
            sys.exit(f"a circle of rooms: {' -> '.join([*seen, n])}")
    return set(links.get(name, ())).union(*[below(n, links, [*seen, n]) for n in links.get(name, ())])


def picture(target, links):
    """A line a room, the lowest first: what it links, without what these link already."""
    folder = {name: f"{f}/" for f, name in target.items()}
    under = {name: below(name, links, [name]) & folder.keys() for name in folder}
    depth = {}
    for name in sorted(folder, key=lambda n: len(under[n])):
        depth[name] = 1 + max((depth[n] for n in under[name]), default=0)
    lines = []
    for name in sorted(folder, key=lambda n: (depth[n], folder[n])):
        nearest = under[name] - set().union(*[under[n] for n in under[name]])
        lines.append(f"    {folder[name]:<26}{' '.join(sorted(folder[n] for n in nearest))}".rstrip())
    return "\n".join(lines) + "\n"


def wrong_picture(contributing, of_rooms, write):
    """What is wrong with the picture in CONTRIBUTING.md, as a list."""
    text = contributing.read_text()
    pictured = re.compile(r"(?<=<!-- rooms and what they link -->\n)(?:    .*\n)*")
    if write:
        contributing.write_text(pictured.sub(lambda _: of_rooms, text))
    elif pictured.findall(text) != [of_rooms]:
        return ["the picture of the rooms in CONTRIBUTING.md is not that of the CMake files: run tests/project/arrows_test.py . --write"]
    return []


def main():
    top = pathlib.Path(sys.argv[1])
    target, links = rooms_of(top)
    if len(target) < 10:
        sys.exit(f"only {len(target)} rooms found under {top}")
    wrong = ["library/ links app/: what a verb does is a function below both"] if "app" in below("library", links, ["library"]) else []
    for folder, name in target.items():
        allowed = below(name, links, [name]) | {name}
        for file in (f for end in ("cpp", "hpp", "h") for f in (top / folder).rglob(f"*.{end}")):
            if room_around(file.parent.relative_to(top).as_posix(), target) != folder:
                continue
            for included in INCLUDE.findall(file.read_text()):
                its = top / included
                if is_special(its) and its != file.parent:
                    wrong.append(f"{file.relative_to(top)} includes a header of {included}, which is for that folder alone")
                other = room_around(included, target)
                if other and target[other] not in allowed:
                    wrong.append(f"{file.relative_to(top)} includes a header of {included}, which driftwright_{name} does not link")
    wrong += wrong_picture(top / "CONTRIBUTING.md", picture(target, links), "--write" in sys.argv)
    print("\n".join(wrong) or f"{len(target)} rooms, every arrow one way")
    sys.exit(bool(wrong))


main()
