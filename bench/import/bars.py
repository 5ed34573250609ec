"""Runs import_bench and sets its figures beside the bar. Prints Markdown.

  bars.py BUILD_FOLDER

MB are millions of bytes of text; the time by the clock has all waiting for the disk in it.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from measure import machine, median_and_spread, run_benchmarks, table

BAR = 200  # MB/s.
STEPS = {"numbers": "the numbers of the file", "motion": "also the skeleton and its rotations",
         "joints": "also where the 24 joints are", "features": "also their features",
         "import": "features in the library"}


def main():
    build = Path(sys.argv[1])
    print(machine(build) + "\n")
    table(["AMC text to", ">MB/s by the processor's time, median", "spread",
           ">MB/s by the clock, median", "spread", ">bar"])
    found = run_benchmarks(build / "bin/import_bench", 9, 0.2)
    for step, words in STEPS.items():
        # Bytes a second are by the clock; milliseconds a turn are of both.
        clock = [each["bytes_per_second"] / 1e6 for each in found[step]]
        busy = [speed * each["real_time"] / each["cpu_time"]
                for speed, each in zip(clock, found[step])]
        bar = BAR if step == "import" else ""
        print(f"| {words} | {median_and_spread(busy)} | {median_and_spread(clock)} | {bar} |")
    print()


if __name__ == "__main__":
    main()
