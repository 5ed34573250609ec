"""Rules for every file: encoding, line ends, size, length."""

from project_files import CPP, main, project_files

LARGEST_BYTES = 1 << 20
LONGEST_LINES = 600
CODE = CPP + (".py", ".sh", ".cmake")


def check_text(path, data):
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        return [f"{path}:1: not UTF-8 ({error.reason} at byte {error.start}); convert it"]
    findings = []
    if data and not text.endswith("\n"):
        findings.append(f"{path}:{text.count(chr(10)) + 1}: no newline at the end; add one")
    for number, line in enumerate(text.split("\n"), 1):
        if "\r" in line:
            findings.append(f"{path}:{number}: carriage return; end lines with a newline alone")
        if "\t" in line:
            findings.append(f"{path}:{number}: tab; indent with spaces")
        if line != line.rstrip(" "):
            findings.append(f"{path}:{number}: space at the end of the line; remove it")
    return findings


def check(root):
    findings = []
    for path in project_files(root):
        data = (root / path).read_bytes()
        if len(data) > LARGEST_BYTES:
            findings.append(f"{path}:1: {len(data) >> 10} KiB, at most {LARGEST_BYTES >> 10}; "
                            "make it in a script instead of keeping it")
        if "corpus" in path.parts or b"\0" in data[:8192]:
            continue  # Files of the corpora are odd on purpose.
        findings += check_text(path, data)
        lines = data.count(b"\n")
        if path.suffix in CODE and lines > LONGEST_LINES:
            findings.append(f"{path}:{LONGEST_LINES + 1}: {lines} lines, at most {LONGEST_LINES}; "
                            "it is probably two things, so make it two files")
        # What Highway compiles once for each instruction set has its own guard.
        once = path.suffix == ".h" and not path.stem.endswith("-inl")
        if once and b"\n#pragma once\n" not in b"\n" + data:
            findings.append(f"{path}:1: no #pragma once; add it below the opening comment")
    return findings


if __name__ == "__main__":
    main(check)
