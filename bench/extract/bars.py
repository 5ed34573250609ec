"""Runs extract_bench and sets its figures beside the bar. Prints Markdown.

  bars.py BUILD_FOLDER

Frames are those of the recording, at 120 Hz; time is the processor's for one thread.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from measure import machine, median_and_spread, run_benchmarks, table

BAR = 1  # Million frames a second.


def main():
    build = Path(sys.argv[1])
    print(machine(build) + "\n")
    table(["feature set", "contender", ">million frames/s, median", "spread", ">bar"])
    for name, results in sorted(run_benchmarks(build / "bin/extract_bench", 9, 0.2).items()):
        features, contender = name.split("/")
        speeds = [each["frames/s"] / 1e6 for each in results]
        bar = BAR if contender == "kinebase" else ""
        print(f"| {features} | {contender} | {median_and_spread(speeds)} | {bar} |")
    print()


if __name__ == "__main__":
    main()
