#!/usr/bin/env python3
"""peer_freefem.py FOLDER [--step SECONDS] [--scheme BE|CN] [--mechanics each_minute|influence|none] [--name NAME] [--cap S]

FreeFEM, P1 or P2 as the mesh is: heat with one factor (CHOLMOD) for all steps; displacements by one elastic solve a minute with
the factor kept (each_minute), or by three adjoint solves before the run and dot products (influence), as Driftwright does it.
"""
import argparse
import os
import shutil

import case
import timed

ELASTICITY = """
fespace Wh(Th, [P{order}, P{order}, P{order}]);
macro div(a) (dx(a#x) + dy(a#y) + dz(a#z)) //
macro eps(a) [dx(a#x), dy(a#y), dz(a#z), (dz(a#y) + dy(a#z)) / sqrt(2.), (dz(a#x) + dx(a#z)) / sqrt(2.), (dy(a#x) + dx(a#y)) / sqrt(2.)] //
varf vE([ux, uy, uz], [wx, wy, wz]) = int3d(Th)(lambda * div(u) * div(w) + 2. * mu * (eps(u)' * eps(w))) + on({bottom}, ux = 0, uy = 0, uz = 0);
varf vL([Tt], [wx, wy, wz]) = int3d(Th)((3 * lambda + 2 * mu) * alpha * Tt * div(w));
varf vEb([ux, uy, uz], [wx, wy, wz]) = on({bottom}, ux = 1, uy = 1, uz = 1);
matrix AE = vE(Wh, Wh, tgv = 1e30, sym = 1, positive = 1, solver = "CHOLMOD");
matrix BL = vL(Vh, Wh);
real[int] be = vEb(0, Wh, tgv = 1);
Wh [sx, sy, sz];
real[int] re(Wh.ndof);
cout << "elasticity assembled " << clock() - t0 << " ndof " << Wh.ndof << endl;
"""

# The tip is a vertex. A component of its displacement is read by the vector that is 1 at one unknown.
INFLUENCE = """
real[int,int] G(3, Vh.ndof);
Vh chi = 0;
for (int k = 0, found = 0; k < Th.nt && !found; k++)
  for (int j = 0; j < 4; j++)
    if (Th[k][j] == {tip}) {{ chi[][Vh(k, j)] = 1; found = 1; }}
Wh [lx, ly, lz];
for (int i = 0; i < 3; i++) {{
  [lx, ly, lz] = [chi * (i == 0), chi * (i == 1), chi * (i == 2)];
  sx[] = AE^-1 * lx[];
  real[int] g = BL' * sx[];
  for (int j = 0; j < Vh.ndof; j++) G(i, j) = g[j];
}}
cout << "influence " << clock() - t0 << endl;
"""

HEAT = """
verbosity = 0;
real t0 = clock();
mesh3 Th = readmesh3("{folder}/mesh.mesh");
fespace Vh(Th, P{order});
fespace Ph(Th, P0);
real dt = {step}, k = {k}, rc = {rc}, h = {h}, E = {E}, nu = {nu}, alpha = {alpha};
real lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
Ph q = {front} * (region == {front_number}) + {rear} * (region == {rear_number});
Vh u, v;
varf vA(u, v) = int3d(Th)({theta} * k * (dx(u) * dx(v) + dy(u) * dy(v) + dz(u) * dz(v)) + rc / dt * u * v)
              + int2d(Th, {exterior})({theta} * h * u * v) + on({bottom}, u = 0);
varf vB(u, v) = int3d(Th)(rc / dt * u * v - {rest} * k * (dx(u) * dx(v) + dy(u) * dy(v) + dz(u) * dz(v)))
              - int2d(Th, {exterior})({rest} * h * u * v);
varf vF(u, v) = int3d(Th)(q * v);
varf vBC(u, v) = on({bottom}, u = 1);
// Without sym and positive FreeFEM 4.11's CHOLMOD returns wrong temperatures with exit code 0.
matrix A = vA(Vh, Vh, tgv = 1e30, sym = 1, positive = 1, solver = "CHOLMOD");
matrix B = vB(Vh, Vh);
real[int] F = vF(0, Vh);
real[int] bc = vBC(0, Vh, tgv = 1);
cout << "heat assembled " << clock() - t0 << " ndof " << Vh.ndof << endl;
Vh T = 0;
real[int] b(Vh.ndof);
"""

LOOP = """
real[int,int] P({n_points}, 3);
{points}
int[int] probe = {vertices};
real[int] duration = {durations}, ratio = {ratios};
ofstream o("{out}");
o.precision(9);
real minute = 0, heating = 0, reading = 0;
for (int s = 0; s < duration.n; s++) {{
  real f = ratio[s]^{exponent};
  for (int m = 0; m < duration[s]; m++) {{
    real c0 = clock();
    for (int j = 0; j < {steps_a_minute}; j++) {{
      b = B * T[]; b += f * F;
      for (int i = 0; i < b.n; i++) if (bc[i] > 0.5) b[i] = 0;
      T[] = A^-1 * b;
    }}
    heating += clock() - c0; c0 = clock();
    minute += 1;
    o << minute;
    for (int i = 0; i < {n_sensors}; i++) o << "," << {reading};
{displacement}
    reading += clock() - c0;
    o << endl;
  }}
}}
cout << "end " << clock() - t0 << " heat " << heating << " readings " << reading << endl;
"""

EACH_MINUTE = """    re = BL * T[];
    for (int i = 0; i < re.n; i++) if (be[i] > 0.5) re[i] = 0;
    sx[] = AE^-1 * re;
    o << "," << 1e6 * sx(P({i}, 0), P({i}, 1), P({i}, 2)) << "," << 1e6 * sy(P({i}, 0), P({i}, 1), P({i}, 2)) << "," << 1e6 * sz(P({i}, 0), P({i}, 1), P({i}, 2));"""
DOT_PRODUCTS = """    for (int i = 0; i < 3; i++) { real d = 0; for (int j = 0; j < Vh.ndof; j++) d += G(i, j) * T[][j]; o << "," << 1e6 * d; }"""


def program(info, options, out):
    order, points = info["order"], info["sensors_m"] + [info["tip_m"]]
    theta = 1.0 if options.scheme == "BE" else 0.5
    given = {"folder": options.folder, "order": order, "step": options.step, "theta": theta, "rest": 1 - theta,
             "k": case.CONDUCTIVITY_W_mK, "rc": case.DENSITY_kg_m3 * case.CAPACITY_J_kgK, "h": case.FILM_W_m2K,
             "E": case.YOUNGS_MODULUS_Pa, "nu": case.POISSON_RATIO, "alpha": case.EXPANSION_1_K,
             "front": case.POWER_W["front_bearing"] / info["volume_m3"]["front_bearing"],
             "rear": case.POWER_W["rear_bearing"] / info["volume_m3"]["rear_bearing"],
             "front_number": case.REGIONS["front_bearing"], "rear_number": case.REGIONS["rear_bearing"], **case.SURFACES,
             "n_points": len(points), "n_sensors": len(case.SENSORS_m), "vertices": info["vertex"], "tip": info["vertex"][-1],
             "points": " ".join("P(%d, %d) = %.16g;" % (i, j, x) for i, p in enumerate(points) for j, x in enumerate(p)),
             "durations": "[%s]" % ", ".join(str(d) for d, _ in case.CYCLOGRAM),
             "ratios": "[%s]" % ", ".join(str(r) for _, r in case.CYCLOGRAM), "exponent": case.EXPONENT,
             "steps_a_minute": round(60 / options.step), "out": out,
             "reading": "T[][probe[i]]" if order == 1 else "T(P(i, 0), P(i, 1), P(i, 2))",
             "displacement": {"each_minute": EACH_MINUTE.format(i=len(points) - 1), "influence": DOT_PRODUCTS,
                              "none": ""}[options.mechanics]}
    text = HEAT.format(**given)
    if options.mechanics != "none":
        text += ELASTICITY.format(**given)
    if options.mechanics == "influence":
        text += INFLUENCE.format(**given)
    return text + LOOP.format(**given)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("folder")
    arguments.add_argument("--step", type=float, default=15.0)
    arguments.add_argument("--scheme", default="BE", choices=["BE", "CN"])
    arguments.add_argument("--mechanics", default="each_minute", choices=["each_minute", "influence", "none"])
    arguments.add_argument("--name", default="freefem")
    arguments.add_argument("--cap", type=float, default=3600.0)
    options = arguments.parse_args()
    base = options.folder + "/" + options.name
    if os.path.exists(base + ".csv"):  # or a run that fails would show what an earlier one left
        os.remove(base + ".csv")
    with open(base + ".edp", "w") as file:
        file.write(program(case.info(options.folder), options, base + ".csv"))
    outcome = timed.run([shutil.which("FreeFem++"), "-nw", "-v", "0", base + ".edp"], base + ".log", options.cap,
                        {"FF_LOADPATH": "/usr/lib/freefem++"})
    n = sum(1 for _ in open(base + ".csv")) if os.path.exists(base + ".csv") else 0
    n_all = sum(minutes for minutes, _ in case.CYCLOGRAM)
    timed.report(options.folder, options.name, outcome, n, "" if n == n_all else "ended after %d of %d minutes; see its log" % (n, n_all))


main()
