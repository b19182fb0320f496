"""tools/test-on states what is missing, and tries the last commit on the system that was asked for."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1))
NEEDED = ("bash", "chmod", "cp", "df", "dirname", "git", "id", "mktemp", "rm", "sed", "tail", "git-upload-pack", "cat")


class TestOn(unittest.TestCase):
    def run_test_on(self, *arguments, mmdebstrap=None):
        """Runs as root in a small repository, with `mmdebstrap` as the text of that program."""
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            programs, tree = folder / "programs", folder / "tree"
            programs.mkdir()
            (tree / "tools/release").mkdir(parents=True)
            for name in ("test-on", "release/test-on-trial"):
                (tree / "tools" / name).write_bytes((SOURCE / "tools" / name).read_bytes())
            (tree / "committed").touch()
            git = ["git", "-C", tree, "-c", "user.name=A", "-c", "user.email=a@example.invalid"]
            for words in (["init", "--quiet"], ["add", "."], ["commit", "--quiet", "--message", "One"]):
                subprocess.run([*git, *words], check=True)
            (tree / "not-committed").touch()
            for name in NEEDED:
                for directory in os.environ["PATH"].split(":"):
                    if os.access(f"{directory}/{name}", os.X_OK):
                        (programs / name).symlink_to(f"{directory}/{name}")
                        break
            fakes = {"id": "echo 0", "df": "echo 99"} | ({"mmdebstrap": mmdebstrap} if mmdebstrap else {})
            for name, text in fakes.items():
                (programs / name).unlink(missing_ok=True)
                (programs / name).write_text(f"#!{programs}/bash\n{text}\n")
                (programs / name).chmod(0o755)
            return subprocess.run(
                [programs / "bash", tree / "tools/test-on", *arguments],
                env=os.environ | {"PATH": str(programs), "TMPDIR": str(folder)},
                capture_output=True,
                text=True,
                check=False,
            )

    def test_the_last_commit_goes_into_the_named_system(self):
        look = 'printf "%s\\n" "$@"; for word in "$@"; do case $word in *copy-in*) set -- $word; ls=("$2"/*); echo "${ls[@]##*/}";; esac; done'
        done = self.run_test_on("trixie", "packages", mmdebstrap=look)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("test-on-trial packages\ntrixie\n/dev/null\n", done.stdout)
        self.assertIn("committed tools\n", done.stdout)
        self.assertNotIn("not-committed", done.stdout)
        self.assertIn("not committed are left out", done.stdout)
        self.assertIn("The trial of packages on trixie passed.", done.stdout)

    def test_demo_is_the_default(self):
        done = self.run_test_on("bookworm", mmdebstrap='printf "%s\\n" "$@"')
        self.assertIn("test-on-trial demo\nbookworm\n", done.stdout)

    def test_a_failed_trial_fails(self):
        done = self.run_test_on("bookworm", mmdebstrap="exit 25")
        self.assertEqual(done.returncode, 1)
        self.assertIn("The trial of demo on bookworm failed.", done.stderr)
        self.assertNotIn("passed", done.stdout)

    def test_a_missing_program_is_named(self):
        done = self.run_test_on("bookworm")
        self.assertEqual(done.returncode, 1)
        self.assertIn("mmdebstrap is not installed", done.stderr)

    def test_unknown_words_show_the_usage(self):
        for words in ([], ["sid"], ["trixie", "bench"], ["trixie", "demo", "more"], ["--keep"]):
            done = self.run_test_on(*words, mmdebstrap="exit 0")
            self.assertEqual(done.returncode, 2, words)
            self.assertIn("usage: tools/test-on", done.stderr)

    def test_a_system_that_was_kept_is_not_overwritten(self):
        done = self.run_test_on("--keep", "/", "trixie", mmdebstrap="exit 0")
        self.assertEqual(done.returncode, 1)
        self.assertIn("--keep: / exists already", done.stderr)


if __name__ == "__main__":
    unittest.main()
