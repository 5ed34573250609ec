"""Runs read_bench and sets its figures beside the bars for reading. Prints Markdown.

  bars.py BUILD_FOLDER

MB are millions of bytes of the file; time is the processor's for one thread, medians of some turns that
the contenders take in random order.
"""

import json
import os
import platform
import re
import statistics
import subprocess
import sys
from pathlib import Path

BARS = {".amc": 400, ".bvh": 400, ".csm": 250, ".c3d": 1500}  # MB/s
REPETITIONS = 9


def machine(build):
    cpu = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text(encoding="utf-8"))[1]
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    compiler = re.search(r"CMAKE_CXX_COMPILER:\w+=(.*)", cache)[1]
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True)
    return (f"{cpu}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} before; Linux "
            f"{platform.release().split('-')[0]}; {version.stdout.splitlines()[0]}")


def measure(build):
    """(file, contender) → MB/s of every repetition."""
    done = subprocess.run(
        [build / "bin/read_bench", "--benchmark_format=json", "--benchmark_min_time=0.05",
         f"--benchmark_repetitions={REPETITIONS}", "--benchmark_enable_random_interleaving=true"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=True)
    found = {}
    for result in json.loads(done.stdout)["benchmarks"]:
        if result["run_type"] != "iteration":
            continue
        file, contender = result["run_name"].split("/")[:2]
        found.setdefault((file, contender), []).append(result["bytes_per_second"] / 1e6)
    return found


def by_format(row):
    (file, contender), _ = row
    return Path(file).suffix, file, contender


def main():
    build = Path(sys.argv[1])
    print(machine(build))
    print("\n| file | reader | MB/s, median | spread | bar |\n|---|---|---:|---|---:|")
    for (file, contender), speeds in sorted(measure(build).items(), key=by_format):
        bar = BARS[Path(file).suffix] if contender == "kinebase" else ""
        print(f"| {file} | {contender} | {statistics.median(speeds):.0f} | "
              f"{min(speeds):.0f} to {max(speeds):.0f} | {bar} |")
    print()


if __name__ == "__main__":
    main()
