# SPDX-License-Identifier: MIT
"""Meshes, matching, refinement and whole tables: the full package."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

from package import columns_of, corral, is_full, matches_text, program

EXAMPLE = pathlib.Path(__file__).resolve().parents[3] / "data" / "example"


@unittest.skipUnless(is_full, "the package has the groupers alone")
class Surfaces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.source, cls.target = (corral.read_mesh(EXAMPLE / f"{side}.ply") for side in ("source", "target"))
        cls.truth = np.loadtxt(EXAMPLE / "truth.txt")
        cls.matches = corral.match(cls.source, cls.target)

    def called(self, *arguments):
        return subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout

    def test_meshes(self):
        self.assertEqual((self.source.vertices.dtype, self.source.triangles.dtype), (np.float64, np.int32))
        self.assertEqual(self.source.vertices.shape[1], 3)
        self.assertLess(self.source.triangles.max(), len(self.source.vertices))
        with self.assertRaises(corral.IoError) as caught:
            corral.read_mesh("not/there.ply")
        self.assertIn("not/there.ply", str(caught.exception))

    def test_matches_of_arrays_are_those_of_a_cloud(self):
        cloud = corral.match(self.source.vertices, corral.Mesh(self.target.vertices), threads=1)
        again = corral.match(np.ascontiguousarray(self.source.vertices), self.target.vertices)
        self.assertGreater(len(cloud), 10)
        np.testing.assert_array_equal(cloud.target_points, again.target_points)
        np.testing.assert_array_equal(cloud.source_points, self.source.vertices[cloud.source_keypoints])
        self.assertEqual(cloud.report["matches"], len(cloud))

    def test_settings(self):
        fewer = corral.match(self.source, self.target, mutual=True, options={"harris": {"radius_pr": 4}})
        self.assertLess(len(fewer), len(self.matches))
        self.assertIsNone(corral.match(self.source, self.target, frames="none").source_frames)
        self.assertEqual(corral.match(self.source, self.target, resolution=0.5).resolution, 0.5)
        for word, changes in (("detector", {"detector": "eyes"}), ("matcher", {"matcher": "guess"}),
                              ("sensor", {"sensor": [1, 2]}), ("radius", {"options": {"harris": {"radius": 4}}}),
                              ("fpfh", {"options": {"fpfh": {"x": 1}}}), ("source.vertices", {"source": [[1, 2]]}),
                              ("source.triangles", {"source": corral.Mesh(np.eye(3), [[0, 1, -2]])}),
                              ("vertex 7", {"source": corral.Mesh(np.eye(3), [[0, 1, 7]])})):
            with self.assertRaises(corral.InvalidInput) as caught:
                corral.match(**{"source": self.source, "target": self.target, **changes})
            self.assertIn(word, str(caught.exception))

    def test_register(self):
        found = corral.register(self.matches, self.source, self.target)
        self.assertEqual(found.verdict, "trust it")
        self.assertGreaterEqual(found.confidence, 0.9)
        self.assertLess(np.abs(found.pose - self.truth).max(), 0.5)
        self.assertIn("residual", found.signals)
        alone = corral.register(self.matches)
        self.assertEqual(alone.pose.shape, (4, 4))
        with self.assertRaises(corral.InvalidInput):
            corral.register(self.matches, self.source)
        nothing = corral.register(corral.Matches(np.zeros((0, 3)), np.zeros((0, 3)), resolution=1))
        self.assertEqual((nothing.pose, nothing.confidence, nothing.verdict), (None, None, None))

    def test_advice_is_a_warning(self):
        with self.assertWarnsRegex(UserWarning, "keypoint"):
            x, y = np.meshgrid(np.arange(40.0), np.arange(40.0))
            flat = np.stack([x.ravel(), y.ravel(), np.zeros(1600)], axis=1)
            self.assertEqual(len(corral.match(flat, flat)), 0)

    def test_refinement(self):
        rows = corral.group(self.matches, method="gc").selected
        refined = corral.refine(self.matches, rows)
        self.assertEqual(refined.status, "refined")
        self.assertLessEqual(refined.final_cost, refined.initial_cost)
        self.assertEqual(refined.covariance.shape, (6, 6))
        over_all = corral.refine_over_all(self.matches, refined.pose)
        self.assertLess(corral.score(self.matches, rows, self.truth, pose=over_all.pose)["mean_error_pr"], 5)
        few = corral.refine(self.matches, rows[:2])
        self.assertEqual((few.status, few.pose, few.final_rms_pr), ("too few rows", None, None))
        for word, changes in (("loss", {"loss": "square"}), ("loss_scale_pr", {"loss_scale_pr": 0}),
                              ("start", {"start": np.zeros((4, 4))}), ("selected", {"selected": "all"})):
            with self.assertRaises(corral.InvalidInput) as caught:
                corral.refine(**{"matches": self.matches, "selected": rows, **changes})
            self.assertIn(word, str(caught.exception))

    def test_whole_tables(self):
        records = corral.evaluate_table(self.matches, self.truth)
        self.assertEqual([record["method"] for record in records],
                         ["ss", "nnsr", "ransac", "st", "gc", "hough", "si", "oracle", "baseline"])
        gc = records[4]
        rows = corral.group(self.matches, method="gc").selected
        score = corral.score(self.matches, rows, self.truth, pose=corral.refine(self.matches, rows).pose)
        for key in ("selected", "precision", "recall", "f1", "rotation_error_deg", "translation_error_pr", "mean_error_pr",
                    "rmse_pr"):
            self.assertEqual(gc[key], score[key], key)
        narrow = corral.evaluate_table(self.matches, self.truth, ["gc"], options={"gc": {"tolerance_pr": 0.5}})
        self.assertNotEqual(narrow[0]["selected"], gc["selected"])
        self.assertEqual(len(corral.evaluate_table(self.matches, self.truth, "all")), len(corral.groupers()) + 2)
        bare = corral.Matches(self.matches.source_points, self.matches.target_points, resolution=self.matches.resolution)
        self.assertIn("not applicable", corral.evaluate_table(bare, self.truth, "ss")[0]["status"])
        for word, changes in (("twice", {"methods": "gc,gc"}), ("'x'", {"methods": ["x"]}), ("repeat", {"repeat": 0}),
                              ("si", {"methods": "gc", "options": {"si": {}}}), ("truth", {"truth": np.eye(3)})):
            with self.assertRaises(corral.InvalidInput) as caught:
                corral.evaluate_table(**{"matches": self.matches, "truth": self.truth, **changes})
            self.assertIn(word, str(caught.exception))

    @unittest.skipUnless(program, "CORRAL_PROGRAM names no program")
    def test_the_same_as_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            table = os.path.join(folder, "matches.csv")
            self.called("match", EXAMPLE / "source.ply", EXAMPLE / "target.ply", "-o", table)
            stored = corral.read_matches(table)
            for name in ("source_keypoints", "target_keypoints", *columns_of(stored)):
                np.testing.assert_array_equal(getattr(stored, name), getattr(self.matches, name), name)
            own = os.path.join(folder, "own.csv")
            with open(own, "w") as file:
                file.write(matches_text(self.matches))
            run = json.loads(self.called("run", "--matches", own, "--truth", EXAMPLE / "truth.txt", "--json"))
            expected = [{**record, "time_ms": None} for record in run["methods"] + run["bounds"]]
            found = corral.evaluate_table(self.matches, self.truth, "all")
            self.assertEqual([{**record, "time_ms": None} for record in found], expected)


if __name__ == "__main__":
    unittest.main()
