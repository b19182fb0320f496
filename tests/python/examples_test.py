"""Every example does on a virtual board what its first line says, whichever language it is in.

    examples_test.py BUILD_FOLDER
"""

import contextlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Callable, Iterator

import inkwell
import numpy as np

from virtual_board import AXES, FREE_POINT_M, VirtualBoard, rests_at_x

BUILD = pathlib.Path()
HOST = pathlib.Path(__file__).resolve().parents[2] / "host/bindings"


def beside(x_m: float) -> tuple[float, float, float]:
    return x_m, *FREE_POINT_M[1:]


def command(name: str) -> list[str]:
    """The example of this file name."""
    if name.endswith(".py"):
        return [sys.executable, str(HOST / "python/examples" / name)]
    # C buffers the output to a pipe by default.
    return ["stdbuf", "-oL", str(BUILD / "examples" / pathlib.Path(name).stem)]


def environment(name: str) -> dict[str, str]:
    """Sanitizers look for leaks in programs, but not in the interpreter, which has some."""
    return {key: value for key, value in os.environ.items() if key != "ASAN_OPTIONS" or name.endswith(".py")}


@contextlib.contextmanager
def running(name: str, *arguments: str) -> Iterator[subprocess.Popen]:
    """Runs an example from its first line, when it has the arm, until its Enter, which it obeys without a complaint."""
    program = subprocess.Popen([*command(name), *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, env=environment(name))
    try:
        said = program.stdout.readline()
        assert said in ("Press Enter to end.\n", "Press button 1 of the stylus to end.\n", "Move the stylus.\n"), said + program.stderr.read()
        yield program
        output, errors = program.communicate("\n")
    except BaseException:
        program.kill()
        program.communicate()
        raise
    assert (program.returncode, errors) == (0, ""), f"{name}: {program.returncode} {errors}{output}"


def in_each_language(*names: str) -> Callable[[Callable], Callable]:
    """Runs a test once for each of these examples, which do the same."""
    def decorate(test: Callable) -> Callable:
        def in_turn(self: unittest.TestCase) -> None:
            with VirtualBoard(BUILD) as board:
                for name in names:
                    with self.subTest(name):
                        test(self, name, board)
        return in_turn
    return decorate


class Examples(unittest.TestCase):
    @in_each_language("spring_to_a_point.c", "spring_to_a_point.py")
    def test_spring_to_a_point(self, name, board):
        board.take_to(beside(0.02))
        with running(name, board.address):
            # The hand's spring of 300 N/m and the program's spring of 100 N/m have rest positions 20 mm apart.
            board.wait_until(rests_at_x(0.015))
        board.wait_until(rests_at_x(0.02))

    @in_each_language("magnetic_surface.cpp", "magnetic_surface.py")
    def test_magnetic_surface(self, name, board):
        board.take_to(beside(0.006))
        with running(name, board.address):
            # Two springs of 300 and 200 N/m have rest positions 6 mm apart.
            board.wait_until(rests_at_x(0.0036, 0.0008))
            board.hold(beside(0.016))
            board.wait_until(rests_at_x(0.016))
            board.hold(beside(-0.006))
            board.wait_until(rests_at_x(-0.0036, 0.0008))

    @in_each_language("viscous_field.cpp", "viscous_field.py")
    def test_viscous_field(self, name, board):
        board.take_to(beside(-0.03))

        def stroke() -> tuple[float, float]:
            """Force of the hand (N) and velocity (m/s) on the way, on average; the hand's are smooth movements."""
            board.call("hand_path", points=[{"after_s": 0.6, "target_m": beside(0.03)}])
            now = board.wait_until(lambda now: now["true_position_x_m"] > -0.01)
            seen = []
            while now["true_position_x_m"] < 0.01:
                seen.append((now["hand_force_x_N"], now["true_velocity_x_m_s"]))
                now = board.truth()
            board.hold(beside(-0.03))
            board.wait_until(rests_at_x(-0.03, 0.002))
            return tuple(np.mean(seen, axis=0)) if seen else (0.0, 1.0)

        friction_N, _ = stroke()
        with running(name, board.address):
            board.let_pass(0.5)  # while the force rises
            damping_Ns_per_m = []
            # On a busy computer the program can be too slow during single strokes, so the test repeats the stroke.
            while not damping_Ns_per_m or abs(damping_Ns_per_m[-1] - 4) > 1:
                self.assertLess(len(damping_Ns_per_m), 10, damping_Ns_per_m)
                force_N, velocity_m_s = stroke()
                damping_Ns_per_m.append((force_N - friction_N) / velocity_m_s)

    @in_each_language("sphere.cpp", "sphere.py")
    def test_sphere(self, name, board):
        board.take_to(beside(0.03), 600)
        with running(name, board.address):
            board.let_pass(0.5)
            board.hold(beside(0.015), 600)
            # Two springs of 800 and 600 N/m have rest positions 5 mm apart, and gravity and friction act.
            board.wait_until(rests_at_x(0.0179, 0.0008))
            radius_m = np.linalg.norm(np.subtract(board.position_m(), FREE_POINT_M))
            self.assertGreater(radius_m, 0.0172)
        board.wait_until(rests_at_x(0.015))

    @in_each_language("mesh.cpp", "mesh.py")
    def test_mesh(self, name, board):
        board.take_to(beside(0.032), 600)
        with running(name, board.address) as program:
            board.let_pass(0.5)
            board.hold(beside(0.02), 600)
            # Two springs of 1000 and 600 N/m have rest positions 5 mm apart: the tip has a radius of 5 mm.
            board.wait_until(rests_at_x(0.0231, 0.0008))
            program.stdin.write("\n")
            program.stdin.flush()
            self.assertRegex(program.stdout.readline(), r"^\d+\.\d{3} s: touched triangle \d+\n$")
        board.wait_until(rests_at_x(0.02))

    @in_each_language("moving_ball.c", "moving_ball.py")
    def test_moving_ball(self, name, board):
        board.take_to(beside(0.025))
        with running(name, board.address) as program:
            # The tip touches the ball 20 mm from the center of the ball, which moves by 20 mm to both sides.
            for _ in range(2):
                board.wait_until(lambda now: now["true_position_x_m"] > 0.03)
                board.wait_until(lambda now: now["true_position_x_m"] < 0.026)
            if name.endswith(".c"):
                board.call("buttons", pressed=[True, False])
                program.wait(60)
                board.call("buttons", pressed=[False, False])

    @in_each_language("two_arms.cpp", "two_arms.py")
    def test_two_arms(self, name, board):
        with VirtualBoard(BUILD, seed=2) as other:
            board.take_to(beside(-0.01))
            other.take_to(beside(0.01))
            with running(name, board.address, other.address):
                # Three springs of 300, 150 and 300 N/m are connected in series over a distance of 20 mm.
                board.wait_until(rests_at_x(-0.005))
                other.wait_until(rests_at_x(0.005))
                # The motion of one hand moves the other hand.
                other.hold(beside(0.03))
                board.wait_until(rests_at_x(0.0))

    def test_recording(self):
        with VirtualBoard(BUILD) as board, tempfile.TemporaryDirectory() as folder:
            board.take_to(beside(0.0))
            # The hand moves back and forth by 20 mm per half second.
            board.call("hand_path", points=[{"after_s": 0.5 * i, "target_m": beside(0.02 * (i % 2))}
                                            for i in range(1, 200)])
            file = pathlib.Path(folder, "movement.npz")
            with running("recording.py", str(file), board.address) as program:
                said = program.stdout.readline()
            movement = np.load(file)
            self.assertEqual(movement["position_m"].shape, (40_000, len(AXES)))
            self.assertAlmostEqual(movement["time_s"][-1], 2.0, places=3)
            self.assertAlmostEqual(np.ptp(movement["position_m"][:, 0]), 0.02, delta=0.003)
            counted = re.fullmatch(r"40000 samples, 0 lost: (\d+) mm of path, at most 0\.\d\d m/s\n", said)
            self.assertTrue(counted, said)
            self.assertAlmostEqual(float(counted[1]), 80, delta=15)

    def test_the_hand_of_a_running_board_follows_a_path_with_its_own_damping(self):
        with VirtualBoard(BUILD) as board, inkwell.open(board.address) as arm:
            with self.assertRaisesRegex(inkwell.Refused, "connect the control socket"):
                arm.virtual_hand.move(beside(0.0))
            arm.virtual_hand.connect(board.control_address)
            arm.virtual_hand.move(beside(0.0), 500, 12)
            self.assertTrue(arm.virtual_hand.truth()["hand_holds"])
            arm.sleep(0.5)
            arm.virtual_hand.follow([(0.0, beside(0.0)), (0.3, beside(0.02))])
            arm.sleep(0.6)
            self.assertAlmostEqual(arm.pose.position_m[0], 0.02, delta=0.003)

    def test_missing_addresses_are_reported(self):
        for name in "two_arms.cpp", "two_arms.py":
            program = subprocess.run([*command(name), "left"], stderr=subprocess.PIPE, text=True)
            self.assertNotEqual(program.returncode, 0)
            self.assertIn("Give the addresses of two arms", program.stderr)

    def test_each_is_short(self):
        sources = [*HOST.glob("library/examples/*.c*"), *HOST.glob("python/examples/*.py")]
        self.assertGreaterEqual(len(sources), 15)
        for source in sources:
            is_class_of_framework = source.name == "ros2_control_system.cpp"
            self.assertLess(len(source.read_text().splitlines()), 150 if is_class_of_framework else 60, source)
        self.assertLess(len((HOST / "library/examples/chai3d_device.hpp").read_text().splitlines()), 150)


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv[1]).resolve()
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
