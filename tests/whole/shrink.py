"""Makes a case small that still fails in the same way."""
import time

import numpy as np

import oracle


def fewer(count, fails, end):
    """Numbers below `count` of which `fails` is true and none can be left out, if there is time.
    Delta debugging: ever smaller parts are left out."""
    numbers, parts = np.arange(count), 2
    while len(numbers) > 1 and time.monotonic() < end:
        for piece in np.array_split(numbers, min(parts, len(numbers))):
            rest = np.setdiff1d(numbers, piece)
            if fails(rest):
                numbers, parts = rest, max(2, parts - 1)
                break
        else:
            if parts >= len(numbers):
                break
            parts *= 2
    return numbers


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
        stay = fewer(case.points(), lambda rows: self.fails(self.of(case, rows)), self.end)
        return self.of(case, stay)

    @staticmethod
    def of(case, numbers):
        """The case with these points alone."""
        smaller = case.copy()
        stays = np.zeros(case.points(), bool)
        stays[numbers] = True
        smaller.inputs, first = [], 0
        for one in case.inputs:
            rows = stays[first:first + len(one.points)]
            first += len(one.points)
            if rows.any():
                smaller.inputs.append(one.take(rows))
        return smaller
