"""The tutorial typed as it stands: every command exists with its options, and the part that needs no arm prints what
the page says. Needs numpy, as its reader does.

usage: tutorial_test.py FOLDER-OF-PROGRAMS FIRMWARE
"""

import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PROGRAMS = Path(sys.argv[1]).resolve()
FIRMWARE = str(Path(sys.argv[2]).resolve())
TEXT = (TOP / "docs" / "tutorial.md").read_text()
PATIENCE_S = 300  # much longer than any healthy run


def help_of(program: str, commands: list[str]) -> str:
    run = subprocess.run([PROGRAMS / program, *commands, "--help"], capture_output=True, text=True, timeout=60)
    assert run.returncode == 0, f"{program} {' '.join(commands)}: {run.stderr}"
    return run.stdout


def part(title: str) -> str:
    return TEXT.split(f"\n## {title}\n")[1].split("\n## ")[0]


def typed_lines(text: str) -> list[str]:
    return re.findall(r"^    (build/pc/.+)$", text, re.MULTILINE)


def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def words_of(line: str, port: int) -> list[str]:
    program, *words = line.replace("3240", str(port)).split()
    return [str(PROGRAMS / Path(program).name), *(FIRMWARE if word.endswith(".elf") else word for word in words)]


class Tutorial(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.folder = Path(directory.name)

    def type(self, line: str, port: int = 0) -> str:
        run = subprocess.run(words_of(line, port), cwd=self.folder, capture_output=True, text=True, timeout=PATIENCE_S)
        self.assertEqual(run.returncode, 0, f"{line}: {run.stdout}{run.stderr}")
        return run.stdout

    def start_board(self, line: str, port: int) -> subprocess.Popen:
        board = subprocess.Popen(words_of(line, port), cwd=self.folder, stdout=subprocess.DEVNULL)
        self.addCleanup(board.wait)
        self.addCleanup(board.kill)
        ask = words_of("inkwell info --usbip 127.0.0.1:3240", port)
        give_up_at_s = time.monotonic() + PATIENCE_S
        while subprocess.run(ask, capture_output=True).returncode != 0:
            self.assertIsNone(board.poll(), "The virtual board ended.")
            self.assertLess(time.monotonic(), give_up_at_s)
            time.sleep(0.1)
        return board

    def test_the_experiment_prints_the_results_of_the_page(self):
        text = part("Measure the wall")
        [command] = typed_lines(text)
        found = [" ".join(line.split()) for line in self.type(command).splitlines()]
        promised = [" ".join(line.split()) for line in re.findall(r"^    (?!build)(.+)$", text, re.MULTILINE)]
        self.assertEqual(len(promised), 2)
        for line in promised:
            self.assertIn(line, found)
        self.assertTrue((self.folder / "results/figure-12.png").exists())
        [plot] = re.findall(r"`(build/pc/inkwell plot [^`]+)`", text)
        self.type(plot)
        [program] = re.findall(r"```python\n(.+?)```", text, re.DOTALL)
        run = subprocess.run([sys.executable, "-c", program], cwd=self.folder, capture_output=True, text=True,
                             timeout=PATIENCE_S)
        self.assertEqual(run.stdout.strip(), re.search(r"prints (\d+ N/m)", text)[1], run.stderr)

    def test_the_board_retains_stored_parameters(self):
        port = free_port()
        text = part("Store the parameters")
        board_line, *commands = typed_lines(text)
        board = self.start_board(board_line, port)
        for line in commands:
            with self.subTest(typed=line):
                self.type(line, port)
        self.assertTrue((self.folder / "still.png").exists())
        board.send_signal(signal.SIGINT)
        self.assertEqual(board.wait(PATIENCE_S), 0)

        self.start_board(board_line, port)
        [asked] = re.findall(r"`(build/pc/inkwell parameters get [^`]+)`", text)
        self.assertIn(re.search(r"prints ([\d.]+\d)\.", text)[1], self.type(asked, port))

    def test_commands_exist_with_their_options(self):
        typed = re.findall(r"^    build/pc/(.+)$", TEXT, re.MULTILINE)
        typed += [" ".join(words.split()) for words in re.findall(r"`build/pc/([^`]+)`", TEXT)]
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
