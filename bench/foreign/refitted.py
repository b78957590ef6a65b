"""How much the records say for what is hidden, by refits that are not linear.

    z of a structure: its numbers in units of the prior sigma that the scenario states, the ambient of each record in units of 0.3 K, and the logarithms of the sizes
    of those faults that are free (these have no prior)
    cost(structure) = min_z 1/2 ( |W (y - model(z))|^2 + |prior part of z|^2 )            damped Gauss-Newton, sensitivities anew at every accepted step
    nats = cost(nominal structure) - cost(structure of the truth)

y are the readings of all measured records as they are expected, without noise, of the true numbers; so nats is the log of the likelihood ratio with priors, in the mean over the noise
(the noise adds half of one for each size that is free, which is left out). `nats.Judge` is the same, linearised about nominal numbers: what is a change of uncertain numbers alone
is worth less here, as numbers may go as far as their price allows and not only as far as their tangent reaches.

    refitted.py        two closed cases: a conductance that its prior allows is taken up at the price of its prior; a hidden body without an equivalent stays
"""
import numpy as np

import nats as linear
from network import moved, simulate

STEP = 0.1     # of a prior sigma or of a logarithm, of the differences
LARGEST = 1.5  # of a prior sigma, of one step of one number


def interval(record):
    steps = np.diff(record.time_s)
    return float(steps[0]) if np.ptp(steps) < 1e-9 else np.append(steps, steps[-1])


def readings(machine, numbers, record, noise, faults, offset_K):
    parts = [linear.whiten(a, s, interval(record), noise["coloured"]).reshape(a.shape[0], -1)
             for a, s in zip(simulate(machine, numbers, record, faults, offset_K), linear.sigmas(noise)) if a.shape[2]]
    return np.concatenate(parts, 1)


class Refit:
    def __init__(self, machine, records, noise, true_z, offsets_K, hidden):
        """true_z: label -> z of the true number; offsets_K: of the ambient, of each record; hidden: the faults with their sizes."""
        self.machine, self.records, self.noise, self.hidden = machine, records, noise, hidden
        self.labels = list(machine.numbers)
        self.start = np.array([true_z[k] for k in self.labels] + [o / linear.HALL_SIGMA_K for o in offsets_K])
        self.y = [self.model(self.start, hidden, np.zeros(len(hidden)), i)[0] for i in range(len(records))]

    def model(self, z, faults, logs, i, differences=False):
        """Readings of one record; with `differences`, the first row is followed by those for a step in each unknown."""
        n, f = len(self.labels), len(faults)
        count = 2 + n + f if differences else 1
        numbers = {}
        for k, label in enumerate(self.labels):
            value, kind = self.machine.numbers[label]
            zs = np.full(count, z[k])
            if differences:
                zs[1 + k] += STEP
            numbers[label] = moved(value, kind, zs, self.machine.stated.get(label, 1.0))
        offset = np.full(count, z[n + i])
        if differences:
            offset[-1] += STEP
        sized = []
        for k, fault in enumerate(faults):
            log = np.full(count, logs[k])
            if differences:
                log[1 + n + k] += STEP
            sized.append(fault.with_size(np.abs(fault.size[0]) * np.exp(log)))
        return readings(self.machine, numbers, self.records[i], self.noise, sized, linear.HALL_SIGMA_K * offset)

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


def main():
    import third_families
    from families import Draw
    from faults import Fault
    rng = np.random.default_rng(5)
    machine, plan = third_families.swivel_head(rng, Draw(rng))
    machine.sensors = [("t_" + b, b) for b in machine.bodies]
    records = [third_families.record(rng, f"measured_{i + 1}", plan, 300, 30, "even") for i in range(2)]
    noise = dict(temperature=dict(sigma=0.1, step=0.001), displacement=dict(sigma=0.5, step=0.01), coloured=dict(share=0.0, minutes=0.0))
    judge = linear.Judge(machine, records, noise)
    exact = {k: 0.0 for k in machine.numbers}
    for link in (("rotor", "sleeve"), ("fork", "ram"), ("ram", "hall")):
        for factor in (1.2, 1.5, 2.0):
            fault = Fault("convection" if link[1] == "hall" else "contact", dict(link=link), None).with_size(float(np.log(factor)))
            got, price = Refit(machine, records, noise, exact, [0.0, 0.0], [fault]).nats(), 0.5 * (np.log(factor) / 0.1) ** 2
            print(f"{link[0]} - {link[1]} times {factor}: linear {float(judge.nats(judge.deviation([fault], 1))[0]):8.2f}, refitted {got:8.2f}, price of the prior {price:6.2f}", "" if got <= price + 0.05 else "WRONG")
    for body in ("fork", "ram", "sleeve"):
        fault = Fault("hidden_body", dict(node=body, capacity=machine.numbers["C " + body][0], conductance=machine.numbers["C " + body][0] / 1200, to_hall=0.0)).with_size(1.0)
        print(f"hidden body at {body}: linear {float(judge.nats(judge.deviation([fault], 1))[0]):8.2f}, refitted {Refit(machine, records, noise, exact, [0.0, 0.0], [fault]).nats():8.2f}")


if __name__ == "__main__":
    main()
