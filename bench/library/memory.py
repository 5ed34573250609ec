"""How much memory searching, learning from and filling a library takes with --memory of several
sizes, and what stored keyframes spare. Prints Markdown.

  memory.py --build FOLDER --data FOLDER [--hours 400] [--pose-hours 12] [--memory 64M,256M,1G]

Libraries of made-up motion (kinebase synth --hours) are searched through the program for two plain
templates and, with poses, for eight of method mt+; the recordings of --data are imported with poses.
Memory is the highest resident memory of the program, and the highest of it that is not mapped from
files: from the program itself, its libraries, segments, recordings.
"""

import argparse
import shutil
import statistics
import tempfile
from pathlib import Path

from scale import TAU, digits, machine, run, table

CLASSES = ("squat1Reps", "throwOverarmR", "grabHighR", "walk4StepsRstart", "kickRFront1Reps",
           "clapAboveHead1Reps", "depositFloorR", "punchRFront1Reps")
REAL_CLASS = "throwBasketball"
ALL_HITS = 10_000_000


def learn_templates(program, folder):
    """Two plain templates and eight of mt+, from made-up people whom the libraries do not show."""
    clips = folder / "clips"
    run(program, "synth", clips, "--actors", 5, "--takes", 0, "--seed", 1000, "--classes",
        ",".join(CLASSES), "--json")
    plain = []
    for name in CLASSES[:2]:
        plain.append(folder / f"{name}.template.json")
        run(program, "learn", *sorted((clips / "cut_amc" / name).glob("*.amc")), "--name", name,
            "-o", plain[-1], "--json")
    run(program, "learn", "--list", clips / "clips.csv", "--in", clips, "--all-classes", "-o",
        folder / "contrast", "--json")
    return plain, sorted((folder / "contrast").glob("*.template.json"))


def sizes_of(library):
    """Of the segments and of the catalogue, as cells of a table."""
    segments = sum(file.stat().st_size for file in (library / "segments").iterdir())
    catalogue = (library / "catalogue.sqlite").stat().st_size
    return f"{digits(segments / 1e6)} MB | {digits(catalogue / 1e6)} MB"


def compare_keyframes(program, templates, library, runs):
    """Times of a search as people make it, and how many hits it finds if all are asked for."""
    table([" ", ">clock s", ">processor s", ">hits, of all"])
    all_hits = None
    for what, keyframes in (("everything", "none"), ("with stored keyframes", "auto")):
        command = ["search", *templates, "--library", library, "--tau", TAU, "--keyframes", keyframes,
                   "--json"]
        found = {(hit["template"], hit["file"], hit["last_frame"])
                 for hit in run(program, *command, "--top", ALL_HITS)[0]["hits"]}
        all_hits = all_hits or found
        taken = [run(program, *command)[1] for _ in range(runs)]
        times = [statistics.median(each[of] for each in taken) for of in ("clock", "busy")]
        print(f"| {what} | {digits(times[0])} | {digits(times[1])} | "
              f"{len(found & all_hits):,} of {len(all_hits):,} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", required=True, type=Path, help="folder of the build")
    parser.add_argument("--data", required=True, type=Path, help="folder of real recordings")
    parser.add_argument("--hours", type=float, default=400, help="in the library without poses")
    parser.add_argument("--pose-hours", type=float, default=12)
    parser.add_argument("--memory", default="64M,256M,1G", help="sizes for --memory")
    parser.add_argument("--runs", type=int, default=5, help="runs that times are medians of")
    parser.add_argument("--folder", type=Path, help="where to make the temporary folder")
    options = parser.parse_args()
    program = options.build / "bin/kinebase"
    sizes = options.memory.split(",")
    print(machine(options.build) + "\n")

    with tempfile.TemporaryDirectory(dir=options.folder) as name:
        folder = Path(name)
        plain, contrast = learn_templates(program, folder)
        library = folder / "library"

        def print_row(what, memory, *command):
            _, taken = run(program, *command, "--memory", memory, "--json")
            print(f"| {what} | {sizes_of(library)} | {memory} | "
                  f"{digits(taken['peak'] / 1e6)} MB | {digits(taken['own'] / 1e6)} MB |", flush=True)

        table([" ", ">segments", ">catalogue", ">`--memory`", ">resident", ">not mapped"])
        run(program, "synth", library, "--hours", options.pose_hours, "--poses", "--json")
        for memory in sizes:
            print_row(f"{digits(options.pose_hours)} hours with poses, {len(contrast)} templates of "
                      "`mt+`", memory, "search", *contrast, "--library", library)
        for memory in sizes:
            shutil.rmtree(library)
            print_row("import of real recordings with poses", memory, "import",
                      options.data / "hdm05/cut_amc", options.data / "cmu", "--library", library,
                      "--poses")
        for memory in sizes:
            print_row("learning a class of them beside all others", memory, "learn", "--library",
                      library, "--class", REAL_CLASS, "--background", library, "-o",
                      folder / f"learned-{memory}.template.json")
        shutil.rmtree(library)
        run(program, "synth", library, "--hours", options.hours, "--json")
        for memory in sizes:
            print_row(f"{digits(options.hours)} hours, {len(plain)} templates", memory, "search",
                      *plain, "--library", library, "--tau", TAU)

        print(f"\nThe {len(plain)} templates over {digits(options.hours)} hours, medians of "
              f"{options.runs} runs:\n")
        compare_keyframes(program, plain, library, options.runs)
    print()


if __name__ == "__main__":
    main()
