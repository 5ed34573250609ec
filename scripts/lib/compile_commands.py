"""How the files of the project are compiled, from the folder that scripts/check configures."""

import json
import os
import pathlib
import shlex
from concurrent.futures import ThreadPoolExecutor

from project_files import ROOT

BUILD = ROOT / "build/tidy"


def compile_commands():
    """Source file relative to the root → its compiler command, for the project's own files."""
    commands = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        file = pathlib.Path(entry["directory"], entry["file"])
        if ROOT in file.parents and BUILD not in file.parents:
            commands[pathlib.PurePosixPath(file.relative_to(ROOT))] = shlex.split(entry["command"])
    return commands


def in_parallel(work, items):
    """The results of work(item), in the order of the items; `work` waits for a process."""
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        return list(pool.map(work, items))
