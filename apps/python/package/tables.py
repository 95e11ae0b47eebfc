# SPDX-License-Identifier: MIT
"""Tables of matches, and the groupers that decide which matches to keep."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy import bool_, float64, int32, int64
from numpy.typing import ArrayLike, NDArray

from . import _corral
from ._corral import InvalidInput, IoError

__all__ = [
    "Grouper", "Grouping", "InvalidInput", "IoError", "Matches", "Option",
    "group", "groupers", "label_correct", "make_synthetic", "score",
]


class Matches:
    """A table of M matches between two surfaces; row i of every column belongs to match i.

    source_points, target_points
        (M, 3), mesh units: where match i lies on either surface.
    resolution
        Mesh units per pr (point resolution): the mean distance of a vertex to its nearest neighbour. Lengths in options are in pr.
    feature_distance, second_feature_distance
        (M,): distance of the source feature to the nearest target feature, and to the second nearest (0 where there is none).
    source_frames, target_frames
        (M, 3, 3): the local reference frame of each keypoint; its rows are the unit axes x, y, z. Zeros where there is none.
    source_centroid
        (3,), mesh units: mean of all source vertices. Without it, that of the source points is used.

    The columns are copied once, here; as attributes they are read-only arrays on the memory of the table, or None. A table may be
    given to any number of calls, in any number of threads.
    """

    __slots__ = ("_table", "report")

    def __init__(self, source_points: ArrayLike, target_points: ArrayLike, *, resolution: float,
                 feature_distance: ArrayLike | None = None, second_feature_distance: ArrayLike | None = None,
                 source_frames: ArrayLike | None = None, target_frames: ArrayLike | None = None,
                 source_centroid: ArrayLike | None = None) -> None:
        self._table = _corral.Table(source_points, target_points, resolution, feature_distance,
                                    second_feature_distance, source_frames, target_frames, source_centroid)
        self.report: dict[str, Any] | None = None  #: what `match` says of its stages; None for other tables

    @classmethod
    def _of(cls, table: _corral.Table, report: dict[str, Any] | None = None) -> Matches:
        matches = cls.__new__(cls)
        matches._table, matches.report = table, report
        return matches

    def __len__(self) -> int:
        return len(self._table)

    def __repr__(self) -> str:
        return f"<{len(self)} matches, 1 pr = {self.resolution:g} mesh units>"

    @property
    def source_points(self) -> NDArray[float64]:
        """(M, 3), mesh units."""
        return self._table.source_points

    @property
    def target_points(self) -> NDArray[float64]:
        """(M, 3), mesh units."""
        return self._table.target_points

    @property
    def resolution(self) -> float:
        """Mesh units per pr."""
        return self._table.resolution

    @property
    def feature_distance(self) -> NDArray[float64] | None:
        """(M,): to the nearest target feature."""
        return self._table.feature_distance

    @property
    def second_feature_distance(self) -> NDArray[float64] | None:
        """(M,): to the second nearest target feature."""
        return self._table.second_feature_distance

    @property
    def source_frames(self) -> NDArray[float64] | None:
        """(M, 3, 3), rows are axes."""
        return self._table.source_frames

    @property
    def target_frames(self) -> NDArray[float64] | None:
        """(M, 3, 3), rows are axes."""
        return self._table.target_frames

    @property
    def source_keypoints(self) -> NDArray[int32] | None:
        """(M,): vertices of the source mesh; of matched meshes only."""
        return self._table.source_keypoints

    @property
    def target_keypoints(self) -> NDArray[int32] | None:
        """(M,): vertices of the target mesh; of matched meshes only."""
        return self._table.target_keypoints

    @property
    def source_centroid(self) -> NDArray[float64] | None:
        """(3,), mesh units."""
        return self._table.source_centroid


@dataclass(frozen=True)
class Grouping:
    """What a grouper found."""

    selected: NDArray[int64]  #: (K,): the rows that it keeps, ascending
    scores: NDArray[float64] | None  #: (M,): of every match, larger is better; None if the grouper computes none
    pose: NDArray[float64] | None  #: (4, 4), target from source, mesh units; None if the grouper estimates none
    runner_up: list[tuple[NDArray[float64], float]]  #: further poses with their scores, the best first, if asked for
    notes: dict[str, int]  #: how the result came about, such as how often a bound was reached
    seconds: float  #: of the grouper alone, wall time


@dataclass(frozen=True)
class Option:
    """An option of a grouper."""

    name: str
    value: bool | int | float | str  #: the default
    unit: str  #: "pr", or "" for a pure number or a choice
    accepted: str
    meaning: str


@dataclass(frozen=True)
class Grouper:
    """A grouper that `group` knows by its name."""

    name: str
    title: str
    principle: str
    citation: str  #: key in paper/references.bib
    options: list[Option]


def _typed(text: str) -> bool | int | float | str:
    if text in ("false", "true"):
        return text == "true"
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def groupers() -> list[Grouper]:
    """Every grouper with its options and their defaults: those of Yang et al. 2017 in its order, then what came after."""
    return [
        Grouper(name, title, principle, citation,
                [Option(option, _typed(value), unit, accepted, meaning)
                 for option, value, unit, accepted, meaning in options])
        for name, title, principle, citation, options in _corral.groupers()
    ]


def _table_of(matches: Matches) -> _corral.Table:
    if not isinstance(matches, Matches):
        raise InvalidInput(f"matches is a {type(matches).__name__}, expected Matches")
    return matches._table


def group(source_points: Matches | ArrayLike, target_points: ArrayLike | None = None, method: str = "gc", *,
          resolution: float | None = None, feature_distance: ArrayLike | None = None,
          second_feature_distance: ArrayLike | None = None, source_frames: ArrayLike | None = None,
          target_frames: ArrayLike | None = None, source_centroid: ArrayLike | None = None,
          **options: bool | int | float | str) -> Grouping:
    """Decides which matches of a table to keep.

    The table is a `Matches` alone, as in group(matches, method="gc"), or its columns: points (M, 3) in mesh units, `resolution` in
    mesh units per pr, and the columns that the grouper reads (see `Matches` for their shapes).

    method
        The name of one of groupers().
    options
        Those of the grouper, by name: group(matches, method="gc", tolerance_pr=2). Lengths in pr.

    The selection is that of `corral group`, and the same for the same table on any machine. Other threads run meanwhile.
    Raises InvalidInput for a table or an option that the grouper cannot work with, and for a column that it needs and misses.
    """
    if isinstance(source_points, Matches):
        columns = (target_points, resolution, feature_distance, second_feature_distance, source_frames, target_frames,
                   source_centroid)
        if any(column is not None for column in columns):
            raise InvalidInput("group: columns are given beside Matches, expected either; the grouper is method='gc'")
        table = source_points._table
    else:
        if target_points is None or resolution is None:
            absent = "target_points" if target_points is None else "resolution"
            raise InvalidInput(f"group: {absent} is absent, expected beside source_points")
        table = _corral.Table(source_points, target_points, resolution, feature_distance, second_feature_distance,
                              source_frames, target_frames, source_centroid)
    return Grouping(*_corral.group(table, method, options))


def label_correct(matches: Matches, truth: ArrayLike, *, threshold_pr: float = 4) -> NDArray[bool_]:
    """Which matches are correct: (M,) of bool, True where the true pose (4, 4) leaves a residual of at most the threshold."""
    return _corral.label_correct(_table_of(matches), truth, threshold_pr)


def score(matches: Matches, selected: ArrayLike, truth: ArrayLike, *, pose: ArrayLike | None = None,
          threshold_pr: float = 4) -> dict[str, Any]:
    """What the true pose (4, 4) says of a selection and of a pose.

    selected
        (K,): rows, strictly ascending. numpy.flatnonzero makes them of a mask.
    pose
        (4, 4), target from source: what is judged; without it, the least-squares fit to the selected matches.

    Returns matches, selected, correct, true_matches (counts); precision, recall, f1; rotation_error_deg, translation_error_pr,
    mean_error_pr (over the source points of the correct matches), rmse_pr (over those of all). None where undefined.
    """
    return _corral.score(_table_of(matches), selected, truth, pose, threshold_pr)


def make_synthetic(matches: int = 500, *, inlier_ratio: float = 0.5, noise_pr: float = 0.5, extent_pr: float = 200,
                   frame_noise_deg: float = 3, resolution: float = 1, seed: int = 1) -> tuple[Matches, NDArray[float64]]:
    """A random table with every column, and its true pose (4, 4): source points in a cube of side extent_pr, of which the share
    inlier_ratio is moved by the pose with noise of this standard deviation, and the rest goes anywhere."""
    table, truth = _corral.make_synthetic(matches, inlier_ratio, noise_pr, extent_pr, frame_noise_deg, resolution, seed)
    return Matches._of(table), truth
