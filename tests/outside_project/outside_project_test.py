"""Another project builds with ours as a part of it, and keeps its own ways.

    outside_project_test.py CMAKE CXX_COMPILER WORK_DIRECTORY
"""

import json
import pathlib
import subprocess
import sys
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
CMAKE, COMPILER, WORK = sys.argv[1:]


def run(*command) -> str:
    result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))} failed:\n{result.stdout}")
    return result.stdout


class OutsideProject(unittest.TestCase):
    def check(self, by: str, *how):
        """Configures the project with ours taken in this way, and builds it."""
        build = pathlib.Path(WORK) / by
        run(CMAKE, "--fresh", "-S", pathlib.Path(__file__).parent / "project", "-B", build, "-G", "Ninja",
            f"-DCMAKE_CXX_COMPILER={COMPILER}", f"-DINKWELL_SOURCE={REPOSITORY}", f"-DINKWELL_BY={by}")
        run(CMAKE, "--build", build, "--target", "outside", "--", *how)

        # None of our warnings, optimisation or other options reach its sources.
        commands = json.loads((build / "compile_commands.json").read_text())
        own = next(each["command"] for each in commands if each["file"].endswith("project/main.cpp"))
        self.assertNotRegex(own, r" -[WfO]")
        # Nor do our warnings end its build.
        self.assertFalse([each["file"] for each in commands if "-Werror" in each["command"]])
        # It does not get our tests.
        self.assertIn("Total Tests: 0", run("ctest", "--test-dir", build, "-N"))
        return build

    def test_add_subdirectory(self):
        build = self.check("add_subdirectory")
        # Its program is where it puts programs, and uses the protocol and the signal path.
        self.assertEqual(run(build / "outside").strip(), "0.479")

    def test_fetch_content(self):
        # The same sources by the same commands: what would be built is found out, and not built again.
        self.check("FetchContent", "-n")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
