"""The checks find what they are for, each in a small project of its own."""

import pathlib
import tempfile
import unittest

import check_files
import check_layers
import check_links
import check_scripts

LAYERS = """# kinebase_layer(search DEPENDS core) is only a comment.
kinebase_layer(core PUBLIC fmt::fmt)
kinebase_layer(motion DEPENDS core PUBLIC Eigen3::Eigen)
kinebase_layer(features DEPENDS motion)
"""


class CheckTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())

    def assert_findings(self, check, *expected):
        findings = check.check(self.root)
        self.assertEqual(len(findings), len(expected), findings)
        for finding, part in zip(findings, expected):
            self.assertIn(part, finding)


class LayersTest(CheckTest):
    def setUp(self):
        super().setUp()
        self.write("src/CMakeLists.txt", LAYERS)

    def test_a_layer_may_include_itself_and_what_it_depends_on_through_others(self):
        self.write("src/features/a.cpp", '#include "kinebase/features/a.h"\n'
                   '#include "kinebase/core/error.h"\n#include <vector>\n#include "fmt/core.h"\n')
        self.assert_findings(check_layers)

    def test_a_layer_may_not_include_what_uses_it(self):
        self.write("include/kinebase/core/a.h", '#pragma once\n#include "kinebase/motion/b.h"\n')
        self.write("src/motion/b.cpp", '#  include <kinebase/features/c.h>\n')
        self.assert_findings(check_layers, "core/a.h:2: core may not include motion",
                             "motion/b.cpp:1: motion may not include features")

    def test_private_headers_count_too(self):
        self.write("src/core/a.cpp", '#include "features/inside.h"\n')
        self.assert_findings(check_layers, "core may not include features")

    def test_a_public_header_includes_no_private_one(self):
        self.write("include/kinebase/core/a.h", '#include "core/inside.h"\n')
        self.assert_findings(check_layers, "a public header includes a private one")

    def test_a_folder_of_no_layer_is_found_and_applications_are_free(self):
        self.write("src/retrieval/a.cpp", "")
        self.write("apps/cli/main.cpp", '#include "kinebase/features/a.h"\n')
        self.assert_findings(check_layers, "src/retrieval/a.cpp:1: folder of no layer")


class LinksTest(CheckTest):
    def test_links_that_work(self):
        self.write("docs/a.md", "# A `b`, c\n## A b c\n")
        self.write("README.md", "[a](docs/a.md#a-b-c-1) [b](docs/) [c](https://example.org/x)\n"
                   "`[d](nowhere.md)`\n```\n[e](nowhere.md)\n```\n![p](docs/a.md \"title\")\n")
        self.assert_findings(check_links)

    def test_links_that_do_not(self):
        self.write("README.md", "# Title\n[a](nowhere.md)\n[b](#titel)\n[c](../../etc)\n"
                   "[d]: gone.md\n[e](/README.md)\n")
        self.assert_findings(check_links, "README.md:2", "README.md:3: the link #titel",
                             "README.md:4", "README.md:5", "README.md:6")


class FilesTest(CheckTest):
    def test_what_is_wrong_with_a_file_is_named_by_line(self):
        self.write("a.cpp", "int a;\n\tint b;\r\nint c; \nint d;")
        self.assert_findings(check_files, "a.cpp:4: no newline", "a.cpp:2: carriage return",
                             "a.cpp:2: tab", "a.cpp:3: space")

    def test_files_that_grew_too_far(self):
        self.write("long.cpp", "\n" * 601)
        self.write("fuzz/corpus/amc/long.amc", "\t\r\n" * 400000)
        self.assert_findings(check_files, "fuzz/corpus/amc/long.amc:1: 1171 KiB",
                             "long.cpp:601: 601 lines")

    def test_headers_are_read_once(self):
        self.write("a.h", "// A.\n#pragma once\n")
        self.write("kernel-inl.h", "// Included once for each instruction set.\n")
        self.write("b.h", "int b();\n")
        self.assert_findings(check_files, "b.h:1: no #pragma once")


class ScriptsTest(CheckTest):
    def test_scripts_that_cannot_be_read_or_started(self):
        self.write("a.py", "x = 1\ny = (\n")
        self.write("b", "#!/usr/bin/env bash\necho b\n")
        self.write("c.sh", "if true; then\n")
        self.assert_findings(check_scripts, "a.py:2", "b:1: cannot be started", "c.sh")


if __name__ == "__main__":
    unittest.main()
