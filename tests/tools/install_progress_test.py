"""tools/install says how far apt is, and ends with apt's own words when it fails."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1))

FAKE_APT = """#!/bin/sh
[ "$1" = update ] && exit 0
echo 'Reading package lists...'
echo 'dlstatus:1:42.0:Retrieving file 1 of 2'
echo 'pmstatus:libnowhere:85.7:Unpacking libnowhere'
{end}
"""


class Install(unittest.TestCase):
    def run_install(self, end):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name, text in (("apt-get", FAKE_APT.format(end=end)), ("sudo", '#!/bin/sh\nexec "$@"\n')):
                (folder / name).write_text(text)
                (folder / name).chmod(0o755)
            (folder / "list.txt").write_text("# what for\nlibnowhere-at-all\n")
            return subprocess.run(
                [SOURCE / "tools/install", folder / "list.txt"],
                env=os.environ | {"PATH": f"{folder}:{os.environ['PATH']}"},
                capture_output=True,
                text=True,
                check=False,
            )

    def test_progress_is_told(self):
        done = self.run_install("exit 0")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("Installing 1 Debian packages", done.stdout)
        self.assertIn("42 %  fetching", done.stdout)
        self.assertIn("85 %  libnowhere", done.stdout)

    def test_a_failure_is_told_in_apts_words(self):
        done = self.run_install("echo 'E: no such package' >&2; exit 100")
        self.assertEqual(done.returncode, 1)
        self.assertIn("E: no such package", done.stderr)
        self.assertIn("could not be installed", done.stderr)


if __name__ == "__main__":
    unittest.main()
