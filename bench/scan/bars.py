"""Runs scan_bench and sets its figures beside the bars. Prints Markdown.

  bars.py BUILD_FOLDER

One template over 378,000 columns of made-up features (210 minutes at 30 Hz), hits with their starts at
τ = 0.1. Billions of cells (template columns × recording columns) a second, by the processor's time;
on two threads by the clock.
"""

import statistics
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from measure import digits, machine, median_and_spread, run_benchmarks, table

COLUMNS = (18, 36, 64, 106)
# Billions of cells a second for templates of fewer than 64 columns, and from there on.
BARS = {"search/AVX3": (5, 8), "search/AVX2": (2.5, 4), "weighted/AVX3": (2.5, 4), "AVX3": (2, 2)}
MANY_BAR_MS = 350
THREADS_BAR = 1.8


def name_of(contender):
    """In words; AVX3 is what Highway calls AVX-512 without its later additions."""
    kind, _, target = contender.rpartition("/")
    kinds = {"": "whole curve in double", "search": "search",
             "weighted": "search, a weight for each entry"}
    if contender == "reference":
        return "plain kernel, whole curve"
    return f"{kinds[kind]}, {target}" if target != "two threads" else "search, two threads"


def bar_of(contender):
    kind, _, target = contender.rpartition("/")
    target = "AVX3" if target.startswith("AVX3") else target
    return BARS.get(f"{kind}/{target}" if kind else target)


def place_in_table(item):
    """Searches, those with weights, curves; each with the fastest first."""
    contender, of_columns = item
    kind = contender.rpartition("/")[0]
    return contender == "reference", ["search", "weighted", ""].index(kind), \
        -statistics.median(of_columns[COLUMNS[-1]])


def main():
    build = Path(sys.argv[1])
    print(machine(build) + "\n")
    found = run_benchmarks(build / "bin/scan_bench", 5, 0.1)
    speeds = {}
    for name, results in found.items():
        contender, _, columns = name.rpartition("/K=")
        if contender:
            speeds.setdefault(contender, {})[int(columns)] = [each["cells/s"] / 1e9
                                                              for each in results]
    table(["template columns: G cells/s, median (spread)", *[f">{k}" for k in COLUMNS],
           ">bar below 64, from 64 on"])
    for contender, of_columns in sorted(speeds.items(), key=place_in_table):
        cells = [median_and_spread(of_columns[k]).replace(" | ", " (") + ")" for k in COLUMNS]
        bar = bar_of(contender)
        print(f"| {name_of(contender)} | {' | '.join(cells)} | "
              f"{'' if bar is None else f'{bar[0]}, {bar[1]}'} |")
    one, two = (found[f"64 templates/threads={threads}"] for threads in (1, 2))
    print()
    table(["64 templates of 18 to 144 columns", ">ms, median", "spread", ">bar"])
    for name, results, time, bar in (
            ("one thread, processor's time", one, "cpu_time", MANY_BAR_MS),
            ("one thread, clock", one, "real_time", ""),
            ("two threads, clock", two, "real_time", "")):
        print(f"| {name} | {median_and_spread([each[time] for each in results])} | {bar} |")
    gain = (statistics.median(each["real_time"] for each in one) /
            statistics.median(each["real_time"] for each in two))
    print(f"\nTwo threads are {digits(gain)} times as fast (bar: {THREADS_BAR}).\n")


if __name__ == "__main__":
    main()
