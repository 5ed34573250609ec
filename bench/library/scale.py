"""How making, storing and searching a library grow with its hours. Prints Markdown, draws a picture.

  scale.py --build FOLDER [--hours 10,30,100,300,1000] [--pose-hours 10,30,100] [--plot FILE.svg]

A library of made-up motion (kinebase synth --hours) grows in a temporary folder, and is searched at
each size for one template and for 64 through the program. Times of making are sums of its steps. Of
every search the median of some runs counts, after one that brings the files into the page cache; one
of more than twenty seconds is run once. Time is by the clock and the processor's for all threads;
memory is the highest resident memory, and the part of it that is not mapped from files: the program's
own, its libraries' and the library's.
"""

import argparse
import json
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from measure import digits, machine, table

TAU = 0.1
LONG_S = 20
TEMPLATES = 64
COLUMNS_AN_HOUR = 30 * 3600


def memory_of(process):
    """Highest resident memory so far, and memory of its own now; None once it has ended."""
    try:
        status = Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
    except (FileNotFoundError, ProcessLookupError):
        return None
    lines = dict(line.split(":", 1) for line in status.splitlines())
    if "VmHWM" not in lines:
        return None
    return [int(lines[name].split()[0]) * 1024 for name in ("VmHWM", "RssAnon")]


def busy_children():
    """Seconds of the processor for all programs that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(*command):
    """The first that the program printed as JSON, and what it took."""
    before = busy_children()
    begin = time.perf_counter()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    peak, own = 0, 0
    while True:
        memory = memory_of(process)
        if memory:
            peak, own = max(peak, memory[0]), max(own, memory[1])
        try:
            out, errors = process.communicate(timeout=0.01)
            break
        except subprocess.TimeoutExpired:
            pass
    clock = time.perf_counter() - begin
    busy = busy_children() - before
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} failed:\n{errors}")
    return (json.JSONDecoder().raw_decode(out)[0] if out.startswith("{") else {},
            {"clock": clock, "busy": busy, "peak": peak, "own": own})


def learn_templates(program, folder):
    """64 templates of fourteen classes, each from three clips of one of five made-up people whom the
    libraries do not show: their seed is another."""
    clips = folder / "clips"
    run(program, "synth", clips, "--actors", 5, "--takes", 0, "--seed", 1000, "--json")
    files = []
    for number, actor in enumerate("abcde"):
        for of_class in sorted((clips / "cut_amc").iterdir()):
            file = folder / f"{of_class.name}-{number}.template.json"
            run(program, "learn", *sorted(of_class.glob(f"SYN_s{actor}_*.amc")), "--name",
                of_class.name, "-o", file, "--json")
            files.append(file)
    return files[:TEMPLATES]


def search(program, library, templates, runs):
    """The medians of some runs, their spread by the clock, and what was found."""
    command = [program, "search", *templates, "--library", library, "--tau", TAU, "--json"]
    found, first = run(*command)
    taken = [first]
    if first["clock"] < LONG_S:
        taken = [run(*command)[1] for _ in range(runs)]
    medians = {name: statistics.median(one[name] for one in taken) for name in taken[0]}
    return medians | {"spread": [one["clock"] for one in taken]}, found


def measure(program, library, hours, poses, templates, runs, before):
    _, made = run(program, "synth", library, "--hours", hours, "--json",
                  *(["--poses"] if poses else []))
    if before:
        made = {name: (max if name in ("peak", "own") else sum)((before["made"][name], made[name]))
                for name in made}
    size = sum(file.stat().st_size for file in library.rglob("*") if file.is_file())
    one, found = search(program, library, templates[:1], runs)
    many, _ = search(program, library, templates, runs)
    if found["scanned_frames"] != hours * COLUMNS_AN_HOUR:
        sys.exit(f"of {hours} hours {found['scanned_frames']} frames were searched")
    if not found["hits"]:
        sys.exit("the first template was found nowhere")
    return {"hours": hours, "poses": poses, "made": made, "bytes": size, "one": one, "many": many}


def check_threads(program, folder, templates):
    """The hits are the same whatever the number of threads."""
    library = folder / "library"
    run(program, "synth", library, "--hours", 1, "--json")
    hits = [run(program, "search", *templates, "--library", library, "--tau", TAU, "--json",
                "--threads", threads)[0]["hits"] for threads in (1, 2)]
    shutil.rmtree(library)
    if hits[0] != hits[1]:
        sys.exit("one thread and two find other hits")


def straight_line(results, value):
    """Slope an hour, value at none, and R²."""
    hours = np.array([each["hours"] for each in results], dtype=float)
    values = np.array([value(each) for each in results])
    slope, start = np.polyfit(hours, values, 1)
    rest = ((values - (slope * hours + start)) ** 2).sum()
    return slope, start, 1 - rest / ((values - values.mean()) ** 2).sum()


LINES = {
    "making, clock s": lambda each: each["made"]["clock"],
    "making, processor s": lambda each: each["made"]["busy"],
    "one template, clock s": lambda each: each["one"]["clock"],
    "one template, processor s": lambda each: each["one"]["busy"],
    f"{TEMPLATES} templates, clock s": lambda each: each["many"]["clock"],
    f"{TEMPLATES} templates, processor s": lambda each: each["many"]["busy"],
}


def print_lines(results, what):
    if len(results) < 3:
        return
    print(f"\nStraight lines through these times, libraries {what}:\n")
    table(["time", ">ms an hour", ">ms at none", ">R²"])
    for name, value in LINES.items():
        slope, start, fit = straight_line(results, value)
        print(f"| {name} | {digits(1e3 * slope)} | {digits(1e3 * start)} | {fit:.5f} |")


def row(each):
    cells = [digits(each["hours"]), digits(each["made"]["clock"]), digits(each["made"]["busy"]),
             digits(each["hours"] * COLUMNS_AN_HOUR / each["made"]["clock"] / 1e6),
             digits(each["made"]["peak"] / 1e6), digits(each["bytes"] / each["hours"] / 1e6)]
    for searched in (each["one"], each["many"]):
        spread = searched["spread"]
        cells += [digits(searched["clock"]) +
                  (f" ({digits(min(spread))} to {digits(max(spread))})" if len(spread) > 1
                   else " (once)"),
                  digits(searched["busy"]), digits(searched["peak"] / 1e6),
                  digits(searched["own"] / 1e6)]
    return "| " + " | ".join(cells) + " |"


TITLES = [">hours", ">made in s", ">processor s", ">million columns/s", ">peak MB",
          ">MB an hour on disk", ">one template: s (spread)", ">processor s", ">peak MB", ">own MB",
          f">{TEMPLATES} templates: s (spread)", ">processor s", ">peak MB", ">own MB"]


def draw(results, path):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "kinebase"})
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(6.4, 4))
    hours = [each["hours"] for each in results]
    for name, value in LINES.items():
        if "clock" not in name:
            continue
        slope, start, fit = straight_line(results, value)
        axes.plot(hours, [value(each) for each in results], "o", markersize=4,
                  label=f"{name.split(',')[0]}: {digits(1e3 * slope)} ms an hour, R² {fit:.4f}")
        many = np.geomspace(min(hours), max(hours), 100)
        axes.plot(many, slope * many + start, linewidth=0.8, color="grey", zorder=0)
    axes.set(xscale="log", yscale="log", xlabel="hours in the library",
             ylabel="seconds by the clock")
    axes.legend(fontsize=8)
    axes.grid(linewidth=0.3)
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None})


def hours_of(text):
    return [float(word) if "." in word else int(word) for word in text.split(",") if word]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", required=True, type=Path, help="folder of the build")
    parser.add_argument("--hours", type=hours_of, default="10,30,100,300,1000")
    parser.add_argument("--pose-hours", type=hours_of, default="10,30,100")
    parser.add_argument("--runs", type=int, default=5, help="searches that medians are of")
    parser.add_argument("--plot", type=Path, help="picture of the libraries without poses")
    parser.add_argument("--folder", type=Path, help="where to make the temporary folder")
    options = parser.parse_args()
    program = options.build / "bin/kinebase"
    print(machine(options.build))
    with tempfile.TemporaryDirectory(dir=options.folder) as name:
        folder = Path(name)
        templates = learn_templates(program, folder)
        check_threads(program, folder, templates[:4])
        for poses, all_hours in ((False, options.hours), (True, options.pose_hours)):
            what = "with poses" if poses else "of features alone"
            print(f"\nLibraries {what}:\n")
            table(TITLES)
            results = []
            library = folder / ("poses" if poses else "features")
            for hours in sorted(all_hours):
                results.append(measure(program, library, hours, poses, templates, options.runs,
                                       results[-1] if results else None))
                print(row(results[-1]), flush=True)
            shutil.rmtree(library)
            print_lines(results, what)
            if options.plot and not poses and len(results) > 2:
                draw(results, options.plot)
    print()


if __name__ == "__main__":
    main()
