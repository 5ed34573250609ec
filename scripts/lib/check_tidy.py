"""clang-tidy finds nothing: names, function sizes, frequent mistakes (.clang-tidy says which).

Looks at what changed since the main branch, or at everything with --all, where there is no history
to compare with, and where its own rules changed.
"""

import re
import subprocess
import sys

from compile_commands import BUILD, compile_commands, in_parallel
from project_files import ROOT, project_files, report

FINDING = re.compile(r"^(.+?):(\d+):(\d+): (?:warning|error): (.*)$")
RULES = (".clang-tidy", "CMakePresets.json", "scripts/lib/check_tidy.py")


def git(*arguments):
    run = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True,
                         check=False)
    return run.stdout.strip() if run.returncode == 0 else None


def changed_files():
    """Names that changed since the main branch or the last commit; None if that is unknown."""
    head = git("rev-parse", "HEAD")
    base = git("merge-base", "HEAD", "origin/main")
    if base is None or base == head:
        base = git("rev-parse", "HEAD~")
    if base is None:
        return None
    untracked = git("ls-files", "--others", "--exclude-standard") or ""
    return set(git("diff", "--name-only", base).splitlines()) | set(untracked.splitlines())


def sources_that_show(header, sources):
    """One source through which a header is seen: its own, or the first that includes it."""
    own = [s for s in sources if s.stem == header.stem and s.parts[0] == "src"]
    name = "/".join(header.parts[1:])  # Below include/ or src/.
    return (own or [s for s in sources if f'"{name}"' in (ROOT / s).read_text()])[:1]


def chosen_sources(everything):
    sources = sorted(compile_commands())
    changed = None if everything else changed_files()
    if changed is None or changed.intersection(RULES):
        return sources
    chosen = {s for s in sources if str(s) in changed}
    for header in project_files(suffixes=(".h",)):
        if str(header) in changed:
            chosen.update(sources_that_show(header, sources))
    return sorted(chosen)


def tidy(source):
    return subprocess.run(["clang-tidy-16", "--quiet", "-p", BUILD, ROOT / source], cwd=ROOT,
                          capture_output=True, text=True, check=False)


def check(everything):
    sources = chosen_sources(everything)
    findings = {}  # In order, once each: a header is seen from several sources.
    for source, run in zip(sources, in_parallel(tidy, sources)):
        before = len(findings)
        for line in run.stdout.splitlines():
            match = FINDING.match(line)
            if match:
                place = match.group(1).removeprefix(f"{ROOT}/")
                findings[f"{place}:{match.group(2)}: {match.group(4)}"] = None
        if run.returncode != 0 and len(findings) == before and not run.stdout:
            findings[f"{source}:1: clang-tidy failed: {run.stderr.strip()[-400:]}"] = None
    missing = [p for p in project_files(suffixes=(".cpp",)) if everything
               and p not in compile_commands() and "install" not in p.parts]
    findings.update({f"{p}:1: is compiled nowhere; add it to a CMakeLists.txt": None
                     for p in missing})
    print(f"({len(sources)} of {len(compile_commands())} source files)", file=sys.stderr)
    return list(findings)


if __name__ == "__main__":
    sys.exit(report(check("--all" in sys.argv[1:])))
