"""clang-format has nothing to change in any C++ file."""

import re
import subprocess

from project_files import CPP, main, project_files

FINDING = re.compile(r"^(.+?):(\d+):\d+: error: code should be clang-formatted")


def check(root):
    files = [str(p) for p in project_files(root, CPP)]
    if not files:
        return []
    run = subprocess.run(["clang-format-16", "--dry-run", "-Werror", *files], cwd=root,
                         capture_output=True, text=True, check=False)
    lines = run.stderr.splitlines()
    first_places = {}
    for match in filter(None, map(FINDING.match, lines)):
        first_places.setdefault(match.group(1), match.group(2))
    findings = [f"{file}:{line}: not laid out from here on; clang-format-16 -i {file}"
                for file, line in first_places.items()]
    return findings if findings or run.returncode == 0 else lines


if __name__ == "__main__":
    main(check)
