"""C3D as ezc3d and the package c3d read it, and C3D that ezc3d wrote."""

import unittest
import warnings

import c3d
import ezc3d
import numpy as np

from kinebase_files import InterchangeTest, places, test_data

# One of each flavour: processors, number types, analog, events, force plates, long recordings.
REAL_FILES = [
    "data/c3d/btk/c3d.org/sample01/Eb015pi.c3d",
    "data/c3d/btk/c3d.org/sample01/Eb015pr.c3d",
    "data/c3d/btk/c3d.org/sample02/pc_real.c3d",
    "data/c3d/btk/c3d.org/sample09/PlugInC3D.c3d",
    "data/c3d/btk/c3d.org/sample10/TYPE-2.C3D",
    "data/cmu/02/02_01.c3d",
    "data/hdm05/amc_c3d_pair/HDM_dg_06-03_03_120.c3d",
]


def parameter(recording, group, name):
    return recording["parameters"][group][name]["value"]


class C3dTest(InterchangeTest):
    def test_joints_of_an_amc_are_read_by_ezc3d(self):
        path = self.convert(self.clip, "clip.c3d", "--units", "mm", "--up", "y")
        names, ours = places(self.clip)
        theirs = ezc3d.c3d(str(path))
        self.assertEqual(parameter(theirs, "POINT", "LABELS"), names)
        self.assertEqual(parameter(theirs, "POINT", "UNITS"), ["mm"])
        self.assertEqual(parameter(theirs, "POINT", "RATE")[0], 120)
        points = theirs["data"]["points"][:3].transpose(2, 1, 0)
        self.assert_close(10 * ours, points, 1e-3)  # Floats of up to a few metres.

    def test_joints_of_an_amc_are_read_by_c3d(self):
        path = self.convert(self.clip, "clip_c3d.c3d", "--units", "mm", "--up", "y")
        _, ours = places(self.clip)
        with open(path, "rb") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            frames = [points[:, :3] for _, points, _ in c3d.Reader(file).read_frames()]
        self.assert_close(10 * ours, frames, 1e-3)

    def test_what_we_write_of_real_files_is_what_ezc3d_saw_in_them(self):
        for name in REAL_FILES:
            with self.subTest(name):
                source = test_data(name)
                written = self.convert(source, "again.c3d")
                before, after = ezc3d.c3d(str(source)), ezc3d.c3d(str(written))
                np.testing.assert_array_equal(before["data"]["points"], after["data"]["points"])
                np.testing.assert_array_equal(before["data"]["analogs"], after["data"]["analogs"])
                for kind in ("residuals", "camera_masks"):
                    np.testing.assert_array_equal(
                        before["data"]["meta_points"][kind], after["data"]["meta_points"][kind]
                    )
                self.assertEqual(
                    before["header"]["points"]["first_frame"],
                    after["header"]["points"]["first_frame"],
                )
                for group in before["parameters"]:
                    self.assertIn(group, after["parameters"])

    def test_ours_of_real_files_are_their_values(self):
        """Places that we state are those that ezc3d reads, in cm and turned."""
        source = test_data("data/hdm05/amc_c3d_pair/HDM_dg_06-03_03_120.c3d")
        names, ours = places(source)
        theirs = ezc3d.c3d(str(source))
        self.assertEqual(parameter(theirs, "POINT", "LABELS"), names)
        points = theirs["data"]["points"][:3].transpose(2, 1, 0)
        self.assert_close(ours, points[:, :, [1, 2, 0]] / 10, 1e-4)  # Z up becomes Y up.

    def test_what_ezc3d_writes_is_read_by_us(self):
        frames = 300
        time = np.arange(frames) / 100
        points = np.ones((4, 2, frames))
        points[0, 0], points[1, 0], points[2, 0] = 1000 * np.sin(time), 200 * time, 1200 + time
        points[0, 1], points[1, 1], points[2, 1] = -time, 3 * time, 400 - time
        points[:3, 1, 50:60] = np.nan
        recording = ezc3d.c3d()
        recording["parameters"]["POINT"]["RATE"]["value"] = [100]
        recording["parameters"]["POINT"]["LABELS"]["value"] = ["HAND", "FOOT"]
        recording["parameters"]["POINT"]["UNITS"]["value"] = ["mm"]
        recording["data"]["points"] = points
        path = self.folder / "theirs.c3d"
        recording.write(str(path))
        names, ours = places(path, "--source-up", "z")
        self.assertEqual(names, ["HAND", "FOOT"])
        self.assert_close(ours, points[:3].transpose(2, 1, 0)[:, :, [1, 2, 0]] / 10, 1e-4)


    def test_what_c3d_writes_is_read_by_us(self):
        """Points with a gap, and three analog channels at four times the rate."""
        frames = 90
        time = np.arange(frames) / 60
        writer = c3d.Writer(point_rate=60, analog_rate=240, point_scale=-1)
        points = np.zeros((frames, 2, 5), np.float32)
        points[:, 0, 0], points[:, 0, 1], points[:, 0, 2] = 300 * np.cos(time), time, 900 - time
        points[:, 1, :3] = 5 + 10 * time[:, np.newaxis]  # Not (0, 0, 0), which is missing.
        points[20:30, 1, :3], points[20:30, 1, 3] = 0, -1
        analog = np.arange(frames * 12, dtype=np.float32).reshape(frames, 3, 4)
        writer.add_frames(list(zip(points, analog)))
        writer.set_point_labels(["HAND", "FOOT"])
        writer.set_analog_labels(["EMG1", "EMG2", "EMG3"])
        path = self.folder / "theirs_c3d.c3d"
        with open(path, "wb") as file:
            writer.write(file)
        names, ours = places(path, "--source-up", "z", "--source-units", "mm")
        self.assertEqual(names, ["HAND", "FOOT"])
        expected = points[:, :, [1, 2, 0]].astype(float) / 10
        expected[20:30, 1] = np.nan
        self.assert_close(ours, expected, 1e-4)
        table = self.convert(path, "channels.sto").read_text().splitlines()
        rows = [line.split("\t") for line in table[table.index("endheader") + 1 :]]
        self.assertEqual(rows[0], ["time", "EMG1", "EMG2", "EMG3"])
        values = np.array(rows[1:], float)[:, 1:]
        np.testing.assert_array_equal(values, analog.transpose(0, 2, 1).reshape(-1, 3))


if __name__ == "__main__":
    unittest.main()
