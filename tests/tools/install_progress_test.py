"""tools/install says how far apt is, mends what dpkg left half done, and says what failed."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1))

# Each package of the fake dpkg is a file in the folder "packages". The file of a package contains its status.
FAKE_PROGRAMS = {
    "apt-get": """
case "$*" in
  update) exit 0 ;;
  *--fix-broken*) {fix}; exit ;;
esac
echo 'Reading package lists...'
status=$(printf '%s\n' "$@" | sed -n 's/^APT::Status-Fd=//p')
echo 'dlstatus:1:42.0:Retrieving file 1 of 2' >&"$status"
echo 'pmstatus:libnowhere:85.7:Unpacking libnowhere' >&"$status"
# Like apt, this hides the status descriptor from package scripts.
eval "exec $status>&-"
echo 'Setting up libnowhere' || { echo 'postinst: echo: I/O error' >&2; exit 100; }
{install}
""",
    "dpkg": """
{configure}
""",
    "dpkg-query": """
cd packages
if [ $# -eq 3 ]; then cat "$3"; else for each in *; do echo "$(cat "$each") $each"; done; fi
""",
    "sudo": 'exec "$@"',
}

UNPACKED = "echo unpacked >packages/libnowhere; echo 'E: Errors were encountered' >&2; exit 100"


class Install(unittest.TestCase):
    def run_install(self, install, configure="exit 1", fix="exit 100"):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name, text in FAKE_PROGRAMS.items():
                for part, value in (("install", install), ("configure", configure), ("fix", fix)):
                    text = text.replace("{" + part + "}", value)
                (folder / name).write_text(f"#!/bin/sh\ncd {folder}\n{text}\n")
                (folder / name).chmod(0o755)
            (folder / "packages").mkdir()
            (folder / "packages" / "libelse").write_text("installed")
            (folder / "packages" / "libgone").write_text("config-files")
            (folder / "list.txt").write_text("# what for\nlibelse\nlibnowhere\n")
            done = subprocess.run(
                [SOURCE / "tools/install", folder / "list.txt"],
                env=os.environ | {"PATH": f"{folder}:{os.environ['PATH']}", "TMPDIR": str(folder)},
                capture_output=True,
                text=True,
                check=False,
            )
            done.logs = {str(path): path.read_text() for path in folder.glob("*.log")}
            return done

    def test_progress_is_printed(self):
        done = self.run_install("exit 0")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("Installing 1 Debian packages", done.stdout)
        self.assertIn("42 %  fetching", done.stdout)
        self.assertIn("85 %  libnowhere", done.stdout)
        self.assertEqual(done.logs, {})

    def test_scripts_of_packages_can_print(self):
        done = self.run_install("exit 100")
        self.assertIn("Setting up libnowhere", done.stderr)
        self.assertNotIn("I/O error", done.stderr)

    def test_a_failure_is_reported_with_the_error_of_apt(self):
        done = self.run_install("echo 'E: no such package' >&2; exit 100")
        self.assertEqual(done.returncode, 1)
        self.assertIn("E: no such package", done.stderr)
        self.assertIn("Reading package lists", done.stderr)
        self.assertNotIn("status:", done.stderr)
        self.assertIn("could not be installed: libnowhere", done.stderr)
        self.assertIn("network", done.stderr)
        [(path, text)] = done.logs.items()
        self.assertIn(path, done.stderr)
        self.assertIn("no such package", text)

    def test_packages_that_dpkg_left_unconfigured_are_configured_again(self):
        for mended in ({"configure": "echo installed >packages/libnowhere"}, {"fix": "echo installed >packages/libnowhere"}):
            done = self.run_install(UNPACKED, **mended)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("at first: libnowhere\n", done.stdout)
            self.assertIn("E: Errors were encountered", done.stdout)
            [(path, text)] = done.logs.items()
            self.assertIn(f"trying once more; the log is {path}", done.stdout)
            self.assertIn("E: Errors were encountered", text)

    def test_packages_that_were_not_reached_are_installed_afterwards(self):
        first = "if [ -e packages/libfirst ]; then echo installed >packages/libnowhere; exit 0; fi"
        done = self.run_install(
            f"{first}; echo half-configured >packages/libfirst; exit 100", fix="echo installed >packages/libfirst"
        )
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_packages_that_cannot_be_configured_are_named_without_a_network_error(self):
        done = self.run_install(UNPACKED)
        self.assertEqual(done.returncode, 1)
        self.assertIn("could not be configured: libnowhere\n", done.stderr)
        self.assertNotIn("libgone", done.stderr)
        self.assertNotIn("network", done.stderr)
        self.assertIn("--fix-broken", done.stderr)

    def test_another_installation_is_waited_for(self):
        done = self.run_install("echo 'E: Could not get lock /var/lib/dpkg/lock-frontend.' >&2; exit 100")
        self.assertEqual(done.returncode, 1)
        self.assertIn("Another program", done.stderr)
        self.assertNotIn("network", done.stderr)


if __name__ == "__main__":
    unittest.main()
