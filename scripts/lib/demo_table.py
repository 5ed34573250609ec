"""Prints the hits of scripts/demo: which are right, which are wrong, and what was missed.

    demo_table.py HITS.json CLIPS.csv TRUTH.csv CLASS SEARCHED.txt

CLIPS.csv says what a whole file shows (file,class,…), TRUTH.csv what happens where in long takes
(file,class,first_frame,last_frame) and need not exist. Writes BEST.txt beside HITS.json: the best
right hits as file:first-last.
"""

import csv
import json
import pathlib
import sys

MOST_ROWS = 25
MOST_POSES = 4


class Stretch:
    """A stretch of a file that shows one motion class."""

    def __init__(self, class_name, first=1, last=None):
        self.class_name = class_name
        self.first = first
        self.last = last  # None: to the end.
        self.claimed = False

    def holds(self, frame):
        return self.first <= frame and (self.last is None or frame <= self.last)


def read_truth(clips, truth, names):
    """File name → stretches, for the files in `names`."""
    stretches = {}
    rows = list(csv.DictReader(clips.read_text().splitlines()))
    if truth.is_file():
        rows += csv.DictReader(truth.read_text().splitlines())
    for row in rows:
        if row["file"] in names:
            where = (int(row["first_frame"]), int(row["last_frame"])) if "last_frame" in row else ()
            stretches.setdefault(row["file"], []).append(Stretch(row["class"], *where))
    return stretches


def judge(hit, stretches, class_name):
    """A hit is right if its middle lies in a stretch of the class that no better hit has claimed."""
    name = pathlib.Path(hit["file"]).name
    if name not in stretches:
        return "not known"
    middle = (hit["first_frame"] + hit["last_frame"]) / 2
    here = [s for s in stretches[name] if s.holds(middle)]
    for stretch in here:
        if stretch.class_name == class_name:
            if stretch.claimed:
                return "wrong: the same one again"
            stretch.claimed = True
            return "right"
    return f"wrong: {here[0].class_name}" if here else "wrong: between two motions"


def print_table(hits, verdicts):
    names = [pathlib.Path(hit["file"]).name for hit in hits]
    width = max(map(len, names))
    print(f"       cost  {'file':{width}}        frames         seconds")
    for i, (hit, name, verdict) in enumerate(zip(hits, names, verdicts)):
        if i == MOST_ROWS:
            right = verdicts[i:].count("right")
            print(f"  … and {len(hits) - i} more, {right} of them right")
            break
        frames = f"{hit['first_frame']}–{hit['last_frame']}"
        seconds = f"{hit['start_s']:.1f}–{hit['end_s']:.1f}"
        print(f"{i + 1:4}  {hit['cost']:.3f}  {name:{width}}  {frames:>12}  {seconds:>14}  {verdict}")


def main(hits_file, clips, truth, class_name, searched):
    result = json.loads(hits_file.read_text())
    hits = result["hits"]
    names = {pathlib.Path(line).name for line in searched.read_text().splitlines()}
    names -= {pathlib.Path(failure["file"]).name for failure in result.get("failed", [])}
    stretches = read_truth(clips, truth, names)
    verdicts = [judge(hit, stretches, class_name) for hit in hits]
    if hits:
        print_table(hits, verdicts)

    of_class = [(name, s) for name, found in stretches.items() for s in found
                if s.class_name == class_name]
    missed = [(name, s) for name, s in of_class if not s.claimed]
    wrong = sum(verdict.startswith("wrong") for verdict in verdicts)
    unknown = verdicts.count("not known")
    print(f"\nOf {len(of_class)} × {class_name}, {len(of_class) - len(missed)} were found and "
          f"{len(missed)} missed; {wrong} of {len(hits)} hits are wrong"
          + (f", {unknown} lie where nobody has said what happens." if unknown else "."))
    for name, stretch in missed:
        where = f", frames {stretch.first}–{stretch.last}" if stretch.last else ""
        print(f"  missed: {name}{where}")
    print(f"Scanned {result['scanned_frames']:,} frames in {result['elapsed_s']:.2f} s.")

    best = [hit for hit, verdict in zip(hits, verdicts) if verdict == "right"] or hits
    (hits_file.parent / "best.txt").write_text("".join(
        f"{hit['file']}:{hit['first_frame']}-{hit['last_frame']}\n" for hit in best[:MOST_POSES]))


if __name__ == "__main__":
    main(*map(pathlib.Path, sys.argv[1:4]), sys.argv[4], pathlib.Path(sys.argv[5]))
