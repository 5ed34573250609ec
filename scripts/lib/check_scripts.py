"""Shell scripts and Python files can be read by their interpreters; scripts can be started."""

import os
import shutil
import subprocess

from project_files import main, project_files


def interpreter(path, first_line):
    if path.suffix == ".py" or "python3" in first_line:
        return "python"
    if path.suffix == ".sh" or (first_line.startswith("#!") and "bash" in first_line):
        return "bash"
    return None


def first_error(command, root):
    run = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    return None if run.returncode == 0 else (run.stderr or run.stdout).strip()


def check(root):
    findings = []
    shellcheck = shutil.which("shellcheck")  # Better where it is there, and not asked for.
    for path in project_files(root):
        with open(root / path, "rb") as file:
            first_line = file.readline(200).decode("utf-8", "replace")
        kind = interpreter(path, first_line)
        if kind is None:
            continue
        if first_line.startswith("#!") and not os.access(root / path, os.X_OK):
            findings.append(f"{path}:1: cannot be started; chmod +x {path}")
        if kind == "python":
            try:
                compile((root / path).read_bytes(), str(path), "exec")
            except SyntaxError as error:
                findings.append(f"{path}:{error.lineno}: {error.msg}; correct the syntax")
            continue
        error = first_error(["bash", "-n", str(path)], root)
        if error:
            findings.append(f"{path}: {error}; correct the syntax")
        elif shellcheck:
            error = first_error([shellcheck, "--external-sources", "--format=gcc", str(path)], root)
            if error:
                findings.append(error)
    return findings


if __name__ == "__main__":
    main(check)
