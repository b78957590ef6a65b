#!/usr/bin/env python3
"""What a diagnosis does to each channel of a measured record that it was not given: kept_out.py PROGRAM DATA OUT [RECORD...]

PROGRAM is driftwright, DATA the folder of the records, OUT a folder for what is made on the way (that of score.py serves as well: a diagnosis that is in it is kept);
RECORD keeps the cases whose record begins so. Prints, a case, the verdict and how long it took, and of every channel that scenario and record both have the RMS error of the scenario as it is written and
of `extended.yaml` on the part kept out; then both over the channels' noise (as the diagnosis says it), pooled. Worse than 1.05 times as written is said. Standard library only.
"""

import json
import math
import os
import re
import sys
import time

import records
import score


def simulated_rows(program, scenario, record, folder, name):
    """{header: [(time, measured, simulated)]} of all channels that record and simulation have, or why there is none."""
    with open(scenario, encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r"^cyclograms:.*\n", lambda m: m.group(0) + f"  kept_out: {{csv: {record}}}\n", text, count=1, flags=re.M)
    rows = score.raw_rows(record)
    if "ambient_degC" in rows[0]:
        text = re.sub(r"^(?:ambient|hall):.*$", f"ambient: {{csv: {record}, channel: ambient}}", text, count=1, flags=re.M)
    edited, log, out = (os.path.join(folder, name + end) for end in (".yaml", ".log", ""))
    with open(edited, "w", encoding="utf-8") as file:
        file.write(text)
    if score.run([program, "simulate", edited, "--cyclogram", "kept_out", "-o", out], log) != 0:
        return None, score.why(log)
    got = score.raw_rows(os.path.join(out, "record.csv"))
    got = got[next(i for i, r in enumerate(got) if r[0].startswith("time")):]
    t, start_s = [float(r[0]) for r in got[1:]], float(rows[1][0])
    channels = {}
    for column, header in enumerate(rows[0]):
        if column == 0 or header not in got[0] or header.startswith(("speed", "feed", "cutting", "ambient")):
            continue
        y = [float(r[got[0].index(header)]) for r in got[1:]]
        hi = 1
        for row in rows[1:]:
            at = min(max(float(row[0]) - start_s, t[0]), t[-1])
            while hi < len(t) - 1 and t[hi] < at:
                hi += 1
            share = (at - t[hi - 1]) / (t[hi] - t[hi - 1])
            if row[column]:
                channels.setdefault(header, []).append((float(row[0]), float(row[column]), y[hi - 1] + share * (y[hi] - y[hi - 1])))
    return channels, ""


def main():
    program, data, out = (os.path.abspath(p) for p in sys.argv[1:4])
    wanted, seen = sys.argv[4:], set()
    for i, case in enumerate(records.cases(data)):
        key = (case.record, case.split)
        if not case.scenario or key in seen or (wanted and not any(case.record.startswith(w) for w in wanted)):
            continue
        seen.add(key)
        folder = os.path.join(out, f"{i:02d}_{case.record.replace(' ', '_')}_{score.base(case.target)}")
        os.makedirs(folder, exist_ok=True)
        begin = time.time()
        result = score.by_diagnosis(case, program, folder)
        found = os.path.join(folder, "diagnosis", "diagnosis.json")
        if not os.path.exists(found):
            print(f"{case.record}, {case.split}: {result.get('why')}", flush=True)
            continue
        with open(found, encoding="utf-8") as file:
            d = json.load(file)
        noise = {c["name"]: c["noise_floor"] for c in d["gain"]["channels"]}
        causes = ", ".join(f"{c['effect']} at {c['where']} ({c['standing']})" for c in d["causes"][:3]) or "none"
        print(f"{case.record}, {case.split}: {d['verdict']}, {time.time() - begin:.0f} s; causes: {causes}", flush=True)
        left = {}
        for key, scenario in (("as written", os.path.join(score.ROOT, "scenarios", "measured", case.scenario + ".yaml")),
                              ("diagnosed", os.path.join(folder, "diagnosis", "extended.yaml"))):
            for source in case.judge_files:
                name = os.path.basename(source)
                record = score.converted(case, source, os.path.join(folder, "twin_judge_" + name))
                channels, reason = simulated_rows(program, scenario, record, folder, f"all_{key.replace(' ', '_')}_{name[:-4]}")
                if channels is None:
                    print(f"  {key}: {reason}")
                    continue
                for header, rows in channels.items():
                    for t, y, p in rows:
                        if not case.judge_rows or len(case.judge_files) > 1 or case.judge_rows(t):
                            left.setdefault(header, {}).setdefault(key, []).append(y - p)
        pooled = {}
        for header, by in left.items():
            rms = {key: math.sqrt(sum(e * e for e in errors) / len(errors)) for key, errors in by.items()}
            print(f"  {header}: " + ", ".join(f"{key} {v:.3g}" for key, v in rms.items()))
            floor = noise.get(score.base(header))
            for key, v in rms.items():
                if floor:
                    pooled.setdefault(key, []).append((v / floor) ** 2)
        over = {key: math.sqrt(sum(v) / len(v)) for key, v in pooled.items()}
        worse = len(over) == 2 and over["diagnosed"] > 1.05 * over["as written"]
        print("  over noise, all channels: " + ", ".join(f"{key} {v:.3g}" for key, v in over.items()) + ("; WORSE" if worse else ""), flush=True)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main()
