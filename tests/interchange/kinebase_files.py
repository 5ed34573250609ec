"""Verbs that the interchange tests share: run the program, read its tables, find recordings."""

import csv
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

PROGRAM = os.environ["KINEBASE_PROGRAM"]


def kinebase(*arguments):
    """Runs the program; its message becomes the test's if it fails."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"kinebase {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


def places(recording, *options):
    """What `kinebase convert` says: names and an array [frame, point, xyz] in cm, Y up."""
    with tempfile.TemporaryDirectory() as folder:
        table = pathlib.Path(folder) / "places.csv"
        kinebase("convert", recording, table, "--quiet", *options)
        with open(table, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    names = [column[:-2] for column in rows[0][2::3]]
    values = [[float(cell) if cell else np.nan for cell in row[2:]] for row in rows[1:]]
    return names, np.array(values).reshape(len(values), len(names), 3)


def test_data(path):
    """A file or folder of the shared recordings; skips the test where there are none."""
    root = os.environ.get("KINEBASE_TEST_DATA")
    root = pathlib.Path(root) if root else pathlib.Path(__file__).parents[3] / "shared"
    if not root.is_dir():
        raise unittest.SkipTest(f"no recordings at {root}")
    return root / path


class InterchangeTest(unittest.TestCase):
    """A folder of its own, and one made-up clip as ASF/AMC."""

    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)
        kinebase("synth", cls.folder / "synth", "--actors", 1, "--repetitions", 1, "--quiet")
        cls.clip = sorted((cls.folder / "synth").rglob("*jumpingJack*.amc"))[0]

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def convert(self, source, name, *options):
        """Converts into a file of this name; gives its path."""
        target = self.folder / name
        kinebase("convert", source, target, "--force", "--quiet", *options)
        return target

    def assert_close(self, ours, theirs, tolerance):
        """Equal shapes, NaN in the same places, and values no further apart than `tolerance`."""
        ours, theirs = np.asarray(ours, float), np.asarray(theirs, float)
        self.assertEqual(ours.shape, theirs.shape)
        np.testing.assert_array_equal(np.isnan(ours), np.isnan(theirs))
        self.assertLessEqual(np.nanmax(np.abs(ours - theirs), initial=0), tolerance)
