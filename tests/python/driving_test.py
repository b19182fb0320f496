"""Forces, shapes and servos of the package inkwell, on virtual boards of their own.

    driving_test.py
"""

import math
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import inkwell
from virtual_board import FREE_POINT_M, make_active, wait_until


class Driving(unittest.TestCase):
    def setUp(self):
        self.arm = inkwell.open("virtual")
        self.addCleanup(self.arm.close)

    def test_a_servo_pulls_and_lets_go(self):
        make_active(self.arm)
        calls = 0

        @self.arm.servo
        def spring(pose):
            nonlocal calls
            calls += 1
            return -100 * (pose.position_m - [0.02, *FREE_POINT_M[1:]])

        self.assertTrue(callable(spring))
        self.assertTrue(self.arm.servo_is_running)
        with self.assertRaisesRegex(inkwell.Refused, "already running on this arm"):
            self.arm.servo(lambda pose: None)
        # The springs of 300 and 100 N/m have rest positions 20 mm apart.
        pulled = wait_until(self.arm, lambda pose: abs(pose.position_m[0] - 0.005) < 0.0007
                            and abs(pose.velocity_m_s[0]) < 0.005)
        self.assertAlmostEqual(pulled.force_N[0], 1.5, delta=0.15)
        self.assertTrue(pulled.feels_program)
        self.assertFalse(pulled.feels_walls)
        self.assertFalse(pulled.limited_by_force)
        self.assertFalse(pulled.limited_by_current)
        self.arm.stop_servo()
        after = calls
        wait_until(self.arm, lambda pose: not pose.feels_program and pose.force_N[0] == 0)
        self.assertEqual(calls, after)
        self.assertFalse(self.arm.servo_is_running)

    def test_a_servo_that_takes_too_long_is_reported(self):
        calls = 0

        def slow(pose):
            nonlocal calls
            calls += 1
            time.sleep(0.05 if calls == 1 else 0)

        self.arm.servo(slow)
        self.arm.sleep(0.05)
        with self.assertWarnsRegex(RuntimeWarning, "A call of the servo took [0-9]+ ms.*below 1 ms"):
            self.arm.stop_servo()
        losses = self.arm.losses
        self.assertGreaterEqual(losses.slow_servo_calls, 1)
        self.assertGreaterEqual(losses.longest_servo_call_s, 0.05)
        self.assertEqual(losses.poses, 0)
        with warnings.catch_warnings(action="error"):
            self.arm.stop_servo()  # the same call is reported only once

    def test_a_recording_holds_name_note_marks_and_the_shapes_that_were_placed(self):
        make_active(self.arm)
        with self.assertRaisesRegex(inkwell.Refused, "No recording is running"):
            self.arm.mark("early")
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "felt.csv")
            with self.arm.record(file, "position_z_m", name="subject 7", note="left hand") as recording:
                self.arm.sleep(0.05)
                self.arm.mark("stimulus")
                self.arm.place_shapes(inkwell.Sphere((0, 0, 0.05), 0.01))
                self.arm.sleep(0.05)
            self.assertEqual(recording.complete, recording.lost == 0)
            text = file.read_text()
        self.assertIn("# name = subject 7\n# note = left hand\n", text)
        self.assertRegex(text, r"# mark [0-9]+ mark [-0-9]+T[0-9:]+\.[0-9]{6}Z = stimulus\n")
        self.assertRegex(text, r"# mark [0-9]+ shape .* = Solid 1: sphere, center \(0, 0, 0.05\) m")

    def test_a_test_pulse_is_recorded(self):
        wait_until(self.arm, lambda pose: pose.state == inkwell.State.READY)
        with self.assertRaisesRegex(inkwell.BadArgument, "either a voltage or a current"):
            self.arm.send_test_pulse(1)
        self.arm.select_signals("current_1_A", "duty_1")
        self.arm.send_test_pulse(1, voltage_V=1.5)
        self.arm.sleep(0.02)
        samples = self.arm.read_scope(rows=400)
        for _ in range(20):
            if samples["duty_1"].max() > 0.03:
                break
            samples = self.arm.read_scope(rows=400)
        self.assertGreater(samples["duty_1"].max(), 0.03)

    def test_an_exception_in_a_servo_stops_it_and_is_raised_once(self):
        def broken(pose):
            raise ZeroDivisionError("in the servo")

        self.arm.servo(broken)
        with self.assertRaisesRegex(ZeroDivisionError, "in the servo"):
            self.arm.wait_for_servo(60)
        self.arm.stop_servo()  # the error is raised only once
        self.arm.servo(broken)
        wait_until(self.arm, lambda _: not self.arm.servo_is_running)
        with self.assertRaises(ZeroDivisionError):
            self.arm.servo(lambda pose: None)
        with self.assertRaises(ZeroDivisionError), self.arm:
            self.arm.servo(broken)
            wait_until(self.arm, lambda _: not self.arm.servo_is_running)
        with self.assertRaises(inkwell.Refused):
            self.arm.pose

    def test_an_error_of_the_program_has_the_error_of_the_servo_as_a_note(self):
        with self.assertRaisesRegex(KeyError, "of the program") as raised, self.arm:
            self.arm.servo(lambda pose: 1 / 0)
            # wait_for_pose() would raise the error of the servo.
            give_up_at_s = time.monotonic() + 60
            while self.arm.servo_is_running and time.monotonic() < give_up_at_s:
                time.sleep(0.01)
            raise KeyError("of the program")
        self.assertIn("ZeroDivisionError", raised.exception.__notes__[0])

    def test_an_invalid_force_ends_the_servo(self):
        for answer, error, words in (((math.nan, 0, 0), ValueError, "not a finite number"),
                                     ((0, math.inf, 0), ValueError, "not a finite number"),
                                     ((1, 2), TypeError, "three numbers")):
            with self.subTest(answer), self.assertRaisesRegex(error, words):
                self.arm.servo(lambda pose: answer)
                self.arm.wait_for_servo(60)
        self.assertEqual(self.arm.information.force_reports_refused, 0)

    def test_a_servo_may_stop_itself_but_not_close_its_arm(self):
        calls = 0

        @self.arm.servo
        def five(pose):
            nonlocal calls
            calls += 1
            if calls == 5:
                self.arm.stop_servo()

        self.assertTrue(self.arm.wait_for_servo(60))
        self.assertEqual(calls, 5)
        self.arm.servo(lambda pose: self.arm.close())
        with self.assertRaisesRegex(inkwell.Refused, "cannot close its own arm"):
            self.arm.wait_for_servo(60)
        self.assertGreater(self.arm.pose.time_s, 0)

    def test_forces_without_a_servo(self):
        make_active(self.arm)
        self.arm.set_force_mode(inkwell.ForceMode.BESIDE_WALLS)

        def pushed(pose):
            self.arm.set_force([1e300, 0, 0])
            return abs(pose.force_N[0]) > 3

        felt = wait_until(self.arm, pushed)
        self.assertLess(felt.force_N[0], 3.31)
        self.assertTrue(felt.feels_program and felt.feels_walls)
        wait_until(self.arm, lambda pose: not pose.feels_program)
        for wrong in math.nan, math.inf, -math.inf:
            with self.assertRaisesRegex(inkwell.BadArgument, "not a finite number"):
                self.arm.set_force((0, wrong, 0))
        for wrong in (1, 2), "xyz", None:
            with self.assertRaisesRegex(TypeError, "^The argument is .*Give three numbers, the force in N"):
                self.arm.set_force(wrong)

    def test_a_limit_that_reduces_the_force_is_reported(self):
        make_active(self.arm)

        def push_until(force_N, condition):
            def pushed(pose):
                self.arm.set_force((force_N, 0, 0))
                return condition(pose)
            wait_until(self.arm, pushed)

        push_until(100, lambda pose: pose.limited_by_force)
        push_until(0.5, lambda pose: not pose.limited_by_force and not pose.limited_by_current)
        self.arm.parameters.current_limit_1_A = 0.02
        push_until(0.5, lambda pose: pose.limited_by_current and not pose.limited_by_force)
        push_until(0, lambda pose: not pose.limited_by_current)

    def test_forces_of_two_threads_faster_than_the_usb(self):
        make_active(self.arm)
        before = self.arm.information

        def push():
            for _ in range(3000):
                self.arm.set_force((0.5, 0, 0))

        threads = [threading.Thread(target=push) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        # On a busy computer the program may set all forces before the library sends the first force.
        wait_until(self.arm, lambda _: self.arm.information.force_reports > before.force_reports)
        wait_until(self.arm, lambda pose: not pose.feels_program)
        after = self.arm.information
        self.assertEqual((after.force_reports_refused, after.force_reports_lost),
                         (before.force_reports_refused, before.force_reports_lost))

    def test_shapes(self):
        make_active(self.arm)
        self.arm.place_shapes(inkwell.Plane(FREE_POINT_M, (0, 0, 1), stiffness_N_per_m=1000))
        self.arm.virtual_hand.move((0, 0, -0.034))
        # The springs of 300 and 1000 N/m have rest positions 4 mm apart.
        wait_until(self.arm, lambda pose: abs(pose.force_N[2] - 0.92) < 0.1 and pose.feels_shapes)
        for wrong, words in (([inkwell.Plane(FREE_POINT_M, (0, 0, 0))], "normal of plane 0"),
                             ([inkwell.Plane((math.nan, 0, 0), (0, 0, 1))], "plane 0"),
                             ([inkwell.Plane(FREE_POINT_M, (0, 0, 1))] * 9, "9 planes are too many"),
                             ([inkwell.Sphere(FREE_POINT_M, 0.01)] * 17, "17 solids are too many"),
                             ([inkwell.Box(FREE_POINT_M, (0.01, 0.01, 0))], "solid 0 \\(box\\)"),
                             ([inkwell.Capsule(FREE_POINT_M, 0.01, 0.02, quaternion=(0, 0, 0, math.nan))], "orientation"),
                             ([inkwell.Cylinder(FREE_POINT_M, 0.01, 0.02, viscosity_Ns_per_m=-1)], "viscosity")):
            with self.assertRaisesRegex(inkwell.BadArgument, words):
                self.arm.place_shapes(*wrong)
        with self.assertRaises(TypeError):
            self.arm.place_shapes("a plane")
        for wrong in inkwell.Plane((0, 0), (0, 0, 1)), inkwell.Sphere(FREE_POINT_M, "wide"):
            with self.assertRaisesRegex(TypeError, "A value of a shape has a wrong type"):
                self.arm.place_shapes(wrong)
        self.assertTrue(self.arm.wait_for_pose(10).feels_shapes)
        self.arm.place_shapes()
        wait_until(self.arm, lambda pose: not pose.feels_shapes)
        self.arm.virtual_hand.move(FREE_POINT_M)
        self.arm.sleep(0.3)
        turned = (math.sqrt(0.5), 0, 0, math.sqrt(0.5))  # the axis z of the capsule along y
        self.arm.place_shapes(inkwell.Capsule((0, 0, -0.05), 0.015, 0.02, quaternion=turned, viscosity_Ns_per_m=1))
        self.arm.virtual_hand.move((0, 0, -0.039))
        wait_until(self.arm, lambda pose: abs(pose.force_N[2] - 0.87) < 0.12 and pose.feels_shapes)

    def test_other_threads_run_while_one_waits_and_closing_ends_the_wait(self):
        raised = []

        def wait():
            try:
                while True:
                    self.arm.wait_for_pose(60)
            except inkwell.Error as error:
                raised.append(error)

        waiting = [threading.Thread(target=wait) for _ in range(4)]
        for thread in waiting:
            thread.start()
        wait_until(self.arm, lambda _: True)
        self.arm.close()
        for thread in waiting:
            thread.join()
        self.assertEqual([str(error) for error in raised], ["The arm is closed. Open it again."] * 4)
        self.arm.close()


class Seeds(unittest.TestCase):
    """Arms whose time passes only while a call waits for it."""

    def run_program(self, seed):
        with inkwell.open("virtual", seed=seed) as arm:
            make_active(arm)
            missed, before = 0, None

            @arm.servo
            def spring(pose):
                nonlocal missed, before
                missed += 0 if before is None else pose.sequence - before - 1
                before = pose.sequence
                return -100 * (pose.position_m - [0.02, *FREE_POINT_M[1:]])

            begin_s = arm.pose.time_s
            arm.sleep(0.12)
            self.assertAlmostEqual(arm.pose.time_s - begin_s, 0.12, places=6)
            samples = arm.capture("position_x_m", "force_x_N", duration_s=0.05)
            arm.stop_servo()
            self.assertEqual(missed, 0)
            return samples.periods.tobytes() + samples.values.tobytes()

    def test_the_same_seed_gives_the_same_samples_on_a_busy_computer_too(self):
        idle = self.run_program(7)
        busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
        try:
            self.assertEqual(self.run_program(7), idle)
        finally:
            for process in busy:
                process.kill()
                process.wait()

    def test_a_seed_is_a_number_for_a_virtual_board(self):
        for address in (None, "usbip:127.0.0.1:3240", "3932"):
            with self.assertRaisesRegex(inkwell.BadArgument, 'Open "virtual"'):
                inkwell.open(address, seed=7)
        for seed in (-1, 1.5, "7"):
            with self.assertRaisesRegex(inkwell.BadArgument, "whole number"):
                inkwell.open("virtual", seed=seed)
        with self.assertRaisesRegex(inkwell.Error, "no_such_arm.toml"):
            inkwell.open("virtual:no_such_arm.toml", seed=7)
        with self.assertRaisesRegex(inkwell.BadArgument, "time"):
            inkwell.open("virtual", seed=7).sleep(-1)


if __name__ == "__main__":
    os.environ.pop("INKWELL_DEVICE", None)
    unittest.main()
