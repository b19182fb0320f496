"""Host binaries of the build load no library from the current folder.

    binaries_test.py BUILD_DIRECTORY [LibraryFolders]
"""

import pathlib
import sys
import unittest

from binaries import host_binaries, unsafe_folders

BUILD = pathlib.Path(sys.argv[1])


class LibraryFolders(unittest.TestCase):
    def test_none_depends_on_the_current_folder(self):
        paths = list(host_binaries(BUILD))
        self.assertIn(BUILD / "virtual-board", paths)
        self.assertEqual([], [problem for path in paths for problem in unsafe_folders(path)])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
