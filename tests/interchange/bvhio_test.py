"""BVH as bvhio reads it, and BVH that bvhio wrote."""

import unittest

import bvhio
import numpy as np

from kinebase_files import InterchangeTest, places


def their_places(path):
    """Name → places in the world, an array [frame, xyz]."""
    root = bvhio.readAsHierarchy(str(path))
    joints = [joint for joint, _, _ in root.layout()]
    found = {joint.Name: [] for joint in joints}
    first, last = root.getKeyframeRange()
    for frame in range(first, last + 1):
        root.loadPose(frame)
        for joint in joints:
            place = joint.PositionWorld
            found[joint.Name].append([place.x, place.y, place.z])
    return {name: np.array(values) for name, values in found.items()}


class BvhioTest(InterchangeTest):
    def assert_same_places(self, path):
        names, ours = places(path, "--source-units", "cm", "--source-up", "y")
        theirs = their_places(path)
        common = [name for name in names if name in theirs]
        self.assertGreaterEqual(len(common), 20)
        for name in common:
            self.assert_close(ours[:, names.index(name)], theirs[name], 1e-3)  # Theirs are floats.

    def test_ours_is_read_by_bvhio(self):
        self.assert_same_places(self.convert(self.clip, "clip.bvh"))

    def test_theirs_is_read_by_us(self):
        ours = self.convert(self.clip, "ours.bvh", "--rate", 30)
        theirs = self.folder / "theirs.bvh"
        bvhio.writeBvh(str(theirs), bvhio.readAsBvh(str(ours)))
        self.assert_same_places(theirs)


if __name__ == "__main__":
    unittest.main()
