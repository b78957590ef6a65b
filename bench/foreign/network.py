"""The truth: networks of lumped bodies, integrated by exact exponentials in steps that end at every row and every event.

    C_i dT_i/dt = sum_j G_ij (T_j - T_i) + G_i (T_hall - T_i) + W_i (T_set - T_i) + P_i(n, v, P_recorded, T_i)

The hall is linear between rows, speed, feed and recorded power hold from their row on. All quantities are in SI units but
speeds (rpm), displacements (um), and temperatures (degC). Many variants of one machine (its numbers, the sizes of its
faults) are integrated side by side: arrays carry the variant as their first axis.
"""
import numpy as np
from scipy.linalg import expm

LONGEST_STEP_s = 20.0   # where heat depends on the temperature of its body


class Record:
    """What a logger knows: times [s], speed [rpm], feeds [m/s] by axis, recorded power [W], hall [degC], further columns."""

    def __init__(self, name, time_s, speed, feeds, power, hall, columns):
        self.name, self.time_s, self.speed, self.feeds, self.power, self.hall, self.columns = name, time_s, speed, feeds, power, hall, columns


class Machine:
    """Bodies, links, circuits, heats, thermometers and displacements; `numbers` are the uncertain ones: label -> (value, kind).

    kind `log`: lognormal, 10 % one sigma; `exponent`: normal, 3 % one sigma.
    """

    def __init__(self, family):
        self.family, self.bodies, self.links, self.circuits, self.heats = family, [], [], [], []
        self.sensors, self.displacements, self.numbers, self.air, self.start, self.t_ref = [], [], {}, set(), "hall", 20.0
        self.longest_step_s = LONGEST_STEP_s
        self.stated = {}     # label -> how much wider or narrower than 10 % (3 %) the scenario says that a number is known

    def body(self, name, capacity):
        self.bodies.append(name)
        self.numbers["C " + name] = (capacity, "log")

    def link(self, a, b, conductance):
        self.links.append((a, b))
        self.numbers[f"G {a} {b}"] = (conductance, "log")

    def circuit(self, node, flow_L_min, passage, set_point):
        self.circuits.append((node, set_point))
        self.numbers["flow " + node] = (flow_L_min, "log")
        self.numbers["passage " + node] = (passage, "log")

    def heat(self, kind, node, power, at=1.0, exponent=0.0, idle=0.0, decay=0.0, axis=None, turning=False):
        i = len(self.heats)
        self.heats.append(dict(kind=kind, node=node, at=at, axis=axis, turning=turning, has_exponent=exponent != 0.0, has_idle=idle > 0, has_decay=decay > 0))
        self.numbers[f"P {i}"] = (power, "log")
        if exponent != 0.0:
            self.numbers[f"e {i}"] = (exponent, "exponent")
        if idle > 0:
            self.numbers[f"idle {i}"] = (idle, "log")
        if decay > 0:
            self.numbers[f"decay {i}"] = (decay, "log")

    def displacement(self, name, axis, sensitivities):
        self.displacements.append((name, axis, list(sensitivities)))
        for node, s in sensitivities.items():
            self.numbers[f"S {name} {node}"] = (s, "log")

    def nominal(self, n_variants=1):
        return {k: np.full(n_variants, v[0], float) for k, v in self.numbers.items()}

    def sigma_steps(self, step):
        """One variant for each uncertain number, moved by `step` of its prior sigma; the first variant is nominal."""
        p = self.nominal(len(self.numbers) + 1)
        for i, (k, (v, kind)) in enumerate(self.numbers.items()):
            p[k][i + 1] = moved(v, kind, step, self.stated.get(k, 1.0))
        return p


def moved(value, kind, z, sigma_factor=1.0):
    return value * np.exp(0.1 * sigma_factor * z) if kind == "log" else value * (1 + 0.03 * sigma_factor * z)


def in_windows(t, windows):
    m = np.zeros(len(t), bool)
    for a, b in windows:
        m |= (t >= a) & (t < b)
    return m


def first_order(time_s, u, lag_s, y0):
    """lag dy/dt = u - y over rows between which u (variant x row) is linear; lag (variant)."""
    y = np.empty_like(u)
    y[:, 0] = y0
    lag = np.maximum(lag_s, 1e-6)
    for k in range(1, u.shape[1]):
        h = time_s[k] - time_s[k - 1]
        e = np.exp(-h / lag)
        slope = (u[:, k] - u[:, k - 1]) / h
        y[:, k] = u[:, k] - slope * lag + (y[:, k - 1] - u[:, k - 1] + slope * lag) * e
    return y


def simulate(machine, numbers, record, faults=(), offset_K=0.0):
    """Readings without noise of one record: temperatures (variant x row x sensor), displacements (variant x row x channel).

    Each fault has `size` (one value for each variant); those that do not hold in this record are passed over.
    """
    faults = [f for f in faults if f.holds(record.name)]
    n_var = len(next(iter(numbers.values())))
    zero = np.zeros(n_var)
    t_rows = record.time_s
    bodies = list(machine.bodies)
    capacity = {b: numbers["C " + b] for b in bodies}
    for f in faults:
        if f.key == "hidden_body":
            bodies.append("hidden")
            capacity["hidden"] = np.maximum(f.size * f.data["capacity"], 1e-3)
        elif f.key == "mass_change":
            bodies.append("load")
            capacity["load"] = np.maximum(f.size * f.data["capacity"], 1e-3)
        elif f.key == "heat_capacity":
            capacity[f.data["node"]] = capacity[f.data["node"]] * np.exp(f.size)
    index = {b: i for i, b in enumerate(bodies)}
    n = len(bodies)

    # --- steps: rows, events, and for heat that follows temperature no step longer than the machine's own -------------------
    marks = [t_rows] + [np.clip(np.concatenate([np.atleast_1d(e) for e in f.events(record)]), 0, t_rows[-1]) for f in faults if f.events(record)]
    t = np.unique(np.round(np.concatenate(marks), 6))
    if any(h["has_decay"] for h in machine.heats) or getattr(machine, "feedback", ()) or any(f.key == "friction_law" and f.data.get("decay") for f in faults):
        t = np.unique(np.concatenate([np.linspace(a, b, int(np.ceil((b - a) / machine.longest_step_s)) + 1)[:-1] for a, b in zip(t[:-1], t[1:])] + [t[-1:]]))
    t0, h = t[:-1], np.diff(t)
    row = np.clip(np.searchsorted(t_rows, t0 + 1e-7, side="right") - 1, 0, len(t_rows) - 1)
    n_steps = len(h)

    # --- what drives it --------------------------------------------------------------------------------------------------
    speed = np.broadcast_to(record.speed[row], (n_var, n_steps)).copy()
    hall0 = np.broadcast_to(np.interp(t0, t_rows, record.hall), (n_var, n_steps)) + np.reshape(offset_K, (-1, 1))
    hall1 = np.broadcast_to(np.interp(t[1:], t_rows, record.hall), (n_var, n_steps)) + np.reshape(offset_K, (-1, 1))
    all_heat = np.ones((n_var, n_steps))
    for f in faults:
        if f.key == "ambient":
            if f.data.get("ramp"):
                hall0, hall1 = hall0 + f.size[:, None] * t0 / 3600, hall1 + f.size[:, None] * t[1:] / 3600
                continue
            on = t0 >= f.data["from_s"] - 1e-7
            hall0, hall1 = hall0 + f.size[:, None] * on, hall1 + f.size[:, None] * on
        elif f.key == "speed_override":
            speed *= np.exp(f.size)[:, None]
        elif f.key == "missing_stop":
            for v in range(n_var):
                speed[v, (t0 >= f.data["start_s"] - 1e-7) & (t0 < f.data["start_s"] + 60 * f.size[v] - 1e-7)] = 0
        elif f.key == "heat_window" and f.data["what"] == "speed":
            speed[:, in_windows(t0 + 1e-6, f.windows(record))] *= np.exp(f.size)[:, None]
        elif f.key == "run_state" and f.data["what"] == "heat":
            all_heat *= np.exp(f.size)[:, None]

    fed = [make(index, record, row, speed, hall0) for make in getattr(machine, "feedback", ())]      # (temperatures, step) -> [(body, watts)], of what hangs on temperatures in any way

    # --- heat by body; that with a decay apart ----------------------------------------------------------------------------
    heat = np.zeros((n_var, n_steps, n))
    heat_still = np.zeros((n_var, n))
    decaying = []
    for i, law in enumerate(machine.heats):
        power = numbers[f"P {i}"][:, None]
        exponent = numbers[f"e {i}"] if law["has_exponent"] else zero
        factor = all_heat.copy()
        decay = numbers[f"decay {i}"] if law["has_decay"] else None
        for f in faults:
            if f.key == "friction_law" and f.data["heat"] == i and f.data.get("decay"):
                decay = (zero if decay is None else decay) + f.size
                continue
            if f.key == "friction_law" and f.data["heat"] == i:
                exponent = exponent + f.size
            if f.key == "recorded_drive" and f.data.get("heat") == i:
                factor *= np.exp(f.size)[:, None]
        idle = numbers[f"idle {i}"] if law["has_idle"] else zero
        if law["kind"] == "cutting_heat":
            q = power * record.power[row]
        elif law["kind"] == "servo_loss":
            q = idle[:, None] + power * (record.feeds[law["axis"]][row] / law["at"]) ** exponent[:, None]
            heat_still[:, index[law["node"]]] += idle * factor[:, 0]
        elif law["kind"] == "heat_source" and not law["has_exponent"]:
            q = power * ((speed > 0) if law["turning"] else 1.0) * np.ones((n_var, n_steps))
            if not law["turning"]:
                heat_still[:, index[law["node"]]] += power[:, 0] * factor[:, 0]
        else:
            turning = speed > 0
            q = np.where(turning, idle[:, None] + power * (np.where(turning, speed, law["at"]) / law["at"]) ** exponent[:, None], 0.0)
        q = q * factor
        if decay is not None:
            decaying.append((index[law["node"]], q, decay, machine.t_ref))
        else:
            heat[:, :, index[law["node"]]] += q
    for f in faults:
        if f.key == "heat_source":
            on = (t0 >= f.data["from_s"] - 1e-7).astype(float)
            if f.data["law"] == "turning":
                on = on * (speed > 0)
            elif f.data["law"] == "power":
                on = on * np.where(speed > 0, speed / f.data["at"], 0.0) ** f.data["exponent"] * (speed > 0)
            elif f.data["from_s"] <= 0:
                heat_still[:, index[f.data["node"]]] += f.size
            heat[:, :, index[f.data["node"]]] += f.size[:, None] * on
        elif f.key == "heat_window" and f.data["what"] == "heat":
            heat[:, :, index[f.data["node"]]] += f.size[:, None] * in_windows(t0 + 1e-6, f.windows(record))
        elif f.key == "recorded_drive" and "column" in f.data:
            if f.data.get("mode", "gain") == "gain":
                heat[:, :, index[f.data["node"]]] += f.size[:, None] * record.columns[f.data["column"]][1][row]
            elif f.data["mode"] == "conductance":      # to a body as warm as the column says
                heat[:, :, index[f.data["node"]]] += f.size[:, None] * record.columns[f.data["column"]][1][row]
                heat_still[:, index[f.data["node"]]] += f.size * record.columns[f.data["column"]][1][0]

    # --- conductances: (a, b, G, levels over steps or None); with levels G has one row for each, the first of them holds at standstill ---
    links = []
    for a, b in machine.links:
        g, level = numbers[f"G {a} {b}"], None
        for f in faults:
            if f.key in ("convection", "contact") and f.data["link"] == (a, b):
                g = g * np.exp(f.size)
            if f.key == "run_state" and f.data["what"] == "exchange" and b == "hall":
                g = g * np.exp(f.size)
            if f.key == "forced_convection" and f.data["link"] == (a, b):     # (n / at)^size while it turns, as `changed_law` has it
                values, level = np.unique(np.append(0.0, record.speed[row]), return_inverse=True)
                g, level = np.stack([g if x <= 0 else g * (x / f.data["at"]) ** f.size for x in values]), level[1:]
        links.append((a, b, g, level))
    for f in faults:
        if f.key == "mass_change":
            inside = in_windows(t0 + 1e-6, f.windows(record)).astype(int)
            joined, apart = f.size * f.data["conductance"], f.size * f.data["capacity"] / 60
            links.append(("load", f.data["node"], np.stack([0 * joined, joined]), inside))
            links.append(("load", "hall", np.stack([apart, 0 * apart]), inside))
        elif f.key == "recorded_drive" and f.data.get("mode") == "conductance":
            links.append((f.data["node"], "nothing", f.size, None))
        elif f.key == "recorded_drive" and f.data.get("mode") == "opening":
            values, level = np.unique(np.append(0.0, record.columns[f.data["column"]][1][row]), return_inverse=True)
            links.append((f.data["node"], "hall", values[:, None] * f.size, level[1:]))
        if f.key == "hidden_body":
            links.append(("hidden", f.data["node"], f.size * f.data["conductance"], None))
            if f.data["to_hall"] > 0:
                links.append(("hidden", "hall", f.size * f.data["to_hall"], None))
        elif f.key == "link":
            links.append((f.data["a"], f.data["b"], f.size, None))
        elif f.key == "exchange_window":
            links.append((f.data["a"], f.data["b"], np.stack([0 * f.size, f.size]), in_windows(t0 + 1e-6, f.windows(record)).astype(int)))
    fixed = []
    for node, set_point in machine.circuits:
        flow = numbers["flow " + node]
        for f in faults:
            if f.key == "coolant" and f.data["node"] == node:
                if f.data["what"] == "flow":
                    flow = flow * np.exp(f.size)
                else:
                    set_point = set_point + f.size
        stream = flow / 60 * 3800.0
        fixed.append((node, stream * (1 - np.exp(-numbers["passage " + node] / stream)), set_point))

    levels = [m for *_, m in links if m is not None]
    radix = np.cumprod([1] + [int(g.shape[0]) for _, _, g, m in links if m is not None])
    state = sum((m * int(x) for x, m in zip(radix, levels)), np.zeros(n_steps, int))
    c = np.stack([capacity[b] for b in bodies], 1)

    def matrices(s):
        a_matrix, to_hall, constant = np.zeros((n_var, n, n)), np.zeros((n_var, n)), np.zeros((n_var, n))
        for a, b, g, level in links:
            if level is not None:
                s, one = divmod(s, g.shape[0])
                g = g[one]
            i = index[a]
            a_matrix[:, i, i] -= g
            if b == "hall":
                to_hall[:, i] += g
            elif b != "nothing":
                j = index[b]
                a_matrix[:, i, j] += g
                a_matrix[:, j, i] += g
                a_matrix[:, j, j] -= g
        for node, g, set_point in fixed:
            a_matrix[:, index[node], index[node]] -= g
            constant[:, index[node]] += g * set_point
        return a_matrix / c[:, :, None], to_hall / c, constant / c

    cache, transitions = {}, {}
    code = np.empty(n_steps, int)
    hr = np.round(h, 6)
    for k in range(n_steps):
        key = (state[k], hr[k])
        if key not in transitions:
            if key[0] not in cache:
                cache[key[0]] = matrices(key[0])
            a_matrix, to_hall, constant = cache[key[0]]
            big = np.zeros((n_var, 3 * n, 3 * n))
            big[:, :n, :n] = a_matrix * hr[k]
            big[:, :n, n:2 * n] = big[:, n:2 * n, 2 * n:] = np.eye(n) * hr[k]
            e = expm(big)
            transitions[key] = (len(transitions), e[:, :n, :n], e[:, :n, n:2 * n], e[:, :n, 2 * n:], to_hall, constant)
        code[k] = transitions[key][0]
    table = sorted(transitions.values(), key=lambda x: x[0])
    base, ramp = heat / c[:, None, :], np.zeros((n_var, n_steps, n))
    for i, tr in enumerate(table):
        m = code == i
        base[:, m] += tr[4][:, None, :] * hall0[:, m, None] + tr[5][:, None, :]
        ramp[:, m] = tr[4][:, None, :] * ((hall1 - hall0)[:, m] / h[m])[:, :, None]

    # --- start ---------------------------------------------------------------------------------------------------------------
    T = np.repeat(hall0[:, :1], n, 1)
    if not isinstance(machine.start, str):
        T = np.full((n_var, n), float(machine.start))
    elif machine.start == "steady":
        if state[0] not in cache or state[0] != 0:
            cache[0] = matrices(0)
        a_matrix, to_hall, constant = cache[0]
        T = np.linalg.solve(a_matrix, -(heat_still / c + to_hall * hall0[:, :1] + constant)[:, :, None])[:, :, 0]
    out = np.empty((n_var, n_steps + 1, n))
    out[:, 0] = T
    if not decaying and not fed:
        for i, tr in enumerate(table):       # what does not depend on T, at once
            m = code == i
            base[:, m] = np.matmul(base[:, m], tr[2].transpose(0, 2, 1)) + np.matmul(ramp[:, m], tr[3].transpose(0, 2, 1))
        for k in range(n_steps):
            T = np.matmul(table[code[k]][1], T[:, :, None])[:, :, 0] + base[:, k]
            out[:, k + 1] = T
    else:
        for k in range(n_steps):
            _, E, F1, F2, _, _ = table[code[k]]
            b = base[:, k].copy()
            for i, q, decay, at in decaying:
                b[:, i] += q[:, k] * np.exp(-decay * (T[:, i] - at)) / c[:, i]
            before = [x for q in fed for x in q(T, k)]
            for i, watts in before:
                b[:, i] += watts / c[:, i]
            first = np.matmul(E, T[:, :, None]) + np.matmul(F1, b[:, :, None]) + np.matmul(F2, ramp[:, k, :, None])
            r = ramp[:, k].copy()
            for i, q, decay, at in decaying:
                r[:, i] += q[:, k] * (np.exp(-decay * (first[:, i, 0] - at)) - np.exp(-decay * (T[:, i] - at))) / c[:, i] / h[k]
            for (i, old), (_, new) in zip(before, [x for q in fed for x in q(first[:, :, 0], k)]):
                r[:, i] += (new - old) / c[:, i] / h[k]
            T = (np.matmul(E, T[:, :, None]) + np.matmul(F1, b[:, :, None]) + np.matmul(F2, r[:, :, None]))[:, :, 0]
            out[:, k + 1] = T
    at_rows = np.searchsorted(t, t_rows - 1e-6)
    T_rows = out[:, at_rows]
    hall_rows = np.concatenate([hall0, hall1[:, -1:]], 1)[:, at_rows]

    def of(node):
        return hall_rows if node == "hall" else T_rows[:, :, index[node]]

    # --- instruments ------------------------------------------------------------------------------------------------------------
    temperatures = np.empty((n_var, len(t_rows), len(machine.sensors)))
    hours = t_rows / 3600
    for i, (name, node) in enumerate(machine.sensors):
        y = of(node).copy()
        for f in faults:
            if f.data.get("sensor") != name:
                continue
            s = f.size[:, None]
            if f.key == "sensor_place":
                y = (1 - s) * y + s * of(f.data["other"])
            elif f.key == "sensor_detached":
                on = t_rows >= f.data["from_s"] - 1e-7
                y = y + s * on * (hall_rows - y)
            elif f.key == "sensor_lag":
                y = first_order(t_rows, y, 60 * f.size, y[:, 0])
            elif f.key == "sensor_bias":
                y = y + s
            elif f.key == "sensor_drift":
                y = y + s * hours
        temperatures[:, :, i] = y
    displacements = np.zeros((n_var, len(t_rows), len(machine.displacements)))
    speed_rows = speed[:, np.searchsorted(t0, t_rows[:-1] - 1e-6)]
    for i, (name, _, nodes) in enumerate(machine.displacements):
        u = np.zeros((n_var, len(t_rows)))
        for node in nodes:
            s = numbers[f"S {name} {node}"]
            for f in faults:
                if f.key == "expansion" and f.data["node"] == node and f.data["displacement"] in (None, name):
                    s = s * np.exp(f.size)
            u += s[:, None] * (of(node) - machine.t_ref)
        for f in faults:
            if f.data.get("channel") != name:
                continue
            if f.key == "displacement_path":
                if "column" in f.data:
                    d = np.broadcast_to(record.columns[f.data["column"]][1] - machine.t_ref, (n_var, len(t_rows)))
                else:
                    d = of(f.data["node"]) - machine.t_ref
                if f.data["lag_min"] > 0:
                    d = first_order(t_rows, d, np.full(n_var, 60 * f.data["lag_min"]), d[:, 0])
                u += f.size[:, None] * d
            elif f.key == "spindle_growth":
                drive = np.where(speed_rows > 0, np.where(speed_rows > 0, speed_rows, 1) / f.data["at"], 0) ** f.data["exponent"] * (speed_rows > 0)
                y = np.zeros((n_var, len(t_rows)))
                for k in range(1, len(t_rows)):
                    e = np.exp(-(t_rows[k] - t_rows[k - 1]) / (60 * f.data["lag_min"]))
                    y[:, k] = y[:, k - 1] * e + drive[:, k - 1] * (1 - e)
                u += f.size[:, None] * y
            elif f.key == "centrifugal":
                u += f.size[:, None] * (np.append(speed_rows, speed_rows[:, -1:], 1) / f.data["at"]) ** 2
            elif f.key == "scale_expansion":
                u = first_order(t_rows, u, 60 * f.size, u[:, 0]) if f.data["what"] == "lag" else u * np.exp(f.size)[:, None]
            elif f.key == "mount_shift":
                u += f.size[:, None] * (t_rows >= f.data["from_s"] - 1e-7)
        displacements[:, :, i] = u
    names = [n for n, _ in machine.sensors]
    for f in faults:
        if f.key == "sensor_swap":
            a, b = names.index(f.data["sensor"]), names.index(f.data["other"])
            temperatures[:, :, [a, b]] = temperatures[:, :, [b, a]]
    for f in faults:
        if f.key == "clock_offset":
            for v in range(n_var):
                at = np.clip(t_rows - 60 * f.size[v], t_rows[0], t_rows[-1])
                for a in (temperatures, displacements):
                    for i in range(a.shape[2]):
                        a[v, :, i] = np.interp(at, t_rows, a[v, :, i])
    return temperatures, displacements
