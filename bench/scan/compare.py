"""Our scan beside those of other projects, on the same columns: same costs first, as far as the
recurrences are the same, then time. Prints Markdown. scripts/bench calls it with what it needs.

One template of 106 columns over 43,200 columns (24 minutes at 30 Hz) of 39 made-up features, one
thread. Each contender works in a process of its own, and they take turns, so that what else the
machine does hits all; the time is the processor's. Python packages get columns of 64-bit floats, for
none has features of a bit; making those is not measured.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from importlib.metadata import version
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from contender import CONTENDERS, FEATURES, columns
from measure import digits, machine, median_and_spread, table

TEMPLATE_COLUMNS, RECORDING_COLUMNS = 106, 43_200
CELLS = TEMPLATE_COLUMNS * RECORDING_COLUMNS
REFERENCE = "reference"


def make_files(folder):
    """Features that hold or fail for about half a second; the template is a stretch of them with
    every thirtieth value turned round, so that there is something to find."""
    random = np.random.default_rng(1)
    flips = random.random((RECORDING_COLUMNS, FEATURES)) < 1 / 15
    values = np.logical_xor.accumulate(flips, axis=0)
    query = values[1000:1000 + TEMPLATE_COLUMNS]
    query = query ^ (random.random(query.shape) < 1 / 30)
    weights = np.uint64(1) << np.arange(FEATURES, dtype=np.uint64)
    paths = folder / "template.words", folder / "recording.words"
    for path, bits in zip(paths, (query, values)):
        (bits * weights).sum(axis=1, dtype=np.uint64).tofile(path)
    return paths


def classic_last_row(query, recording):
    """Accumulated costs with steps (1,0), (0,1), (1,1), written down plainly."""
    costs = (query[:, None, :] != recording[None, :, :]).sum(axis=2).astype(float)
    row = costs[0]
    for k in range(1, len(costs)):
        above, row, left = row, costs[k], np.inf
        corner = np.inf
        for column, nearest in enumerate(above):
            left = row[column] = min(nearest, corner, left) + row[column]
            corner = nearest
    return row


def run(program, contender, files, runs, out=None):
    command = ([sys.executable, "-B", HERE / "contender.py"] if contender in CONTENDERS
               else [program])
    command += [contender, *files, runs] + ([out] if out else [])
    one_thread = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS",
                                         "NUMBA_NUM_THREADS", "MKL_NUM_THREADS")}
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          env=os.environ | one_thread)
    if done.returncode != 0:
        sys.exit(f"{contender} failed:\n{done.stderr}")
    return json.loads(done.stdout)["seconds"]


def check_same(contender, found, ours, classic):
    """Says how equal the answers are and to what, or stops."""
    if contender.startswith("search"):
        return "hits and starts: all"
    steps = "(1,0), (0,1), (1,1)"
    expected = classic
    if contender not in CONTENDERS or contender == "librosa":
        steps = "(1,1), (1,2), (2,1)"
        expected = ours
        if contender in CONTENDERS:  # Whole features, not shares.
            found = found / (FEATURES * TEMPLATE_COLUMNS)
    if np.array_equal(found, expected):
        return f"{steps}: all bits"
    if not np.array_equal(np.isfinite(found), np.isfinite(expected)):
        sys.exit(f"{contender} has paths where there are none, or lacks some")
    finite = np.isfinite(expected)
    found, expected = found[finite], expected[finite]
    difference = (np.abs(found - expected) / np.maximum(expected, 1e-3)).max()
    if difference > 1e-9:
        sys.exit(f"{contender} has other costs, by up to {difference:g} of them")
    return f"{steps}: to {difference:.0e}"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", required=True, type=Path, help="folder of the build")
    parser.add_argument("--runs", type=int, default=5, help="scans in a process (ours: ten times)")
    parser.add_argument("--rounds", type=int, default=5, help="turns that the contenders take")
    options = parser.parse_args()
    program = options.build / "bin/scan_contender"
    listed = subprocess.run([program, "list"], capture_output=True, text=True, check=True)
    contenders = [*listed.stdout.splitlines(), *CONTENDERS]
    print(machine(options.build))
    print("Python " + sys.version.split()[0] +
          "".join(f", {name} {version(name)}" for name in (*CONTENDERS, "numba", "numpy")) + "\n")
    with tempfile.TemporaryDirectory() as folder:
        files = make_files(Path(folder))
        out, rows = Path(folder) / "costs", {}
        for contender in contenders:
            run(program, contender, files, 0, out)
            rows[contender] = np.fromfile(out)
        classic = classic_last_row(*[columns(file).astype(bool) for file in files])
        equal = {each: check_same(each, rows[each], rows[REFERENCE], classic)
                 for each in contenders}
        seconds = {each: [] for each in contenders}
        for _ in range(options.rounds):
            for each in contenders:
                runs = options.runs * (1 if each in CONTENDERS else 10)
                seconds[each] += run(program, each, files, runs)
    table(["scan", ">ms, median", "spread", ">million cells/s", ">takes, to our search",
           "steps, and costs equal"])
    ours = statistics.median(seconds[contenders[0]])
    for each in contenders:
        median = statistics.median(seconds[each])
        print(f"| {each} | {median_and_spread([1e3 * value for value in seconds[each]])} | "
              f"{digits(CELLS / median / 1e6)} | {digits(median / ours)} × | {equal[each]} |")
    print()


if __name__ == "__main__":
    main()
