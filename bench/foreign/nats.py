"""How much the records say for what is hidden.

    d = y(nominal numbers, with the fault) - y(nominal numbers, without)            all readings of all measured records, without noise
    J = dy / d(number in units of its prior sigma), by differences of this simulator; one column for each record's hall (0.3 K)
    nats = 1/2 min_z ( |W (d - J z)|^2 + |z|^2 ) = 1/2 [ a'a - a'B (I + B'B)^-1 B'a ],   a = W d, B = W J

W whitens the noise: white noise and the step's rounding, sigma^2 + step^2 / 12, and where there is coloured noise of the first order beside
it, by the innovations of its Kalman filter. It is the log of the likelihood ratio of truth against the nominal model, refitted within its
priors, in the mean over the noise and linearised about the nominal numbers.
"""
import numpy as np

from network import simulate

HALL_SIGMA_K = 0.3
STEP = 0.3     # of a prior sigma, of the differences


def whiten(y, sigma, dt, coloured):
    """y: variant x row x channel of one record."""
    y = y / sigma
    if coloured["share"] <= 0:
        return y
    phis = np.exp(-dt / (60 * coloured["minutes"]))     # dt: one, or that to the next row
    q = coloured["share"] ** 2
    out, state, p = np.empty_like(y), np.zeros_like(y[:, 0]), q
    for k in range(y.shape[1]):
        phi = phis if np.ndim(phis) == 0 else phis[k]
        s = p + 1.0
        e = y[:, k] - state
        out[:, k] = e / np.sqrt(s)
        state = phi * (state + p / s * e)
        p = phi ** 2 * p / s + q * (1 - phi ** 2)
    return out


def sigmas(noise):
    return [np.sqrt(noise[k]["sigma"] ** 2 + noise[k]["step"] ** 2 / 12) for k in ("temperature", "displacement")]


def readings(machine, numbers, record, noise, faults=(), offset_K=0.0):
    """Whitened: variant x (row, channel)."""
    t, u = simulate(machine, numbers, record, faults, offset_K)
    dt = record.time_s[1] - record.time_s[0]
    parts = [whiten(a, s, dt, noise["coloured"]).reshape(a.shape[0], -1) for a, s in zip((t, u), sigmas(noise)) if a.shape[2]]
    return np.concatenate(parts, 1)


class Judge:
    """Knows the nominal machine's sensitivities on the measured records; gives nats of faults."""

    def __init__(self, machine, records, noise):
        self.machine, self.records, self.noise = machine, records, noise
        n = len(machine.numbers)
        self.nominal, columns, self.of_temperature = [], [], []
        for i, r in enumerate(records):
            numbers = machine.sigma_steps(STEP)
            for k in numbers:
                numbers[k] = np.append(numbers[k], numbers[k][0])
            offsets = np.append(np.zeros(n + 1), HALL_SIGMA_K)
            y = readings(machine, numbers, r, noise, offset_K=offsets)
            self.nominal.append(y[0])
            self.of_temperature.append(np.arange(y.shape[1]) < len(r.time_s) * len(machine.sensors))
            block = np.zeros((y.shape[1], n + len(records)))
            block[:, :n] = ((y[1:n + 1] - y[0]) / STEP).T
            block[:, n + i] = y[n + 1] - y[0]
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
        out = []
        for r, y0 in zip(self.records, self.nominal):
            if any(f.holds(r.name) for f in faults):
                out.append(readings(self.machine, self.machine.nominal(n_sizes), r, self.noise, faults) - y0)
            else:
                out.append(np.zeros((n_sizes, len(y0))))
        return np.concatenate(out, 1)

    def nats(self, deviation, beside=None):
        """Of each row; `beside`: a direction that is free (another fault)."""
        B = self.B if beside is None else np.concatenate([self.B, 1e3 * beside[:, None] / np.linalg.norm(beside)], 1)
        c = deviation @ B
        m = np.eye(B.shape[1]) + B.T @ B
        return 0.5 * (np.sum(deviation ** 2, 1) - np.sum(c * np.linalg.solve(m, c.T).T, 1))

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
        x = np.interp(np.log(target), np.log(y[k:k + 2]), np.log(sizes[k:k + 2]))
        return float(np.exp(x))
