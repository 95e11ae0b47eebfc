# SPDX-License-Identifier: MIT
"""What arrays go in and come out, and what is refused."""

import threading
import time
import tracemalloc
import unittest

import numpy as np

from package import columns_of, corral


class Arrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.matches, cls.truth = corral.make_synthetic(300, inlier_ratio=0.3, resolution=0.25)
        cls.columns = columns_of(cls.matches)

    def changed(self, **changes):
        return corral.group(**{**self.columns, **changes}, method="si")

    def refused(self, words, **changes):
        with self.assertRaises(corral.InvalidInput) as caught:
            self.changed(**changes)
        message = str(caught.exception)
        for word in words:
            self.assertIn(word, message)
        self.assertNotIn("\n", message)

    def test_types_and_shapes_of_results(self):
        found = corral.group(self.matches, method="si")
        self.assertEqual(found.selected.dtype, np.int64)
        self.assertTrue((np.diff(found.selected) > 0).all())
        self.assertEqual((found.scores.dtype, found.scores.shape), (np.float64, (300,)))
        self.assertIsNone(found.pose)
        self.assertIsNone(corral.group(self.matches, method="gc").scores)
        self.assertGreater(found.seconds, 0)
        pose = corral.group(self.matches, method="ransac").pose
        self.assertEqual((pose.dtype, pose.shape), (np.float64, (4, 4)))
        self.assertEqual(pose[3].tolist(), [0, 0, 0, 1])
        self.assertLess(np.abs(pose - self.truth).max(), 2)

    def test_any_layout_and_any_real_type_of_the_same_numbers(self):
        expected = self.changed().selected
        points, frames = self.columns["source_points"], self.columns["source_frames"]
        wide = np.zeros((300, 7))
        wide[:, 1:6:2] = points
        for same in (np.ascontiguousarray(points), np.asfortranarray(points), wide[:, 1:6:2], points[::-1][::-1],
                     points.astype(">f8"), points.astype(np.longdouble), points.tolist()):
            np.testing.assert_array_equal(self.changed(source_points=same).selected, expected)
        np.testing.assert_array_equal(self.changed(source_frames=np.asfortranarray(frames)).selected, expected)
        rounded = np.round(points)
        for kind in (np.int16, np.int64, np.float32):
            np.testing.assert_array_equal(self.changed(source_points=rounded.astype(kind)).selected,
                                          self.changed(source_points=rounded).selected)

    def test_frames_keep_their_rows(self):
        transposed = {**self.columns, "source_frames": self.columns["source_frames"].transpose(0, 2, 1)}
        self.assertFalse(np.array_equal(corral.group(**transposed, method="hough").selected,
                                        corral.group(self.matches, method="hough").selected))
        again = corral.Matches(**self.columns)
        np.testing.assert_array_equal(again.source_frames, self.columns["source_frames"])

    def test_columns_are_read_only_views_that_keep_the_table(self):
        matches = corral.Matches(**self.columns)
        for name in ("source_points", "target_frames", "feature_distance"):
            column = getattr(matches, name)
            self.assertTrue(np.shares_memory(column, getattr(matches, name)), name)
            with self.assertRaises(ValueError):
                column[0] = 0
        points = matches.source_points
        del matches, column
        np.testing.assert_array_equal(points, self.columns["source_points"])

    def test_columns_of_doubles_are_not_copied(self):
        points, rows = np.random.default_rng(1).random((200_000, 3)), np.arange(200_000.0)
        tracemalloc.start()
        try:
            corral.Matches(points, points, resolution=1, feature_distance=rows)
            exact = tracemalloc.get_traced_memory()[1]
            tracemalloc.reset_peak()
            corral.Matches(points.astype(np.float32), points, resolution=1)
            converted = tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()
        self.assertLess(exact, 100_000)
        self.assertGreater(converted, points.nbytes)  # so that the measure sees a copy

    def test_what_is_no_array_of_real_numbers(self):
        points = self.columns["source_points"]
        for wrong in ("points", np.array([["a", "b", "c"]] * 300), points.astype(complex), points.astype(object), points > 0,
                      [[1, 2, 3], [4, 5]], {"x": 1}, object()):
            self.refused(["source_points", "real numbers"], source_points=wrong)
        self.refused(["feature_distance", "real numbers"], feature_distance="near")
        self.refused(["resolution", "real numbers"], resolution="1 mm")
        self.refused(["source_centroid", "complex128"], source_centroid=[1j, 0, 0])

    def test_wrong_shapes(self):
        points, frames = self.columns["source_points"], self.columns["source_frames"]
        self.refused(["source_points", "(300, 2)", "(N, 3)"], source_points=points[:, :2])
        self.refused(["target_points", "(3, 300)"], target_points=points.T)
        self.refused(["target_points", "299 rows", "300"], target_points=points[:-1])
        self.refused(["source_frames", "(300, 9)", "(M, 3, 3)"], source_frames=frames.reshape(-1, 9))
        self.refused(["feature_distance", "(300, 1)"], feature_distance=points[:, :1])
        self.refused(["feature_distance", "10 rows"], feature_distance=np.arange(10))
        self.refused(["source_centroid", "(4,)"], source_centroid=np.zeros(4))
        self.refused(["resolution", "(2,)"], resolution=[1, 2])

    def test_numbers_that_are_not_finite(self):
        for name in ("source_points", "target_points", "feature_distance", "second_feature_distance", "target_frames"):
            for value in (np.nan, np.inf):
                wrong = self.columns[name].copy()
                wrong[17] = value
                self.refused([name, "row 17", "finite"], **{name: wrong})
        self.refused(["source_centroid", "finite"], source_centroid=[0, np.nan, 0])
        for value in (np.nan, 0, -1):
            self.refused(["resolution", "above zero"], resolution=value)

    def test_empty_and_tiny_tables(self):
        for rows in (0, 1, 2):
            few = {name: column if name in ("resolution", "source_centroid") else column[:rows]
                   for name, column in self.columns.items()}
            for grouper in corral.groupers():
                found = corral.group(**few, method=grouper.name)
                self.assertLessEqual(len(found.selected), rows, grouper.name)

    def test_other_threads_run_meanwhile(self):
        matches, _ = corral.make_synthetic(20_000, inlier_ratio=0.1)
        done, ticks = threading.Event(), []

        def work():
            corral.group(matches, method="gc")
            done.set()

        thread = threading.Thread(target=work)
        start = time.perf_counter()
        thread.start()
        while not done.is_set():
            ticks.append(time.perf_counter() - start)
            time.sleep(1e-4)
        thread.join()
        self.assertGreater(len(ticks), 20)

    def test_a_call_costs_less_than_a_fifth_of_a_millisecond_beside_the_grouper(self):
        matches, _ = corral.make_synthetic(1000, inlier_ratio=0.3)
        columns = {name: np.ascontiguousarray(column) for name, column in columns_of(matches).items()
                   if name not in ("resolution", "source_centroid")}

        def least(call):
            costs = []
            for _ in range(200):
                start = time.perf_counter()
                found = call()
                costs.append(time.perf_counter() - start - found.seconds)
            return min(costs)

        of_table = least(lambda: corral.group(matches, method="gc"))
        of_columns = least(lambda: corral.group(**columns, method="gc", resolution=1))
        print(f"\nbeside the grouper, 1,000 rows: {1e3 * of_table:.4f} ms for Matches, {1e3 * of_columns:.4f} ms for columns")
        self.assertLess(of_table, 0.2e-3)
        self.assertLess(of_columns, 0.2e-3)


if __name__ == "__main__":
    unittest.main()
