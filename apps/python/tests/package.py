# SPDX-License-Identifier: MIT
"""The package under test: CORRAL_PACKAGE is corral or corral_grouping. CORRAL_PROGRAM is the program to compare with, if there is one."""

import importlib
import os

import numpy as np

corral = importlib.import_module(os.environ.get("CORRAL_PACKAGE", "corral"))
is_full = hasattr(corral, "match")
program = os.environ.get("CORRAL_PROGRAM", "")

COLUMNS = ("source_points", "target_points", "feature_distance", "second_feature_distance", "source_frames", "target_frames",
           "source_centroid")


def columns_of(matches):
    """What Matches(...) takes to make the same table."""
    return {"resolution": matches.resolution, **{name: getattr(matches, name) for name in COLUMNS}}


def matches_text(matches):
    """The table as the program reads it."""
    fields = {}
    for side in ("source", "target"):
        points, frames = getattr(matches, f"{side}_points"), getattr(matches, f"{side}_frames")
        fields.update({f"{side}_{axis}": points[:, i] for i, axis in enumerate("xyz")})
        fields.update({f"{side}_frame_{i}": frames.reshape(-1, 9)[:, i] for i in range(9)})
    fields.update({name: getattr(matches, name) for name in ("feature_distance", "second_feature_distance")})
    lines = ["# corral matches 1", f"# resolution {matches.resolution!r}",
             "# source_centroid " + " ".join(map(repr, matches.source_centroid.tolist())), ",".join(fields)]
    lines += [",".join(map(repr, row)) for row in np.column_stack(list(fields.values())).tolist()]
    return "\n".join(lines) + "\n"


def read_group(path):
    """Rows and scores of a group file; scores None if it has none."""
    with open(path) as file:
        rows = [line.rstrip("\n").split(",") for line in file if not line.startswith("#")][1:]
    selected = np.array([int(row[0]) for row in rows if row[1] == "1"], dtype=np.int64)
    has_scores = bool(rows) and rows[0][2] != ""
    return selected, np.array([float(row[2]) for row in rows]) if has_scores else None
