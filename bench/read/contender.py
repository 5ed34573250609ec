"""Other readers under the rules of read_contender.cpp: reads a file some times and tells how long
each took and how much memory the first needed, beyond what the interpreter with all its packages had.

  contender.py READER FILE RUNS [VALUES]      VALUES gets the numbers as 64-bit floats
"""

import contextlib
import io
import json
import sys
import time
from pathlib import Path

import numpy as np


class Reader:
    """`read` is measured; `values` then makes an array [frame × value] of what it gave."""

    def prepare(self, file):
        """What has to be done once, and does not count."""

    def split(self, record):
        """Arrays to write one after another."""
        return [self.values(record)]


class AsfamcParser(Reader):
    def prepare(self, file):
        import asfamcparser
        self.parse = asfamcparser.ParseAMC

    def read(self, file):
        return self.parse(file).amc

    def values(self, record):
        return np.array([[v for bone in frame.values() for v in bone] for frame in record.frames])


class Pyacclaim(Reader):
    """Leaves out the last frame; turns degrees and the skeleton's lengths into radians and inches."""

    def prepare(self, file):
        import pyacclaim
        self.load = pyacclaim.loadAMC
        with contextlib.redirect_stdout(io.StringIO()):
            self.skeleton = pyacclaim.loadASF(Path(file).with_suffix(".asf"), verbose=False)

    def read(self, file):
        return self.load(self.skeleton, file)

    def values(self, record):
        frames = []
        for pose in record:
            frame = np.concatenate(list(pose.values()))
            place = frame[:3] * self.skeleton["units"]["length"]  # The root is the first bone.
            frames.append(np.concatenate([place, np.rad2deg(frame[3:])]))
        return np.array(frames)


class Bvhio(Reader):
    """Values are a place and a quaternion (w, x, y, z) for each joint."""

    def prepare(self, file):
        import bvhio
        self.load = bvhio.readAsBvh

    def read(self, file):
        return self.load(file)

    def values(self, record):
        joints = [joint for joint, _, _ in record.Root.layout()]
        return np.array([[number for joint in joints
                          for number in (*joint.Keyframes[frame].Position.to_tuple(),
                                         *joint.Keyframes[frame].Rotation.to_tuple())]
                         for frame in range(record.FrameCount)])


class Ezc3d(Reader):
    def prepare(self, file):
        import ezc3d
        self.load = ezc3d.c3d

    def read(self, file):
        return self.load(file)

    def split(self, record):
        points = record["data"]["points"][:3].transpose(2, 1, 0)
        return [points, record["data"]["analogs"][0].T]


class C3d(Reader):
    def prepare(self, file):
        import c3d
        self.reader = c3d.Reader

    def read(self, file):
        with open(file, "rb") as handle:
            return list(self.reader(handle).read_frames())

    def split(self, record):
        points = np.array([frame[1] for frame in record])
        places = np.where(points[:, :, 3:4] < 0, np.nan, points[:, :, :3])
        return [places, np.concatenate([frame[2].T for frame in record])]


class PlainPython(Reader):
    """CSM, for which there is no package: words and float() as one would write them."""

    def read(self, file):
        rows = []
        with open(file, encoding="latin-1") as lines:
            for line in lines:
                if line.strip().lower() == "$points":
                    break
            for line in lines:
                row = []
                for word in line.split()[1:]:
                    row.extend([float("nan")] * 3 if word == "DROPOUT" else [float(word)])
                rows.append(row)
        return rows

    def values(self, record):
        return np.array(record)


READERS = {"asfamc-parser": AsfamcParser, "pyacclaim": Pyacclaim, "bvhio": Bvhio, "ezc3d": Ezc3d,
           "c3d": C3d, "plain Python": PlainPython}


def status(name):
    """A line of /proc/self/status, in bytes."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(name + ":"):
            return int(line.split()[1]) * 1024
    raise KeyError(name)


def main():
    reader, file, runs = READERS[sys.argv[1]](), sys.argv[2], int(sys.argv[3])
    reader.prepare(file)
    Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # The peak counts anew.
    before = status("VmRSS")
    record = reader.read(file)
    peak = status("VmHWM") - before
    seconds = []
    for _ in range(runs):
        record = None
        begin = time.perf_counter()
        record = reader.read(file)
        seconds.append(time.perf_counter() - begin)
    if len(sys.argv) > 4:
        with open(sys.argv[4], "wb") as out:
            for values in reader.split(record):
                out.write(np.ascontiguousarray(values, dtype=np.float64).tobytes())
    print(json.dumps({"seconds": seconds, "peak_bytes": peak}))


if __name__ == "__main__":
    main()
