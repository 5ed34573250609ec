"""TRC, MOT and STO as OpenSim reads them, and TRC that OpenSim wrote.

The package of OpenSim is built without its C3D adapter, which reads through ezc3d: see c3d_test.
"""

import os
import unittest

import numpy as np
import opensim

from kinebase_files import InterchangeTest, places, test_data

opensim.Logger.setLevelString("Off")


def table_places(table):
    """Names and an array [frame, point, xyz] of a TimeSeriesTableVec3."""
    names = list(table.getColumnLabels())
    values = np.array(
        [
            [[point[axis] for axis in range(3)] for point in (row[i] for i in range(len(names)))]
            for row in (table.getRowAtIndex(frame) for frame in range(table.getNumRows()))
        ]
    )
    return names, values


class OpenSimTest(InterchangeTest):
    def test_joints_of_an_amc_as_trc(self):
        path = self.convert(self.clip, "clip.trc", "--units", "m")
        names, ours = places(self.clip)
        table = opensim.TimeSeriesTableVec3(str(path))
        labels, theirs = table_places(table)
        self.assertEqual(labels, names)
        self.assertEqual(table.getTableMetaDataString("Units"), "m")
        np.testing.assert_allclose(
            table.getIndependentColumn(), np.arange(len(ours)) / 120, atol=1e-6
        )
        self.assert_close(ours / 100, theirs, 1e-6)

    def test_markers_of_a_real_c3d_as_trc(self):
        source = test_data("data/cmu/02/02_01.c3d")
        path = self.convert(source, "markers.trc")
        names, ours = places(source)
        labels, theirs = table_places(opensim.TimeSeriesTableVec3(str(path)))
        self.assertEqual(labels, names)
        self.assert_close(10 * ours, theirs, 1e-3)

    def test_what_opensim_writes_is_read_by_us(self):
        path = self.convert(self.clip, "for_opensim.trc")
        again = self.folder / "by_opensim.trc"
        opensim.TRCFileAdapter.write(opensim.TimeSeriesTableVec3(str(path)), str(again))
        names, ours = places(again)
        before, expected = places(path)
        self.assertEqual(names, before)
        self.assert_close(ours, expected, 1e-3)

    def test_angles_of_an_amc_as_mot(self):
        """The angles of an AMC are columns of the MOT, and its values those of the file."""
        table = opensim.TimeSeriesTable(str(self.convert(self.clip, "clip.mot")))
        self.assertEqual(table.getTableMetaDataString("inDegrees"), "yes")
        column = list(table.getDependentColumn("lfemur_rx").to_numpy())
        lines = [
            line.split() for line in self.clip.read_text().splitlines() if line.startswith("lfemur ")
        ]
        self.assertEqual(len(column), len(lines))
        # An angle may be written as another that means the same rotation; most are not.
        same = np.isclose(column, [float(line[1]) for line in lines], atol=1e-4)
        self.assertGreater(np.mean(same), 0.99)

    def test_orientations_of_an_amc_as_sto(self):
        table = opensim.TimeSeriesTableQuaternion(str(self.convert(self.clip, "clip.sto")))
        _, ours = places(self.clip)
        self.assertEqual(table.getNumRows(), len(ours))
        for frame in range(0, len(ours), 20):
            row = table.getRowAtIndex(frame)
            for i in range(table.getNumColumns()):
                norm = sum(row.getElt(0, i).get(axis) ** 2 for axis in range(4))
                self.assertAlmostEqual(norm, 1, places=6)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    unittest.main()
