"""A feed axis with a ball screw, computed by itself: finite volumes along the rod that are a fifth of the program's, lumped
bodies beside it, steps of TR-BDF2 in time, the growth by trapezoids. It shares no code with the program. It reads the numbers of
scenarios/ball_screw.yaml from a dictionary of its own, scatters them and hides a fault in them."""

import numpy as np

AMBIENT = "ambient"
NOMINAL = dict(
    capacity=dict(x_nut=2.6e3, slide=60e3, x_fixed=3.3e3, x_far=1.2e3, x_motor=4.5e3, bed=300e3, x_scale=0.9e3),  # J/K
    link={("x_nut", "slide"): 9.0, ("slide", AMBIENT): 9.0, ("slide", "bed"): 6.0, ("x_fixed", "bed"): 12.0, ("x_far", "bed"): 8.0,
          ("x_motor", "x_fixed"): 2.0, ("x_motor", AMBIENT): 1.5, ("x_scale", "bed"): 1.5, ("x_scale", AMBIENT): 0.8,
          ("bed", AMBIENT): 25.0},  # W/K
    torque=1.2, thrust=300.0, film=6.0, film_growth=1.0, f0=2.0, f1=0.001, servo=45.0, idle=5.0, scale_expansion=8e-6, slide_um_K=0.3)
TRAVEL, FIXED_GAP, FAR_GAP, NUT = 0.8, 0.14, 0.16, 0.12  # m
DIAMETER, LEAD, EXPANSION, CONDUCTIVITY, HEAT_CAPACITY = 0.038, 0.02, 11.9e-6, 42.0, 7810.0 * 470.0
SHARE, NUT_W_K, FIXED_W_K, FAR_W_K, EFFICIENCY = 0.5, 4.0, 3.0, 1.5, 0.9
CELLS = 140
PLACES_MM = (0.0, 400.0, 800.0)


def scattered(rng, share=0.1):
    """The numbers that a scenario knows roughly, each times exp(share z); bodies and links too."""
    draw = lambda v: v * float(np.exp(share * np.clip(rng.standard_normal(), -3, 3)))
    return {k: {n: draw(v) for n, v in of.items()} if isinstance(of, dict) else draw(of) for k, of in NOMINAL.items()}


def smeared(centre_m, stroke_m, faces_m):
    """Share of each cell in the nut's heat, the nut's length spread over the stroke: by many places of the nut."""
    places = centre_m + stroke_m * (np.arange(400) + 0.5 - 200) / 400 if stroke_m > 0 else np.array([centre_m])
    below = np.clip((faces_m[:, None] - places[None, :]) / NUT + 0.5, 0, 1).mean(axis=1)
    below[0], below[-1] = 0.0, 1.0
    return np.diff(below)


class Axis:
    """The machine at its numbers, with a fault. `extra`: {body: function(feed m/s, position mm, time s) -> W}"""

    def __init__(self, numbers, extra=None, fixed_at_mm=400.0, friction=1.0):
        self.n, self.extra, self.fixed_at_mm, self.friction = numbers, extra or {}, fixed_at_mm, friction
        self.bodies = list(numbers["capacity"])
        self.length = FIXED_GAP + TRAVEL + FAR_GAP
        self.faces = np.linspace(0, self.length, CELLS + 1)
        self.cell = self.length / CELLS
        self.area = np.pi * DIAMETER ** 2 / 4
        self.size = CELLS + len(self.bodies)
        self.c = np.concatenate([np.full(CELLS, HEAT_CAPACITY * self.area * self.cell), [numbers["capacity"][b] for b in self.bodies]])

    def at(self, body):
        return CELLS + self.bodies.index(body)

    def matrices(self, feed, position_mm, stroke_mm):
        """Conductances K, those to the ambient, and the heat, at a row of the drive: C T' = -K T + a T_ambient + q."""
        n, k, a, q = self.n, np.zeros((self.size, self.size)), np.zeros(self.size), np.zeros(self.size)

        def join(i, j, g):
            k[i, i] += g
            if j is None:
                a[i] += g
                return
            k[j, j] += g
            k[i, j] -= g
            k[j, i] -= g

        for (one, other), g in n["link"].items():
            join(self.at(one), None if other == AMBIENT else self.at(other), g)
        along = CONDUCTIVITY * self.area / self.cell
        for i in range(CELLS - 1):
            join(i, i + 1, along)
        end = lambda g: 1.0 / (1.0 / g + 0.5 / along)  # half a cell between its middle and the end
        join(0, self.at("x_fixed"), end(FIXED_W_K))
        join(CELLS - 1, self.at("x_far"), end(FAR_W_K))
        turns_s = feed / LEAD
        reynolds = np.pi * DIAMETER * turns_s * DIAMETER / 15.9e-6
        film = n["film"] + n["film_growth"] * 0.133 * reynolds ** (2 / 3) * 0.71 ** (1 / 3) * 0.026 / DIAMETER
        share = smeared(FIXED_GAP + position_mm / 1e3, stroke_mm / 1e3, self.faces)
        for i in range(CELLS):
            join(i, None, film * np.pi * DIAMETER * self.cell)
            if share[i] > 0:
                join(i, self.at("x_nut"), NUT_W_K * share[i])
        friction = self.friction * 2 * np.pi * n["torque"] * turns_s + n["thrust"] * feed * (1 / EFFICIENCY - 1)
        q[:CELLS] += SHARE * friction * share
        q[self.at("x_nut")] += (1 - SHARE) * friction
        rpm = 60 * turns_s
        if rpm > 0:
            viscous = n["f0"] * 1e-7 * max(2000.0, 30.0 * rpm) ** (2 / 3) * 46.0 ** 3 if 30 * rpm >= 2000 else n["f0"] * 160e-7 * 46.0 ** 3
            q[self.at("x_fixed")] += 2 * (viscous + n["f1"] * 4300.0 * 46.0) * 1e-3 * 2 * np.pi * turns_s
        q[self.at("x_motor")] += n["idle"] + n["servo"] * feed / 0.25
        return k, a, q

    def run(self, drive, ambient, row_s=60.0, steps=4):
        """drive: rows (seconds, feed m/s, position mm, stroke mm). ambient: function of time, degC.
        -> times, temperatures of the bodies (dict) and readings of the axis (dict), um."""
        times, rows = [0.0], []
        for seconds, *state in drive:
            count = int(round(seconds / row_s))
            times += [times[-1] + row_s * (i + 1) for i in range(count)]
            rows += [tuple(state)] * count
        t = np.full(self.size, ambient(0.0))
        out, gamma = [t.copy()], 2 - np.sqrt(2)
        h = row_s / steps
        known, held = None, None
        for i, state in enumerate(rows):
            if state != known:
                k, a, q0 = self.matrices(*state)
                known = state
                left = np.linalg.inv(np.diag(self.c) + 0.5 * gamma * h * k)
            for s in range(steps):  # TR-BDF2 (Bank et al. 1985)
                now = times[i] + s * h

                def heat(at_s):
                    q = q0 + a * ambient(at_s)
                    for body, law in self.extra.items():
                        q[self.at(body)] += law(state[0], state[1], at_s)
                    return q
                first = left @ (self.c * t + 0.5 * gamma * h * (heat(now) - k @ t + heat(now + gamma * h)))
                t = left @ (self.c * (first / (gamma * (2 - gamma)) - t * (1 - gamma) ** 2 / (gamma * (2 - gamma)))
                            + (1 - gamma) / (2 - gamma) * h * heat(now + h))
            out.append(t.copy())
        out, rows = np.array(out), rows + [rows[-1]]
        warm = {b: out[:, self.at(b)] for b in self.bodies}
        grown = np.concatenate([np.zeros((len(out), 1)), np.cumsum(EXPANSION * self.cell * (out[:, :CELLS] - 20.0), axis=1)], axis=1)
        at = lambda mm: np.array([np.interp(FIXED_GAP + p / 1e3, self.faces, g) for p, g in zip(mm, grown)]) * 1e6
        position = np.array([r[1] for r in rows])
        read = {"x_%g" % mm: at(np.full(len(out), mm)) for mm in PLACES_MM}
        read["x_at_nut"] = at(position)
        read["x_by_scale"] = (self.n["slide_um_K"] * (warm["slide"] - 20.0)
                              + 1e3 * self.n["scale_expansion"] * (warm["x_scale"] - 20.0) * (position - self.fixed_at_mm))
        return np.array(times), rows, warm, read


def write_record(path, axis, drive, ambient, rng, noise_K=0.05, noise_um=1.0, row_s=120.0):
    """A record as a logger writes it, with white noise."""
    times, rows, warm, read = axis.run(drive, ambient, row_s)
    sensors = dict(t_nut="x_nut", t_fixed="x_fixed", t_far="x_far", t_motor="x_motor", t_bed="bed")  # none on the turning screw
    columns = {k + "_degC": warm[v] + noise_K * rng.standard_normal(len(times)) for k, v in sensors.items()}
    columns.update({k + "_um": v + noise_um * rng.standard_normal(len(times)) for k, v in read.items()})
    with open(path, "w") as f:
        f.write("time_s,speed_rpm,feed_x_mm_min,position_x_mm,stroke_x_mm,ambient_degC,%s\n" % ",".join(columns))
        for i, time in enumerate(times):
            feed, position, stroke = rows[i]
            f.write("%.0f,0,%.6g,%.6g,%.6g,%.3f,%s\n" % (time, feed * 6e4, position, stroke, ambient(time),
                                                         ",".join("%.4f" % v[i] for v in columns.values())))
