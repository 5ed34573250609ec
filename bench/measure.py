"""What the benchmarks share: the machine in a line, runs of Google Benchmark, medians and spreads."""

import json
import os
import platform
import re
import statistics
import subprocess
import sys
from pathlib import Path


def machine(build):
    """The processor, how busy it is, and what compiled the programs below a build folder."""
    cpu = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text(encoding="utf-8"))[1]
    cache = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    compiler = re.search(r"CMAKE_CXX_COMPILER:\w+=(.*)", cache)[1]
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True)
    return (f"{cpu}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} before; Linux "
            f"{platform.release().split('-')[0]}; {version.stdout.splitlines()[0]}")


def run_benchmarks(program, repetitions, least_seconds):
    """Name → results of its repetitions, as Google Benchmark has them, in random order."""
    done = subprocess.run(
        [program, "--benchmark_format=json", f"--benchmark_min_time={least_seconds}",
         f"--benchmark_repetitions={repetitions}", "--benchmark_enable_random_interleaving=true"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{program} failed:\n{done.stderr}")
    found = {}
    for result in json.loads(done.stdout)["benchmarks"]:
        if result["run_type"] == "iteration":
            name = re.sub(r"/(real_time|repeats:\d+)", "", result["run_name"])
            found.setdefault(name, []).append(result)
    return found


def digits(value):
    """Three figures that count, and no exponent."""
    if value == 0:
        return "0"
    places = max(0, 2 - int(f"{value:e}".split("e")[1]))
    return f"{value:,.{places}f}"


def median_and_spread(values):
    """Two cells of a table: the median, and the smallest to the largest."""
    return f"{digits(statistics.median(values))} | {digits(min(values))} to {digits(max(values))}"


def table(titles):
    """The head of a Markdown table; a title that begins with > is a column of numbers."""
    print("| " + " | ".join(title.lstrip(">") for title in titles) + " |")
    print("|" + "|".join("---:" if title.startswith(">") else "---" for title in titles) + "|",
          flush=True)
