"""Meshes as arrays, from files of all formats and into some."""
import os
import subprocess

import numpy as np

ENDS = {"ply-ascii": "ply", "landxml": "xml"}


class Mesh:
    def __init__(self, vertices, simplices, index=None):
        self.lattice = None         # scale and offset, that a written mesh tells
        self.vertices = vertices    # three coordinates, of more dimensions as many
        self.simplices = simplices
        self.index = index          # of each vertex its number in the input, if it is known


def end_of(form):
    return ENDS.get(form, form)


def read_npy(stem):
    index = f"{stem}_input_index.npy"
    return Mesh(np.load(f"{stem}_vertices.npy"), np.load(f"{stem}_simplices.npy"),
                np.load(index) if os.path.exists(index) else None)


def read_text(path, form):
    """OBJ, OFF and ASCII PLY."""
    with open(path, encoding="utf-8") as file:
        lines = [line.split() for line in file]
    if form == "obj":
        vertices = [line[1:4] for line in lines if line[:1] == ["v"]]
        cells = [[int(v) - 1 for v in line[1:]] for line in lines if line[:1] == ["f"]]
        return vertices, cells, None
    if form == "off":
        lines = [line for line in lines[1:] if line and line[0] != "#"]
        vertices, count = int(lines[0][0]), int(lines[0][1])
        body = lines[1:]
        names = ["x", "y", "z"]
    else:
        end = lines.index(["end_header"])
        vertices, count = [int(line[2]) for line in lines[:end] if line[:1] == ["element"]]
        names = [line[2] for line in lines[:end] if line[:1] == ["property"] and len(line) == 3]
        body = lines[end + 1:]
    index = None
    if "input_index" in names:
        index = np.array([row[names.index("input_index")] for row in body[:vertices]], float)
    cells = [[int(v) for v in row[1:]] for row in body[vertices:vertices + count]]
    return [row[:3] for row in body[:vertices]], cells, index


def read_mesh(command, path, form, dim):
    """Spillway's own reader takes binary formats, the driver's the others."""
    if form == "npy":
        return read_npy(path[:-len(".npy")])
    if form in ("obj", "off", "ply-ascii"):
        vertices, cells, index = read_text(path, form)
        return Mesh(np.array(vertices, float).reshape(-1, 3),
                    np.array(cells, np.int64).reshape(-1, dim + 1), index)
    done = subprocess.run([command, "convert", path, "-o", "read.npy", "-q"], capture_output=True,
                          text=True)
    if done.returncode != 0:
        raise AssertionError(f"convert does not read {path}: {done.stderr}")
    mesh = read_npy("read")
    for name in ("vertices", "simplices", "input_index"):
        if os.path.exists(f"read_{name}.npy"):
            os.remove(f"read_{name}.npy")
    return mesh


def notes(mesh, mark):
    if mesh.lattice is None:
        return ""
    numbers = " ".join(repr(float(v)) for part in mesh.lattice for v in part)
    return (f"{mark} spillway dimension {mesh.simplices.shape[1] - 1}\n"
            f"{mark} spillway lattice {numbers}\n")


def ply_bytes(mesh, coding):
    kind = "face" if mesh.simplices.shape[1] == 3 else "tetrahedron"
    head = (f"ply\nformat {coding} 1.0\n{notes(mesh, 'comment')}element vertex {len(mesh.vertices)}\n"
            "property double x\nproperty double y\nproperty double z\n"
            f"element {kind} {len(mesh.simplices)}\n"
            "property list uchar int vertex_indices\nend_header\n").encode()
    if coding == "ascii":
        rows = "".join(" ".join(repr(float(v)) for v in row) + "\n" for row in mesh.vertices)
        rows += "".join(f"{len(row)} {' '.join(map(str, row))}\n" for row in mesh.simplices)
        return head + rows.encode()
    corners = mesh.simplices.shape[1]
    cells = np.zeros(len(mesh.simplices), dtype=[("n", "u1"), ("corners", "<i4", corners)])
    cells["n"] = corners
    cells["corners"] = mesh.simplices
    return head + mesh.vertices.astype("<f8").tobytes() + cells.tobytes()


def obj_bytes(mesh):
    rows = notes(mesh, "#")
    rows += "".join("v " + " ".join(repr(float(v)) for v in row) + "\n" for row in mesh.vertices)
    rows += "".join("f " + " ".join(str(v + 1) for v in row) + "\n" for row in mesh.simplices)
    return rows.encode()


def sma_bytes(mesh):
    """A stream: vertices come just before their first triangle, and end with their last one."""
    last = {}
    for number, row in enumerate(mesh.simplices):
        for vertex in row:
            last[int(vertex)] = number
    lines, name = [], {}
    for number, row in enumerate(mesh.simplices):
        for vertex in map(int, row):
            if vertex not in name and vertex < len(mesh.vertices):
                name[vertex] = len(name) + 1
                lines.append("v " + " ".join(repr(float(v)) for v in mesh.vertices[vertex]))
        names = [name.get(v, len(mesh.vertices) + 1) for v in map(int, row)]
        corners = [n - len(name) - 1 if last[int(v)] == number else n for v, n in zip(row, names)]
        lines.append("f " + " ".join(map(str, corners)))
    for vertex in range(len(mesh.vertices)):
        if vertex not in name:
            lines.append("v " + " ".join(repr(float(v)) for v in mesh.vertices[vertex]))
    return (notes(mesh, "#") + "\n".join(lines) + "\n").encode()


def write_mesh(mesh, stem, form):
    """The name of the file, which `spillway check` is given."""
    path = f"{stem}.{end_of(form)}"
    if form == "npy":
        np.save(f"{stem}_vertices.npy", mesh.vertices.astype("<f8"))
        np.save(f"{stem}_simplices.npy", mesh.simplices.astype("<i8"))
        return path
    content = {"ply": lambda: ply_bytes(mesh, "binary_little_endian"),
               "ply-ascii": lambda: ply_bytes(mesh, "ascii"),
               "obj": lambda: obj_bytes(mesh), "sma": lambda: sma_bytes(mesh)}[form]()
    with open(path, "wb") as file:
        file.write(content)
    return path
