"""Every command of the tutorial exists, with the options that are typed.

usage: tutorial_test.py FOLDER-OF-PROGRAMS
"""

import re
import subprocess
import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PROGRAMS = Path(sys.argv[1])


def help_of(program: str, commands: list[str]) -> str:
    run = subprocess.run([PROGRAMS / program, *commands, "--help"], capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, f"{program} {' '.join(commands)}: {run.stderr}"
    return run.stdout


class Tutorial(unittest.TestCase):
    def test_commands_exist_with_their_options(self):
        text = (TOP / "docs" / "tutorial.md").read_text()
        typed = re.findall(r"^    build/pc/(.+)$", text, re.MULTILINE)
        typed += [" ".join(words.split()) for words in re.findall(r"`build/pc/([^`]+)`", text)]
        self.assertGreater(len(typed), 15)
        for line in typed:
            program, *words = line.split()
            commands = []
            for word in words:
                if not re.fullmatch(r"[a-z][a-z-]*", word):
                    break
                commands.append(word)
            with self.subTest(typed=line):
                told = help_of(program, commands) + help_of(program, [])
                for option in (word for word in words if word.startswith("--")):
                    self.assertRegex(told, rf"(?<![\w-]){option}(?![\w-])")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
