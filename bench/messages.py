#!/usr/bin/env python3
"""Collects all messages of the program from the string literals of its C++ sources.

    bench/messages.py                 prints every message with file and line, and a count for each room
    bench/messages.py --dialect       prints those with a word of the list DIALECT; exit code 1 if there are any
    bench/messages.py --write         writes docs/reference/messages.txt: the list for a review, without line numbers
    bench/messages.py --check         exit code 1 if docs/reference/messages.txt differs from what --write would write

A message is a sentence with a subject. It says what is wrong, where, what is allowed, and what to write instead: "must be", "is required", "is expected",
"is allowed", "after", "write ... instead". It begins in lower case and ends without a full stop, since "error: file:line:column:" comes before it and
"[key]" after it.

This is an approximation. A message is a literal (joined with adjacent literals) of three words or more that does not look like code (style sheets, C,
NC programs, SVG). Literals joined by `+` count as several.
"""
import argparse, re, sys
from collections import Counter
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
ROOMS = ("app base compensation diagnosis effects findings follow identification include library machine mesh nc output python scenarios solver "
         "studies").split()
LIST = TOP / "docs/reference/messages.txt"

# word of the dialect: what to write instead
DIALECT = {
    r"wants?|wanted": "is required, must be, is expected",
    r"behind(?:hand)?": "after; of a lag: with",
    r"stands?|stood": "is, is at rest, is listed",
    r"tells?|told": "gives, says, shows; tell apart: distinguish",
    r"by (?:it|them)sel(?:f|ves)": "automatically, alone, on its own",
    r"(?:is|are|was|were) not there": "is missing, does not exist",
    r"do(?:es)? without": "needs no",
    r"waited for": "waits for, with a subject",
}
WORDS = re.compile(rf"\b(?:{'|'.join(DIALECT)})\b", re.I)

# messages in which such a word is right: file, and a part of the message
ALLOWED = [
    ("findings/machine_section.cpp", "grey names lie behind"),                    # behind the picture
    ("mesh/knee_mill.cpp", "behind its front wall"),                              # a place
    ("mesh/knee_mill.cpp", "a cylinder behind the headstock"),                    # a place
    ("scenarios/reader/read_outputs.cpp", "the indicator's stand moves"),         # a thing
    ("solver/springs.cpp", "no cell lies behind surface"),                        # a place
]
NOT_YET = set()  # rooms whose messages are not reviewed yet; --dialect leaves them out

TOKEN = re.compile(
    r"""(?P<skip>//[^\n]*|/\*.*?\*/|\s+)
    |R"(?P<mark>[^()\s\\]{0,16})\((?P<raw>.*?)\)(?P=mark)"
    |"(?P<text>(?:[^"\\\n]|\\.)*)"
    |(?P<other>(?<!\w)'(?:[^'\\\n]|\\.)+'|^[ \t]*\#[ \t]*include[^\n]*|\w+|.)""", re.S | re.M | re.X)
CODE = re.compile(r"[<>{}=;|\\$@#]")
PLACE = re.compile(r"\{[^{}\s]*\}|`[^`]*`|\{\{|\}\}|\\[n\"]")


def literals(source):
    """@return line and text of each literal, joined as the compiler joins them"""
    found, is_open = [], False
    for m in TOKEN.finditer(source):
        if m["skip"] is not None:
            continue
        text = m["raw"] if m["raw"] is not None else m["text"]
        if text is None:
            is_open = False
        elif is_open:
            found[-1][1] += text
        else:
            found.append([source.count("\n", 0, m.start()) + 1, text])
            is_open = True
    return found


def is_message(text):
    if re.match(r"(?:re)?set[p ]", text):  # halcmd
        return False
    words = PLACE.sub(" ", text)
    n_letters = len(re.findall(r"[A-Za-z]", words))
    return (len(re.findall(r"[A-Za-z]{2,}", words)) >= 3 and " " in text.strip() and len(CODE.findall(words)) <= 0.04 * n_letters
            and not text.rstrip().endswith((";", "{", "}")) or WORDS.search(text) is not None and " " in text.strip())


def messages():
    """@return room, file, line and text"""
    for room in ROOMS:
        for path in sorted(p for p in (TOP / room).rglob("*") if p.suffix in (".cpp", ".hpp")):
            for line, text in literals(path.read_text(encoding="utf-8")):
                if is_message(text):
                    yield room, path.relative_to(TOP).as_posix(), line, text.replace("\n", "\\n")


def in_dialect(found):
    return [m for m in found if WORDS.search(m[3]) and not any(m[1] == file and part in m[3] for file, part in ALLOWED)]


def listed(found):
    lines = ["# What the program says, by file, made by bench/messages.py --write: for a review of all of it. Not to be edited.", ""]
    last, seen = "", set()
    for _, file, _, text in found:
        if file != last:
            lines += ["", file] if last else [file]
            last, seen = file, set()
        if text not in seen:
            lines.append("    " + text)
        seen.add(text)
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for option in ("dialect", "write", "check"):
        parser.add_argument("--" + option, action="store_true")
    options = parser.parse_args()
    found = list(messages())
    shown = [m for m in in_dialect(found) if m[0] not in NOT_YET] if options.dialect else [] if options.write or options.check else found
    for _, file, line, text in shown:
        print(f"{file}:{line}: {text}")
    counts, dialect = Counter(m[0] for m in found), Counter(m[0] for m in in_dialect(found))
    if options.dialect:
        for words, instead in DIALECT.items() if shown else ():
            print(f"{words}: write {instead}")
        print(f"{len(shown)} of {len(found)} messages are in the dialect" + (", without " + ", ".join(sorted(NOT_YET)) if NOT_YET else ""))
    elif shown:
        print("\n".join(f"{room}: {counts[room]} messages, {dialect[room]} in the dialect" for room in ROOMS))
    if options.write:
        LIST.write_text(listed(found), encoding="utf-8")
    is_stale = options.check and (not LIST.exists() or LIST.read_text(encoding="utf-8") != listed(found))
    if is_stale:
        print(f"{LIST.relative_to(TOP)} is not up to date: bench/messages.py --write")
    return 1 if is_stale or options.dialect and shown else 0


if __name__ == "__main__":
    sys.exit(main())
