"""Proximity queries between convex bodies. Every distance, depth and time comes with an interval that holds the true value.

Lengths are in the unit of the vertices. A pose is a (3, 4) array [R|T], or a (4, 4) array with the last row 0 0 0 1, or a Pose.
"""

from ._core import (
    Cast,
    Distance,
    Error,
    FileError,
    FirstHit,
    Gradient,
    Ground,
    InputError,
    Manifold,
    Motion,
    Outcome,
    OutOfMemory,
    Pair,
    Pose,
    Scene,
    SceneCast,
    Shape,
    SignedDistance,
    Unverified,
    __version__,
    dtype,
    load,
)

__all__ = [
    "Cast",
    "Distance",
    "Error",
    "FileError",
    "FirstHit",
    "Gradient",
    "Ground",
    "InputError",
    "Manifold",
    "Motion",
    "OutOfMemory",
    "Outcome",
    "Pair",
    "Pose",
    "Scene",
    "SceneCast",
    "Shape",
    "SignedDistance",
    "Unverified",
    "__version__",
    "dtype",
    "load",
]
