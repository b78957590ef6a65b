#!/usr/bin/env python3
"""Measures how a diagnosis changes the error of each channel on parts of measured records that it was not given: kept_out.py PROGRAM DATA OUT [RECORD...]

PROGRAM is driftwright, DATA the folder of the records, OUT a folder for intermediate files (it may be that of score.py: a diagnosis in it is used again);
RECORD limits the run to cases whose record has a name that begins so. For each case the script prints the verdict and its time, and for each channel in both scenario and record the RMS error of the scenario as written and
of `extended.yaml` on the part kept out; then both divided by the channels' noise (as the diagnosis estimates it), pooled. It reports channels that are worse than 1.05 times as written. It needs only the standard library.
"""

import json
import math
import os
import sys
import time

import records
import score


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
                channels, reason = score.simulated_channels(program, scenario, record, folder, f"all_{key.replace(' ', '_')}_{name[:-4]}")
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
