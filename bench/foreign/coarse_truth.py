"""The truth of the set `coarse`: bars and plates of finite volumes, with films that grow with the temperature difference, radiation, friction that falls as it warms, motors, circuits with a tank.

All in SI units, but degC, rpm and um. A place on a part is s, 0 to 1 along it.
"""
import copy

import numpy as np

SIGMA = 5.670374e-8
#             density, heat capacity, conductivity, expansion
MATERIALS = dict(steel=(7850, 470, 46, 11.5e-6), cast=(7200, 480, 48, 10.5e-6), alu=(2700, 900, 150, 23e-6), winding=(6500, 420, 30, 14e-6),
                 granite=(2850, 800, 3.0, 6.5e-6), mineral=(2400, 900, 2.2, 13e-6), wool=(300, 900, 0.25, 5e-6))


class Record:
    """What is known of a run: rows [s], speed [rpm], feeds [mm/min], power [W], columns, and the air at the recorder's height [degC]."""

    def __init__(self, name, t, speed, feed, power, air, grad):
        self.name, self.t, self.speed, self.feed, self.power, self.air, self.grad = name, t, speed, feed, power, air, grad
        self.column = np.zeros(len(t))
        self.start = None       # of each node, above its air


class Truth:
    def __init__(self, family, drive, hours):
        self.family, self.drive, self.hours = family, drive, hours
        self.cap, self.area, self.z, self.eps, self.h, self.wind, self.body, self.s, self.part_of = [], [], [], [], [], [], [], [], []
        self.parts, self.edges, self.joints, self.heats, self.circuits, self.sensors, self.displacements = {}, [], [], [], [], [], []
        self.more_film = []     # (nodes, factor, begin_s, end_s): of films for a while
        self.cold_air = []      # (nodes, K, begin_s, end_s)
        self.top, self.top_feed, self.top_power, self.wall_lag_s = 3000.0, 10000.0, 1000.0, 5400.0
        self.z_recorder = 1.2

    def node(self, part, body, cap, area, z, eps, h, wind, s):
        for x, v in ((self.cap, cap), (self.area, area), (self.z, z), (self.eps, eps), (self.h, h), (self.wind, wind), (self.body, body), (self.s, s), (self.part_of, part)):
            x.append(v)
        return len(self.cap) - 1

    def bar(self, name, length, section, perimeter, n, material="steel", z=(1.0, 1.0), eps=0.6, h=4.5, wind=0.0, bodies=None):
        """bodies: [(name, up to s)]: what the user's model has of it; default: one of the part's name."""
        rho, c, k, alpha = MATERIALS[material]
        dx = length / n
        idx = []
        for i in range(n):
            s = (i + 0.5) / n
            body = next(b for b, upto in (bodies or [(name, 1.0)]) if s <= upto)
            idx.append(self.node(name, body, rho * c * section * dx, perimeter * dx, z[0] + s * (z[1] - z[0]), eps, h, wind, s))
        self.edges += [(i, i + 1, k * section / dx) for i in idx[:-1]]
        self.parts[name] = dict(nodes=idx, length=length, kA=k * section, alpha=alpha, dx=np.full(n, dx))

    def plate(self, name, lx, ly, thick, nx, ny, material="alu", z=1.0, eps=0.4, h=5.0):
        rho, c, k, alpha = MATERIALS[material]
        idx = [self.node(name, name, rho * c * lx * ly * thick / nx / ny, 1.2 * lx * ly / nx / ny, z, eps, h, 0.0, (i + 0.5) / nx) for j in range(ny) for i in range(nx)]
        for j in range(ny):
            for i in range(nx):
                if i + 1 < nx:
                    self.edges.append((idx[j * nx + i], idx[j * nx + i + 1], k * thick * (ly / ny) / (lx / nx)))
                if j + 1 < ny:
                    self.edges.append((idx[j * nx + i], idx[(j + 1) * nx + i], k * thick * (lx / nx) / (ly / ny)))
        self.parts[name] = dict(nodes=idx, length=lx, kA=k * thick * ly, alpha=alpha, dx=np.full(nx * ny, lx / nx / ny))

    def at(self, part, s, width=0.0):
        idx = self.parts[part]["nodes"]
        near = [i for i in idx if abs(self.s[i] - s) <= width / 2]
        best = min(abs(self.s[i] - s) for i in idx)
        return near or [i for i in idx if abs(self.s[i] - s) <= best + 1e-9]

    def joint(self, a, sa, b, sb, g, wa=0.0, wb=0.0):
        na, nb = self.at(a, sa, wa), self.at(b, sb, wb)
        self.joints.append(dict(a=a, sa=sa, b=b, sb=sb, g=g, wa=wa, wb=wb, bodies=(self.body[na[len(na) // 2]], self.body[nb[len(nb) // 2]]), first=len(self.edges), n=len(na) * len(nb)))
        self.edges += [(i, j, g / len(na) / len(nb)) for i in na for j in nb]

    def heat(self, kind, part, s, width, share, exponent=1.0, decay=0.0, idle=0.0, by="speed"):
        nodes = self.at(part, s, width)
        self.heats.append(dict(kind=kind, nodes=nodes, body=self.body[nodes[len(nodes) // 2]], p=share, e=exponent, decay=decay, idle=idle, by=by, window=None))

    def circuit(self, part, s0, s1, flow, ha, set_point, volume=15.0):
        nodes = [i for i in self.parts[part]["nodes"] if s0 <= self.s[i] <= s1]
        tank = self.node("tank_" + part, None, volume * 4180.0, 0.4, 0.3, 0.5, 4.0, 0.0, 0.5)
        self.circuits.append(dict(nodes=nodes, tank=tank, flow=flow, ha=ha, set=set_point, body=self.body[nodes[len(nodes) // 2]], off=None))

    def grow(self, name, along, terms, bend=()):
        """terms: (part, sign, s0, s1); bend: (part, um/K of its ends' difference)."""
        w = {}
        for part, sign, s0, s1 in terms:
            p = self.parts[part]
            for i, dx in zip(p["nodes"], p["dx"]):
                if s0 <= self.s[i] <= s1:
                    w[i] = w.get(i, 0.0) + sign * p["alpha"] * dx * 1e6
        model = dict(w)
        for part, c in bend:
            idx = self.parts[part]["nodes"]
            w[idx[-1]] = w.get(idx[-1], 0.0) + c
            w[idx[0]] = w.get(idx[0], 0.0) - c
        self.displacements.append(dict(name=name, along=along, w=w, model=model))

    def copy(self):
        return copy.deepcopy(self)


def power_of(h, r, tm, t_s):
    """Heat and its derivative by the temperature where it arises; r: of the drive, 0 to 1."""
    if h["window"] and not any(a <= t_s < b for a, b in h["window"]):
        return 0.0, 0.0
    d = tm - 20.0
    if h["kind"] == "friction":
        q = h["p"] * r ** h["e"] * np.exp(-h["decay"] * d) if r > 0 else 0.0
        return q, -h["decay"] * q
    if h["kind"] == "motor":        # iron, and copper whose resistance grows
        iron, copper = h["p"] * (0.25 * r + 0.35 * r * r), (0.4 * h["p"] * (r > 0) * (0.5 + 0.5 * r) + h["idle"])
        return iron + copper * (1 + 0.0039 * d), 0.0039 * copper
    if h["kind"] == "heater":
        q = h["p"] * r
        return q * (1 - 0.0006 * d), -0.0006 * q
    if h["kind"] == "constant":
        return h["p"], 0.0
    if h["kind"] == "turning":
        return h["p"] * (r > 0), 0.0
    raise ValueError(h["kind"])


class Solver:
    def __init__(self, truth):
        self.t = t = truth
        self.n = n = len(t.cap)
        self.cap, self.area, self.z, self.eps, self.h, self.wind = (np.array(x, float) for x in (t.cap, t.area, t.z, t.eps, t.h, t.wind))
        k = np.zeros((n, n))
        for i, j, g in t.edges:
            k[i, i] -= g
            k[j, j] -= g
            k[i, j] += g
            k[j, i] += g
        self.k = k
        self.circ = []
        for c in t.circuits:
            m, b = np.zeros((n, n)), np.zeros(n)
            stream = c["flow"] / 60 * 4180.0
            e = 1 - np.exp(-c["ha"] / len(c["nodes"]) / stream)
            water = np.zeros(n)
            water[c["tank"]] = 1.0
            for i in c["nodes"]:
                into = -water.copy()
                into[i] += 1.0
                m[i] -= stream * e * into
                water = water + e * into
            m[c["tank"]] += stream * water
            m[c["tank"], c["tank"]] -= stream
            chill = 3.0 * stream
            m2, b2 = np.zeros((n, n)), np.zeros(n)
            m2[c["tank"], c["tank"]], b2[c["tank"]] = -chill, chill * (c["set"] + 0.4)
            self.circ.append((m + m2, b2, c))

    def inputs(self, rec, row):
        t = self.t
        return dict(speed=rec.speed[row] / t.top, feed=rec.feed[row] / t.top_feed, power=rec.power[row] / t.top_power, column=rec.column[row], one=1.0)

    def rates(self, temp, air, wall, u, t_s, jac=True):
        """Watts into each node and their derivative."""
        d = temp - air
        r = u["speed"]
        h, wind = self.h, self.wind
        film = self.area.copy()
        for nodes, f, a, b in self.t.more_film:
            if a <= t_s < b:
                film[nodes] *= f
        x = d * d + 0.25
        y = x ** 0.125 / 10 ** 0.25
        q = self.k @ temp - film * d * (h * y + wind * r ** 0.7) + self.area * self.eps * SIGMA * ((wall + 273.15) ** 4 - (temp + 273.15) ** 4)
        if jac:
            j = self.k.copy()
            j[np.diag_indices(self.n)] -= film * (h * (y + 0.25 * d * d * y / x) + wind * r ** 0.7) + 4 * self.area * self.eps * SIGMA * (temp + 273.15) ** 3
        for m, b, c in self.circ:
            if c["off"] and any(x0 <= t_s < x1 for x0, x1 in c["off"]):
                continue
            q = q + m @ temp + b
            if jac:
                j += m
        for s in self.t.heats:
            nodes = s["nodes"]
            p, dp = power_of(s, u[s["by"]], temp[nodes].mean(), t_s)
            q[nodes] += p / len(nodes)
            if jac and dp:
                j[np.ix_(nodes, nodes)] += dp / len(nodes) ** 2
        return (q, j) if jac else q

    def air_at(self, rec, t_s):
        t = self.t
        a = np.interp(t_s, rec.t, rec.air) + rec.grad * (self.z - t.z_recorder)
        for nodes, k, x0, x1 in t.cold_air:
            if x0 <= t_s < x1:
                a[nodes] += k
        return a

    def run(self, rec, h_max=30.0):
        """Temperatures of all nodes at the rows: ROS2, L-stable, finer after each change of the drive."""
        g = 1 - 1 / np.sqrt(2.0)
        temp = self.air_at(rec, -1.0) + (rec.start if rec.start is not None else 0.0)
        for c in self.t.circuits:
            temp[c["tank"]] = c["set"] + 0.4
        wall = rec.air[0]
        out = np.empty((len(rec.t), self.n))
        out[0] = temp
        last, eye = None, np.diag(self.cap)
        for row in range(len(rec.t) - 1):
            u = self.inputs(rec, row)
            t0, t1 = rec.t[row], rec.t[row + 1]
            n = int(np.ceil((t1 - t0) / h_max))
            parts = np.full(n, (t1 - t0) / n)
            key = tuple(u.values())
            if key != last:         # 1/8, 1/8, 1/4, 1/2 of the first step
                parts = np.concatenate([parts[0] * np.array([0.0625, 0.0625, 0.125, 0.25, 0.5]), parts[1:]])
            last, t_s = key, t0
            for dt in parts:
                wall += (np.interp(t_s + dt / 2, rec.t, rec.air) - wall) * -np.expm1(-dt / self.t.wall_lag_s)
                a0, a1 = self.air_at(rec, t_s), self.air_at(rec, t_s + dt * 0.999)
                f0, j = self.rates(temp, a0, wall, u, t_s)
                w = np.linalg.inv(eye - g * dt * j)
                k1 = w @ (f0 + g * (self.rates(temp, a1, wall, u, t_s, False) - f0))     # dt f_t is the air's alone
                f1 = self.rates(temp + dt * k1, a1, wall, u, t_s, False)
                k2 = w @ (f1 - g * (self.rates(temp, a1, wall, u, t_s, False) - f0) - 2 * self.cap * k1)
                temp = temp + dt * (1.5 * k1 + 0.5 * k2)
                t_s += dt
            out[row + 1] = temp
        return out


def readings(truth, rec, temp):
    """What thermometers and displacements read, without noise: (rows, sensors), (rows, displacements)."""
    dt = np.diff(rec.t)
    t = np.empty((len(rec.t), len(truth.sensors)))
    for j, s in enumerate(truth.sensors):
        x = temp[:, s["node"]]
        y = x[0]
        t[0, j] = y
        for k in range(1, len(x)):
            y += (x[k] - y) * -np.expm1(-dt[k - 1] / s["lag_s"])
            t[k, j] = y
        t[:, j] += s["bias"]
    u = np.empty((len(rec.t), len(truth.displacements)))
    for j, d in enumerate(truth.displacements):
        idx = list(d["w"])
        u[:, j] = (temp[:, idx] - 20.0) @ np.array([d["w"][i] for i in idx])
    return t, u
