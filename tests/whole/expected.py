"""What the mesh of a case must be, by CGAL and the driver's own filters."""
import numpy as np

import filters
import oracle


class Expected:
    """What the mesh of a case must be."""

    def __init__(self, case, cgal):
        self.left_out, self.unclear = 0, False
        world = np.vstack([one.world() for one in case.inputs])
        counts = [len(one.points) for one in case.inputs]
        self.kept = filters.kept(case.filters, world, counts)
        self.records = len(world)
        self.world = world[self.kept] + 0.0
        self.lattice = self.common_lattice(case)
        self.keys = self.key(self.world)[:, :case.dim]
        if len(self.keys) == 0:
            self.points = self.keys
            self.simplices = np.zeros((0, case.dim + 1), np.int64)
            return
        self.points, self.first, self.inverse = np.unique(
            self.keys, axis=0, return_index=True, return_inverse=True)
        self.inverse = self.inverse.reshape(-1)
        self.simplices = oracle.simplices_of(cgal, self.points)
        if case.option("--max-edge") and len(self.simplices):
            self.leave_out(float(case.option("--max-edge")[1]), case.dim)

    def leave_out(self, most, dim):
        """Simplices with a longer edge; unclear if rounding might decide of one."""
        corners = self.world[self.first][self.simplices][:, :, :dim]
        with np.errstate(all="ignore"):
            edges = corners[:, :, None] - corners[:, None]
            lengths = np.sqrt((edges ** 2).sum(axis=3)).max(axis=(1, 2))
            slack = 1e-9 * most + 1e-15 * np.abs(corners).max()
        self.unclear = bool(np.any(np.abs(lengths - most) <= slack))
        self.left_out = int((lengths > most).sum())
        self.simplices = self.simplices[lengths <= most]

    @staticmethod
    def common_lattice(case):
        """Scale and offset, if all inputs are on one lattice."""
        if any(one.scale is None for one in case.inputs):
            return None
        return case.inputs[0].scale, np.min([one.offset for one in case.inputs], axis=0)

    def key(self, world):
        """Numbers that are triangulated: integers if there is a lattice."""
        if self.lattice is None:
            return world + 0.0
        scale, offset = self.lattice
        return np.rint((world - offset) / scale) + 0.0
