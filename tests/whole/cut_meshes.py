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
    if not found:
        raise Failed("a run has made no file")
    return [path.replace("_vertices", "") for path in found]


def check_tile(path, mesh, side):
    """The square of a tile has the centroids of all its simplices, and their vertices alone."""
    name = path.removeprefix("out/mesh_").rsplit(".", 1)[0]
    square = np.rint(np.array(name.split("_"), float) / side)
    if len(np.unique(mesh.simplices)) != len(mesh.vertices):
        raise Failed("a tile with vertices of other tiles", path)
    centroids = mesh.vertices[mesh.simplices][:, :, :2].mean(axis=1)
    slack = 1e-9 * side + 1e-15 * np.abs(centroids)
    low, high = np.floor((centroids - slack) / side), np.floor((centroids + slack) / side)
    if np.any(low > square) or np.any(high < square):
        raise Failed("a simplex of another square", path)


def together(case, meshes):
    """One mesh, with each vertex once."""
    vertices = np.vstack([mesh.vertices for mesh in meshes]) + 0.0
    firsts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    simplices = np.vstack([mesh.simplices + first for mesh, first in zip(meshes, firsts)])
    alone, first, number = np.unique(vertices, axis=0, return_index=True, return_inverse=True)
    number = number.reshape(-1)
    index = None
    if case.option("--id"):
        if any(mesh.index is None for mesh in meshes):
            raise Failed("no input index")
        index = np.concatenate([mesh.index for mesh in meshes])
        if np.any(index[first][number] != index):
            raise Failed("a vertex that has several input indices")
        index = index[first]
    return mesh_files.Mesh(alone, number[simplices], index)


def read(command, case):
    """The whole of the files."""
    tiles = case.option("--tiles")
    meshes = []
    for path in paths(case):
        mesh = mesh_files.read_mesh(command, path, case.form, case.dim)
        if len(np.unique(mesh.vertices, axis=0)) != len(mesh.vertices):
            raise Failed("a file that has a vertex twice", path)
        if tiles:
            check_tile(path, mesh, float(tiles[1]))
        meshes.append(mesh)
    if not tiles and len(meshes) != case.ranks:
        raise Failed("another number of parts", f"{len(meshes)}, not {case.ranks}")
    return together(case, meshes)
