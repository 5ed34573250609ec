"""BVH and GLB as Assimp reads them."""

import json
import subprocess
import unittest

import numpy as np

from kinebase_files import InterchangeTest, places, test_data


def rotation(w, x, y, z):
    """The matrix of a unit quaternion."""
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def at_key(keys, frame):
    """The key of a frame, or the only one."""
    return keys[min(frame, len(keys) - 1)][1]


class Scene:
    """What Assimp made of a file: where each node is in each frame of its animation."""

    def __init__(self, path):
        target = path.with_suffix(".assjson")
        done = subprocess.run(
            ["assimp", "export", path, target, "-fassjson"], capture_output=True, text=True
        )
        if done.returncode != 0 or not target.exists():
            raise AssertionError(f"assimp: {done.stdout}{done.stderr}")
        scene = json.loads(target.read_text())
        self.root = scene["rootnode"]
        self.channels = {c["name"]: c for c in scene["animations"][0]["channels"]}
        self.frames = max(len(c["rotationkeys"]) for c in self.channels.values())

    def local(self, node, frame):
        channel = self.channels.get(node["name"])
        if channel is None:
            return np.array(node["transformation"], float).reshape(4, 4)
        matrix = np.eye(4)
        matrix[:3, :3] = rotation(*at_key(channel["rotationkeys"], frame))
        matrix[:3, 3] = at_key(channel["positionkeys"], frame)
        return matrix

    def places(self, frame):
        """Name → place in the world."""
        found = {}

        def visit(node, parent):
            world = parent @ self.local(node, frame)
            found[node["name"]] = world[:3, 3]
            for child in node.get("children", []):
                visit(child, world)

        visit(self.root, np.eye(4))
        return found


class AssimpTest(InterchangeTest):
    def assert_same_places(self, path, names, ours, scale):
        """Every joint that both know lies in the same place, in at least 20 of them."""
        scene = Scene(path)
        self.assertEqual(scene.frames, len(ours))
        for frame in range(0, scene.frames, max(1, scene.frames // 20)):
            theirs = scene.places(frame)
            common = [name for name in names if name in theirs]
            self.assertGreaterEqual(len(common), 20)
            self.assert_close(
                [ours[frame][names.index(name)] for name in common],
                [theirs[name] * scale for name in common],
                0.01,  # Assimp computes in floats, and writes six digits.
            )

    def test_bvh_of_an_amc(self):
        path = self.convert(self.clip, "clip.bvh")
        names, ours = places(path)
        self.assert_same_places(path, names, ours, 1)

    def test_glb_of_an_amc(self):
        names, ours = places(self.convert(self.clip, "clip.bvh"))
        self.assert_same_places(self.convert(self.clip, "clip.glb"), names, ours, 100)

    def test_real_bvh(self):
        """A file of others: we and Assimp see the same."""
        source = test_data("data/bvh/misc/Boxing_Toes.bvh")
        path = self.convert(source, "boxing.bvh")
        names, ours = places(path, "--source-units", "cm", "--source-up", "y")
        self.assert_same_places(path, names, ours, 1)


if __name__ == "__main__":
    unittest.main()
