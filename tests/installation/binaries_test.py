"""Host binaries of the build are protected against memory errors, and load no library from the current folder.

    binaries_test.py BUILD_DIRECTORY [Hardening | LibraryFolders]
"""

import json
import pathlib
import sys
import unittest

from binaries import BINARIES, host_binaries, missing, unsafe_folders
from kinds import KINDS

BUILD = pathlib.Path(sys.argv[1])


class Hardening(unittest.TestCase):
    def test_each_binary_shows_each_flag(self):
        for binary in BINARIES:
            paths = list(BUILD.glob(binary.file))
            if binary.is_optional and not paths:
                continue
            with self.subTest(binary.file):
                [path] = paths
                self.assertEqual([], missing(path, binary))

    def test_each_source_is_compiled_with_each_flag(self):
        # Linked libraries have the same properties, so a binary does not prove that each source has the flags.
        for entry in json.loads((BUILD / "compile_commands.json").read_text()):
            words = entry["command"].split()
            flags = ["-fPIC", "-fstack-protector-strong", "-fstack-clash-protection", "-D_GLIBCXX_ASSERTIONS"]
            if "-O0" not in words:
                flags.append("-D_FORTIFY_SOURCE=3")
            with self.subTest(entry["file"]):
                self.assertEqual([], [flag for flag in flags if flag not in words])

    def test_each_row_is_of_a_kind_that_is_installed(self):
        kinds = [kind for kinds in KINDS.values() for kind in kinds]
        self.assertEqual([], [binary.kind for binary in BINARIES if binary.kind and binary.kind not in kinds])


class LibraryFolders(unittest.TestCase):
    def test_none_depends_on_the_current_folder(self):
        paths = list(host_binaries(BUILD, left_out=BUILD / "tests"))  # other tests replace the files there
        self.assertIn(BUILD / "virtual-board", paths)
        self.assertEqual([], [problem for path in paths for problem in unsafe_folders(path)])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
