#!/usr/bin/env python3
"""make_mesh.py NODES FOLDER [ORDER]: one mesh of tetrahedra for all programs.

FOLDER/mesh.msh for Driftwright, mesh.mesh (Medit; corners only, the program adds its own mid-side nodes) for FreeFEM,
mesh.inc for CalculiX, info.json with the data that the runs need. Sensors and tool point lie on nodes.
"""
import json
import os
import sys
import time

import gmsh
import numpy as np

import case

CUBES_PER_NODE = [(50_000, 0.98), (150_000, 0.86), (float("inf"), 0.70)]  # nodes come out within a few per cent


def build(size_m, n_wanted, order):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    occ = gmsh.model.occ
    column = occ.addBox(-0.2, 0, 0, 0.4, 0.5, 1.5)
    head = occ.addBox(-0.15, -0.6, 1.0, 0.3, 0.6, 0.4)
    front = occ.addCylinder(0, -0.4, 1.02, 0, 0, 0.08, 0.08)
    rear = occ.addCylinder(0, -0.4, 1.30, 0, 0, 0.08, 0.08)
    nose = occ.addCylinder(0, -0.4, 0.85, 0, 0, 0.15, 0.05)
    tip = occ.addPoint(*case.TIP_m)
    _, pieces = occ.fragment([(3, column)], [(3, head), (3, front), (3, rear), (3, nose), (0, tip)])
    occ.synchronize()
    volumes = {name: [tag for dim, tag in pieces[i] if dim == 3] for i, name in
               enumerate(("column", "head", "front_bearing", "rear_bearing", "nose"))}
    inner = volumes["front_bearing"] + volumes["rear_bearing"] + volumes["nose"]
    volumes["head"] = [v for v in volumes["head"] if v not in inner]
    boundary = [abs(tag) for _, tag in gmsh.model.getBoundary([(3, v) for vs in volumes.values() for v in vs],
                                                              combined=True, oriented=False)]
    bottom = [s for s in boundary if gmsh.model.getBoundingBox(2, s)[5] < 1e-3]
    surfaces = {"bottom": bottom, "exterior": [s for s in boundary if s not in bottom]}
    for dim, groups, numbers in ((3, volumes, case.REGIONS), (2, surfaces, case.SURFACES)):
        for name, tags in groups.items():
            gmsh.model.addPhysicalGroup(dim, tags, numbers[name])
            gmsh.model.setPhysicalName(dim, numbers[name], name)
    for key, value in (("MeshSizeMin", size_m), ("MeshSizeMax", size_m), ("MeshSizeFromCurvature", 0), ("Optimize", 1),
                       ("Algorithm3D", 10 if n_wanted > 150_000 else 1), ("SecondOrderLinear", 1), ("SaveAll", 0)):
        gmsh.option.setNumber("Mesh." + key, value)
    gmsh.model.mesh.generate(3)
    if order == 2:
        gmsh.model.mesh.setOrder(2)
    return volumes, surfaces


def elements(dim, groups, numbers, n_nodes):
    nodes, number = [], []
    for name, tags in groups.items():
        for tag in tags:
            for _, _, flat in zip(*gmsh.model.mesh.getElements(dim, tag)):
                nodes.append(flat.reshape(-1, n_nodes).astype(np.int64))
                number.append(np.full(len(nodes[-1]), numbers[name], np.int64))
    return np.vstack(nodes), np.concatenate(number)


def write_medit(path, x, cells, region, facets, surface):
    with open(path, "w") as file:
        file.write("MeshVersionFormatted 2\nDimension 3\nVertices\n%d\n" % len(x))
        np.savetxt(file, x, fmt="%.16g %.16g %.16g 0")
        file.write("Triangles\n%d\n" % len(facets))
        np.savetxt(file, np.column_stack([facets + 1, surface]), fmt="%d")
        file.write("Tetrahedra\n%d\n" % len(cells))
        np.savetxt(file, np.column_stack([cells + 1, region]), fmt="%d")
        file.write("End\n")


def write_calculix(path, x, cells, region, exterior, bottom_nodes, sensors, tip):
    def write_set(file, kind, name, ids):
        file.write("*%s, %s=%s\n" % (kind, kind, name))
        ids = np.asarray(ids) + 1
        file.write("\n".join(", ".join(map(str, ids[i:i + 12])) for i in range(0, len(ids), 12)) + "\n")

    faces = np.sort(np.stack([cells[:, f] for f in ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3))], 1).reshape(-1, 3), 1)
    key = lambda a: (a[:, 0] * len(x) + a[:, 1]) * len(x) + a[:, 2]
    outside = np.isin(key(faces), key(np.sort(exterior[:, :3], 1))).reshape(-1, 4)
    assert outside.sum() == len(exterior)
    with open(path, "w") as file:
        file.write("*NODE, NSET=NALL\n")
        # CalculiX cuts numbers after 20 characters and then stops at the rest.
        np.savetxt(file, np.column_stack([np.arange(1, len(x) + 1), x]), fmt="%d, %.12g, %.12g, %.12g")
        quadratic = cells.shape[1] == 10
        file.write("*ELEMENT, TYPE=%s, ELSET=EALL\n" % ("C3D10" if quadratic else "C3D4"))
        e = cells[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]] if quadratic else cells  # Gmsh lists the last two edges the other way
        np.savetxt(file, np.column_stack([np.arange(1, len(e) + 1), e + 1]), fmt="%d", delimiter=", ")
        write_set(file, "NSET", "NBOT", bottom_nodes)
        write_set(file, "NSET", "NSENS", sorted(set(sensors + [tip])))
        write_set(file, "NSET", "NTIP", [tip])
        write_set(file, "ELSET", "EFB", np.where(region == case.REGIONS["front_bearing"])[0])
        write_set(file, "ELSET", "ERB", np.where(region == case.REGIONS["rear_bearing"])[0])
        for k in range(4):
            write_set(file, "ELSET", "EF%d" % (k + 1), np.where(outside[:, k])[0])


def main():
    n_wanted, folder = int(sys.argv[1]), sys.argv[2]
    order = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    os.makedirs(folder, exist_ok=True)
    start = time.time()
    volume_m3 = 0.3 + 0.3 * 0.6 * 0.4
    per_node = next(factor for most, factor in CUBES_PER_NODE if n_wanted < most)
    size_m = (per_node * volume_m3 / n_wanted) ** (1 / 3) * order
    volumes, surfaces = build(size_m, n_wanted, order)
    gmsh.write(folder + "/mesh.msh")
    tags, flat, _ = gmsh.model.mesh.getNodes()
    position = np.zeros((int(tags.max()) + 1, 3))
    position[tags.astype(np.int64)] = flat.reshape(-1, 3)
    cells, region = elements(3, volumes, case.REGIONS, 4 if order == 1 else 10)
    facets, surface = elements(2, surfaces, case.SURFACES, 3 if order == 1 else 6)
    gmsh.finalize()

    used = np.unique(cells)
    number = np.full(len(position), -1, np.int64)
    number[used] = np.arange(len(used))
    x, cells, facets = position[used], number[cells], number[facets]
    corner = [x[cells[:, i]] for i in range(4)]
    volume = np.einsum("ij,ij->i", np.cross(corner[1] - corner[0], corner[2] - corner[0]), corner[3] - corner[0]) / 6
    assert volume.min() > 0

    corners = np.unique(cells[:, :4])
    nearest = lambda p: int(corners[np.argmin(((x[corners] - np.array(p)) ** 2).sum(1))])
    sensors, tip = [nearest(p) for p in case.SENSORS_m], nearest(case.TIP_m)
    renumbered = np.full(len(x), -1, np.int64)  # FreeFEM's vertices: the corners alone
    renumbered[corners] = np.arange(len(corners))
    write_medit(folder + "/mesh.mesh", x[corners], renumbered[cells[:, :4]], region, renumbered[facets[:, :3]], surface)
    write_calculix(folder + "/mesh.inc", x, cells, region, facets[surface == case.SURFACES["exterior"]],
                   np.unique(facets[surface == case.SURFACES["bottom"]]), sensors, tip)
    # Each point lies inside its region: a sensor on a face of two regions would belong to the first one.
    region_name = {v: k for k, v in case.REGIONS.items()}
    region_of = [region_name[int(region[np.where((cells == n).any(1))[0][0]])] for n in sensors + [tip]]
    with open(folder + "/info.json", "w") as file:
        json.dump({"n_nodes": len(x), "n_cells": len(cells), "order": order, "size_m": size_m,
                   "volume_m3": {name: float(volume[region == n].sum()) for name, n in case.REGIONS.items()},
                   "sensors": sensors, "tip": tip, "sensors_m": x[sensors].tolist(), "tip_m": x[tip].tolist(),
                   "vertex": [int(renumbered[n]) for n in sensors + [tip]], "regions": region_of,
                   "bottom_nodes": np.unique(facets[surface == case.SURFACES["bottom"]]).size}, file, indent=1)
    print("%s: %d nodes, %d tetrahedra of order %d, %.1f s" % (folder, len(x), len(cells), order, time.time() - start))


main()
