"""How much the records say for what is hidden, and how large it must be to be worth so much.

Linear (`Judge`), about nominal numbers:

    d = y(nominal numbers, with the fault) - y(nominal numbers, without)            all readings of all measured records, without noise
    J = dy / d(number in units of its prior sigma), by differences of this simulator; one column for each record's hall (0.3 K)
    nats = 1/2 min_z ( |W (d - J z)|^2 + |z|^2 ) = 1/2 [ a'a - a'B (I + B'B)^-1 B'a ],   a = W d, B = W J

Refitted (`Refit`), about true numbers; z: numbers in units of the prior sigma, the hall of each record in units of 0.3 K, and the logarithms of the sizes that are free (these have no prior):

    cost(structure) = min_z 1/2 ( |W (y - model(z))|^2 + |prior part of z|^2 )            damped Gauss-Newton, sensitivities anew at every accepted step
    nats = cost(nominal structure) - cost(structure of the truth)

y are the readings that are expected, without noise; so nats is the log of the likelihood ratio with priors, in the mean over the noise. Numbers may go as far as their price allows and not only as far as their tangent reaches. W whitens the
noise: white noise and the step's rounding, sigma^2 + step^2 / 12, and where there is coloured noise of the first order beside it, by the innovations of its Kalman filter.
"""
import numpy as np

from faults import Impossible
from machines import log_uniform
from network import moved, simulate

HALL_SIGMA_K = 0.3
LINEAR_STEP = 0.3     # of a prior sigma, of the differences
STEP = 0.1            # the same, of refits, or of a logarithm
LARGEST = 1.5         # of a prior sigma, of one step of one number


def whiten(y, sigma, dt, coloured):
    """y: variant x row x channel of one record; dt: to the next row."""
    y = y / sigma
    if coloured["share"] <= 0:
        return y
    phis, q = np.exp(-dt / (60 * coloured["minutes"])), coloured["share"] ** 2
    out, state, p = np.empty_like(y), np.zeros_like(y[:, 0]), q
    for k in range(y.shape[1]):
        s, e = p + 1.0, y[:, k] - state
        out[:, k] = e / np.sqrt(s)
        state = phis[k] * (state + p / s * e)
        p = phis[k] ** 2 * p / s + q * (1 - phis[k] ** 2)
    return out


def sigmas(noise):
    return [np.sqrt(noise[k]["sigma"] ** 2 + noise[k]["step"] ** 2 / 12) for k in ("temperature", "displacement")]


def readings(machine, numbers, record, noise, faults=(), offset_K=0.0):
    """Whitened: variant x (row, channel)."""
    steps = np.diff(record.time_s)
    parts = [whiten(a, s, np.append(steps, steps[-1]), noise["coloured"]).reshape(a.shape[0], -1) for a, s in zip(simulate(machine, numbers, record, faults, offset_K), sigmas(noise)) if a.shape[2]]
    return np.concatenate(parts, 1)


class Judge:
    """Knows the nominal machine's sensitivities on the measured records; gives linear nats of faults."""

    def __init__(self, machine, records, noise):
        self.machine, self.records, self.noise = machine, records, noise
        n = len(machine.numbers)
        self.nominal, columns, self.of_temperature = [], [], []
        for i, r in enumerate(records):
            numbers = {k: np.append(x, x[0]) for k, x in machine.sigma_steps(LINEAR_STEP).items()}
            y = readings(machine, numbers, r, noise, offset_K=np.append(np.zeros(n + 1), HALL_SIGMA_K))
            self.nominal.append(y[0])
            self.of_temperature.append(np.arange(y.shape[1]) < len(r.time_s) * len(machine.sensors))
            block = np.zeros((y.shape[1], n + len(records)))
            block[:, :n], block[:, n + i] = ((y[1:n + 1] - y[0]) / LINEAR_STEP).T, y[n + 1] - y[0]
            columns.append(block)
        self.B = np.concatenate(columns)

    def louder(self):
        """The same case with the noisiest instruments there are, where the least size would be worth too much."""
        old = sigmas(self.noise)
        for channel, most in (("temperature", 0.2), ("displacement", 2.0)):
            self.noise[channel]["sigma"] = max(self.noise[channel]["sigma"], most)
        ratio = [a / b for a, b in zip(old, sigmas(self.noise))]
        factors = [np.where(m, ratio[0], ratio[1]) for m in self.of_temperature]
        self.nominal = [y * f for y, f in zip(self.nominal, factors)]
        self.B = self.B * np.concatenate(factors)[:, None]

    def deviation(self, faults, n_sizes):
        return np.concatenate([readings(self.machine, self.machine.nominal(n_sizes), r, self.noise, faults) - y0 if any(f.holds(r.name) for f in faults) else np.zeros((n_sizes, len(y0))) for r, y0 in zip(self.records, self.nominal)], 1)

    def nats(self, deviation, beside=None):
        """Of each row; `beside`: a direction that is free (another fault)."""
        B = self.B if beside is None else np.concatenate([self.B, 1e3 * beside[:, None] / np.linalg.norm(beside)], 1)
        c = deviation @ B
        return 0.5 * (np.sum(deviation ** 2, 1) - np.sum(c * np.linalg.solve(np.eye(B.shape[1]) + B.T @ B, c.T).T, 1))

    def size_for(self, fault, target, n=9, may_be_louder=False):
        """Size at which the fault is worth `target` nats, or None."""
        low, high = fault.low, fault.high
        for turn in range(3):
            sizes = np.exp(np.linspace(np.log(low), np.log(high), n if turn == 0 else 4))
            y = np.maximum(self.nats(self.deviation([fault.with_size(sizes)], len(sizes))), 1e-9)
            above = np.flatnonzero((y[1:] >= target) & (y[:-1] < target))
            if len(above) == 0:
                if turn == 0 and y[0] >= target and may_be_louder:
                    self.louder()
                    return self.size_for(fault, target, n, False)
                return None
            k = above[0]
            low, high = sizes[k], sizes[k + 1]
            if high / low < 1.01:
                break
        return float(np.exp(np.interp(np.log(target), np.log(y[k:k + 2]), np.log(sizes[k:k + 2]))))


class Refit:
    def __init__(self, machine, records, noise, true_z, offsets_K, hidden):
        """true_z: label -> z of the true number; offsets_K: of the ambient, of each record; hidden: the faults with their sizes."""
        self.machine, self.records, self.noise, self.hidden, self.labels = machine, records, noise, hidden, list(machine.numbers)
        self.start = np.array([true_z[k] for k in self.labels] + [o / HALL_SIGMA_K for o in offsets_K])
        self.y = [self.model(self.start, hidden, np.zeros(len(hidden)), i)[0] for i in range(len(records))]

    def model(self, z, faults, logs, i, differences=False):
        """Readings of one record; with `differences`, the first row is followed by those for a step in each unknown."""
        n, f = len(self.labels), len(faults)
        count = 2 + n + f if differences else 1
        numbers, offset, sized = {}, np.full(count, z[n + i]), []
        for k, label in enumerate(self.labels):
            zs = np.full(count, z[k])
            if differences:
                zs[1 + k] += STEP
            numbers[label] = moved(*self.machine.numbers[label], zs, self.machine.stated.get(label, 1.0))
        if differences:
            offset[-1] += STEP
        for k, fault in enumerate(faults):
            log = np.full(count, logs[k])
            if differences:
                log[1 + n + k] += STEP
            sized.append(fault.with_size(np.abs(fault.size[0]) * np.exp(log)))
        return readings(self.machine, numbers, self.records[i], self.noise, sized, HALL_SIGMA_K * offset)

    def cost(self, faults=(), start=None, steps=8):
        """Least cost of the nominal structure with these of the faults, sizes free."""
        n, r, f = len(self.labels), len(self.records), len(faults)
        z, logs, damping = (self.start if start is None else start).copy(), np.zeros(f), 1e-3
        prior = np.append(np.ones(n + r), np.zeros(f))

        def value(z, logs):
            return 0.5 * (sum(np.sum((self.y[i] - self.model(z, faults, logs, i)[0]) ** 2) for i in range(r)) + np.sum(z ** 2))

        best = value(z, logs)
        for _ in range(steps):
            normal, slope = np.diag(prior.copy()), -prior * np.append(z, logs)
            for i in range(r):
                m = self.model(z, faults, logs, i, True)
                b = np.zeros((m.shape[1], n + r + f))
                b[:, :n], b[:, n + r:], b[:, n + i] = ((m[1:n + 1] - m[0]) / STEP).T, ((m[n + 1:-1] - m[0]) / STEP).T, (m[-1] - m[0]) / STEP
                normal += b.T @ b
                slope += b.T @ (self.y[i] - m[0])
            for k, fault in enumerate(faults):      # two thermometers that are swapped: no size
                if fault.low == fault.high:
                    normal[n + r + k, n + r + k] = 1.0
            gained = None
            for _ in range(6):
                step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), slope)
                step *= LARGEST / max(LARGEST, np.max(np.abs(step)))
                new = value(z + step[:n + r], logs + step[n + r:])
                if new < best:
                    gained, best, z, logs, damping = best - new, new, z + step[:n + r], logs + step[n + r:], damping / 10
                    break
                damping = max(10 * damping, 1e-3)
            if gained is None or gained < 0.02 + 1e-3 * best:
                break
        return best, z

    def nats(self, left_out=None, thorough=False):
        """Of all that is hidden, or of the one that is left out while the others stay free; thorough: begun from the true and from the nominal numbers, the better counts."""
        beside = [f for i, f in enumerate(self.hidden) if i != left_out] if left_out is not None else []
        wrong = self.cost(beside)[0]
        if thorough:
            wrong = min(wrong, self.cost(beside, np.zeros_like(self.start), 12)[0])
        return wrong - self.cost(self.hidden, steps=3)[0]


def sized(rng, allowed, drawn, machine, records, noise, z, offsets):
    """The faults with sizes at which each is worth what it shall be, refitted, while the others' sizes are free: (faults, refitted nats, linear nats, judge). allowed: (least, most)."""
    judge, target, sizes = Judge(machine, records, noise), [], []
    fixed = [f.low == f.high for f in drawn]      # wired to each other's channel: there is no size, it is worth what it is
    fits = lambda n, k: allowed[0] <= n <= allowed[1]
    for fault, has_none in zip(drawn, fixed):
        target.append(log_uniform(rng, 1.04 * allowed[0], 0.96 * allowed[1]))
        sizes.append(1.0 if has_none else judge.size_for(fault, target[-1], may_be_louder=len(drawn) == 1))
        if sizes[-1] is None:
            raise Impossible
    for _ in range(6):
        sizes = [float(f"{s:.5g}") for s in sizes]
        hidden = [f.with_size(s) for f, s in zip(drawn, sizes)]
        refit = Refit(machine, records, noise, z, offsets, hidden)
        got = [refit.nats(i if len(hidden) > 1 else None) for i in range(len(hidden))]
        if all(fits(n, k) and (0.67 < n / target[k] < 1.5 or fixed[k]) for k, n in enumerate(got)):
            got = [refit.nats(i if len(hidden) > 1 else None, thorough=True) for i in range(len(hidden))]
            if all(fits(n, k) for k, n in enumerate(got)):
                return hidden, [float(n) for n in got], [float(judge.nats(judge.deviation([f], 1))[0]) for f in hidden], judge
        new = [s if k else float(np.clip(s * np.clip(np.sqrt(t / max(n, 0.05)), 0.3, 2.2), f.low, f.high)) for s, n, t, f, k in zip(sizes, got, target, drawn, fixed)]
        if new == sizes:
            raise Impossible
        sizes = new
    raise Impossible
