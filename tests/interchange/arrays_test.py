"""NPZ and MAT as NumPy and SciPy read them, and files that those wrote."""

import unittest

import numpy as np
import scipy.io

from kinebase_files import InterchangeTest, places, test_data


class NpzTest(InterchangeTest):
    def test_places_of_an_amc(self):
        names, ours = places(self.clip)
        arrays = np.load(self.convert(self.clip, "clip.npz"), allow_pickle=False)
        self.assertEqual(list(arrays["bone_names"]), names)
        self.assertEqual(float(arrays["rate_hz"]), 120)
        self.assert_close(ours, arrays["positions"], 1e-9)
        np.testing.assert_allclose(np.linalg.norm(arrays["rotations"], axis=-1), 1, atol=1e-9)

    def test_what_numpy_writes_is_read_by_us(self):
        arrays = np.load(self.convert(self.clip, "first.npz"), allow_pickle=False)
        for name, save in (("plain.npz", np.savez), ("small.npz", np.savez_compressed)):
            again = self.folder / name
            save(again, **{key: arrays[key] for key in arrays.files})
            names, ours = places(again)
            before, expected = places(self.clip)
            self.assertEqual(names, before)
            self.assert_close(ours, expected, 1e-9)

    def test_markers_of_a_real_c3d(self):
        source = test_data("data/hdm05/amc_c3d_pair/HDM_dg_06-03_03_120.c3d")
        names, ours = places(source)
        arrays = np.load(self.convert(source, "markers.npz"), allow_pickle=False)
        self.assertEqual(list(arrays["labels"]), names)
        self.assert_close(ours, arrays["positions"], 1e-9)


class MatTest(InterchangeTest):
    def load(self, path):
        return scipy.io.loadmat(path, squeeze_me=True, struct_as_record=False)

    def test_trajectories_of_an_amc(self):
        names, ours = places(self.clip)
        file = self.load(self.convert(self.clip, "clip.mat"))
        mot, skel = file["mot"], file["skel"]
        self.assertEqual(mot.nframes, len(ours))
        self.assertEqual([node.boneName for node in skel.nodes], names)
        scale = ours[0, 1] @ ours[0, 1] / (mot.jointTrajectories[1][:, 0] @ ours[0, 1])
        for joint, trajectory in enumerate(mot.jointTrajectories):
            self.assert_close(ours[:, joint], scale * trajectory.T, 1e-6)

    def test_fields_are_those_of_the_original_tools(self):
        """Every field of skel, mot and the nodes that the original cache files have.

        But for three of mot that the documentation does not know: a later version of the tools
        added them for marker data. Two are empty, one names a file that is not there.
        """
        folder = test_data("data/hdm05/fk_oracle")
        theirs = self.load(sorted(folder.glob("*.mat"))[0])
        ours = self.load(self.convert(self.clip, "fields.mat"))
        undocumented = {"Labels", "Data", "csvFile"}
        self.assertEqual(len(theirs["mot"].Labels) + len(theirs["mot"].Data), 0)
        for name in ("skel", "mot"):
            wanted = set(theirs[name]._fieldnames) - undocumented
            self.assertLessEqual(wanted, set(ours[name]._fieldnames), f"of {name}")
        self.assertLessEqual(
            set(theirs["skel"].nodes[1]._fieldnames), set(ours["skel"].nodes[1]._fieldnames)
        )

    def test_what_scipy_writes_is_read_by_us(self):
        path = self.convert(self.clip, "first.mat")
        file = scipy.io.loadmat(path)
        again = self.folder / "again.mat"
        scipy.io.savemat(again, {"skel": file["skel"], "mot": file["mot"]}, do_compression=True)
        names, ours = places(again)
        before, expected = places(path)
        self.assertEqual(names, before)
        self.assert_close(ours, expected, 1e-9)


if __name__ == "__main__":
    unittest.main()
