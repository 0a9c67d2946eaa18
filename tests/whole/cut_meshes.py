"""Meshes in several files: tiles of a triangulation, and parts of ranks."""
import glob

import numpy as np

import mesh_files
from oracle import Failed

MOST_TILES = 6  # from side to side
IN_PARTS = {"spm", "ply", "vtu"}


def random_side(rng, case):
    """A side of tiles, or none where there would be too many, or where doubles do not tell them
    apart."""
    places = np.vstack([one.world()[:, :2] for one in case.inputs])
    side = float(np.max(np.ptp(places / 2, axis=0)) * 2 * rng.uniform(1 / MOST_TILES, 1.2))
    if not 1e-3 < side < 1e12 or np.max(np.abs(places)) > 1e9 * side:
        return None
    return side


def paths(case):
    """The files that a run has made, in the order of their names."""
    end = f"_vertices.{case.form}" if case.form == "npy" else f".{mesh_files.end_of(case.form)}"
    found = sorted(glob.glob(f"out/mesh*{end}"))
    return [path.replace("_vertices", "") for path in found]


def check_tile(path, mesh, side):
    """The square of a tile, which has the centroids of all its simplices."""
    centroids = mesh.vertices[mesh.simplices][:, :, :2].mean(axis=1)
    slack = 1e-9 * side + 1e-15 * np.abs(centroids)
    low = np.floor((centroids - slack) / side).max(axis=0)
    high = np.floor((centroids + slack) / side).min(axis=0)
    if np.any(low > high):
        raise Failed("simplices of several squares in a tile", path)
    return tuple(low)


def together(case, meshes):
    """One mesh, with each vertex once."""
    vertices = np.vstack([mesh.vertices for mesh in meshes]) + 0.0
    firsts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    simplices = np.vstack([mesh.simplices + first for mesh, first in zip(meshes, firsts)])
    alone, first, number = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    number = number.reshape(-1)
    index = None
    if case.option("--id"):
        index = np.concatenate([mesh.index for mesh in meshes])
        if np.any(index[first][number] != index):
            raise Failed("a vertex that has several input indices")
        index = index[first]
    return mesh_files.Mesh(alone, number[simplices], index)


def read(command, case):
    """The whole of the files."""
    meshes = []
    for path in paths(case):
        mesh = mesh_files.read_mesh(command, path, case.form, case.dim)
        if len(np.unique(mesh.vertices, axis=0)) != len(mesh.vertices):
            raise Failed("a file that has a vertex twice", path)
        meshes.append(mesh)
    tiles = case.option("--tiles")
    if tiles:
        squares = [check_tile(path, mesh, float(tiles[1])) for path, mesh in zip(paths(case), meshes)]
        if len(set(squares)) < len(squares):
            raise Failed("several tiles of one square", ", ".join(paths(case)))
    elif len(meshes) != max(1, case.ranks):
        raise Failed("another number of parts", ", ".join(paths(case)))
    return together(case, meshes)
