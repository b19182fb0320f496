"""Each interface under each loss. Each interface has a program (agent.py, agent.cpp, agent.m, window_agent.cpp), which
carries out one command per line and answers with one line:

    open ADDRESS   opens the arm, closes the one before, and asks for its force
    pose           reads the pose; the answer begins with the probe's x in m, whatever the result
    push N         asks for N newtons to the right, about thirty times, at the pace of the poses
    enable         asks for the force again
    close          closes the arm
    take_over ADDRESS   opens the arm and takes it over (Python only)

The answer is "ok ..." or "error ...", with the sentence if there is one.

    losses_test.py BUILD_FOLDER INTERFACE
"""

import os
import pathlib
import subprocess
import sys
import time
import unittest

import inkwell
from virtual_board import VirtualBoard, be_patient, wait_until

HERE = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path()
INTERFACE = ""
BEYOND_A_WALL_M = -0.09
"""The box ends at -0.08 m. Command line and window send no force: the hand feels this wall, which pushes to the right."""
CLAIMS_WHEN_IT_OPENS = {"hdapi", "hdphantom"}
"""These keep an arm open only if they may drive it."""
HAS_NO_SENTENCES = {"hdphantom"}
TELLS_FORCES_BY_FRAMES = {"hdphantom"}
"""A force is accepted as long as there are frames, whether or not it is felt."""
FEELS_A_WALL = {"command-line", "window"}
SHOWS_NO_POSE_WITHOUT_A_LINK = {"window"}
SHOWS_A_RESTART_AS_A_STATE = {"window"}
"""It connects again by itself and shows that the arm has to be put into its inkwell."""
ENDS_WITH_A_SILENCE = {"command-line"}
READS_WITHOUT_A_HANDLE = {"command-line"}
SAYS = {"window": {"silence": "silent", "unplugged": "No arm was found", "link lost": "usb_gone", "restarted": "inkwell"},
        "command-line": {"silence": "silent", "link lost": "its cable was unplugged", "restarted": "restarted"}}
"""Texts of the interfaces that do not show the library's errors."""


def command(interface):
    return {"cpp": [BUILD / "losses-agent"],
            "window": [BUILD / "losses-window-agent"],
            "octave": ["octave-cli", "--norc", "--quiet", "--path", BUILD / "octave", HERE / "agent.m"],
            }.get(interface, [sys.executable, HERE / "agent.py", BUILD, interface])


class Agent:
    def __init__(self, interface, address):
        self._process = subprocess.Popen(command(interface), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                         env={**os.environ, "INKWELL_DEVICE": address})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.stdin.close()
        try:
            self._process.wait(60)
        finally:
            self._process.kill()
            self._process.wait()
            self._process.stdout.close()

    @property
    def process_id(self):
        return self._process.pid

    def ask(self, *words):
        self._process.stdin.write(" ".join(map(str, words)) + "\n")
        self._process.stdin.flush()
        answer = self._process.stdout.readline()
        assert answer, f"the program ended at {words}"
        return answer.strip()


class Losses(unittest.TestCase):
    """Ends with the arm lost, so that each begins with one that is felt."""

    @classmethod
    def setUpClass(cls):
        cls.board = VirtualBoard(BUILD)
        cls.addClassCleanup(cls.board.__exit__)
        cls.board.let_pass(1)  # until the encoders are referenced
        with inkwell.open(cls.board.address) as arm:
            be_patient(arm)
            arm.parameters.store()
        cls.held_point_m = (BEYOND_A_WALL_M if INTERFACE in FEELS_A_WALL else 0.02, 0.01, -0.03)
        cls.board.hold(cls.held_point_m)
        cls.board.let_pass(0.5)

    def setUp(self):
        self.board.call("resume")  # a failed test may have left the board paused
        self.agent = Agent(INTERFACE, self.board.address)
        self.addCleanup(self.agent.__exit__)
        self.answers = []
        self.board.let_pass(0.2)
        self.rest_m = self.board.position_m()[0]

    def ask(self, *words):
        self.answers.append(self.agent.ask(*words))
        return self.answers[-1]

    # ---- requests to a program -----------------------------------------------------------------------------------

    def succeeds(self, *words):
        answer = self.ask(*words)
        self.assertTrue(answer.startswith("ok"), f"{words}: {answer}")
        return answer.split()[1:]

    def fails(self, *words, says=""):
        answer = self.ask(*words)
        self.assertTrue(answer.startswith("error"), f"{words}: {answer}")
        if INTERFACE not in HAS_NO_SENTENCES:
            self.assertIn(says, answer)
        return answer.split()[1:]

    def eventually(self, attempt):
        """Repeats what raises an AssertionError until it does not, for a minute at most."""
        give_up_at = time.monotonic() + 60
        while True:
            try:
                return attempt()
            except AssertionError:
                if time.monotonic() > give_up_at:
                    raise
            time.sleep(0.02)

    def pulled_m(self):
        return self.board.position_m()[0] - self.rest_m

    def is_felt(self):
        """1 N against a hand of 300 N/m."""
        give_up_at = time.monotonic() + 60
        while self.pulled_m() < 0.0025 and time.monotonic() < give_up_at:
            self.succeeds("push", 1)
        self.assertGreater(self.pulled_m(), 0.0025)

    def is_not_felt(self, says=None):
        """The program continues to push for half a second of board time. With `says`, it gets an error with this text."""
        end_s = self.board.truth()["board_time_s"] + 0.5
        while self.board.truth()["board_time_s"] < end_s:
            self.ask("push", 1)
        self.assertLess(abs(self.pulled_m()), 0.0015)
        if says is not None and INTERFACE not in TELLS_FORCES_BY_FRAMES:
            self.assertTrue(any(answer.startswith("error") and says in answer for answer in self.answers), self.answers)

    def is_lost(self, says):
        """Reading the pose fails, but gives the last known one; no force is accepted."""
        x_m = self.board.position_m()[0]
        shown = self.eventually(lambda: self.fails("pose", says=says))[0]
        if INTERFACE not in SHOWS_NO_POSE_WITHOUT_A_LINK or shown != "none":
            self.assertAlmostEqual(float(shown), x_m, delta=0.001)
        if INTERFACE in ENDS_WITH_A_SILENCE:  # `watch` may report the loss before `force on` does
            self.eventually(lambda: self.fails("push", 1))
        self.fails("push", 1)
        self.fails("pose")

    def is_back(self):
        self.eventually(lambda: self.succeeds("pose"))

    def says(self, loss, sentence):
        return SAYS.get(INTERFACE, {}).get(loss, sentence)

    def becomes_active(self):
        self.succeeds("open", self.board.address)
        self.is_felt()
        self.eventually(self.pose_equals_the_truth)

    def pose_equals_the_truth(self):
        """The arm moves between the two answers if the force has just ended."""
        self.assertAlmostEqual(float(self.succeeds("pose")[0]), self.board.position_m()[0], delta=0.001)

    # ---- losses --------------------------------------------------------------------------------------------------

    def test_silence(self):
        self.becomes_active()
        self.board.call("pause")
        self.is_lost(self.says("silence", "No pose has arrived for 2 s"))
        self.board.call("resume")
        self.is_back()
        if INTERFACE in ENDS_WITH_A_SILENCE:
            self.succeeds("enable")
        self.is_felt()

    def test_unplugged_cable(self):
        self.becomes_active()
        self.board.call("usb", connected=False)
        self.is_lost(self.says("unplugged", "its cable was unplugged"))
        self.board.call("usb", connected=True)
        self.is_back()
        self.is_not_felt(says=self.says("link lost", "The link to the arm was lost"))
        self.succeeds("enable")
        self.is_felt()

    def test_board_fault(self):
        self.becomes_active()
        self.board.call("inject", fault="bridge_fault")
        self.is_not_felt(says="bridge_fault")
        self.succeeds("pose")
        self.board.call("heal", fault="bridge_fault")
        self.succeeds("enable")
        self.is_felt()

    def test_board_restart(self):
        self.becomes_active()
        self.board.call("reset")
        if INTERFACE not in SHOWS_A_RESTART_AS_A_STATE:
            self.eventually(lambda: self.fails("pose", says="restarted"))
        self.is_back()
        self.is_not_felt(says=self.says("restarted", "The link to the arm was lost"))
        self.board.call("dock", docked=True)
        with inkwell.open(self.board.address) as looker:
            wait_until(looker, lambda pose: pose.state == inkwell.State.READY)
        self.board.hold(self.held_point_m)
        self.board.let_pass(0.5)
        self.succeeds("enable")
        self.is_felt()

    def test_another_driver(self):
        with Agent("python", self.board.address) as other:
            other.ask("open", self.board.address)
            other.ask("push", 0)
            self.fails("open", self.board.address, says=f"(process {other.process_id})")
            if INTERFACE in CLAIMS_WHEN_IT_OPENS:
                self.fails("pose")
                self.fails("push", 1)
            else:
                self.succeeds("pose")
                self.fails("push", 1, says=f"(process {other.process_id})")
            if INTERFACE not in FEELS_A_WALL:
                self.is_not_felt()
            other.ask("close")
        self.becomes_active()
        with Agent("python", self.board.address) as other:
            self.assertEqual(other.ask("take_over", self.board.address), "ok")
            if INTERFACE in FEELS_A_WALL:  # the other program still renders the wall
                self.eventually(lambda: self.fails("push", 1, says=f"(process {other.process_id})"))
            else:
                self.is_not_felt(says=f"(process {other.process_id})")
            self.succeeds("pose")
            self.assertEqual(other.ask("push", 0), "ok")
            other.ask("close")
        self.succeeds("enable")
        self.is_felt()

    def test_closed_handle(self):
        self.becomes_active()
        self.succeeds("close")
        self.board.let_pass(0.3)
        if INTERFACE in READS_WITHOUT_A_HANDLE:
            self.succeeds("pose")
        else:
            self.fails("pose")
        self.fails("push", 1)
        self.is_not_felt()
        self.becomes_active()


if __name__ == "__main__":
    BUILD, INTERFACE = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
