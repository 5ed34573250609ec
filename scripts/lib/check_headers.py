"""Every public header compiles on its own."""

import subprocess

from compile_commands import BUILD, compile_commands, in_parallel
from project_files import ROOT, main, project_files


def flags_by_layer():
    """Compiler and flags of one source file of each layer, without what names that file."""
    flags = {}
    for path, command in compile_commands().items():
        if path.parts[0] != "src" or path.parts[1] in flags:
            continue
        kept = []
        arguments = iter(command)
        for argument in arguments:
            if argument == "-o":
                next(arguments)
            elif argument != "-c" and not argument.endswith(".cpp"):
                kept.append(argument)
        flags[path.parts[1]] = kept
    return flags


def check(root):
    headers = [p for p in project_files(root, (".h",)) if p.parts[:2] == ("include", "kinebase")]
    flags = flags_by_layer()

    def compile_alone(header):
        layer = header.parts[2]
        if layer not in flags:
            return f"{header}:1: its layer {layer} has no source file that says how to compile it"
        command = [*flags[layer], "-fsyntax-only", "-include", str(ROOT / header), "-x", "c++",
                   "/dev/null"]
        run = subprocess.run(command, cwd=BUILD, capture_output=True, text=True, check=False)
        if run.returncode == 0:
            return None
        error = next((line for line in run.stderr.splitlines() if "error:" in line), run.stderr)
        return f"{header}:1: does not compile alone; include what it uses: {error}"

    return [finding for finding in in_parallel(compile_alone, headers) if finding]


if __name__ == "__main__":
    main(check)
