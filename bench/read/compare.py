"""Our readers beside those of other projects, on real recordings: same values first, then time and
memory. Prints Markdown. scripts/bench calls it with what it needs.

Each contender reads a file in a process of its own, once to see how much memory that takes and then
some times against the clock; the contenders take turns, so that what else the machine does hits all.
"""

import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
OURS = "kinebase"
# Recording, other readers of it.
CASES = [
    ("cmu/135/135_02.amc", ["asfamc-parser", "pyacclaim"]),
    ("bvh/misc/Boxing_Toes.bvh", ["bvhio"]),
    ("bvh/misc/cmu_12_01_walk.bvh", ["bvhio"]),
    ("csm/ThomasFechten.csm", ["plain Python"]),
    ("hdm05/take_c3d/HDM_bd_05-01_01_120.c3d", ["ezc3d", "c3d"]),
    ("c3d/btk/c3d.org/sample09/PlugInC3D.c3d", ["ezc3d", "c3d"]),
]


def run(program, contender, file, runs, values=None):
    command = [program] if contender == OURS else [sys.executable, HERE / "contender.py", contender]
    command += [file, str(runs)] + ([values] if values else [])
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          env=environment)
    if done.returncode != 0:
        sys.exit(f"{contender} cannot read {file.name}:\n{done.stderr}")
    return json.loads(done.stdout)


def copy_recording(source, folder):
    """A copy that all contenders read: asfamc-parser knows no comments before the keywords."""
    copy = folder / source.name
    shutil.copyfile(source, copy)
    if source.suffix == ".amc":
        text = source.read_bytes()
        copy.write_bytes(text[text.index(b"\n:") + 1:])
        skeleton = next(source.parent.glob("*.asf"))
        shutil.copyfile(skeleton, copy.with_suffix(".asf"))
    return copy


def quaternions(angles, axes):
    """Rotations about `axes`, the first outermost, as (w, x, y, z): [frame, 4] of [frame, axis]."""
    w, v = np.ones(len(angles)), np.zeros((len(angles), 3))
    for angle, axis in zip(np.radians(angles).T / 2, axes):
        turn = np.sin(angle)[:, None] * np.eye(3)["XYZ".index(axis)]
        w, v = (w * np.cos(angle) - np.sum(v * turn, axis=1),
                w[:, None] * turn + np.cos(angle)[:, None] * v + np.cross(v, turn))
    return np.column_stack([w, v])


def channels_and_offsets(file):
    """Of every joint of a BVH file: names of its channels, its place where no channel tells it."""
    joints, offset = [], None
    for line in file.read_text(encoding="latin-1").splitlines():
        words = line.split()
        if words[:1] == ["OFFSET"]:
            offset = [float(word) for word in words[1:]]
        elif words[:1] == ["CHANNELS"]:
            joints.append((words[2:], offset))
    return joints


def places_and_quaternions(file, values):
    """Our BVH channels as bvhio gives them."""
    joints = channels_and_offsets(file)
    values = values.reshape(-1, sum(len(names) for names, _ in joints))
    column, parts = 0, []
    for names, offset in joints:
        mine = dict(zip(names, values[:, column:column + len(names)].T))
        column += len(names)
        parts.append(np.column_stack([mine.get(f"{axis}position", np.full(len(values), at))
                                      for axis, at in zip("XYZ", offset)]))
        turns = [name for name in names if name.endswith("rotation")]
        parts.append(quaternions(np.column_stack([mine[name] for name in turns]),
                                 [name[0] for name in turns]))
    return np.concatenate(parts, axis=1)


def check_same(file, contender, ours, theirs):
    """Says how equal they are, or stops."""
    def require(holds, told):
        if not holds:
            sys.exit(f"{file.name}: {contender} reads other values than {OURS}: {told}")

    if contender == "bvhio":
        mine = places_and_quaternions(file, ours)
        theirs = theirs.reshape(-1, mine.shape[1])
        declared = int(re.search(r"Frames:\s*(\d+)", file.read_text(encoding="latin-1"))[1])
        require(len(theirs) == declared, "another number of frames")
        mine = mine[:declared].reshape(len(theirs), -1, 7)
        theirs = theirs.reshape(mine.shape)
        sign = np.sign(np.sum(mine[:, :, 3:] * theirs[:, :, 3:], axis=2, keepdims=True))
        difference = max(np.abs(mine[:, :, :3] - theirs[:, :, :3]).max(),
                         np.abs(mine[:, :, 3:] * sign - theirs[:, :, 3:]).max())
        require(difference < 1e-4, f"by up to {difference:g}")
        return f"to {difference:.0e} (32-bit floats)"
    if contender == "pyacclaim":
        missing = len(ours) - len(theirs)
        require(0 < missing < 200, "another number of frames")
        ours = ours[:len(theirs)]
    require(len(ours) == len(theirs), f"{len(theirs)} values, not {len(ours)}")
    same = np.array_equal(ours, theirs, equal_nan=True)
    if same:
        return "all bits"
    require(np.array_equal(np.isnan(ours), np.isnan(theirs)), "others are missing")
    difference = np.nanmax(np.abs(ours - theirs) / np.maximum(np.abs(ours), 1e-3))
    require(difference < 1e-5, f"by up to {difference:g}")
    return f"to {difference:.0e}" + (", the last frame missing" if contender == "pyacclaim" else "")


def compare(program, file, contenders, runs, rounds):
    values, results = {}, {}
    for contender in contenders:
        out = file.with_suffix(".values")
        run(program, contender, file, 0, out)
        values[contender] = np.fromfile(out)
        out.unlink()
    equal = {contender: check_same(file, contender, values[OURS], values[contender])
             for contender in contenders if contender != OURS}
    equal[OURS] = ""
    for _ in range(rounds):
        for contender in contenders:
            one = run(program, contender, file, runs if contender != OURS else 10 * runs)
            result = results.setdefault(contender, {"seconds": [], "peak_bytes": []})
            result["seconds"] += one["seconds"]
            result["peak_bytes"].append(one["peak_bytes"])
    decoded = run(program, OURS, file, 0)["record_bytes"]
    return equal, results, decoded


def rows(file, contenders, equal, results, decoded):
    size = file.stat().st_size / 1e6
    median = {each: statistics.median(results[each]["seconds"]) for each in contenders}
    for each in contenders:
        seconds = results[each]["seconds"]
        peak = statistics.median(results[each]["peak_bytes"])
        slower = "" if each == OURS else f"{median[each] / median[OURS]:.0f} ×"
        yield (f"| {file.name} ({size:.1f} MB) | {each} | {size / median[each]:.4g} | "
               f"{size / max(seconds):.4g} to {size / min(seconds):.4g} | {slower} | "
               f"{peak / 1e6:.1f} | {peak / decoded:.2g} × | {equal[each]} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=Path, help="read_contender")
    parser.add_argument("--data", required=True, type=Path, help="folder of real recordings")
    parser.add_argument("--runs", type=int, default=2, help="reads in a process (ours: ten times)")
    parser.add_argument("--rounds", type=int, default=5, help="turns that the contenders take")
    options = parser.parse_args()
    packages = ("asfamc-parser", "pyacclaim", "bvhio", "ezc3d", "c3d", "numpy")
    print("Python " + sys.version.split()[0] + "".join(f", {each} {version(each)}"
                                                       for each in packages))
    print("\n| file | reader | MB/s, median | spread | takes | peak memory, MB "
          "| of the numbers | values equal ours |")
    print("|---|---|---:|---|---:|---:|---:|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, others in CASES:
            file = copy_recording(options.data / name, Path(folder))
            contenders = [OURS, *others]
            result = compare(options.program, file, contenders, options.runs, options.rounds)
            for row in rows(file, contenders, *result):
                print(row, flush=True)


if __name__ == "__main__":
    main()
