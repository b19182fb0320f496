"""tools/check/format: only the version that formats the sources judges them."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1))
NEEDED = ("bash", "dirname", "git", "nproc", "xargs")


class CheckFormat(unittest.TestCase):
    def run_check(self, **formatters):
        """Runs the check where only the given formatters exist: {name: (version, exit code for files)}."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name in NEEDED:
                for directory in os.environ["PATH"].split(":"):
                    if os.access(f"{directory}/{name}", os.X_OK):
                        (folder / name).symlink_to(f"{directory}/{name}")
                        break
            for name, (version, code) in formatters.items():
                program = folder / name.replace("_", "-")
                program.write_text(
                    f"#!{folder}/bash\n"
                    f"[ \"$1\" != --version ] || {{ echo 'clang-format version {version}'; exit 0; }}\n"
                    f"exit {code}\n"
                )
                program.chmod(0o755)
            return subprocess.run(
                [SOURCE / "tools/check/format"],
                env=os.environ | {"PATH": str(folder)},
                capture_output=True,
                text=True,
                check=False,
            )

    def test_another_version_is_skipped_with_its_name(self):
        done = self.run_check(clang_format=("19.1.7 (1)", 1))
        self.assertEqual(done.returncode, 77, done.stderr)
        self.assertIn("Skipped", done.stdout)
        self.assertIn("19.1.7", done.stdout)
        self.assertNotIn("-i FILE", done.stdout + done.stderr)

    def test_the_needed_version_judges_under_either_name(self):
        for name in ("clang_format", "clang_format_14"):
            self.assertEqual(self.run_check(**{name: ("14.0.6", 0)}).returncode, 0)
            done = self.run_check(**{name: ("14.0.6", 1)})
            self.assertEqual(done.returncode, 1)
            self.assertIn(f"{name.replace('_', '-')} -i FILE", done.stderr)

    def test_the_needed_version_is_preferred(self):
        self.assertEqual(self.run_check(clang_format=("19.1.7", 1), clang_format_14=("14.0.6", 0)).returncode, 0)

    def test_a_missing_formatter_is_named(self):
        done = self.run_check()
        self.assertEqual(done.returncode, 1)
        self.assertIn("clang-format is not installed", done.stderr)


if __name__ == "__main__":
    unittest.main()
