# SPDX-License-Identifier: MIT
"""An own grouper beside Corral's: F1 on tables that get harder, and the time of a call.

Runs as a script, or cell by cell (# %%) in an editor that knows notebooks:
  compare.py [--output FIGURE]                     on synthetic tables
  compare.py --matches FILE --truth FILE ...       on a table of `corral match` and its true pose (needs the full package)
"""

# %% What is compared
import argparse
import time

import matplotlib
import numpy as np

try:
    import corral
except ImportError:
    import corral_grouping as corral

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--matches", help="a table of matches; without it, synthetic ones")
parser.add_argument("--truth", help="its true pose: four rows of four")
parser.add_argument("--output", help="write the figure instead of showing it: compare.png, compare.pdf")
settings = parser.parse_args()
if settings.output:
    matplotlib.use("agg")
import matplotlib.pyplot as plt  # noqa: E402


# %% An own grouper: the matches that keep their distances to many others
def many_partners(matches, tolerance_pr=3.0, share=0.7):
    p, q = matches.source_points, matches.target_points
    lengths = [np.linalg.norm(x[:, None] - x[None], axis=2) for x in (p, q)]
    partners = (abs(lengths[0] - lengths[1]) < tolerance_pr * matches.resolution).sum(axis=1)
    return np.flatnonzero(partners >= share * partners.max(initial=0))


# %% The tables: (label, matches, true pose)
if settings.matches:
    tables = [("F1", corral.read_matches(settings.matches), np.loadtxt(settings.truth))]
else:
    tables = [(f"{share:.0%}", *corral.make_synthetic(500, inlier_ratio=share, noise_pr=1, seed=7))
              for share in (0.4, 0.2, 0.1, 0.05, 0.03, 0.02)]

# %% Every grouper on every table
names = ["many_partners", *(grouper.name for grouper in corral.groupers())]
f1 = np.full((len(names), len(tables)), np.nan)
time_ms = np.full((len(names), len(tables)), np.nan)
for column, (label, matches, truth) in enumerate(tables):
    for row, name in enumerate(names):
        try:
            start = time.perf_counter()
            selected = many_partners(matches) if row == 0 else corral.group(matches, method=name).selected
            time_ms[row, column] = 1e3 * (time.perf_counter() - start)
        except corral.InvalidInput as error:  # such as a column that this table does not have
            print(f"{name} on {label}: {error}")
            continue
        f1[row, column] = corral.score(matches, selected, truth)["f1"]

order = np.argsort(-np.nanmean(np.nan_to_num(f1), axis=1), kind="stable")
for row in order:
    print(f"{names[row]:15}", *(f"{value:6.3f}" for value in f1[row]), f"{np.nanmedian(time_ms[row]):10.2f} ms")

# %% The figure
figure, (left, right) = plt.subplots(
    1, 2, sharey=True, figsize=(4.5 + 0.6 * len(tables), 1.3 + 0.28 * len(names)), layout="constrained",
    gridspec_kw={"width_ratios": [max(1.2, 0.6 * len(tables)), 2]})
left.imshow(f1[order], vmin=0, vmax=1, cmap="cividis", aspect="auto")
for place, row in enumerate(order):
    for column, value in enumerate(f1[row]):
        text = "-" if np.isnan(value) else f"{value:.2f}"
        left.text(column, place, text, ha="center", va="center", fontsize=8, color="white" if value < 0.55 else "black")
left.set_xticks(range(len(tables)), [label for label, *_ in tables])
left.set_yticks(range(len(names)), [names[row] for row in order])
left.get_yticklabels()[int(np.flatnonzero(order == 0)[0])].set_fontweight("bold")
left.set_xlabel("share of correct matches" if not settings.matches else f"{len(tables[0][1])} matches")
left.set_title("F1 of the selection", fontsize=10)
right.barh(range(len(names)), np.nanmedian(time_ms[order], axis=1), color=["#c44e52" if row == 0 else "#4c72b0" for row in order])
right.set_xscale("log")
right.set_xlabel("ms a call, median")
right.set_title("time", fontsize=10)
right.tick_params(axis="y", length=0)
right.grid(axis="x", alpha=0.3)
if settings.output:
    figure.savefig(settings.output, dpi=150)
else:
    plt.show()
