# SPDX-License-Identifier: MIT
"""The package as it is installed: files as recorded, documented, typed."""

import base64
import hashlib
import importlib.metadata
import inspect
import unittest

from package import corral, is_full


class Package(unittest.TestCase):
    def test_the_record_is_right(self):
        files = importlib.metadata.files(corral.__name__)
        names = {str(file) for file in files}
        self.assertIn(f"{corral.__name__}/py.typed", names)
        self.assertEqual(f"{corral.__name__}/surfaces.py" in names, is_full)
        checked = 0
        for file in files:
            if file.hash is not None and "dist-info" not in str(file):
                digest = base64.urlsafe_b64encode(hashlib.sha256(file.read_binary()).digest()).rstrip(b"=").decode()
                self.assertEqual(file.hash.value, digest, file)
                checked += 1
        self.assertGreaterEqual(checked, 5)

    def test_the_licence_is_that_of_what_is_linked(self):
        licence = importlib.metadata.metadata(corral.__name__)["License"]
        self.assertEqual(licence, "GPL-3.0-or-later" if is_full else "MIT")

    def test_everything_public_is_documented(self):
        for name in corral.__all__:
            entry = getattr(corral, name)
            if isinstance(entry, type) and issubclass(entry, Exception):
                continue
            self.assertTrue(inspect.getdoc(entry), name)
            if inspect.isfunction(entry):
                for parameter in inspect.signature(entry).parameters.values():
                    self.assertIsNot(parameter.annotation, parameter.empty, f"{name}: {parameter.name}")


if __name__ == "__main__":
    unittest.main()
