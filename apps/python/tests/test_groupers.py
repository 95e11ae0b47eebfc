# SPDX-License-Identifier: MIT
"""The list of groupers, their options, and the same selections as the program."""

import os
import pickle
import subprocess
import tempfile
import unittest

import numpy as np

from package import columns_of, corral, matches_text, program, read_group


class Groupers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.matches, cls.truth = corral.make_synthetic(400, inlier_ratio=0.2)

    def test_the_list(self):
        names = [grouper.name for grouper in corral.groupers()]
        self.assertEqual(names[:7], ["ss", "nnsr", "ransac", "st", "gc", "hough", "si"])
        self.assertEqual(len(set(names)), len(names))
        gc = corral.groupers()[4]
        self.assertIn("Geometric consistency", gc.title)
        tolerance = next(option for option in gc.options if option.unit == "pr")
        self.assertIsInstance(tolerance.value, (int, float))

    def test_every_default_may_be_given(self):
        for grouper in corral.groupers():
            given = corral.group(self.matches, method=grouper.name,
                                 **{option.name: option.value for option in grouper.options})
            np.testing.assert_array_equal(given.selected, corral.group(self.matches, method=grouper.name).selected)

    def test_options_of_numpy_types(self):
        expected = corral.group(self.matches, method="ransac", seed=7, iterations=300).selected
        found = corral.group(self.matches, method="ransac", seed=np.uint64(7), iterations=np.int32(300)).selected
        np.testing.assert_array_equal(found, expected)
        narrow = corral.group(self.matches, method="gc", tolerance_pr=np.float64(0.5)).selected
        self.assertLess(len(narrow), len(corral.group(self.matches, method="gc", tolerance_pr=6).selected))

    def test_wrong_names_and_options(self):
        for words, call in (
            (["'nothing'", "ss|nnsr"], lambda: corral.group(self.matches, method="nothing")),
            (["gc", "tolerance", "tolerance_pr"], lambda: corral.group(self.matches, method="gc", tolerance=3)),
            (["gc", "tolerance_pr", "-1"], lambda: corral.group(self.matches, method="gc", tolerance_pr=-1)),
            (["tolerance_pr", "nan"], lambda: corral.group(self.matches, method="gc", tolerance_pr=float("nan"))),
            (["tolerance_pr", "list"], lambda: corral.group(self.matches, method="gc", tolerance_pr=[3])),
            (["target_points", "absent"], lambda: corral.group(self.matches.source_points, resolution=1)),
            (["resolution", "absent"], lambda: corral.group(self.matches.source_points, self.matches.target_points)),
            (["method="], lambda: corral.group(self.matches, "gc")),
            (["feature_distance", "absent"],
             lambda: corral.group(self.matches.source_points, self.matches.target_points, "ss", resolution=1)),
        ):
            with self.assertRaises(corral.InvalidInput) as caught:
                call()
            for word in words:
                self.assertIn(word, str(caught.exception))

    def test_errors_are_those_of_python(self):
        self.assertTrue(issubclass(corral.InvalidInput, ValueError))
        self.assertTrue(issubclass(corral.IoError, OSError))
        self.assertEqual(corral.InvalidInput.__module__, corral.__name__)
        self.assertIs(type(pickle.loads(pickle.dumps(corral.InvalidInput("x")))), corral.InvalidInput)

    def test_scores_of_a_selection(self):
        correct = corral.label_correct(self.matches, self.truth)
        self.assertEqual((correct.dtype, correct.shape), (bool, (400,)))
        residuals = np.linalg.norm(self.matches.source_points @ self.truth[:3, :3].T + self.truth[:3, 3]
                                   - self.matches.target_points, axis=1)
        np.testing.assert_array_equal(correct, residuals <= 4)
        rows = np.flatnonzero(correct)
        perfect = corral.score(self.matches, rows, self.truth)
        self.assertEqual((perfect["precision"], perfect["recall"], perfect["selected"]), (1, 1, len(rows)))
        self.assertLess(perfect["rotation_error_deg"], 0.5)
        self.assertLess(perfect["mean_error_pr"], 0.5)
        half = corral.score(self.matches, np.arange(400), self.truth, pose=self.truth)
        self.assertAlmostEqual(half["precision"], len(rows) / 400)
        self.assertEqual((half["rotation_error_deg"], half["translation_error_pr"], half["rmse_pr"]), (0, 0, 0))
        none = corral.score(self.matches, [], self.truth)
        self.assertIsNone(none["precision"])
        self.assertIsNone(none["rotation_error_deg"])

    def test_what_a_score_refuses(self):
        stretched, moved = np.diag([2.0, 2, 2, 1]), self.truth.copy()
        moved[3, 0] = 1
        undefined = self.truth.copy()
        undefined[0, 3] = np.nan
        for words, changes in (
            (["selected", "bool", "flatnonzero"], {"selected": np.ones(400, bool)}),
            (["selected", "float64"], {"selected": [0.0, 1.0]}),
            (["400"], {"selected": [400]}),
            (["selected", "-1"], {"selected": [-1]}),
            (["truth", "(3, 3)"], {"truth": np.eye(3)}),
            (["truth", "rigid"], {"truth": stretched}),
            (["truth", "last row"], {"truth": moved}),
            (["pose", "rigid"], {"pose": undefined}),
            (["threshold"], {"threshold_pr": np.nan}),
        ):
            with self.assertRaises(corral.InvalidInput) as caught:
                corral.score(**{"matches": self.matches, "selected": [0, 1, 2], "truth": self.truth, **changes})
            for word in words:
                self.assertIn(word, str(caught.exception), changes)

    @unittest.skipUnless(program, "CORRAL_PROGRAM names no program")
    def test_the_same_bytes_as_the_program(self):
        tables = [self.matches, corral.make_synthetic(1000, inlier_ratio=0.03, noise_pr=1.5, resolution=0.013, seed=5)[0]]
        for matches in tables:
            with tempfile.TemporaryDirectory() as folder:
                table, groups = os.path.join(folder, "matches.csv"), os.path.join(folder, "groups")
                with open(table, "w") as file:
                    file.write(matches_text(matches))
                subprocess.run([program, "group", table, "--method", "all", "-o", groups], check=True, capture_output=True)
                for grouper in corral.groupers():
                    selected, scores = read_group(os.path.join(groups, f"group_{grouper.name}.csv"))
                    for found in (corral.group(matches, method=grouper.name),
                                  corral.group(**columns_of(matches), method=grouper.name)):
                        self.assertEqual(found.selected.tobytes(), selected.tobytes(), grouper.name)
                        self.assertEqual(None if found.scores is None else found.scores.tobytes(),
                                         None if scores is None else scores.tobytes(), grouper.name)


if __name__ == "__main__":
    unittest.main()
