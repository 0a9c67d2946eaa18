"""Ways to damage a mesh: each changes the arrays that it is given."""
import collections

import numpy as np

import oracle


def some_row(rng, mesh):
    return int(rng.integers(0, len(mesh.simplices)))


def lost_simplex(rng, mesh, dim):
    mesh.simplices = np.delete(mesh.simplices, some_row(rng, mesh), axis=0)


def lost_hull_simplex(rng, mesh, dim):
    rows, count = oracle.facets(mesh.simplices)
    outer = {tuple(row) for row in rows[count == 1].tolist()}
    at_hull = [number for number, simplex in enumerate(mesh.simplices.tolist())
               if any(tuple(sorted(simplex[:i] + simplex[i + 1:])) in outer for i in range(dim + 1))]
    mesh.simplices = np.delete(mesh.simplices, rng.choice(at_hull), axis=0)


def double_simplex(rng, mesh, dim):
    row = np.roll(mesh.simplices[some_row(rng, mesh)], 0 if dim == 3 else rng.integers(0, 3))
    mesh.simplices = np.insert(mesh.simplices, rng.integers(0, len(mesh.simplices) + 1), row, axis=0)


def turned_simplex(rng, mesh, dim):
    """The wrong orientation."""
    row = mesh.simplices[some_row(rng, mesh)]
    row[[0, 1]] = row[[1, 0]]


def all_turned(rng, mesh, dim):
    mesh.simplices[:, [0, 1]] = mesh.simplices[:, [1, 0]]


def other_corner(rng, mesh, dim):
    mesh.simplices[some_row(rng, mesh), rng.integers(0, dim + 1)] = rng.integers(0, len(mesh.vertices))


def no_such_vertex(rng, mesh, dim):
    mesh.simplices[some_row(rng, mesh), rng.integers(0, dim + 1)] = len(mesh.vertices)


def swapped_vertices(rng, mesh, dim):
    """Two vertices change places: of the simplices that have them, most are turned."""
    a, b = rng.integers(0, len(mesh.vertices), 2)
    if rng.random() < 0.5:
        a, b = mesh.simplices[some_row(rng, mesh)][:2]
    mesh.vertices[[a, b]] = mesh.vertices[[b, a]]


def moved_vertex(rng, mesh, dim):
    """By anything from the last place to the whole extent."""
    vertex = rng.integers(0, len(mesh.vertices))
    axis = rng.integers(0, dim)
    if rng.random() < 0.3:
        for _ in range(rng.integers(1, 4)):
            mesh.vertices[vertex, axis] = np.nextafter(mesh.vertices[vertex, axis], np.inf)
    else:
        extent = np.ptp(mesh.vertices[:, axis])
        mesh.vertices[vertex, axis] += rng.normal() * extent * 10.0 ** -rng.integers(0, 12)


def not_finite(rng, mesh, dim):
    mesh.vertices[rng.integers(0, len(mesh.vertices)), rng.integers(0, dim)] = rng.choice([np.nan, np.inf])


def merged_vertices(rng, mesh, dim):
    """All simplices of one vertex have another one in its place."""
    a, b = mesh.simplices[some_row(rng, mesh)][:2]
    mesh.simplices[mesh.simplices == a] = b
    if rng.random() < 0.5:  # and those that have no size any more are gone
        mesh.simplices = np.array([row for row in mesh.simplices if len(set(row)) == dim + 1],
                                  np.int64).reshape(-1, dim + 1)
    if rng.random() < 0.5:
        mesh.vertices = np.delete(mesh.vertices, a, axis=0)
        mesh.simplices[mesh.simplices > a] -= 1


def equal_vertices(rng, mesh, dim):
    """A vertex is there twice; one of its simplices has the other."""
    row = some_row(rng, mesh)
    corner = rng.integers(0, dim + 1)
    mesh.vertices = np.vstack([mesh.vertices, mesh.vertices[mesh.simplices[row, corner]]])
    mesh.simplices[row, corner] = len(mesh.vertices) - 1


def point_without_simplex(rng, mesh, dim):
    """A vertex that is used by none: inside of a simplex, or anywhere."""
    corners = mesh.vertices[mesh.simplices[some_row(rng, mesh)]]
    point = corners.mean(axis=0) if rng.random() < 0.7 else 3 * corners[0] - 2 * corners[1]
    mesh.vertices = np.vstack([mesh.vertices, point])


def split_simplex(rng, mesh, dim):
    """A new vertex inside of a simplex, joined with its corners alone: often not Delaunay."""
    row = some_row(rng, mesh)
    simplex = mesh.simplices[row]
    weights = rng.random(dim + 1)
    point = (mesh.vertices[simplex] * (weights / weights.sum())[:, None]).sum(axis=0)
    mesh.vertices = np.vstack([mesh.vertices, point])
    parts = np.repeat(simplex[None], dim + 1, axis=0)
    parts[np.arange(dim + 1), np.arange(dim + 1)] = len(mesh.vertices) - 1
    mesh.simplices = np.vstack([np.delete(mesh.simplices, row, axis=0), parts])


def flipped(rng, mesh, dim):
    """The other diagonal of two triangles; in space three tetrahedra in place of two."""
    sharing = collections.defaultdict(list)
    for number, simplex in enumerate(mesh.simplices.tolist()):
        for corner in range(dim + 1):
            facet = tuple(sorted(simplex[:corner] + simplex[corner + 1:]))
            sharing[facet].append((number, simplex[corner]))
    inner = [facet for facet, two in sharing.items() if len(two) == 2]
    if not inner:
        return
    facet = inner[rng.integers(0, len(inner))]
    (one, a), (other, b) = sharing[facet]
    new = [[a, b, *[v for v in facet if v != left]] for left in facet]
    if dim == 2:
        new = [[a, b, v] for v in facet]
    new = [oriented(mesh, row) for row in new]
    mesh.simplices = np.vstack([np.delete(mesh.simplices, [one, other], axis=0), new])


def oriented(mesh, row):
    dim = len(row) - 1
    if oracle.exact_orientation(mesh.vertices[row][:, :dim]) < 0:
        row[0], row[1] = row[1], row[0]
    return row


def cut_out_vertex(rng, mesh, dim):
    """All simplices of a vertex, and the vertex: a hole, or a notch in the hull."""
    vertex = int(rng.integers(0, len(mesh.vertices)))
    mesh.simplices = mesh.simplices[~np.any(mesh.simplices == vertex, axis=1)]
    mesh.simplices[mesh.simplices > vertex] -= 1
    mesh.vertices = np.delete(mesh.vertices, vertex, axis=0)


def two_meshes(rng, mesh, dim):
    """A moved copy beside it: each is right, both are not."""
    copy = mesh.vertices + (3 * np.ptp(mesh.vertices, axis=0) + 1) * rng.choice([0.01, 1])
    mesh.simplices = np.vstack([mesh.simplices, mesh.simplices + len(mesh.vertices)])
    mesh.vertices = np.vstack([mesh.vertices, copy])


def shuffled(rng, mesh, dim):
    """Another order of vertices and simplices, which leaves the mesh right."""
    order = rng.permutation(len(mesh.vertices))
    place = np.argsort(order)
    mesh.vertices = mesh.vertices[order]
    mesh.simplices = place[mesh.simplices][rng.permutation(len(mesh.simplices))]


MUTATIONS = [lost_simplex, lost_hull_simplex, double_simplex, turned_simplex, all_turned, other_corner,
             no_such_vertex, swapped_vertices, moved_vertex, moved_vertex, not_finite, merged_vertices,
             equal_vertices, point_without_simplex, split_simplex, flipped, flipped, flipped,
             cut_out_vertex, two_meshes, shuffled]
