"""Programs for two hands open their arms by name.

    names_test.py BUILD_FOLDER
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import inkwell

from virtual_board import FREE_POINT_M, be_patient, wait_until

PUSHES_N = {"left": (1.0, 0.0, 0.0), "right": (-1.0, 0.0, 0.0)}


def push_both_hands() -> None:
    """Runs under `inkwell run`. Each hand must follow its own force."""
    assert list(inkwell.names()) == ["left", "right"]
    with inkwell.open() as first, inkwell.open("left") as left:
        assert first.information.serial_number == left.information.serial_number
    arms = {name: inkwell.open(name.upper()) for name in PUSHES_N}
    for arm in arms.values():
        be_patient(arm)
        wait_until(arm, lambda pose: pose.state == inkwell.State.READY)
        arm.virtual_hand.move(FREE_POINT_M)
        arm.sleep(1)  # until the hand rests
        arm.enable_force(30)
    for name, arm in arms.items():
        arm.servo(lambda pose, push_N=PUSHES_N[name]: push_N)
    wait_until(arms["left"], lambda pose: pose.position_m[0] > 0.002)  # 1 N displaces a hand of 300 N/m by 3.3 mm
    wait_until(arms["right"], lambda pose: pose.position_m[0] < -0.002)
    for arm in arms.values():
        arm.close()
    print("felt", flush=True)


class Names(unittest.TestCase):
    def test_a_program_feels_a_different_force_on_each_of_two_virtual_arms(self):
        run = subprocess.run([BUILD / "inkwell", "run", "--virtual", "--arms", "left,right", sys.executable, __file__],
                             capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stdout), (0, "felt\n"), run.stderr)

    def test_an_unknown_name_is_reported_with_the_known_names(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "arms.toml")
            os.environ["INKWELL_ARMS"] = str(file)
            self.assertEqual(inkwell.names(), {})
            with self.assertRaisesRegex(inkwell.BadArgument, "`left` is neither .* No names are known"):
                inkwell.open("left")
            file.write_text('[[arm]]\nname = "right"\naddress = "2A"\n')
            self.assertEqual(inkwell.names(), {"right": "2A"})
            with self.assertRaisesRegex(inkwell.BadArgument, "Did you mean right\\? Known names: right"):
                inkwell.open("rigt")
            with self.assertRaisesRegex(inkwell.NoDevice, "The arm right is not plugged in"):
                inkwell.open("right")
            file.write_text("[[arm]]\n")
            with self.assertRaisesRegex(inkwell.Failed, "arms.toml, line 1: .*name"):
                inkwell.names()


if __name__ == "__main__":
    if len(sys.argv) == 1:
        push_both_hands()
    else:
        BUILD = pathlib.Path(sys.argv[1]).resolve()
        unittest.main(argv=sys.argv[:1] + sys.argv[2:])
