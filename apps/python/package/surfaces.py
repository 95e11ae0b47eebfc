# SPDX-License-Identifier: MIT
"""From meshes to matches, and from a selection to a refined pose: what the full package has beside the groupers."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

from numpy import asarray, float64
from numpy.typing import ArrayLike, NDArray

from . import _corral
from .tables import Matches, _table_of

__all__ = ["Mesh", "RefinedPose", "evaluate_table", "match", "read_matches", "read_mesh", "refine", "refine_over_all",
           "Registration", "register"]


@dataclass(frozen=True)
class Mesh:
    """A triangle mesh, or a point cloud if it has no triangles."""

    vertices: ArrayLike  #: (V, 3), mesh units
    triangles: ArrayLike | None = None  #: (F, 3): rows of vertices, counter-clockwise seen from outside
    normals: ArrayLike | None = None  #: (V, 3), zeros where unknown
    sensor: ArrayLike | None = None  #: (3,), mesh units: from where the surface was seen
    notes: Sequence[str] = field(default=())  #: what the reader left out or skipped

    def __repr__(self) -> str:
        faces = 0 if self.triangles is None else len(asarray(self.triangles))
        return f"<{len(asarray(self.vertices))} vertices, {faces} triangles>"


@dataclass(frozen=True)
class RefinedPose:
    """A pose that minimises a robust cost over matches. None where there is none."""

    pose: NDArray[float64] | None  #: (4, 4), target from source, mesh units
    status: str  #: "refined", "too few rows", "degenerate geometry" or "diverged"
    converged: bool
    iterations: int
    initial: NDArray[float64] | None  #: (4, 4): where it started
    initial_rms_pr: float | None  #: root mean square residual over the rows
    final_rms_pr: float | None
    initial_cost: float | None  #: pr^2
    final_cost: float | None  #: never larger
    condition: float | None  #: of the normal equations, in pr and radians
    covariance: NDArray[float64] | None  #: (6, 6): of rotation (radians, about the axes of the target) and translation (mesh units)


@dataclass(frozen=True)
class Registration:
    """The pose that lays one surface on another, and how far it can be trusted without a truth. None where there is none."""

    pose: NDArray[float64] | None  #: (4, 4), target from source, mesh units
    confidence: float | None  #: probability that its mean error is at most 5 pr
    verdict: str | None  #: "trust it", "look at it" or "do not use it"
    method: str | None  #: the grouper that proposed it
    others: Sequence[NDArray[float64]]  #: (4, 4) each: other poses, the best first
    signals: Mapping[str, float]  #: what the confidence is made of; larger is safer


def read_mesh(path: str | os.PathLike[str]) -> Mesh:
    """A mesh or point cloud from a file (.ply .off .obj .stl .pcd .xyz .pts .asc .txt .csv, each also .gz).

    Raises IoError that names the file, the place in it and what was expected there."""
    return Mesh(*_corral.read_mesh(os.fsencode(path)))


def read_matches(path: str | os.PathLike[str]) -> Matches:
    """A table of matches as `corral match` writes it. Raises IoError naming file and line."""
    return Matches._of(_corral.read_matches(os.fsencode(path)))


def _parts(surface: Mesh | ArrayLike) -> tuple[Any, ...]:
    if isinstance(surface, Mesh):
        return surface.vertices, surface.triangles, surface.normals, surface.sensor
    return surface, None, None, None


def _names(methods: str | Sequence[str]) -> list[str]:
    return methods.split(",") if isinstance(methods, str) else list(methods)


def _each(options: Mapping[str, Mapping[str, Any]] | None) -> dict[str, dict[str, Any]]:
    return {name: dict(values) for name, values in (options or {}).items()}


def match(source: Mesh | ArrayLike, target: Mesh | ArrayLike, *, resolution: str | float = "mean",
          detector: str = "harris", descriptor: str = "shot", frames: str = "shot", normals: str = "auto",
          sensor: ArrayLike | None = None, matcher: str = "exact", mutual: bool = False, threads: int = 0,
          options: Mapping[str, Mapping[str, Any]] | None = None) -> Matches:
    """The table of matches between two surfaces: keypoints, descriptors, and for each of the source the nearest of the target.

    source, target
        Mesh, or the vertices (V, 3) of a point cloud, mesh units.
    resolution
        pr of the pair: "mean", "source" or "target" of the two, or a length in mesh units.
    detector, descriptor, frames, normals, matcher, mutual
        As the options of `corral match`, whose help lists them.
    sensor
        (3,), mesh units: normals point to it.
    threads
        0: as many as there are processors. Results do not depend on it.
    options
        Of the detector and the descriptor: {"harris": {"radius_pr": 3}}.

    The table is that of `corral match`; its `report` says what became of the keypoints. Advice on the data (units, stray points,
    no keypoints) is a UserWarning. Raises InvalidInput.
    """
    choices = {"frames": frames, "normals": normals, "matcher": matcher, "mutual": mutual}
    table, report, advice = _corral.match(_parts(source), _parts(target), str(resolution), detector, descriptor,
                                          choices, sensor, _each(options), threads)
    for line in advice:
        warnings.warn(line, stacklevel=2)
    return Matches._of(table, report)


def register(matches: Matches, source: Mesh | ArrayLike | None = None, target: Mesh | ArrayLike | None = None, *,
             threads: int = 0) -> Registration:
    """The pose of a pair without a truth, as `corral register`: several groupers propose poses, the surfaces choose.

    matches
        The table of match(source, target), or any other.
    source, target
        Mesh, or vertices (V, 3), mesh units. Without them the table alone chooses.
    threads
        0: as many as there are processors. Results do not depend on it.
    """
    if (source is None) != (target is None):
        raise _corral.InvalidInput("register: source and target: expected both surfaces, or none")
    parts = (None, None) if source is None else (_parts(source), _parts(target))
    return Registration(**_corral.register(_table_of(matches), *parts, threads))


def refine(matches: Matches, selected: ArrayLike, *, loss: str = "cauchy", loss_scale_pr: float = 5,
           maximum_iterations: int = 500, start: ArrayLike | None = None) -> RefinedPose:
    """The rigid pose that minimises a robust cost over the selected matches, as `corral refine`.

    selected
        (K,): rows of the table.
    loss
        "none", "huber", "cauchy", "tukey" or "geman-mcclure".
    loss_scale_pr
        The residual at which a match begins to lose its influence (tukey: has none left).
    start
        (4, 4): where to start; without it, the least-squares fit.
    """
    return RefinedPose(**_corral.refine(_table_of(matches), selected, loss, loss_scale_pr, maximum_iterations, start))


def refine_over_all(matches: Matches, start: ArrayLike) -> RefinedPose:
    """refine() over all matches from a pose (4, 4) that was found before, by Tukey's loss with a scale of 5 pr: matches that a
    selection missed take part, incorrect ones that it held drop out."""
    return RefinedPose(**_corral.refine_over_all(_table_of(matches), start))


def evaluate_table(matches: Matches, truth: ArrayLike, methods: str | Sequence[str] = "paper", *,
                   options: Mapping[str, Mapping[str, Any]] | None = None, threshold_pr: float = 4,
                   repeat: int = 1) -> list[dict[str, Any]]:
    """Groups, scores, refines and judges by every named grouper, as `corral run --matches`.

    truth
        (4, 4): the true pose, target from source, mesh units.
    methods
        "paper" (the seven of 2017), "all", names between commas, or a list of names.
    options
        Of the groupers: {"gc": {"tolerance_pr": 2}}.
    threshold_pr
        The residual up to which a match is correct.
    repeat
        Timed calls of each; the median counts.

    Returns a dict for each grouper with the keys of `corral run --json`, then "oracle" (all correct matches) and "baseline" (all
    matches); pandas.DataFrame makes a table of them. A grouper that fails is recorded so in its `status`; `confidence` is the
    probability that its pose is right, worked out without the truth.
    """
    return _corral.evaluate_table(_table_of(matches), truth, _names(methods), _each(options), threshold_pr, repeat)
