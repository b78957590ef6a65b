#!/usr/bin/python3
"""`place` and `plan-test` in shards: after the merge every file has the bytes of one run; a killed shard continues where it was; damaged pieces are computed again. Missing
pieces, wrong shards and two processes at one shard are refused.

    shards_verb_test.py PROGRAM FOLDER_OF_THE_PROJECT
"""
import fcntl
import pathlib
import shutil
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "shared"))
from claims import caller, expect, failures


def files_of(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def main():
    program, top = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory(prefix="driftwright_shards-") as name:
        folder = pathlib.Path(name)
        shutil.copy(top / "scenarios/first_machine.yaml", folder / "plain.yaml")
        call = caller(program, folder)
        for verb, scenario, options in (("place", "plain.yaml", ["--count", "1"]), ("plan-test", "plain.yaml", ["--programmes", "600", "--time", "4 h"])):
            command = [verb, scenario, *options]
            done = call(*command, "-o", "whole")
            expect(done.returncode == 0, f"{verb}: {done.stderr.strip()[-300:]}")
            expect(not (folder / "whole.parts").exists(), f"{verb}: a run that ended keeps no pieces")
            done = call(*command, "--shard", "1/3", "-o", "shared")
            expect(done.returncode == 0 and not (folder / "shared").exists(), f"{verb} --shard 1/3: {done.stdout.strip()} {done.stderr.strip()[-300:]}")
            done = call(*command, "--merge", "-o", "shared")
            expect(done.returncode == 2 and "let every shard end" in done.stderr, f"{verb}: what is missing is refused: {done.stderr.strip()[-200:]}")
            for shard in ("2/3", "3/3"):
                done = call(*command, "--shard", shard, "-o", "shared")
                expect(done.returncode == 0, f"{verb} --shard {shard}: {done.stdout.strip()} {done.stderr.strip()[-300:]}")
            # One file as a killed process may leave it: the last rows missing, a torn line, and a changed row.
            whole = folder / "shared.parts/pieces.3of3.csv"
            lines = whole.read_text().splitlines(keepends=True)
            torn = lines[:2] + [lines[2].replace(",", ",1", 1)] + lines[3:-4] + [lines[-4][:-5]]
            whole.unlink()
            (folder / "shared.parts/pieces.3of3.csv.partial").write_text("".join(torn))
            others = {p.name: p.read_bytes() for p in (folder / "shared.parts").glob("pieces.[12]of3.csv")}
            done = call(*command, "--shard", "3/3", "-o", "shared")
            expect(done.returncode == 0 and "1 piece in" in done.stderr and "damaged" in done.stderr, f"{verb}: resumed: {done.stderr.strip()[-300:]}")
            expect(others == {p.name: p.read_bytes() for p in (folder / "shared.parts").glob("pieces.[12]of3.csv")}, f"{verb}: other shards' files are as they were")
            started = time.monotonic()
            done = call(*command, "--merge", "-o", "shared")
            expect(done.returncode == 0, f"{verb} --merge: {time.monotonic() - started:.1f} s {done.stderr.strip()[-300:]}")
            expect(not (folder / "shared.parts").exists(), f"{verb}: merged, no pieces stay")
            one, merged = files_of(folder / "whole"), files_of(folder / "shared")
            if "report.html" in one:  # it names its own folder
                one["report.html"] = one["report.html"].replace(b"whole/", b"shared/")
            differ = [f for f in one.keys() | merged.keys() if one.get(f) != merged.get(f)]
            expect(len(one) > 5 and not differ, f"{verb}: {len(one)} files, of which differ: {differ}")
            # Pieces of other options, or of a scenario that has changed since, are not used.
            kept = folder / "shared.parts/pieces.1of2.csv"
            call(*command, "--shard", "1/2", "-o", "shared", "--force")
            text, opening = (folder / scenario).read_text(), kept.open().readline()
            (folder / scenario).write_text(text + "# changed\n")
            done = call(*command, "--shard", "1/2", "-o", "shared", "--force")
            (folder / scenario).write_text(text)
            expect(done.returncode == 0 and kept.open().readline() != opening, f"{verb}: pieces of another scenario are worked out anew")
            n_rows = len(kept.read_text().splitlines())
            kept.rename(str(kept) + ".partial")
            done = call(*command, "--shard", "1/2", "-o", "shared", "--force")
            expect("note: pieces of an earlier version" in done.stderr and len(kept.read_text().splitlines()) == n_rows,
                   f"{verb}: stale pieces are dropped with a note: {done.stderr.strip()[-200:]}")
            for words, message in (
                (["--shard", "4/3"], "--shard '4/3' must be i/n with 1 <= i <= n"),
                (["--shard", "1/2", "--merge"], "leave out --shard"),
            ):
                done = call(*command, *words, "-o", "refused")
                expect(done.returncode == 2 and message in done.stderr and not (folder / "refused.parts").exists(), f"{verb} {words}: {done.stderr.strip()[-200:]}")
            shutil.rmtree(folder / "shared.parts")
            (folder / "shared.parts").mkdir()
            with (folder / "shared.parts/pieces.1of2.csv.partial").open("w") as held:
                fcntl.flock(held, fcntl.LOCK_EX)
                done = call(*command, "--shard", "1/2", "-o", "shared", "--force")
                expect(done.returncode == 2 and "another process is working" in done.stderr, f"{verb}: two at one shard: {done.stderr.strip()[-200:]}")
            for left in ("whole", "shared", "shared.parts"):
                shutil.rmtree(folder / left)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
