"""Records as loggers leave them: how machines are driven, the hall, further columns, and at which times rows are written.

A style of driving is a row of (begin, end, level), of a record that lasts from 0 to 1; what comes later holds. A set names the styles that it draws from (README.md).
"""
import numpy as np

from network import Record

PACES = (1, 2, 3, 5, 10, 15, 20, 30, 60, 90, 120, 180, 300, 600, 900, 1200)      # of loggers [s]


def level(rng, low=0.3, high=1.0):
    return round(float(rng.uniform(low, high)), 2)


# --- styles of driving -----------------------------------------------------------------------------------------------------------


def blocks(rng):
    """A few levels for a while each, with rests."""
    levels, mean, t, last = [level(rng, 0.2) for _ in range(int(rng.integers(3, 6)))], rng.uniform(0.05, 0.14), 0.0, None
    while t < 1:
        length = mean * np.exp(0.5 * rng.standard_normal())
        last = 0.0 if last and rng.random() < 0.3 else float(rng.choice(levels))
        yield t, t + length, last
        t += length


def duty(rng):
    """On and off, as a thermostat or a pseudo-random sequence does."""
    t, on, mean = 0.0, True, rng.uniform(0.01, 0.03)
    while t < 1:
        length = (mean if on else mean * rng.uniform(0.8, 2.2)) * np.exp(0.6 * rng.standard_normal())
        yield t, t + length, float(on)
        t, on = t + length, not on


def warm_up(rng):
    """Full power until it is warm, then less, on and off."""
    yield from ((a, b, 0.45 * x) for a, b, x in duty(rng))
    yield 0.0, rng.uniform(0.03, 0.08), 1.0


def cycle(rng):
    """One short list of levels, exactly the same again and again."""
    n, period = int(rng.integers(2, 6)), 1 / rng.uniform(3.2, 14)
    lengths, levels = rng.uniform(0.3, 1, n), rng.uniform(0.25, 1, n)
    levels[int(rng.integers(n))] = 0.0
    ends = np.append(0.0, np.cumsum(lengths) / lengths.sum())
    for k in range(int(np.ceil(1 / period))):
        yield from (((k + a) * period, (k + b) * period, x) for a, b, x in zip(ends, ends[1:], levels))


def stair(rng):
    """Up, or up and down again."""
    n = int(rng.integers(3, 8))
    levels = list(np.linspace(1 / n, 1, n))
    levels += levels[-2::-1] + [0.0] if rng.random() < 0.6 else [0.0]
    yield from ((k / len(levels), (k + 1) / len(levels), x) for k, x in enumerate(levels))


def fresh(rng):
    """No level twice, for very different times."""
    t = 0.0
    while t < 1:
        length = np.exp(rng.uniform(np.log(0.015), np.log(0.16)))
        yield t, t + length, 0.0 if rng.random() < 0.2 else rng.uniform(0.12, 1)
        t += length


def spectrum(rng):
    """Random levels of equal length."""
    n = int(rng.integers(9, 25))
    yield from ((k / n, (k + 1) / n, 0.0 if rng.random() < 0.2 else level(rng, 0.15)) for k in range(n))


def slope(rng):
    """Levels that are neared in many steps."""
    t, last = 0.0, 0.0
    while t < 1:
        length, goal = np.exp(rng.uniform(np.log(0.03), np.log(0.16))), 0.0 if rng.random() < 0.2 else rng.uniform(0.12, 1)
        yield from ((t + 0.05 * k * length, t + length, round(20 * (last + (goal - last) * (k + 1) / 8)) / 20) for k in range(8))
        t, last = t + length, round(20 * goal) / 20


def shifts(rng):
    """Work in small pieces, with long rests."""
    t = 0.0
    while t < 1:
        end = t + rng.uniform(0.2, 0.4)
        while t < end:
            piece = rng.uniform(0.01, 0.06)
            yield t, min(t + piece, end), float(rng.choice([0.0, 0.4, 0.7, 0.85, 1.0]))
            t += piece
        t = end + rng.uniform(0.12, 0.25)


def series(rng):
    """Parts alike, a set-up, another series."""
    t = rng.uniform(0, 0.08)
    while t < 1:
        parts, takt, use, x = int(rng.integers(4, 14)), rng.uniform(0.01, 0.04), rng.uniform(0.55, 0.85), level(rng)
        yield from ((t + k * takt, t + (k + use) * takt, x) for k in range(parts))
        t += parts * takt + rng.uniform(0.04, 0.14)


def breaks(rng):
    """A shift with its breaks at fixed times."""
    begin, n, x = rng.uniform(0, 0.1), int(rng.integers(3, 6)), level(rng, 0.5)
    block, use = (1 - begin) / n, rng.uniform(0.72, 0.9)
    slower = rng.random() < 0.5
    yield from ((begin + k * block, begin + (k + use) * block, round(0.6 * x, 2) if slower and k == n - 1 else x) for k in range(n))


def soak_steps(rng):
    """Ever higher levels with a rest after each, then a long soak."""
    n, step = int(rng.integers(3, 6)), rng.uniform(0.07, 0.11)
    yield from ((k * step, (k + 0.75) * step, round((k + 1) / n, 2)) for k in range(n))
    yield n * step, n * step + rng.uniform(0.2, 0.35), level(rng, 0.6)


def tool_list(rng):
    """A list of levels with short stops, over and over."""
    n, period, stop = int(rng.integers(4, 8)), rng.uniform(0.1, 0.4), rng.uniform(0.02, 0.06)
    levels, lengths = [level(rng, 0.15) for _ in range(n)], rng.uniform(0.3, 1, n)
    ends = np.append(0.0, np.cumsum(lengths) / lengths.sum())
    for k in range(int(np.ceil(1 / period))):
        yield from (((k + a + stop) * period, (k + b) * period, x) for a, b, x in zip(ends, ends[1:], levels))


def octaves(rng):
    """Runs each twice as long as the one before."""
    t, length, rest, x = rng.uniform(0.01, 0.06), rng.uniform(0.015, 0.03), rng.uniform(0.02, 0.06), level(rng, 0.6)
    while t < 1:
        yield t, t + length, x
        t, length = t + length + rest, 2 * length


def decline(rng):
    """Runs that become slower and rarer."""
    t, x, run = 0.0, 1.0, rng.uniform(0.08, 0.2)
    while t < 1:
        yield t, t + run, round(x, 2)
        t, x = t + run + rng.uniform(0.02, 0.12) / x, max(0.15, x * rng.uniform(0.65, 0.95))


def recipe(rng):
    """A warming run, then batches at one or two levels."""
    t, levels = rng.uniform(0.06, 0.2), [level(rng, 0.35) for _ in range(2)]
    yield 0.0, t, level(rng, 0.3, 0.6)
    while t < 1:
        t += rng.uniform(0.02, 0.07)
        length = rng.uniform(0.06, 0.14)
        yield t, t + length, levels[int(rng.integers(2))]
        t += length


def walk(rng):
    """A level that somebody moves a little now and then."""
    t, x = 0.0, rng.uniform(0.3, 0.8)
    while t < 1:
        length = rng.uniform(0.03, 0.12)
        yield t, t + length, round(x, 2)
        x, t = float(np.clip(x + 0.18 * rng.standard_normal(), 0.1, 1)), t + length
    t = rng.uniform(0.2, 0.75)
    yield t, t + rng.uniform(0.06, 0.15), 0.0


def duty_sweep(rng):
    """On and off at one level, for an ever greater, or smaller, share of each period."""
    period, x, up = rng.uniform(0.05, 0.12), level(rng, 0.6), rng.random() < 0.6
    yield from ((k * period, (k + 0.15 + 0.75 * (k * period if up else 1 - k * period)) * period, x) for k in range(int(1 / period)))


def trials(rng):
    """A few long levels, each tried twice, with rests."""
    m = int(rng.integers(2, 4))
    block, use = 1 / (2 * m), rng.uniform(0.5, 0.75)
    levels = [level(rng) for _ in range(m)]
    yield from ((k * block, (k + use) * block, levels[k // 2]) for k in range(2 * m))


def idling(rng):
    """A low level with rare peaks."""
    yield rng.uniform(0.01, 0.06), 1.1, level(rng, 0.1, 0.3)
    for _ in range(int(rng.integers(3, 8))):
        t = rng.uniform(0, 0.95)
        yield t, t + rng.uniform(0.02, 0.1), level(rng, 0.6)


def trips(rng):
    """Runs that end at once and are taken up again."""
    t = rng.uniform(0, 0.05)
    while t < 1:
        length = rng.uniform(0.1, 0.3)
        yield t, t + length, level(rng, 0.5)
        t += length + (rng.uniform(0.01, 0.03) if rng.random() < 0.6 else rng.uniform(0.08, 0.2))


def chirp(rng):
    """On and off, ever quicker."""
    t, length, x = rng.uniform(0, 0.03), rng.uniform(0.12, 0.22), level(rng, 0.6)
    while t < 1:
        yield t, t + 0.6 * length, x
        t, length = t + length, max(0.02, 0.82 * length)


def iso_steps(rng):
    """Levels in turn, a stop after every few."""
    t, k = 0.0, 0
    while t < 1:
        length = rng.uniform(0.04, 0.07)
        yield t, t + length, 0.0 if k % 4 == 3 else level(rng, 0.2)
        t, k = t + length, k + 1


def night_shift(rng):
    """Two long runs of different use with a rest between."""
    for begin, end, use in ((rng.uniform(0.02, 0.1), rng.uniform(0.38, 0.48), rng.uniform(0.7, 0.95)), (rng.uniform(0.55, 0.68), rng.uniform(0.88, 0.98), rng.uniform(0.35, 0.7))):
        t, levels = begin, [level(rng, 0.4) for _ in range(3)]
        while t < end:
            length = rng.uniform(0.03, 0.08)
            yield t, min(end, t + use * length), levels[int(rng.integers(3))]
            t += length


def telegraph(rng):
    """On and off, or between two levels, at random times."""
    low, high, t, on = (0.0 if rng.random() < 0.6 else level(rng, 0.15, 0.35)), level(rng, 0.65), 0.0, rng.random() < 0.5
    while t < 1:
        length = rng.exponential(0.06) + 0.015
        yield t, t + length, high if on else low
        t, on = t + length, not on
    yield (*np.sort(rng.uniform(0.3, 0.6, 2)), 0.0)


def long_run(rng):
    """One level for most of the record, once or twice interrupted."""
    yield rng.uniform(0.01, 0.1), rng.uniform(0.6, 0.85), level(rng, 0.6)
    for _ in range(int(rng.integers(1, 3))):
        t = rng.uniform(0.15, 0.6)
        yield t, t + rng.uniform(0.02, 0.08), 0.0
    if rng.random() < 0.5:
        yield 0.9, 1.1, level(rng, 0.2, 0.6)


def warm_up_and_cut(rng):
    """A warming run at a low level, then cuts at one level with pauses of one length."""
    yield rng.uniform(0, 0.03), 0.2, level(rng, 0.2, 0.4)
    x, run, pause, t = level(rng, 0.6), rng.uniform(0.04, 0.1), rng.uniform(0.015, 0.06), 0.2 + rng.uniform(0.01, 0.06)
    while t < 0.97:
        yield t, t + run, x if rng.random() < 0.8 else round(0.6 * x, 2)
        t += run + pause


def takt(rng):
    """One level with short stops at one rhythm, and two breaks."""
    t, length, use, x = rng.uniform(0.01, 0.08), rng.uniform(0.03, 0.07), rng.uniform(0.6, 0.9), level(rng, 0.6)
    while t < 0.97:
        yield t, t + use * length, x if rng.random() < 0.85 else round(x / 2, 2)
        t += length
    for _ in range(2):
        t = rng.uniform(0.2, 0.9)
        yield t, t + rng.uniform(0.04, 0.1), 0.0


def product_change(rng):
    """Blocks of one level each, set-ups between them."""
    t = rng.uniform(0, 0.05)
    while t < 1:
        length = rng.uniform(0.1, 0.25)
        yield t, t + length, level(rng)
        t += length + rng.uniform(0.02, 0.09)


def sporadic(rng):
    """Single runs of very different length."""
    t = rng.uniform(0.01, 0.1)
    while t < 0.98:
        length = min(0.3, 0.02 + rng.exponential(0.07))
        yield t, t + length, level(rng, 0.35)
        t += length + 0.02 + rng.exponential(0.06)


def sawtooth(rng):
    """Levels that climb within each run and begin anew."""
    t = rng.uniform(0, 0.05)
    while t < 1:
        length, steps, low = rng.uniform(0.15, 0.3), int(rng.integers(3, 6)), rng.uniform(0.15, 0.4)
        yield from ((t + i * length / steps, t + (i + 1) * length / steps, round(low + (1 - low) * i / (steps - 1), 2)) for i in range(steps))
        t += length + rng.uniform(0.03, 0.1)


def parts(rng):
    """One programme of two to five cuts again and again, with a pause while the next part is put in."""
    k, cut, pause, t = int(rng.integers(2, 6)), rng.uniform(0.04, 0.12), rng.uniform(0.008, 0.03), rng.uniform(0.0, 0.06)
    levels, lengths = [level(rng) for _ in range(k)], rng.uniform(0.4, 1, k)
    while t < 0.97:
        for x, length in zip(levels, lengths / lengths.sum() * cut):
            yield t, t + length, x
            t += length
        t += pause if rng.random() < 0.85 else rng.uniform(0.05, 0.12)


def day(rng):
    """A warming run, and work until a break, a second one and the end."""
    a, b, c = rng.uniform(0.01, 0.05), rng.uniform(0.3, 0.4), rng.uniform(0.6, 0.7)
    yield a, a + 0.06, level(rng, 0.2, 0.5)
    for t, end in ((a + 0.06, b), (b + rng.uniform(0.03, 0.06), c), (c + rng.uniform(0.05, 0.1), rng.uniform(0.88, 0.98))):
        usual = level(rng, 0.4)
        while t < end:
            length = rng.uniform(0.02, 0.07)
            yield t, min(end, t + length), usual if rng.random() < 0.6 else level(rng, 0.25)
            t += length + rng.uniform(0.004, 0.02)


def spindle_test(rng):
    """Levels up and down with a rest after each, or one until all is warm, and then a rest."""
    if rng.random() < 0.7:
        begin, length = rng.uniform(0.01, 0.05), rng.uniform(0.1, 0.14)
        yield from ((begin + i * length, begin + (i + 0.9) * length, x) for i, x in enumerate([0.25, 0.5, 0.75, 1.0, 0.6, 0.3]))
    else:
        yield rng.uniform(0.01, 0.06), rng.uniform(0.55, 0.7), level(rng, 0.5)
        yield 0.85, 0.95, level(rng)


def lots(rng):
    """A set-up, a trial part at half the level, then three to eight equal parts; and so on."""
    t = rng.uniform(0.0, 0.05)
    while t < 0.97:
        x, length, pause = level(rng, 0.35), rng.uniform(0.02, 0.06), rng.uniform(0.006, 0.015)
        yield t, t + length, round(x / 2, 2)
        t += length + rng.uniform(0.01, 0.03)
        for _ in range(int(rng.integers(3, 9))):
            yield t, t + length, x
            t += length + pause
        t += rng.uniform(0.03, 0.09)


STYLES = {f.__name__: f for f in (blocks, duty, warm_up, cycle, stair, fresh, spectrum, slope, shifts, series, breaks, soak_steps, tool_list, octaves, decline, recipe, walk, duty_sweep, trials, idling, trips, chirp, iso_steps, night_shift, telegraph, long_run,
                                  warm_up_and_cut, takt, product_change, sporadic, sawtooth, parts, day, spindle_test, lots)}


def driven(rng, time_s, style, top=1.0, days=False):
    """A column from 0 to `top`, held from each row on; `days`: at night there is little or nothing. Levels are 4 % of the top apart: Driftwright takes a change by less than 1 % for jitter of the tachometer."""
    share, out = time_s / time_s[-1], np.zeros(len(time_s))
    for a, b, x in STYLES[style](rng):
        out[(share >= a - 1e-9) & (share < b)] = x
    if days:
        hour = (time_s / 3600 + rng.uniform(0, 24)) % 24
        out = np.where((hour > 6) & (hour < rng.uniform(17, 23)), out, 0.3 * out if rng.random() < 0.5 else 0.0)
    return float(top) * np.round(25 * out) / 25


def windy(rng, time_s, plan):
    """Speed and power follow one wind; below its smallest value the rotor is at rest."""
    wind = np.clip(0.55 + np.cumsum(rng.standard_normal(len(time_s)) * 0.35 * np.sqrt(np.diff(time_s, append=time_s[-1]) / 86400)), 0, None)
    wind = np.abs((wind + 1) % 2 - 1)
    speed = np.where(wind > 0.22, np.round(plan["top"] * np.clip(0.55 + 0.6 * wind, 0, 1) / 40) * 40, 0.0)
    return speed, np.where(speed > 0, np.round(plan["power"] * np.clip(1.15 * wind, 0, 1) ** 2 / 5000) * 5000, 0.0)


# --- hall and further columns ------------------------------------------------------------------------------------------------------


def follows(time_s, x, tau):
    y = np.zeros(len(time_s))
    for k in range(1, len(y)):
        y[k] = x[k - 1] + (y[k - 1] - x[k - 1]) * np.exp(-(time_s[k] - time_s[k - 1]) / tau)
    return y


def hall(rng, time_s, outdoor):
    """Outdoors a day and a front that passes; indoors a day's wave, doors, warming or cooling in the morning, an air conditioner's teeth, ventilation or people, draughts, or next to nothing. A slow walk beside it."""
    hours, share = time_s / 3600, time_s / time_s[-1]
    if outdoor:
        x = 2 * np.pi * (hours + rng.uniform(0, 24)) / 24
        y = rng.uniform(2, 22) + rng.uniform(2, 6) * (np.sin(x) + rng.uniform(0, 0.3) * np.sin(2 * x)) + rng.uniform(-5, 5) / (1 + np.exp(-(hours - rng.uniform(0.2, 0.8) * hours[-1]) / 3))
    else:
        y, kind = np.full(len(hours), rng.uniform(16, 28)), str(rng.choice(["day", "doors", "morning", "teeth", "ventilation", "draughts", "still"]))
        if kind == "day":
            y = y + rng.uniform(0.4, 2.4) * np.sin(2 * np.pi * (hours + rng.uniform(0, 24)) / 24)
        elif kind == "morning":
            y = y + rng.uniform(0.8, 4) * (1 if rng.random() < 0.7 else -1) / (1 + np.exp(-(share - rng.uniform(0.0, 0.6)) / rng.uniform(0.04, 0.15)))
        elif kind == "teeth":
            y = y + rng.uniform(0.2, 1.0) * (hours / rng.uniform(0.15, 0.6) % 1 - 0.5)
        elif kind == "ventilation":
            y = y + rng.uniform(0.5, 3) * (1 if rng.random() < 0.5 else -1) * follows(share, driven(rng, time_s, "telegraph") > 0, rng.uniform(0.02, 0.12))
        elif kind == "doors":
            for _ in range(int(rng.integers(1, 5))):
                t = rng.uniform(0, 0.95)
                y = y - rng.uniform(0.4, 2.5) * (share > t) * np.exp(-np.maximum(0, share - t) / rng.uniform(0.01, 0.1))
        elif kind == "draughts":
            for _ in range(int(rng.integers(2, 7))):
                y = y - rng.uniform(0.5, 2.5) * np.exp(-((share - rng.uniform(0, 1)) / rng.uniform(0.015, 0.05)) ** 2)
    slow, x, tau = np.empty(len(hours)), 0.0, rng.uniform(0.08, 0.4)
    for k in range(len(hours)):
        e = np.exp(-(share[k] - share[k - 1]) / tau) if k else 0.0
        x = e * x + np.sqrt(1 - e * e) * (0.6 if outdoor else 0.2) * rng.standard_normal()
        slow[k] = x
    return np.round(y + np.convolve(np.pad(slow, 4, mode="edge"), np.ones(9) / 9, mode="valid"), 2)


def further(rng, time_s, unit):
    """A recorded column beside: degC, W_m2, percent, 1 (a switch), V, W, count."""
    end = time_s[-1]
    if unit == "degC":
        return np.round(rng.uniform(9, 45) + rng.uniform(3, 10) * driven(rng, time_s, "sawtooth") + rng.uniform(0.2, 2) * np.sin(2 * np.pi * time_s / (rng.uniform(0.1, 0.9) * end)), 1)
    if unit == "W_m2":
        sky = np.maximum(0, np.sin(2 * np.pi * (time_s / 86400 - rng.random()))) if end > 86400 else np.sin(np.pi * np.clip((time_s / end - rng.uniform(-0.3, 0.3)) / rng.uniform(0.5, 1.1), 0, 1))
        return np.round(780 * sky * np.where(driven(rng, time_s, "fresh") > 0.45, 1.0, rng.uniform(0.2, 0.5)))
    style = str(rng.choice(["cycle", "spectrum", "sporadic", "product_change", "series"]))
    if unit == "1":
        return (driven(rng, time_s, style) > 0).astype(float)
    return np.round(driven(rng, time_s, style, {"percent": 100, "V": 24, "W": 300, "count": 40}[unit]), 1 if unit == "V" else 0)


# --- rows ------------------------------------------------------------------------------------------------------------------------------


def pace(rng, plan, rows, channels, n_records):
    """Of the logger [s]; and how many rows a record has, about, fewer where there are many channels and records."""
    n = float(np.exp(rng.uniform(*np.log(rows))))
    n = max(float(rows[0]), min(n, 24000 / (channels * n_records), 1600 / n_records))
    span = 3600 * np.exp(rng.uniform(*np.log(plan["hours"])))
    return min(PACES, key=lambda d: abs(np.log(d * n / span))), n


def rows(rng, style, dt, n):
    """Times [s]. even; gaps: the logger was off once to three times; lost: single rows are missing; two_paces: at half the pace from somewhere on; slower: this record has two, three or five times the pace; watched: each row for one or two whiles, and else
    each fourth; sleepy: it writes ever more rarely until something wakes it; triggered: at its pace for a while after a trigger, and else every third to sixth time; bursts: it sleeps after every so many rows; on_change: see thinned()."""
    n = int(np.clip(round(n * np.exp(rng.uniform(np.log(0.7), np.log(1.4)))), 60, 1500))
    k, steps = np.arange(n), None
    keep = np.ones(n, bool)
    if style == "gaps":
        for _ in range(int(rng.integers(1, 4))):
            a = rng.uniform(0.1, 0.9)
            keep &= ~((k > a * n) & (k < (a + rng.uniform(0.02, 0.07)) * n))
    elif style == "lost":
        keep = rng.random(n) > rng.uniform(0.04, 0.25)
    elif style == "two_paces":
        keep = (k < rng.uniform(0.25, 0.75) * n) | (k % 2 == 0)
    elif style == "slower":
        slow = int(rng.choice([1, 1, 2, 3, 5]))
        return np.arange(max(60, n // slow)) * float(dt * slow)
    elif style == "watched":
        keep = k % 4 == 0
        for _ in range(int(rng.integers(1, 3))):
            begin = rng.uniform(0, 0.75)
            keep |= (k >= begin * n) & (k < (begin + rng.uniform(0.15, 0.4)) * n)
    elif style in ("sleepy", "triggered", "bursts"):
        slow, run, steps = int(rng.integers(3, 7)), int(rng.integers(4, 13)), []
        while len(steps) < n - 1:
            steps += {"sleepy": sum([[k] * int(rng.integers(3, 12)) for k in (1, 2, 4, 8)[:int(rng.integers(1, 5))]], []), "triggered": [1] * int(rng.integers(10, 40)) + [slow] * int(rng.integers(5, 30)), "bursts": [1] * run + [slow]}[style]
        return np.append(0.0, np.cumsum(steps[:n - 1]) * float(dt))
    keep[:2] = keep[-1] = True
    return (k * float(dt))[keep]


def thinned(record, every):
    """What a logger keeps that writes a row when the drive changes, and else one of `every`; at least 60 rows."""
    n = len(record.time_s)
    keep = (np.arange(n) % every == 0) | (np.arange(n) < 2) | (np.arange(n) == n - 1)
    for x in [record.speed, record.power, *record.feeds.values()]:
        keep |= np.append(False, np.diff(x) != 0)
    if keep.sum() < 60:
        return record
    k = np.flatnonzero(keep)
    return Record(record.name, record.time_s[k], record.speed[k], {a: f[k] for a, f in record.feeds.items()}, record.power[k], record.hall[k], {c: (u, x[k]) for c, (u, x) in record.columns.items()})


def record(rng, name, plan, time_s, styles, column=None):
    """`plan`: `records` of the machine's family: drive, hours, top, power, feeds, columns, outdoor, days or week. styles: of speed, of power, of feeds."""
    n, days, drive = len(time_s), plan.get("days") or plan.get("week"), plan["drive"]
    speed, power, feeds = np.zeros(n), np.zeros(n), {}
    if drive == "wind":
        speed, power = windy(rng, time_s, plan)
    else:
        if "top" in plan:
            speed = np.round(driven(rng, time_s, styles[0], plan["top"], days), 0 if plan["top"] > 300 else 2)
        if "power" in plan:
            load = driven(rng, time_s, dict(bed="warm_up", duty="duty").get(drive, styles[1]), 1.0, days)
            if drive in ("speed+power", "bursts"):
                load = np.where(speed > 0, 0.1 + 0.9 * load, 0.0)
            power = np.array([float(f"{p:.4g}") for p in plan["power"] * load])
    for axis, top in plan.get("feeds", {}).items():
        f = driven(rng, time_s, styles[2], top)
        if "top" in plan:      # it moves while the spindle turns, but for some positioning
            f = np.where(speed > 0, f, np.where(rng.random(n) < 0.1, 0.3 * f, 0.0))
        feeds[axis] = np.round(f, 0) / 60000
    columns = {column[0]: (column[1], further(rng, time_s, column[1]))} if column else {}
    for c, how in plan.get("columns", {}).items():      # of the machine's own
        low, top = how.get("low", 0.0), how["top"]
        columns[c] = (how["unit"], np.round(low + driven(rng, time_s, how.get("style", styles[1]), top - low, days), 1 if top < 1000 else 0))
    return Record(name, time_s, speed, feeds, power, hall(rng, time_s, plan.get("outdoor", False)), columns)
