"""Exact Delaunay triangulations of huge point sets, in the plane and in space.

>>> import numpy as np, spillway
>>> tri = spillway.Delaunay(np.random.default_rng(1).random((1000, 2)))
>>> tri.simplices.shape[1]
3
"""

import os as _os

from . import _spillway
from ._delaunay import Delaunay
from .errors import Error

__all__ = ["Delaunay", "Error", "__version__"]
__version__: str = _spillway.version

# A child of fork() has none of its parent's threads, so the library must not count on any.
if hasattr(_os, "register_at_fork"):
    _os.register_at_fork(before=_spillway.end_threads)
