"""A layer includes only itself and the layers that src/CMakeLists.txt lets it depend on."""

import re

from project_files import CPP, main, project_files

DECLARATION = re.compile(r"kinebase_layer\(\s*(\w+)([^)]*)\)")
KEYWORDS = {"DEPENDS", "PUBLIC", "PRIVATE", "DATA"}
INCLUDE = re.compile(r'\s*#\s*include\s*[<"]([^>"]+)[>"]')


def declared_layers(root):
    """Each layer with the layers that it may include."""
    text = re.sub(r"#.*", "", (root / "src/CMakeLists.txt").read_text())
    direct = {}
    for name, arguments in DECLARATION.findall(text):
        words = arguments.split()
        depends = []
        if "DEPENDS" in words:
            for word in words[words.index("DEPENDS") + 1:]:
                if word in KEYWORDS:
                    break
                depends.append(word)
        direct[name] = depends
    allowed = {}
    for name in direct:  # Declared left to right, so what it depends on is known already.
        allowed[name] = {name}.union(*(allowed.get(d, {d}) for d in direct[name]))
    return allowed


def layer_of(path):
    """The layer that a file belongs to; None outside include/kinebase and src."""
    if path.parts[:2] == ("include", "kinebase") and len(path.parts) > 3:
        return path.parts[2]
    if path.parts[0] == "src" and len(path.parts) > 2:
        return path.parts[1]
    return None


def included_layer(include, layers):
    """The layer of "kinebase/<layer>/x.h", or of "<layer>/x.h", a header in src/."""
    parts = include.split("/")
    if parts[0] == "kinebase" and len(parts) > 2:
        return parts[1]
    return parts[0] if len(parts) > 1 and parts[0] in layers else None


def check(root):
    layers = declared_layers(root)
    findings = []
    for path in project_files(root, CPP):
        layer = layer_of(path)
        if layer is None:
            continue
        if layer not in layers:
            findings.append(f"{path}:1: folder of no layer; declare \"{layer}\" in "
                            "src/CMakeLists.txt or move the file")
            continue
        is_public = path.parts[0] == "include"
        for number, line in enumerate((root / path).read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            target = match and included_layer(match.group(1), layers)
            if not target:
                continue
            if target not in layers[layer]:
                may = ", ".join(name for name in layers if name in layers[layer])
                findings.append(f"{path}:{number}: {layer} may not include {target} "
                                f"({match.group(1)}); it may include {may}; move the code to the "
                                "layer that it belongs to")
            elif is_public and not match.group(1).startswith("kinebase/"):
                findings.append(f"{path}:{number}: a public header includes a private one "
                                f"({match.group(1)}); nobody outside has it")
    return findings


if __name__ == "__main__":
    main(check)
