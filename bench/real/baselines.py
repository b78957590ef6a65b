"""Simple predictors with which the strategies of the program are compared. They share no code with it and need only the standard library.

Each takes a Case (records.py) and returns, for each judged run, one prediction per row, in the target's unit; or None if the record lacks a
column that it needs. Settings of a fit are chosen by leaving out training runs, or eighths of the training rows of a single record.
"""

import bisect
import math

PENALTIES = [1e-5, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0]
DRIVE_LAGS_MIN = [2, 5, 10, 20, 40, 80, 160]
AMBIENT_LAGS_MIN = [30, 60, 120, 240, 480]
STATE_LAGS_MIN = [0, 5, 10, 20, 40, 80, 160]


def held(values):
    """Replaces missing values by the last one before them."""
    result, last = [], next((v for v in values if v is not None), 0.0)
    for v in values:
        last = last if v is None else v
        result.append(last)
    return result


def lagged(time_s, x, lag_s, is_drive):
    """First-order lag. A drive starts from 0 and is held from row to row; a temperature starts from its first reading and is taken as the mean of both ends."""
    if lag_s == 0.0:
        return list(x)
    state, result = 0.0 if is_drive else x[0], []
    for i in range(len(x)):
        if i > 0:
            towards = x[i - 1] if is_drive else 0.5 * (x[i - 1] + x[i])
            state += (1.0 - math.exp(-(time_s[i] - time_s[i - 1]) / lag_s)) * (towards - state)
        result.append(state)
    return result


class Runs:
    """The rows of a case: columns computed from a table by `columns(case, table)`, and the target."""

    def __init__(self, case, columns):
        self.case = case
        self.folds, self.judged = [], []
        for table in case.fit:
            x, y = columns(case, table), target(case, table)
            rows = [(x[i], y[i]) for i in range(len(y)) if y[i] is not None and (not case.fit_rows or case.fit_rows(table.time_s[i]))]
            if len(case.fit) == 1:
                n = len(rows)
                self.folds += [rows[n * p // 8:n * (p + 1) // 8] for p in range(8)]
            else:
                self.folds.append(rows)
        for table in case.judge:
            self.judged.append(columns(case, table))


def start(column):
    return next((v for v in column if v is not None), 0.0)


def readings(case, table, name):
    x = held(table.columns[name])
    return [v - start(x) for v in x] if case.from_start else x


def target(case, table):
    y = table.columns[case.target]
    return [None if v is None else v - start(y) for v in y] if case.from_start else y


def sums(rows):
    """[1 x y]'[1 x y] summed over rows (x, y)."""
    m = len(rows[0][0]) + 2
    s = [[0.0] * m for _ in range(m)]
    for x, y in rows:
        v = [1.0, *x, y]
        for i in range(m):
            vi, si = v[i], s[i]
            if vi != 0.0:
                for j in range(i + 1):
                    si[j] += vi * v[j]
    return s


def plus(a, b, factor):
    return [[p + factor * q for p, q in zip(x, y)] for x, y in zip(a, b)]


def solve(s, penalty):
    """Intercept and slopes that minimise |y - b0 - x b|^2 / n + penalty |b deviation(x)|^2; 0 for columns that never change."""
    n, m = s[0][0], len(s) - 2
    mean = [s[i][0] / n for i in range(m + 2)]

    def product(i, j):
        return s[max(i, j)][min(i, j)] / n - mean[i] * mean[j]

    deviation = [math.sqrt(max(product(i, i), 0.0)) for i in range(1, m + 1)]
    size = [math.sqrt(s[i][i] / n) for i in range(1, m + 1)]
    used = [i for i in range(m) if deviation[i] > 1e-6 * size[i]]
    a = [[product(i + 1, j + 1) / (deviation[i] * deviation[j]) + (penalty if i == j else 0.0) for j in used] for i in used]
    b = [product(i + 1, m + 1) / deviation[i] for i in used]
    for k in range(len(used)):  # Cholesky; a column that repeats others is left out
        d = a[k][k] - sum(a[k][p] ** 2 for p in range(k))
        if not d > 1e-9:
            for i in range(k, len(used)):
                a[i][k] = 0.0
            a[k][k] = math.inf
            continue
        a[k][k] = math.sqrt(d)
        for i in range(k + 1, len(used)):
            a[i][k] = (a[i][k] - sum(a[i][p] * a[k][p] for p in range(k))) / a[k][k]
    for k in range(len(used)):
        b[k] = (b[k] - sum(a[k][p] * b[p] for p in range(k) if math.isfinite(a[p][p]))) / a[k][k]
    for k in reversed(range(len(used))):
        b[k] = 0.0 if math.isinf(a[k][k]) else (b[k] - sum(a[i][k] * b[i] for i in range(k + 1, len(used)))) / a[k][k]
    slopes = [0.0] * m
    for k, i in enumerate(used):
        slopes[i] = b[k] / deviation[i]
    return mean[m + 1] - sum(mean[i + 1] * slopes[i] for i in range(m)), slopes


def apply(fit, x):
    return fit[0] + sum(a * b for a, b in zip(fit[1], x))


def left_out(folds, penalty):
    """RMS error over all rows of folds, each predicted from the others."""
    parts = [sums(f) for f in folds]
    total = parts[0]
    for p in parts[1:]:
        total = plus(total, p, 1.0)
    squares = n = 0.0
    for fold, part in zip(folds, parts):
        fit = solve(plus(total, part, -1.0), penalty)
        squares += sum((y - apply(fit, x)) ** 2 for x, y in fold)
        n += len(fold)
    return math.sqrt(squares / n)


def ridge(case, columns, penalties):
    runs = Runs(case, columns)
    folds = [f for f in runs.folds if f]
    if not folds[0][0][0]:
        return None
    penalty = penalties[0]
    if len(penalties) > 1:
        penalty = min(penalties, key=lambda p: left_out(folds, p))
    fit = solve(sums([row for fold in folds for row in fold]), penalty)
    return [[apply(fit, x) for x in table] for table in runs.judged]


def across(columns):
    return [list(row) for row in zip(*columns)]


def thermometers(case, table):
    return across([readings(case, table, n) for n in case.thermometers]) or [[] for _ in table.time_s]


def memories(case, table):
    """Thermometers, drive, its square and whether it is on, without lag and with lags, and lags of the ambient."""
    columns = [readings(case, table, n) for n in case.thermometers]
    if case.drive:
        n = held(table.columns[case.drive])
        for u in (n, [v * v for v in n], [1.0 if v != 0.0 else 0.0 for v in n]):
            columns += [lagged(table.time_s, u, 60.0 * lag, True) for lag in [0, *DRIVE_LAGS_MIN]]
    if case.ambient:
        columns += [lagged(table.time_s, readings(case, table, case.ambient), 60.0 * lag, False) for lag in AMBIENT_LAGS_MIN]
    return across(columns)


def with_state(lag_min):
    def columns(case, table):
        on = [1.0 if v != 0.0 else 0.0 for v in held(table.columns[case.drive])]
        return across([readings(case, table, n) for n in case.thermometers] + [lagged(table.time_s, on, 60.0 * lag_min, True)])

    return columns


def constant(case, value):
    return [[value] * len(t.time_s) for t in case.judge]


def training_values(case):
    values = []
    for table in case.fit:
        for t, y in zip(table.time_s, target(case, table)):
            if y is not None and (not case.fit_rows or case.fit_rows(t)):
                values.append(y)
    return values


def by_mean(case):
    values = training_values(case)
    return constant(case, sum(values) / len(values))


def by_last(case):
    """The value of the last training run at the same time since its start (its last value beyond its end); for a single record the last training value."""
    if len(case.fit) == 1:
        return constant(case, training_values(case)[-1])
    last = case.fit[-1]
    at = [(t - last.time_s[0], y) for t, y in zip(last.time_s, target(case, last)) if y is not None]
    times = [t for t, _ in at]
    result = []
    for table in case.judge:
        predicted = []
        for t in table.time_s:
            i = min(max(bisect.bisect_left(times, t - table.time_s[0]), 0), len(at) - 1)
            predicted.append(at[i][1])
        result.append(predicted)
    return result


def by_all_thermometers(case):
    return ridge(case, thermometers, [1e-12]) if case.thermometers else None


def by_ridge(case):
    return ridge(case, thermometers, PENALTIES) if case.thermometers else None


def by_memories(case):
    return ridge(case, memories, PENALTIES)


def by_run_and_stop(case):
    if not case.drive:
        return None
    chosen = min(STATE_LAGS_MIN, key=lambda lag: left_out(Runs(case, with_state(lag)).folds, 1e-12))
    return ridge(case, with_state(chosen), [1e-12])


BASELINES = {
    "mean": by_mean,
    "last": by_last,
    "thermometers": by_all_thermometers,
    "and run/stop": by_run_and_stop,
    "ridge": by_ridge,
    "and memories": by_memories,
}


def rms(case, predicted):
    """Root mean square of target minus prediction over all judged rows."""
    squares = n = 0
    for table, p in zip(case.judge, predicted):
        for t, y, v in zip(table.time_s, target(case, table), p):
            if y is not None and (not case.judge_rows or case.judge_rows(t)):
                squares += (y - v) ** 2
                n += 1
    return math.sqrt(squares / n)
