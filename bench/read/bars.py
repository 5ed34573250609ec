"""Runs read_bench and sets its figures beside the bars for reading. Prints Markdown.

  bars.py BUILD_FOLDER

MB are millions of bytes of the file; time is the processor's for one thread, medians of some turns that
the contenders take in random order.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from measure import machine, median_and_spread, run_benchmarks, table

BARS = {".amc": 400, ".bvh": 400, ".csm": 250, ".c3d": 1500}  # MB/s
REPETITIONS = 9


def by_format(row):
    (file, contender), _ = row
    return Path(file).suffix, file, contender


def main():
    build = Path(sys.argv[1])
    print(machine(build) + "\n")
    table(["file", "reader", ">MB/s, median", "spread", ">bar"])
    found = {}
    for name, results in run_benchmarks(build / "bin/read_bench", REPETITIONS, 0.05).items():
        found[tuple(name.split("/")[:2])] = [each["bytes_per_second"] / 1e6 for each in results]
    for (file, contender), speeds in sorted(found.items(), key=by_format):
        bar = BARS[Path(file).suffix] if contender == "kinebase" else ""
        print(f"| {file} | {contender} | {median_and_spread(speeds)} | {bar} |")
    print()


if __name__ == "__main__":
    main()
