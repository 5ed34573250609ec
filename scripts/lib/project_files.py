"""Which files belong to the project, and how a check reports what it finds."""

import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
GENERATED_FOLDERS = {".git", "build", "demo-output", "__pycache__", ".cache"}
CPP = (".h", ".cpp")


def project_files(root=ROOT, suffixes=None):
    """Paths relative to `root`, sorted: what git tracks or would track if it were added."""
    listing = subprocess.run(
        ["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        capture_output=True, text=True, check=False) if (root / ".git").exists() else None
    if listing is not None and listing.returncode == 0:
        names = set(filter(None, listing.stdout.split("\0")))
    else:
        names = set()
        for folder, folders, files in os.walk(root):
            folders[:] = [f for f in folders if f not in GENERATED_FOLDERS]
            names.update(os.path.relpath(os.path.join(folder, f), root) for f in files)
    paths = sorted(pathlib.PurePosixPath(name) for name in names)
    return [p for p in paths
            if (suffixes is None or p.suffix in suffixes) and (root / p).is_file()]


def report(findings):
    """Prints "file:line: what is wrong; remedy" lines. Returns the exit code."""
    for finding in findings:
        print(finding)
    return 1 if findings else 0


def main(check):
    """Runs a check on the project, or on the folder that the command line names."""
    root = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT
    sys.exit(report(check(root)))
