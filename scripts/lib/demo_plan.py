"""Decides what scripts/demo learns and searches in a folder of recordings.

    demo_plan.py FOLDER OUTPUT

Prints three lines: the clip list, the motion class, the actors to learn from (with commas).
Writes OUTPUT/searched.txt, the files of everybody else, and OUTPUT/clips.csv if FOLDER has no clip
list: HDM05 says class and actor in the name, HDM_{actor}_{class}_{number}_{rate}.amc.
"""

import csv
import pathlib
import re
import sys

CLIP_NAME = re.compile(r"[^_]+_(?P<actor>[^_]+)_(?P<class>[^_]*[a-z][^_]*)_\d+_\d+\.amc", re.I)
ACTOR_IN_NAME = re.compile(r"[^_]+_(?P<actor>[^_]+)_.*\.amc", re.I)
USUAL_CLASS = "squat1Reps"


def recordings(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix.lower() == ".amc" and p.is_file())


def write_list(files, path):
    """The clips among `files` as a clip list."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["file", "class", "actor"])
        for recording in files:
            match = CLIP_NAME.fullmatch(recording.name)
            if match:
                writer.writerow([recording.name, match["class"], match["actor"]])


def read_list(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def choose_class(clips):
    """The class with its actors: the usual one, else the one that most people perform most often."""
    clips_of = {}
    for clip in clips:
        clips_of.setdefault(clip["class"], []).append(clip["actor"])
    candidates = {name: actors for name, actors in clips_of.items() if len(set(actors)) > 1}
    if not candidates:
        sys.exit("The demo needs clips of one motion class by two people or more, named as in HDM05 "
                 "(HDM_bd_squat1Reps_001_120.amc) or listed in clips.csv (file,class,actor)")
    name = USUAL_CLASS if USUAL_CLASS in candidates else max(
        candidates, key=lambda c: (len(set(candidates[c])), len(candidates[c])))
    return name, sorted(set(candidates[name]))


def main(folder, output):
    files = recordings(folder)
    if not files:
        sys.exit(f"There is no .amc file below {folder}")
    clip_list = folder / "clips.csv"
    if not clip_list.is_file():
        clip_list = output / "clips.csv"
        write_list(files, clip_list)
    clips = read_list(clip_list)
    class_name, actors = choose_class(clips)
    teachers = actors[:(len(actors) + 1) // 2]

    actor_of = {clip["file"]: clip["actor"] for clip in clips}
    searched = []
    for path in files:
        match = ACTOR_IN_NAME.fullmatch(path.name)
        if actor_of.get(path.name, match and match["actor"]) not in teachers:
            searched.append(path)
    (output / "searched.txt").write_text("".join(f"{path}\n" for path in searched))
    print(clip_list, class_name, ",".join(teachers), sep="\n")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
