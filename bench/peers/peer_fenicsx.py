#!/usr/bin/env python3
"""peer_fenicsx.py FOLDER [--solver cholmod|mumps|multigrid] [--mechanics each_minute|influence|none] [--step SECONDS]
                   [--scheme BE|CN] [--ranks N] [--minutes N] [--name NAME] [--cap S]

FEniCSx (dolfinx 0.5.2 of Debian 12), order of the mesh. Solvers of PETSc as in its documentation, set up once for all steps:
  cholmod    Cholesky by CHOLMOD, on one rank; here the fastest
  mumps      Cholesky by MUMPS
  multigrid  conjugate gradients; hypre's BoomerAMG for heat, GAMG with rigid-body modes (demo_elasticity) for displacements
Displacements as in peer_freefem.py: one elastic solve a minute, or three adjoint solves before the run and dot products.
Forms are compiled on first use and kept in FOLDER/../fenicsx_cache; a run with --minutes 1 before the others does this.
"""
import argparse
import os
import shutil
import sys
import time

import case
import timed


def read_mesh(path):
    import gmsh
    from dolfinx.io import gmshio
    from mpi4py import MPI

    # gmshio.read_from_msh of 0.5.2 closes Gmsh before it reads the mesh; these are the calls that it should make.
    if MPI.COMM_WORLD.rank == 0:
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(path)
        gmsh.model.mesh.renumberNodes()
    mesh = gmshio.model_to_mesh(gmsh.model, MPI.COMM_WORLD, 0)
    if MPI.COMM_WORLD.rank == 0:
        gmsh.finalize()
    return mesh


def solver_of(matrix, prefix, options, multigrid):
    from petsc4py import PETSc

    direct = {"ksp_type": "preonly", "pc_type": "cholesky", "pc_factor_mat_solver_type": options.solver}
    iterative = {"ksp_type": "cg", "ksp_rtol": 1e-8, **multigrid}
    database = PETSc.Options()
    for key, value in (iterative if options.solver == "multigrid" else direct).items():
        database[prefix + key] = value
    matrix.setOption(PETSc.Mat.Option.SPD, True)
    solver = PETSc.KSP().create(matrix.comm)
    solver.setOptionsPrefix(prefix)
    solver.setOperators(matrix)
    solver.setFromOptions()
    solver.setInitialGuessNonzero(options.solver == "multigrid")
    solver.setErrorIfNotConverged(True)
    solver.setUp()
    return solver


def rigid_modes(W):
    from dolfinx import la
    from petsc4py import PETSc

    x = W.tabulate_dof_coordinates()
    modes = [la.create_petsc_vector(W.dofmap.index_map, W.dofmap.index_map_bs) for _ in range(6)]
    for i, mode in enumerate(modes):
        with mode.localForm() as local:
            u = local.array_w.reshape(-1, 3)
            u[:] = 0.0
            if i < 3:
                u[:, i] = 1.0
            else:
                j, k = (i - 2) % 3, (i - 1) % 3
                u[:, j], u[:, k] = -x[:, k], x[:, j]
    la.orthonormalize(modes)
    return PETSc.NullSpace().create(vectors=modes)


def solve(options):
    """The run itself, in a process of its own."""
    start = time.time()
    import numpy
    import ufl
    from dolfinx import fem
    from dolfinx.fem.petsc import assemble_matrix, assemble_vector, set_bc
    from mpi4py import MPI
    from petsc4py import PETSc

    comm = MPI.COMM_WORLD
    tell = lambda what: comm.rank == 0 and print("%8.2f s  %s" % (time.time() - start, what), flush=True)
    info = case.info(options.folder)
    order = info["order"]
    mesh, cells, facets = read_mesh(options.folder + "/mesh.msh")
    tell("mesh read")
    exact = {"quadrature_degree": 2 * order}
    dx = ufl.Measure("dx", domain=mesh, subdomain_data=cells, metadata=exact)
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=facets, metadata=exact)
    constant = lambda value: fem.Constant(mesh, PETSc.ScalarType(value))
    bottom = facets.indices[facets.values == case.SURFACES["bottom"]]

    V = fem.FunctionSpace(mesh, ("Lagrange", order))
    cold = fem.dirichletbc(PETSc.ScalarType(0), fem.locate_dofs_topological(V, 2, bottom), V)
    u, v = ufl.TrialFunction(V), ufl.TestFunction(V)
    theta = 1.0 if options.scheme == "BE" else 0.5
    capacity = constant(case.DENSITY_kg_m3 * case.CAPACITY_J_kgK / options.step)

    def operator(share):
        k, h = constant(share * case.CONDUCTIVITY_W_mK), constant(share * case.FILM_W_m2K)
        conduction = k * ufl.dot(ufl.grad(u), ufl.grad(v)) * dx
        return fem.form(capacity * u * v * dx + conduction + h * u * v * ds(case.SURFACES["exterior"]))

    source = {name: constant(power_W / info["volume_m3"][name]) for name, power_W in case.POWER_W.items()}
    A, B = assemble_matrix(operator(theta), bcs=[cold]), assemble_matrix(operator(theta - 1.0))
    A.assemble()
    B.assemble()
    F = assemble_vector(fem.form(sum(q * v * dx(case.REGIONS[name]) for name, q in source.items())))
    F.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
    tell("heat assembled, %d unknowns" % V.dofmap.index_map.size_global)
    heat = solver_of(A, "heat_", options, {"pc_type": "hypre"})
    tell("heat set up")

    def dof_at(space, point):
        """The unknown at a node, or None on the ranks that do not own it."""
        x = space.tabulate_dof_coordinates()[:space.dofmap.index_map.size_local]
        distance2 = ((x - point) ** 2).sum(axis=1)
        nearest = int(distance2.argmin()) if len(x) else -1
        return nearest if nearest >= 0 and distance2[nearest] < 1e-16 else None

    probes = [dof_at(V, p) for p in info["sensors_m"]]
    if options.mechanics != "none":
        W = fem.VectorFunctionSpace(mesh, ("Lagrange", order))
        clamp = fem.dirichletbc(PETSc.ScalarType((0, 0, 0)), fem.locate_dofs_topological(W, 2, bottom), W)
        w, y = ufl.TrialFunction(W), ufl.TestFunction(W)
        E, nu = case.YOUNGS_MODULUS_Pa, case.POISSON_RATIO
        lame, mu = constant(E * nu / ((1 + nu) * (1 - 2 * nu))), constant(E / (2 * (1 + nu)))
        expansion = constant(E / (1 - 2 * nu) * case.EXPANSION_1_K)
        strain = lambda a: ufl.sym(ufl.grad(a))
        work = 2 * mu * ufl.inner(strain(w), strain(y)) + lame * ufl.div(w) * ufl.div(y)
        K = assemble_matrix(fem.form(work * dx), bcs=[clamp])
        L = assemble_matrix(fem.form(expansion * u * ufl.div(y) * dx))
        K.assemble()
        L.assemble()
        if options.solver == "multigrid":
            K.setNearNullSpace(rigid_modes(W))
        tell("elasticity assembled, %d unknowns" % (3 * W.dofmap.index_map.size_global))
        elastic = solver_of(K, "elastic_", options, {"pc_type": "gamg", "mg_levels_ksp_type": "chebyshev",
                                                     "mg_levels_pc_type": "jacobi",
                                                     "mg_levels_ksp_chebyshev_esteig_steps": 10})
        tell("elasticity set up")
        tip = dof_at(W, info["tip_m"])
        displacement, load = K.createVecRight(), K.createVecLeft()
        if options.mechanics == "influence":
            influence = []
            for axis in range(3):
                load.set(0.0)
                displacement.set(0.0)
                if tip is not None:
                    load.array[3 * tip + axis] = 1.0
                elastic.solve(load, displacement)
                influence.append(L.createVecRight())
                L.multTranspose(displacement, influence[-1])
            tell("influence vectors")
            displacement.set(0.0)

    T, b = A.createVecRight(), A.createVecLeft()
    T.set(0.0)
    minute = 0
    with open(options.folder + "/" + options.name + ".csv" if comm.rank == 0 else os.devnull, "w") as file:
        for duration, ratio in case.CYCLOGRAM:
            power = ratio ** case.EXPONENT
            for _ in range(min(duration, options.minutes - minute)):
                for _ in range(round(60 / options.step)):
                    B.mult(T, b)
                    b.axpy(power, F)
                    set_bc(b, [cold])
                    heat.solve(b, T)
                here = T.array_r
                values = [0.0 if i is None else here[i] for i in probes]
                if options.mechanics == "each_minute":
                    L.mult(T, load)
                    set_bc(load, [clamp])
                    elastic.solve(load, displacement)
                    values += [0.0 if tip is None else 1e6 * displacement.array_r[3 * tip + axis] for axis in range(3)]
                values = comm.reduce(numpy.array(values), root=0)
                if options.mechanics == "influence":
                    moved = [1e6 * g.dot(T) for g in influence]
                    values = None if values is None else list(values) + moved
                minute += 1
                if comm.rank == 0:
                    file.write(",".join("%.9g" % x for x in [minute, *values]) + "\n")
                    file.flush()
    tell("%d minutes" % minute)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("folder")
    arguments.add_argument("--solver", default="cholmod", choices=["cholmod", "mumps", "multigrid"])
    arguments.add_argument("--mechanics", default="each_minute", choices=["each_minute", "influence", "none"])
    arguments.add_argument("--step", type=float, default=15.0)
    arguments.add_argument("--scheme", default="BE", choices=["BE", "CN"])
    arguments.add_argument("--ranks", type=int, default=1)
    n_all = sum(minutes for minutes, _ in case.CYCLOGRAM)
    arguments.add_argument("--minutes", type=int, default=n_all)
    arguments.add_argument("--name", default="fenicsx")
    arguments.add_argument("--cap", type=float, default=3600.0)
    arguments.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    options = arguments.parse_args()
    if options.inside:
        return solve(options)
    base = options.folder + "/" + options.name
    if os.path.exists(base + ".csv"):  # or a run that fails would show what an earlier one left
        os.remove(base + ".csv")
    command = [sys.executable] + sys.argv + ["--inside"]
    environment = {"OMP_NUM_THREADS": "1", "XDG_CACHE_HOME": os.path.abspath(options.folder + "/../fenicsx_cache")}
    if options.ranks > 1:
        command = [shutil.which("mpirun"), "-n", str(options.ranks)] + command
        if os.geteuid() == 0:
            environment.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    outcome = timed.run(command, base + ".log", options.cap, environment)
    n = sum(1 for _ in open(base + ".csv")) if os.path.exists(base + ".csv") else 0
    note = "" if n == options.minutes else "ended after %d of %d minutes; see its log" % (n, options.minutes)
    if options.minutes < n_all:
        note += "%d of %d minutes" % (options.minutes, n_all)
    timed.report(options.folder, options.name, outcome, n, note)


main()
