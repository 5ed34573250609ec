"""Runs learn_bench and sets its figures beside the bars. Prints Markdown.

  bars.py BUILD_FOLDER

Time is the processor's, one thread.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from measure import machine, median_and_spread, run_benchmarks, table

BARS = {"26 clips of 36 columns": 20, "11 clips of 105 columns": 40}  # Milliseconds.


def main():
    build = Path(sys.argv[1])
    print(machine(build) + "\n")
    table(["class", "profile", "contender", ">rounds", ">ms, median", "spread", ">bar"])
    for name, results in sorted(run_benchmarks(build / "bin/learn_bench", 9, 0.2).items(),
                                reverse=True):
        clips, profile, contender = name.split("/")
        times = [each["cpu_time"] for each in results]
        bar = BARS[clips] if contender == "kinebase" else ""
        print(f"| {clips} | {profile} | {contender} | {results[0]['rounds']:.0f} | "
              f"{median_and_spread(times)} | {bar} |")
    print()


if __name__ == "__main__":
    main()
