"""Every relative link in a Markdown file leads to a file, and to a heading where it names one."""

import re
import urllib.parse

from project_files import main, project_files

LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?[^)]*\)|^\[[^\]]+\]:\s*(\S+)")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$")
FENCE = re.compile(r"^\s*(```|~~~)")


def prose_lines(text):
    """Numbered lines outside fenced code; `code` within a line is blanked."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if FENCE.match(line):
            fenced = not fenced
        elif not fenced:
            yield number, line


def anchors(text):
    """The anchors that GitHub and GitLab give to the headings."""
    seen = {}
    result = set()
    for _, line in prose_lines(text):
        match = HEADING.match(line)
        if not match:
            continue
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", match.group(1)).lower()
        slug = re.sub(r"[^\w\- ]", "", title).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        result.add(f"{slug}-{count}" if count else slug)
    return result


def broken(root, path, target):
    """Why a link does not work, or None."""
    parts = urllib.parse.urlsplit(target)
    if parts.scheme or parts.netloc:
        return None
    file = root / path
    if parts.path:
        if parts.path.startswith("/"):
            return "starts at the root of a disk; write it relative to this file"
        file = file.parent / urllib.parse.unquote(parts.path)
        if not file.exists():
            return "leads nowhere; name a file of the project"
        if root not in file.resolve().parents and file.resolve() != root:
            return "leaves the project; others have no such file"
    if parts.fragment and file.suffix == ".md":
        known = anchors(file.read_text())
        if parts.fragment not in known:
            return f"names no heading; {file.name} has {', '.join(sorted(known))}"
    return None


def check(root):
    findings = []
    for path in project_files(root, (".md",)):
        for number, line in prose_lines((root / path).read_text()):
            for match in LINK.finditer(re.sub(r"`[^`]*`", "`x`", line)):
                target = match.group(1) or match.group(2)
                reason = broken(root, path, target)
                if reason:
                    findings.append(f"{path}:{number}: the link {target} {reason}")
    return findings


if __name__ == "__main__":
    main(check)
