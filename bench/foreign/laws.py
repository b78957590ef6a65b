"""What formulas of faults.yaml may use: numpy's functions, and laws that need more than a line.

Most take a record `r` and give values at its rows, held from row on. `on` is such a column of 0 and 1.
"""
import functools

import numpy as np

STEFAN_BOLTZMANN = 5.67e-8
WATER = 3800.0     # of a circuit's stream [J/(L K)]
FUNCTIONS = {name: getattr(np, name) for name in ("exp log log10 sqrt sin cos pi inf abs sign minimum maximum clip where mean median sum cumsum max min ptp any all unique round diff append concatenate ones zeros full linspace sort arange array quantile isfinite "
                                                  "ceil floor interp argmax argmin searchsorted flatnonzero full_like gradient").split()}
BUILTINS = {f.__name__: f for f in (len, float, int, str, range, sorted, zip, dict, list, set, tuple, enumerate, frozenset, next, reversed, bool)}


@functools.lru_cache(maxsize=None)
def compiled(formula):
    return compile(str(formula).strip(), str(formula), "eval")


def mentions(formula, name):
    return isinstance(formula, str) and name in compiled(formula).co_names


def value(formula, names):
    if not isinstance(formula, str):
        return formula
    return eval(compiled(formula), {"__builtins__": {}, **BUILTINS, **FUNCTIONS, **LAWS, **names})


# --- columns -----------------------------------------------------------------------------------------------------------------


def stretches(r, on):
    """[begin, end] of all times at which `on` holds; beyond the end where the record ends so."""
    t = r.time_s
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(on, int), [0]])))
    return [(float(t[a]), float(t[b]) if b < len(t) else 1.02 * float(t[-1])) for a, b in zip(edges[::2], edges[1::2])]


def rests(r, on):
    """Stretches at which it is not on, but for those that begin or end the record."""
    return [(a, b) for a, b in stretches(r, np.asarray(on) == 0) if a > 0 and b <= r.time_s[-1]]


def begins(on):
    """Where something goes on that was off one row before."""
    on = np.asarray(on, bool)
    return np.append(False, on[1:] & ~on[:-1])


def pace(r):
    return np.append(np.diff(r.time_s), r.time_s[-1] - r.time_s[-2])


def lagged(r, x, tau, y0=0.0):
    """tau dy/dt = x - y."""
    y = np.full(len(x), float(y0))
    for k in range(1, len(x)):
        e = np.exp(-(r.time_s[k] - r.time_s[k - 1]) / tau)
        y[k] = y[k - 1] * e + x[k - 1] * (1 - e)
    return y


def delayed(r, x, delay_s):
    """The values that held so long before each row; the first one before the record."""
    x = np.asarray(x, float)
    return x[np.clip(np.searchsorted(r.time_s, r.time_s - delay_s + 1e-7, side="right") - 1, 0, len(x) - 1)]


def and_after(r, on, after_s):
    """While it is on, and so long after."""
    on = np.asarray(on) > 0
    last = np.maximum.accumulate(np.where(on, np.append(r.time_s[1:], r.time_s[-1]), -1e9))
    return (on | (r.time_s - last < after_s)).astype(float)


def since_begin(r, on):
    """[s] since it last went on; very long before that."""
    return r.time_s - np.maximum.accumulate(np.where(begins(on), r.time_s, -1e9))


def on_time(r, on):
    """[s] for which it has been on."""
    return np.append(0.0, np.cumsum(np.diff(r.time_s) * (np.asarray(on)[:-1] > 0)))


def off_time(r, on):
    """[s] since it was last on, from the record's beginning."""
    rested, out, on = 0.0, np.zeros(len(r.time_s)), np.asarray(on) > 0
    for k in range(1, len(out)):
        rested = 0.0 if on[k] else rested + r.time_s[k] - r.time_s[k - 1]
        out[k] = rested
    return out


def at_some_times(r, rng):
    out, t = np.zeros(len(r.time_s)), rng.uniform(0.03, 0.3)
    while t < 0.95:
        length = rng.uniform(0.06, 0.25)
        out[(r.time_s >= t * r.time_s[-1]) & (r.time_s < (t + length) * r.time_s[-1])] = 1.0
        t += length + rng.uniform(0.08, 0.4)
    return out


def in_some_programmes(r, on, rng, often):
    out = np.zeros(len(r.time_s))
    for a, b in stretches(r, on):
        out[(r.time_s >= a) & (r.time_s < b)] = rng.random() < often
    return out


def positions(r, rng, levels):
    """One of the levels, for a while each."""
    out, share, t = np.zeros(len(r.time_s)), r.time_s / r.time_s[-1], float(rng.uniform(0, 0.2))
    while t < 1:
        out[share >= t] = levels[int(rng.integers(len(levels)))]
        t += float(rng.uniform(0.06, 0.25))
    return out


def sun(r, rng, first, width):
    """A beam from `first` on, with clouds."""
    out, t = np.clip(np.sin(np.pi * (r.time_s - first) / width), 0, None) * ((r.time_s >= first) & (r.time_s <= first + width)), 0.0
    while t < r.time_s[-1]:
        length = width * float(rng.uniform(0.05, 0.3))
        out[(r.time_s >= t) & (r.time_s < t + length)] *= 1.0 if rng.random() < 0.65 else float(rng.uniform(0.1, 0.5))
        t += length
    return out


def stiff_start(r, fades, settles):
    """Grease that has settled: more after each start, the more the longer the machine had been at rest."""
    out, x = np.zeros(len(r.time_s)), 1.0
    for k, h in enumerate(np.append(np.diff(r.time_s), 0.0)):
        if r.speed[k] > 0:
            out[k], x = x, x * np.exp(-h / fades)
        else:
            x = 1 - (1 - x) * np.exp(-h / settles)
    return out


def heap(r, y, on, swept_after, scale):
    """Chips: they grow as the machine works, and are removed when it rests for long."""
    out, x, stood, on = np.zeros(len(r.time_s)), 0.0, 0.0, np.asarray(on) > 0
    for k, h in enumerate(np.append(np.diff(r.time_s), 0.0)):
        stood = 0.0 if on[k] else stood
        x = 0.0 if stood >= swept_after else x
        out[k] = x
        x, stood = x + y[k] * h / scale, stood + (0.0 if on[k] else h)
    return out


def relaxing(r, on):
    """From 0 to 1 by the logarithm of the time since it last went on or off: half of it within 20 min."""
    on, out, level, since = np.asarray(on) > 0, np.zeros(len(r.time_s)), 0.0, 0.0
    for k in range(1, len(out)):
        level, since = (out[k - 1], 0.0) if on[k] != on[k - 1] else (level, since)
        since += r.time_s[k] - r.time_s[k - 1]
        out[k] = level + (on[k] - level) * min(1.0, np.log1p(since / 120) / np.log1p(120.0))
    return out


def burnt(r, top, fades):
    """What a spindle gives back as it brakes, as the mean of each row."""
    fallen, out, x = np.append(0.0, np.maximum(0, -np.diff((r.speed / top) ** 2))), np.zeros(len(r.time_s)), 0.0
    for k, h in enumerate(pace(r)):
        x += fallen[k]
        out[k] = x * (1 - np.exp(-h / fades)) * fades / h
        x *= np.exp(-h / fades)
    return out


def door_air(r, times, fast, slow):
    """What comes in through a door: quickly while it is open, and slowly gone."""
    y, on = np.zeros(len(r.time_s)), np.any([(r.time_s >= a) & (r.time_s < b) for a, b in times], axis=0)
    for k in range(1, len(y)):
        h = r.time_s[k] - r.time_s[k - 1]
        y[k] = on[k - 1] + (y[k - 1] - on[k - 1]) * np.exp(-h / (fast if on[k - 1] else slow))
    return y


# --- what truly drives, of a whole record --------------------------------------------------------------------------------------


def coasting(r, top, minutes):
    """The speed, in the mean of each row, of what needs so many minutes from `top` to rest where it is not driven."""
    rate, out, v = top / (60 * max(minutes, 1e-6)), r.speed.astype(float).copy(), 0.0
    for k, (target, h) in enumerate(zip(r.speed, pace(r))):
        if v > target:
            falls = min(h, (v - target) / rate)
            out[k] = (falls * (v - 0.5 * rate * falls) + (h - falls) * target) / h
            v = v - rate * falls
        else:
            v = target
    return out


def rate_of(r, x):
    """dx/dt, smoothed."""
    width = max(3, len(r.time_s) // 60)
    return np.gradient(np.convolve(np.pad(x, width, mode="edge"), np.ones(2 * width + 1) / (2 * width + 1), mode="valid"), r.time_s)


def inside(r, windows):
    on = np.zeros(len(r.time_s), bool)
    for a, b in windows:
        on |= (r.time_s >= a - 1e-6) & (r.time_s < b - 1e-6)
    return on


# --- readings: y is variant x row, s is variant x 1 ----------------------------------------------------------------------------


def shifted(y, t, minutes):
    """Logged late by so many minutes (variant x 1, or variant x row)."""
    at = np.broadcast_to(np.clip(t - 60 * minutes, t[0], t[-1]), y.shape)
    return np.stack([np.interp(a, t, row) for a, row in zip(at, y)])


def growth(t, speed, at, exponent, lag_s):
    """Spindle growth: follows a power of the speed with a lag, from nothing."""
    drive, y = np.where(speed > 0, np.where(speed > 0, speed, 1) / at, 0) ** exponent * (speed > 0), np.zeros(speed.shape)
    for k in range(1, len(t)):
        e = np.exp(-(t[k] - t[k - 1]) / lag_s)
        y[:, k] = y[:, k - 1] * e + drive[:, k - 1] * (1 - e)
    return y


def stretching(t, x, slow):
    """A shaft that turns is cooled better: its growth is quicker."""
    y = np.zeros(x.shape)
    for k in range(1, len(t)):
        e = np.exp(-(t[k] - t[k - 1]) * (1 + 2 * x[:, k - 1]) / slow)
        y[:, k] = y[:, k - 1] * e + x[:, k - 1] ** 1.5 * (1 - e)
    return y


def play(y, width):
    """It follows only after a change of more than this."""
    out = y.copy()
    for k in range(1, y.shape[1]):
        out[:, k] = np.clip(out[:, k - 1], y[:, k] - width[:, 0], y[:, k] + width[:, 0])
    return out


def mean_before(y, t, minutes):
    """The mean of so many minutes before each row."""
    total = np.concatenate([np.zeros_like(y[:, :1]), np.cumsum(0.5 * (y[:, 1:] + y[:, :-1]) * np.diff(t), axis=1)], axis=1)
    slope, out = np.diff(y, axis=1) / np.diff(t), y.copy()
    for v, m in enumerate(minutes[:, 0]):
        begin = np.maximum(t[1:] - 60 * m, t[0])
        k = np.clip(np.searchsorted(t, begin, side="right") - 1, 0, len(t) - 2)
        x = begin - t[k]
        out[v, 1:] = (total[v, 1:] - total[v, k] - y[v, k] * x - 0.5 * slope[v, k] * x ** 2) / (t[1:] - begin)
    return out


def held(y, t, begin, minutes):
    """The channel repeats its last value for so long; between two rows' ends it fades out, so that a reading is no step of the size."""
    k, pace_s = int(np.searchsorted(t, begin)), np.append(np.diff(t), t[-1] - t[-2])
    on = (t >= begin - 1e-7) * np.clip((begin + 60 * minutes - t) / pace_s, 0, 1)
    return y + on * (y[:, k:k + 1] - y)


def sticks(y, width):
    """It stays until more than this is pent up, and then jumps there."""
    out = y.copy()
    for k in range(1, y.shape[1]):
        out[:, k] = np.where(np.abs(y[:, k] - out[:, k - 1]) > width[:, 0], y[:, k], out[:, k - 1])
    return out


def rezeroed(y, t, times, share):
    out = y.copy()
    for k in np.searchsorted(t, np.asarray(times) - 1e-6):
        out[:, k:] -= share * out[:, k:k + 1]
    return out


def sampled(y, t, every):
    """Held from the first row after each multiple of `every` on."""
    k = np.maximum.accumulate(np.where(np.append(True, np.diff(np.floor(t / every)) > 0), np.arange(len(t)), 0))
    return y[:, k]


def renewed(t, warm, air, fresh, slow):
    """What follows `warm` with a lag, and begins anew at the air's temperature at the rows `fresh`."""
    y, fresh = np.empty(warm.shape), np.broadcast_to(np.asarray(fresh) > 0, warm.shape)[0]
    y[:, 0] = air[:, 0]
    for k in range(1, y.shape[1]):
        middle = 0.5 * (warm[:, k] + warm[:, k - 1])
        y[:, k] = air[:, k] if fresh[k] else middle + (y[:, k - 1] - middle) * np.exp(-(t[k] - t[k - 1]) / slow)
    return y


# --- heat that hangs on temperatures --------------------------------------------------------------------------------------------


def thermostat(state, T, k, low, high):
    """1 from where it is warmer than `high` until it is colder than `low`; it is looked at once in each step."""
    if state.get("k") != k:
        state["on"] = np.where(T > high, 1.0, np.where(T < low, 0.0, state.get("on", np.zeros_like(T))))
        state["k"] = k
    return state["on"]


def melting(state, T, k, h, at, g, most):
    """Heat that a filling takes over `g` as it melts at `at`, `most` joules at the most; it gives them back as it freezes. h: lengths of steps."""
    if state.get("k") != k:
        state["has"] = np.clip(state.get("has", np.zeros_like(T)) + state.get("q", 0.0) * h[k - 1], 0, most)
        state["k"], state["q"] = k, g * (T - at) * np.where(T > at, state["has"] < most, state["has"] > 0)
    return -state["q"]


def viscosity(T, at):
    """Of a mineral oil of VG 32, as a share of that at `at`: Vogel's law."""
    return np.exp(711 / (np.maximum(T, -40) + 95) - 711 / (at + 95))


def passes(n, node):
    """What a circuit takes up [W/K]; n: label -> number."""
    stream = n("flow " + node) / 60 * WATER
    return stream * (1 - np.exp(-n("passage " + node) / stream))


LAWS = {f.__name__: f for f in (passes, stretches, rests, begins, pace, lagged, delayed, and_after, since_begin, on_time, off_time, at_some_times, in_some_programmes, positions, sun, stiff_start, heap, relaxing, burnt, door_air, coasting, rate_of, inside,
                                shifted, growth, stretching, play, mean_before, held, sticks, rezeroed, sampled, renewed, viscosity)} | {"STEFAN_BOLTZMANN": STEFAN_BOLTZMANN}
