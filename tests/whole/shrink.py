"""Makes a case small that still fails in the same way."""
import time

import numpy as np

import oracle


class Shrinker:
    def __init__(self, run, sort, seconds):
        self.run = run          # takes a case, raises oracle.Failed
        self.sort = sort
        self.end = time.monotonic() + seconds

    def fails(self, case):
        if time.monotonic() > self.end:
            return False
        try:
            self.run(case)
        except oracle.Failed as failure:
            return failure.sort == self.sort
        except Exception:  # a case that makes no sense
            return False
        return False

    def shrunk(self, case):
        case = self.without_options(case)
        case = self.without_points(case)
        return self.without_options(case)

    def without_options(self, case):
        for simpler in self.simpler_cases(case):
            change, value = simpler
            smaller = case.copy()
            change(smaller, value)
            if self.fails(smaller):
                case = smaller
        for kind in ("options", "filters"):
            for one in list(getattr(case, kind)):
                smaller = case.copy()
                setattr(smaller, kind, [other for other in getattr(case, kind) if other is not one])
                if self.fails(smaller):
                    case = smaller
        return case

    @staticmethod
    def simpler_cases(case):
        def put(name):
            return lambda smaller, value: setattr(smaller, name, value)

        def one_form(smaller, form):
            smaller.inputs = [one if one.form == form else one.as_form("las" if one.scale is not None
                                                                        else form)
                              for one in smaller.inputs]

        def joined(smaller, _):
            first = smaller.inputs[0]
            smaller.inputs = [first.take(slice(None))]
            smaller.inputs[0].points = np.vstack([one.points for one in case.inputs])

        changes = [(put("ranks"), 0), (put("pipe_in"), False), (put("pipe_out"), False),
                   (put("proves"), False), (put("form"), "npy"), (one_form, "text")]
        if len({(str(one.scale), str(one.offset)) for one in case.inputs}) == 1:
            changes.append((joined, None))
        return changes

    def without_points(self, case):
        """Delta debugging over all points of all inputs: ever smaller parts are left out."""
        parts = 2
        while case.points() > 1 and time.monotonic() < self.end:
            pieces = np.array_split(np.arange(case.points()), min(parts, case.points()))
            for piece in pieces:
                smaller = self.left_out(case, piece)
                if smaller.inputs and self.fails(smaller):
                    case, parts = smaller, max(2, parts - 1)
                    break
            else:
                if parts >= case.points():
                    return case
                parts *= 2
        return case

    @staticmethod
    def left_out(case, numbers):
        smaller = case.copy()
        stays = np.ones(case.points(), bool)
        stays[numbers] = False
        smaller.inputs, first = [], 0
        for one in case.inputs:
            rows = stays[first:first + len(one.points)]
            first += len(one.points)
            if rows.any():
                smaller.inputs.append(one.take(rows))
        return smaller
