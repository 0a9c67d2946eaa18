"""Point files of many formats, and the coordinates that they really have."""
import gzip
import struct
import subprocess

import numpy as np

PLAIN = ["npy", "npy-columns", "npy-big", "npy-float32", "npy-structure", "text", "csv", "text-gz",
         "ply-ascii", "ply", "pcd-ascii", "pcd", "spp", "sorted-spp"]
LATTICE = ["las", "las", "laz", "copc", "las-spp"]
NOT_PIPED = {"npy-columns", "copc"}
ENDS = {"npy-columns": "npy", "npy-big": "npy", "npy-float32": "npy", "npy-structure": "npy",
        "text": "txt", "text-gz": "txt.gz", "ply-ascii": "ply", "pcd-ascii": "pcd",
        "sorted-spp": "spp", "copc": "copc.laz", "las-spp": "spp"}


class Input:
    """One file: points as doubles; on a lattice integers, a scale and an offset."""

    def __init__(self, form, points, scale=None, offset=None, lies=False):
        self.form = form
        self.points = points  # on a lattice: the integers
        self.scale = scale
        self.offset = offset
        self.lies = lies      # of LAS: whether the header's box is too small

    def take(self, rows):
        return Input(self.form, self.points[rows], self.scale, self.offset, self.lies)

    def as_form(self, form):
        return Input(form, self.points, self.scale, self.offset)

    def name(self, number):
        return f"points{number}.{ENDS.get(self.form, self.form)}"

    def world(self):
        """Coordinates as the command gives them."""
        if self.scale is not None:
            return self.points * self.scale + self.offset
        if self.form == "npy-float32":
            with np.errstate(over="ignore"):
                return self.points.astype(np.float32).astype(float)
        return self.points

    def write(self, command, number):
        """Writes the file, and brings the points into the order in which it has them."""
        name = self.name(number)
        if self.scale is not None:
            write_lattice(self, command, name)
        elif self.form in ("spp", "sorted-spp"):
            with open("converted.npy", "wb") as file:
                plain = Input("npy-structure" if self.points.shape[1] > 3 else "npy", self.points)
                write_plain(plain, file)
            how = ["--sorted"] if self.form == "sorted-spp" else []
            convert(command, ["converted.npy", *how, "-o", name])
        else:
            with open(name, "wb") as file:
                write_plain(self, file)
        if self.form in ("sorted-spp", "copc"):
            reread(self, command, name)


def convert(command, arguments):
    subprocess.run([command, "convert", *arguments, "-q"], check=True, capture_output=True)


def reread(points, command, name):
    """Takes over the order of a file that has been sorted; no point may be lost."""
    convert(command, [name, "-o", "reread.npy"])
    rows = np.load("reread.npy")
    if rows.dtype.names:
        rows = np.stack([rows[field] for field in "xyz"], 1)
    if points.scale is not None:
        rows = np.rint((rows - points.offset) / points.scale)
    rows = rows[:, :points.points.shape[1]]
    given = points.points + 0.0
    if not np.array_equal(rows[np.lexsort(rows.T)], given[np.lexsort(given.T)]):
        raise AssertionError(f"convert lost points of {name}")
    points.points = rows


def text_rows(points, separator):
    return "".join(separator.join(repr(float(v)) for v in row) + "\n" for row in points).encode()


def write_plain(points, file):
    rows, form = points.points, points.form
    names = ["x", "y", "z", "x4", "x5", "x6"][:rows.shape[1]]
    if form == "npy":
        np.save(file, rows)
    elif form == "npy-columns":
        np.save(file, np.asfortranarray(rows))
    elif form == "npy-big":
        np.save(file, rows.astype(">f8"))
    elif form == "npy-float32":
        np.save(file, rows.astype(np.float32))
    elif form == "npy-structure":
        table = np.zeros(len(rows), dtype=[("id", "<i4"), *[(name, "<f8") for name in names]])
        for axis, name in enumerate(names):
            table[name] = rows[:, axis]
        np.save(file, table)
    elif form == "text":
        file.write(text_rows(rows, " "))
    elif form == "text-gz":
        file.write(gzip.compress(text_rows(rows, " "), mtime=0))
    elif form == "csv":
        file.write((",".join(names) + "\n").encode() + text_rows(rows, ","))
    elif form.startswith("ply"):
        coding = "ascii" if form == "ply-ascii" else "binary_little_endian"
        lines = ["ply", f"format {coding} 1.0", f"element vertex {len(rows)}",
                 *[f"property double {name}" for name in names], "end_header", ""]
        file.write("\n".join(lines).encode())
        file.write(text_rows(rows, " ") if form == "ply-ascii" else rows.astype("<f8").tobytes())
    elif form.startswith("pcd"):
        ones = " ".join("1" * len(names))
        lines = ["# .PCD v0.7", "VERSION 0.7", f"FIELDS {' '.join(names)}",
                 f"SIZE {ones.replace('1', '8')}", f"TYPE {ones.replace('1', 'F')}", f"COUNT {ones}",
                 f"WIDTH {len(rows)}", "HEIGHT 1", "VIEWPOINT 0 0 0 1 0 0 0", f"POINTS {len(rows)}",
                 f"DATA {'ascii' if form == 'pcd-ascii' else 'binary'}", ""]
        file.write("\n".join(lines).encode())
        file.write(text_rows(rows, " ") if form == "pcd-ascii" else rows.astype("<f8").tobytes())
    else:
        raise ValueError(form)


def write_lattice(points, command, name):
    las = name if points.form == "las" else "converted.las"
    with open(las, "wb") as file:
        file.write(las_bytes(points))
    if las != name:
        convert(command, [las, "-o", name])


def attributes_of(world):
    """Class, number of the return, and how many returns its pulse has, by the bits of x and y."""
    bits = (np.ascontiguousarray(world[:, :2]) + 0.0).view(np.uint64)
    mixed = (bits[:, 0] * np.uint64(0x9E3779B97F4A7C15) + bits[:, 1]) * np.uint64(0xD1B54A32D192ED03)
    mixed >>= np.uint64(40)
    of_pulse = mixed // 7 % 3 + 1
    return mixed % 7, mixed // 21 % of_pulse + 1, of_pulse


def las_bytes(points):
    """LAS 1.2, point format 0."""
    rows = points.points.astype(np.int64)
    world = points.world()
    low, high = (world.min(0), world.max(0)) if len(rows) else (np.zeros(3), np.zeros(3))
    if points.lies:
        high = low + (high - low) / 2
    head = bytearray(227)
    head[0:4] = b"LASF"
    head[24:26] = bytes([1, 2])
    struct.pack_into("<HI", head, 94, 227, 227)
    struct.pack_into("<BHI", head, 104, 0, 20, len(rows))
    struct.pack_into("<I", head, 111, len(rows))
    struct.pack_into("<6d", head, 131, *points.scale, *points.offset)
    struct.pack_into("<6d", head, 179, *[v for axis in range(3) for v in (high[axis], low[axis])])
    records = np.zeros(len(rows), dtype=[("xyz", "<i4", 3), ("rest", "u1", 8)])
    records["xyz"] = rows
    classes, number, of_pulse = attributes_of(world)
    records["rest"][:, 2] = number + of_pulse * 8
    records["rest"][:, 3] = classes
    return bytes(head) + records.tobytes()
