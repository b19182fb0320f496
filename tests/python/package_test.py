"""The package inkwell as users meet it, on virtual boards.

    package_test.py BUILD_FOLDER
"""

import ast
import copy
import gc
import inspect
import math
import multiprocessing
import os
import pathlib
import pickle
import pydoc
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest
from unittest import mock

import numpy as np

try:
    import h5py
except ImportError:
    h5py = None

import inkwell
from inkwell import _native, errors
from virtual_board import VirtualBoard, be_patient, rests_at_x, wait_until

BUILD = pathlib.Path()


def run(program, *arguments, timeout_s=None):
    """Runs a Python program of its own."""
    return subprocess.run([sys.executable, "-c", textwrap.dedent(program), *arguments], capture_output=True, text=True,
                          timeout=timeout_s)


class SelfTest(unittest.TestCase):
    def test_the_board_tests_itself(self):
        arm = inkwell.open("virtual")
        self.addCleanup(arm.close)
        items = {item.name: item for item in arm.self_test()}
        self.assertEqual({item.result for item in items.values()}, {inkwell.Test.PASSED})
        motor = items["motor_3"]
        resistance_ohm = arm.parameters.motor_resistance_3_ohm
        self.assertEqual(motor.unit, "ohm")
        self.assertAlmostEqual(motor.figure, resistance_ohm, delta=0.2 * resistance_ohm)
        self.assertTrue(motor.takes_force)
        self.assertFalse(items["gimbal_1"].takes_force)
        self.assertIn("shunt", motor.remedy)
        self.assertIn("motor_3", repr(motor))
        again = arm.self_test(only_last=True)
        self.assertEqual([item.figure for item in again], [item.figure for item in items.values()])


class Storing(unittest.TestCase):
    def test_stored_parameters_are_reported_restored_and_erased(self):
        arm = inkwell.open("virtual")
        self.addCleanup(arm.close)
        parameters = arm.parameters
        default_N_per_m = parameters.wall_stiffness_N_per_m
        with self.assertRaisesRegex(inkwell.Refused, "no stored parameters"):
            parameters.restore()
        parameters.wall_stiffness_N_per_m = 500
        self.assertEqual(parameters.not_stored(), {"wall_stiffness_N_per_m": default_N_per_m})
        self.assertEqual(parameters.store_state().contents, inkwell.Stored.NOTHING)
        parameters.store()
        self.assertEqual(parameters.not_stored(), {})
        state = parameters.store_state()
        self.assertEqual(state.contents, inkwell.Stored.PARAMETERS)
        self.assertEqual(state.not_stored, 0)
        self.assertEqual(state.records_written, 1)
        self.assertGreater(state.stores_left, 0)
        self.assertEqual(len(state.sector_erases), 2)
        parameters.wall_stiffness_N_per_m = 600
        parameters.restore()
        self.assertEqual(parameters.wall_stiffness_N_per_m, 500)
        parameters.factory_reset()
        self.assertEqual(parameters.wall_stiffness_N_per_m, default_N_per_m)
        self.assertEqual(parameters.store_state().contents, inkwell.Stored.FACTORY_RESET)


class Records(unittest.TestCase):
    """Records are values: they can be compared, copied and sent to other processes."""

    @classmethod
    def setUpClass(cls):
        with inkwell.open("virtual") as arm:
            arm.set_force((0, 0, 0))
            cls.records = [arm.wait_for_pose(), arm.information, arm.parameters.store_state(), arm.driver, arm.losses,
                           arm.state, arm.abilities, *arm.self_test()]
            cls.later = [arm.wait_for_pose(), arm.information, arm.parameters.store_state(), arm.driver]
            arm.scene.add_sphere(0.01, position_m=(0, 0, 1))
            arm.virtual_hand.press(button_1=True)
            arm.sleep(0.05)
            event, = arm.scene.events()
            cls.records += [event, event.contact]
            cls.samples = arm.capture("supply_V", duration_s=0.01)
        with mock.patch.dict(os.environ, INKWELL_DEVICE="virtual"):
            cls.records.append(inkwell.devices()[-1])
        cls.enumerations = [inkwell.State.READY, inkwell.ForceMode.BESIDE_WALLS, inkwell.Stored.NOTHING,
                            inkwell.Test.PASSED, inkwell.EventKind.LEFT]

    @staticmethod
    def attributes(record):
        return {name: np.asarray(getattr(record, name)).tolist() for name in dir(record) if not name.startswith("_")}

    def test_each_class_is_tested(self):
        native = {kind for kind in vars(_native).values() if inspect.isclass(kind)} - {_native.Arm}
        self.assertEqual({type(each) for each in self.records + self.enumerations}, native)

    def test_copies_and_pickles_equal_the_original(self):
        ways = [copy.copy, copy.deepcopy]
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            ways.append(lambda record, protocol=protocol: pickle.loads(pickle.dumps(record, protocol)))
        for record in self.records + self.enumerations:
            for way in ways:
                copied = way(record)
                self.assertIs(type(copied), type(record))
                self.assertTrue(copied == record and not copied != record, record)
                self.assertEqual(hash(copied), hash(record))
                if record in self.records:
                    self.assertEqual(self.attributes(copied), self.attributes(record))

    def test_records_differ_from_others(self):
        self.assertNotEqual(self.records[0], self.later[0])
        self.assertEqual(len({*self.records}), len(self.records))
        self.assertNotEqual(self.records[0], None)
        self.assertFalse(self.records[0] == 3)
        self.assertEqual(self.records[3].program, self.later[3].program)

    def test_a_member_that_is_not_a_number_equals_its_copy(self):
        state = list(self.records[0].__getstate__())
        state[-1] = math.nan
        pose = inkwell.Pose.__new__(inkwell.Pose)
        pose.__setstate__(tuple(state))
        self.assertTrue(math.isnan(pose.supply_V))
        self.assertEqual(pickle.loads(pickle.dumps(pose)), pose)

    def test_each_record_has_a_readable_repr(self):
        for record in self.records:
            self.assertNotIn("object at 0x", repr(record))
        self.assertRegex(repr(self.records[1]), r"^<inkwell.Information product='Inkwell haptic arm', serial_number='\w+', .*"
                                                r"servo_rate_Hz=20000.0, .*motor_heat=array\(.*\)>$")
        self.assertRegex(repr(self.records[2]), r"^<inkwell.Store contents=<Stored.NOTHING: 0>, not_stored=0, .*>$")

    def test_a_record_of_another_version_is_refused(self):
        for wrong in ((), (1, 2), ("",) * 16):
            with self.assertRaisesRegex(ValueError, "This Pose was stored by another version"):
                inkwell.Pose.__new__(inkwell.Pose).__setstate__(wrong)

    def test_processes_exchange_records(self):
        for method in "fork", "spawn":
            context = multiprocessing.get_context(method)
            questions, answers = context.Queue(), context.Queue()
            process = context.Process(target=send_back, args=(questions, answers, len(self.records)))
            process.start()
            for record in self.records:
                questions.put(record)
                self.assertEqual(answers.get(timeout=60), record)
            process.join()

    def test_samples_are_compared_by_their_values(self):
        self.assertEqual(copy.deepcopy(self.samples), self.samples)
        other = copy.deepcopy(self.samples)
        other.values[0] += 1
        self.assertNotEqual(other, self.samples)
        self.assertNotEqual(self.samples, None)


def send_back(questions, answers, count):
    for _ in range(count):
        answers.put(questions.get())


class Import(unittest.TestCase):
    """An import that fails names its cause and the remedy."""

    def raised(self, folder, *options):
        paths = [path for path in os.environ["PYTHONPATH"].split(os.pathsep) if not (pathlib.Path(path) / "numpy").exists()]
        said = subprocess.run([sys.executable, *options, "-c", "import inkwell"], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), *paths])})
        self.assertEqual(said.returncode, 1)
        return said.stderr.splitlines()[-1]

    def test_another_python(self):
        with tempfile.TemporaryDirectory() as folder:
            package = pathlib.Path(folder, "inkwell")
            shutil.copytree(pathlib.Path(inkwell.__file__).parent, package)
            module, = package.glob("_native.*.so")
            module.rename(package / re.sub(r"cpython-\d+", "cpython-399", module.name))
            running = re.escape(f"this is Python {sys.version_info[0]}.{sys.version_info[1]} ({sys.executable}). ")
            self.assertRegex(self.raised(folder), rf"^ImportError: The package inkwell in .* was built for Python 3.99, but "
                                                  rf"{running}Start python3.99, or .* -DINKWELL_PYTHON={sys.executable}\.$")
            next(package.glob("_native.*.so")).unlink()
            self.assertRegex(self.raised(folder), r"^ImportError: .* has no native module\. Build it with tools/build\.$")

    def test_no_numpy(self):
        self.assertRegex(self.raised(pathlib.Path(inkwell.__file__).parents[1], "-S"),
                         r"^ModuleNotFoundError: .* requires numpy, which is not installed for Python .* python3-numpy, or")


class Reading(unittest.TestCase):
    """What does not drive, on one arm."""

    @classmethod
    def setUpClass(cls):
        cls.arm = inkwell.open("virtual")

    @classmethod
    def tearDownClass(cls):
        cls.arm.close()

    def test_information(self):
        information = self.arm.information
        self.assertTrue(information.is_virtual)
        self.assertEqual(information.product, "Inkwell haptic arm")
        self.assertEqual(information.firmware_version, inkwell.__version__)
        self.assertEqual(information.servo_rate_Hz, 20_000)
        self.assertEqual(information.motor_heat.shape, (3,))
        self.assertEqual(self.arm.board_name, "omni_driver")

    def test_a_pose_has_arrays_that_outlive_it_and_are_not_written(self):
        pose = wait_until(self.arm, lambda pose: pose.state == inkwell.State.READY)
        self.assertTrue(pose.in_inkwell)
        self.assertFalse(pose.feels_program)
        self.assertEqual(pose.fault, inkwell.Fault.NONE)
        self.assertAlmostEqual(pose.supply_V, 18, delta=1)
        np.testing.assert_allclose(pose.rotation @ pose.rotation.T, np.eye(3), atol=1e-5)
        self.assertRegex(repr(pose), "READY: probe at")
        position_m = pose.position_m
        self.assertTrue(np.shares_memory(position_m, pose.position_m))
        with self.assertRaises(ValueError):
            position_m[0] = 1
        before = position_m.copy()
        del pose
        gc.collect()
        np.testing.assert_array_equal(position_m, before)

    def test_poses_come_in_order(self):
        sequences = [pose.sequence for pose in self.arm.poses(duration_s=0.1)]
        self.assertGreater(len(sequences), 3)
        self.assertTrue(all(np.diff(sequences) > 0))

    def test_buttons(self):
        self.arm.virtual_hand.press(button_2=True)
        pose = wait_until(self.arm, lambda pose: pose.button_2)
        self.assertFalse(pose.button_1)
        self.arm.virtual_hand.press()

    def test_parameters_are_attributes(self):
        parameters = self.arm.parameters
        self.assertEqual(parameters.wall_stiffness_N_per_m, 800)
        parameters.wall_stiffness_N_per_m = 500
        self.assertEqual(parameters.wall_stiffness_N_per_m, 500)
        parameters.set(wall_stiffness_N_per_m=600, wall_damping_Ns_per_m=1)
        with self.assertRaisesRegex(inkwell.Refused, "wall_damping_Ns_per_m"):
            parameters.set(wall_stiffness_N_per_m=700, wall_damping_Ns_per_m=1e6)
        with self.assertRaises(inkwell.Refused):
            parameters.wall_stiffness_N_per_m = math.nan
        with self.assertRaises(TypeError):
            parameters.wall_stiffness_N_per_m = None
        with self.assertRaises(ValueError):
            parameters.wall_stiffness_N_per_m = "stiff"
        self.assertEqual(parameters.wall_stiffness_N_per_m, 600)
        self.assertIn("wall_stiffness_N_per_m                          600 N/m", repr(parameters))

    def test_an_unknown_parameter_is_an_attribute_that_is_not_there(self):
        for attempt in (lambda: self.arm.parameters.wall_stifness_N_per_m,
                        lambda: setattr(self.arm.parameters, "wall_stifness_N_per_m", 1)):
            with self.assertRaisesRegex(AttributeError, "Did you mean wall_stiffness_N_per_m?"):
                attempt()
        with self.assertRaisesRegex(inkwell.BadArgument, "Did you mean wall_stiffness_N_per_m?"):
            self.arm.parameters.set(wall_stifness_N_per_m=1)
        self.assertFalse(hasattr(self.arm.parameters, "_repr_html_"))
        with self.assertRaises(AttributeError) as raised:
            self.arm.parameters.nope
        self.assertEqual(str(raised.exception), "There is no parameter nope. `inkwell parameters` lists them all.")

    def test_an_argument_of_a_wrong_type_is_reported_in_a_sentence(self):
        arm = self.arm
        for attempt, words in ((lambda: inkwell.open(5), "is 5. Give the address as text"),
                               (lambda: arm.servo(1), "1 cannot be called. Give a function"),
                               (lambda: arm.set_force("abc"), "is 'abc'. Give three numbers"),
                               (lambda: arm.set_force_mode(3), "inkwell.ForceMode"),
                               (lambda: arm.wait_for_pose("long"), "is 'long'. Give seconds"),
                               (lambda: arm.enable_force(None), "is None. Give seconds"),
                               (lambda: arm.select_signals(7), "signal names"),
                               (lambda: arm.read_scope(rows=-1), "number of rows"),
                               (lambda: arm.virtual_hand.move((0, 0)), "three numbers, the position in m"),
                               (lambda: arm.virtual_hand.press("a"), "True or False"),
                               (lambda: arm.parameters.set(force_limit_N=()), "force_limit_N is (), which is not a number")):
            with self.assertRaises(TypeError) as raised:
                attempt()
            self.assertIn(words, str(raised.exception))
            self.assertNotIn("incompatible", str(raised.exception))

    def test_scope(self):
        with self.assertRaises(inkwell.BadArgument):
            self.arm.select_signals("position_x_mm")
        with self.assertRaises(inkwell.Refused):
            self.arm.read_scope()
        samples = self.arm.capture("position_z_m", "supply_V", duration_s=0.2)
        self.assertEqual(samples.values.shape, (4000, 2))
        self.assertEqual(samples.values.dtype, np.float32)
        self.assertTrue(np.shares_memory(samples["supply_V"], samples.values))
        np.testing.assert_allclose(samples["supply_V"], 18, atol=1)
        self.assertEqual(np.diff(samples.periods).sum() - len(samples) + 1, samples.lost)
        self.assertAlmostEqual(samples.time_s[-1], samples.periods[-1] / 2e4 - samples.periods[0] / 2e4)
        with self.assertRaises(KeyError):
            samples["force_x_N"]
        for wrong_s in -1, 0, math.nan, math.inf, "long", None:
            with self.assertRaisesRegex(inkwell.BadArgument, "duration is .*Give a time of more than 0 s"):
                self.arm.capture("supply_V", duration_s=wrong_s)
        with self.assertRaisesRegex(inkwell.BadArgument, "No signal is given"):
            self.arm.capture(duration_s=1)
        with mock.patch.object(self.arm, "_samples", side_effect=KeyboardInterrupt), \
                self.assertRaises(KeyboardInterrupt):
            self.arm.capture("supply_V", duration_s=1)
        with self.assertRaisesRegex(inkwell.Refused, "No signals are selected"):
            self.arm.read_scope()
        self.arm.select_signals("supply_V")
        some = self.arm.read_scope(rows=37)
        self.assertTrue(0 < len(some) <= 37)
        self.arm.select_signals()

    def test_recording(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "arm.csv")
            with self.arm.record(file, "position_z_m") as recording:
                for _ in self.arm.poses(duration_s=0.1):
                    with self.assertRaises(inkwell.Refused):
                        self.arm.select_signals("supply_V")
            self.assertGreater(recording.samples, 1000)
            self.assertEqual(recording.lost, 0)
            self.assertIn("position_z_m", file.read_text())
            with self.assertRaises(inkwell.Error), self.arm.record(pathlib.Path(folder, "no/such/arm.csv"), "supply_V"):
                pass

    @unittest.skipIf(h5py is None, "h5py is not installed")
    def test_h5py_reads_a_recording_as_the_page_says(self):
        page = (pathlib.Path(__file__).parents[2] / "docs/python.md").read_text()
        line, = re.findall(r'^force_N = (h5py\.File\("push\.h5"\).*)$', page, re.MULTILINE)
        with tempfile.TemporaryDirectory() as folder:
            file = str(pathlib.Path(folder, "push.h5"))
            with self.arm.record(file, "position_x_m", "force_x_N") as recording:
                self.arm.sleep(0.05)
            force_N = eval(line.replace("push.h5", file), {"h5py": h5py})
        self.assertEqual(force_N.shape, (recording.samples,))

    def test_an_invalid_timeout_is_refused(self):
        for timeout_s in math.nan, -1.0:
            with self.assertRaisesRegex(inkwell.BadArgument, "time-out"):
                self.arm.wait_for_pose(timeout_s)
        with self.assertRaises(inkwell.TimedOut):
            for _ in range(10_000):  # many more iterations than poses in this time
                self.arm.wait_for_pose(0)


class Programs(unittest.TestCase):
    """What takes a process of its own."""

    def test_two_arms_have_two_numbers(self):
        with inkwell.open("virtual") as one, inkwell.open("virtual") as other:
            self.assertNotEqual(one.information.serial_number, other.information.serial_number)
            one.set_force((0, 0, 0))
            other.set_force((0, 0, 0))

    def test_a_second_program_can_read_but_not_drive(self):
        program = """
            import sys, inkwell
            with inkwell.open(sys.argv[1]) as arm:
                print(arm.wait_for_pose(10).time_s > 0)
                try:
                    arm.servo(lambda pose: None)
                except inkwell.InUse as error:
                    print(error)
            """
        with VirtualBoard(BUILD) as board, inkwell.open(board.address) as first:
            with self.assertRaisesRegex(inkwell.Refused, 'opened as "virtual"'):
                first.virtual_hand.release()
            first.set_force((0, 0, 0))
            said = run(program, board.address)
            self.assertRegex(said.stdout, rf"^True\nThe arm is driven by \w+ \(process {os.getpid()}\), which claimed it \d+ s ago\. "
                                          "Close that program, or take the arm over from it\\.\n$")
            with inkwell.open(board.address) as second, self.assertRaises(inkwell.InUse):
                second.set_force((0, 0, 0))

    def test_a_fault_whose_cause_stays_is_raised(self):
        with VirtualBoard(BUILD) as board, inkwell.open(board.address) as arm:
            arm.clear_fault()  # there is no fault
            board.call("inject", fault="bridge_fault")
            wait_until(arm, lambda pose: pose.state == inkwell.State.FAULT)
            with self.assertRaisesRegex(inkwell.Refused, "The board has raised the fault again. bridge_fault: A bridge reported"):
                arm.clear_fault()
            board.call("heal", fault="bridge_fault")
            arm.clear_fault()
            self.assertEqual(arm.pose.state, inkwell.State.READY)

    def test_the_loss_of_the_force_ends_the_servo_and_is_raised_once(self):
        with VirtualBoard(BUILD) as board, inkwell.open(board.address) as arm, inkwell.open(board.address) as other:
            be_patient(arm)
            wait_until(arm, lambda pose: pose.state == inkwell.State.READY)
            board.hold((0.02, 0, -0.03))
            board.wait_until(rests_at_x(0.02))

            def drive():
                arm.enable_force(30)
                arm.servo(lambda pose: (0, 0, 0))
                wait_until(arm, lambda pose: pose.feels_program)

            drive()
            other.stop()
            with self.assertRaisesRegex(inkwell.ForceLost, "Another program switched the force off"):
                for _ in arm.poses():
                    pass
            self.assertFalse(arm.servo_is_running)
            self.assertFalse(wait_until(arm, lambda pose: pose.state == inkwell.State.READY).feels_program)
            arm.stop_servo()  # the error is raised only once
            with self.assertRaisesRegex(inkwell.ForceLost, "Another program"):
                arm.set_force((0, 0, 0))

            drive()
            board.call("inject", fault="bridge_fault")
            with self.assertRaisesRegex(inkwell.ForceLost, "bridge_fault"):
                arm.wait_for_servo(60)
            board.call("heal", fault="bridge_fault")
            arm.clear_fault()

            drive()
            with tempfile.TemporaryDirectory() as folder:
                with self.assertRaisesRegex(inkwell.ForceLost, "Another program"), \
                        arm.record(pathlib.Path(folder, "arm.csv"), "supply_V"):
                    other.stop()
                    while arm.servo_is_running:
                        time.sleep(0.01)

            drive()
            board.call("usb", connected=False)
            with self.assertRaises(inkwell.Disconnected) as raised:
                arm.wait_for_servo(60)
            self.assertGreater(raised.exception.last_pose.time_s, 0)

    def test_the_scope_is_free_after_its_use(self):
        with VirtualBoard(BUILD) as board, inkwell.open(board.address) as first, inkwell.open(board.address) as second:
            for arm in first, second:
                self.assertEqual(len(arm.capture("supply_V", duration_s=0.05)), 1000)
            first.select_signals("supply_V")
            with self.assertRaisesRegex(inkwell.InUse, "scope is in use"):
                second.capture("supply_V", duration_s=0.05)

    def test_all_signals_in_any_order(self):
        names = [signal.name for signal in reversed(inkwell.signals())]
        with inkwell.open("virtual", seed=7) as arm:
            samples = arm.capture(*names, duration_s=0.2)
            self.assertEqual((samples.values.shape, samples.lost), ((4000, len(names)), 0))
            self.assertAlmostEqual(samples["supply_V"].mean(), 18, delta=1)
            # The first 32 signals of the table are sent in each period, the others in each 16th.
            self.assertGreater(np.count_nonzero(np.diff(samples["current_1_A"])), 2000)
            self.assertLess(np.count_nonzero(np.diff(samples["servo_cycles"])), 400)
            with self.assertRaisesRegex(inkwell.BadArgument, "contain a signal twice"):
                arm.select_signals(*["supply_V"] * 33)

    def test_samples_that_stop_midway_are_no_capture(self):
        with VirtualBoard(BUILD) as board, inkwell.open(board.address) as arm:
            arm.select_signals("supply_V")
            board.let_pass(0.1)
            board.call("pause")
            with self.assertRaisesRegex(inkwell.TimedOut, r"^Of 100000 samples \d{3,5} arrived, then none for 0.2 s"):
                arm._samples(100_000, 0.2, True)  # as capture() does
            board.call("resume")

    def test_a_forked_child_has_no_part_in_the_arm_and_may_open_its_own(self):
        said = run("""
            import contextlib, multiprocessing, os, threading, inkwell

            def refused(call):
                try:
                    call()
                except inkwell.Refused as error:
                    assert f"was opened by process {os.getppid()}. Open" in str(error), error
                else:
                    raise AssertionError("the child uses its parent's arm")

            def use(arm):
                for call in (lambda: arm.pose, lambda: arm.wait_for_pose(1000), lambda: arm.set_force((0, 0, 0)),
                             lambda: arm.enable_force(1000), arm.disable_force, arm.stop, arm.clear_fault,
                             arm.stop_servo, lambda: arm.servo(lambda pose: None), lambda: arm.servo_is_running,
                             lambda: arm.select_signals("supply_V"), arm.read_scope, lambda: arm.information,
                             lambda: arm.parameters.wall_stiffness_N_per_m, arm.virtual_hand.release):
                    refused(call)
                arm.close()
                with inkwell.open("virtual") as own:
                    assert own.wait_for_pose(60).time_s > 0

            with inkwell.open("virtual") as arm:
                @arm.servo
                def servo(pose):
                    return (0, 0, 0)

                def looks_on():
                    with contextlib.suppress(inkwell.Refused):  # as it is closed
                        for _ in arm.poses():
                            pass

                threading.Thread(target=looks_on, daemon=True).start()
                child = multiprocessing.get_context("fork").Process(target=use, args=(arm,))
                child.start()
                child.join(300)
                print("child", child.exitcode, flush=True)  # a forked child would print it again
                for _ in range(20):  # that end as programs do
                    pid = os.fork()
                    if pid == 0:
                        raise SystemExit(0)
                    if (code := os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])) != 0:
                        print("a child ends with", code)
                print("servo", arm.servo_is_running, arm.wait_for_pose(60).time_s > 0)
            """)
        self.assertEqual((said.returncode, said.stdout), (0, "child 0\nservo True True\n"), said.stderr)

    def test_a_thread_that_is_cancelled_ends_its_call(self):
        said = run("""
            import ctypes, threading, inkwell
            threads = ctypes.CDLL(None)
            results = []
            arm = inkwell.open("virtual")
            arm.wait_for_pose(60)

            def wait():
                for _ in range(3):
                    results.append(arm.wait_for_pose(60).time_s > 0)
                threads.pthread_setcancelstate(1, None)  # beyond the call the interpreter would be cancelled

            thread = threading.Thread(target=wait)
            thread.start()
            threads.pthread_cancel(ctypes.c_ulong(thread.ident))
            thread.join()
            print(results)
            arm.close()
            """)
        self.assertEqual((said.returncode, said.stdout), (0, "[True, True, True]\n"), said.stderr)

    def test_ctrl_c(self):
        program = subprocess.Popen(
            [sys.executable, "-c", textwrap.dedent("""
                import inkwell
                with inkwell.open("virtual") as arm:
                    arm.servo(lambda pose: None)
                    print("waits", flush=True)
                    for _ in arm.poses():
                        pass
                """)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(program.stdout.readline(), "waits\n")
        program.send_signal(signal.SIGINT)
        _, said = program.communicate()
        self.assertTrue(said.rstrip().endswith("KeyboardInterrupt"), said)
        self.assertEqual(program.returncode, -signal.SIGINT)

    def test_a_program_that_forgets_to_close_ends_in_peace(self):
        said = run("""
            import inkwell
            arm = inkwell.open("virtual")
            @arm.servo
            def servo(pose):
                return arm.pose.position_m * 0
            arm.wait_for_pose(10)
            print("end")
            """)
        self.assertEqual((said.returncode, said.stdout, said.stderr), (0, "end\n", ""))

    def test_addresses_that_lead_nowhere(self):
        for address, error, words in (("0123456789AB", inkwell.NoDevice, "0123456789AB"),
                                      ("no such number", inkwell.BadArgument, "no such number"),
                                      ("usbip:nowhere", inkwell.BadArgument, "127.0.0.1:3240"),
                                      ("usbip:127.0.0.1:1", inkwell.Failed, "127.0.0.1"),
                                      ("virtual:/no/such/arm.toml", inkwell.Failed, "/no/such/arm.toml")):
            with self.subTest(address), self.assertRaisesRegex(error, words):
                inkwell.open(address)

    def test_a_virtual_board_with_options(self):
        root = pathlib.Path(__file__).parents[2]
        options = {"arm": root / "boards/arms/paper.toml", "elf": str(BUILD.parent / "board/magnet.elf"), "seed": 7}
        with inkwell.open("virtual", **options) as arm:
            x_m = wait_until(arm, lambda pose: pose.state == inkwell.State.READY).position_m[0]
            samples = arm.capture("supply_V", duration_s=0.01)
            self.assertGreater(x_m, 0.1)  # the inkwell of the Omni is at x = 0
            self.assertIn("magnet_strength_N", arm.parameters)
        with inkwell.open("virtual?seed=7", arm=options["arm"], elf=options["elf"]) as arm:
            wait_until(arm, lambda pose: pose.state == inkwell.State.READY)
            self.assertEqual(arm.capture("supply_V", duration_s=0.01), samples)

    def test_sleep_ends_although_times_are_rounded(self):
        said = run("""
            import inkwell
            with inkwell.open("virtual", seed=1) as arm:
                begin_s = arm.pose.time_s
                for _ in range(30):
                    arm.sleep(0.1)
                print(round(arm.pose.time_s - begin_s, 3))
            """, timeout_s=120)
        self.assertEqual(said.stdout, "3.0\n", said.stderr)

    def test_options_that_no_virtual_board_accepts(self):
        for address, options, error, words in (
                ("virtual", {"elf": "no/such.elf"}, inkwell.Failed, "firmware no/such.elf is missing"),
                ("virtual", {"arm": "no/such.toml"}, inkwell.Failed, "no/such.toml: this arm description cannot be read"),
                ("virtual", {"arm": 5}, TypeError, "option arm is 5. Give the name of a file"),
                ("virtual", {"elf": ""}, inkwell.BadArgument, "option elf is ''"),
                ("virtual", {"arm": "a&b.toml"}, inkwell.BadArgument, "without the character &"),
                ("virtual:a.toml", {"arm": "b.toml"}, inkwell.BadArgument, "arm is given twice"),
                ("virtual?seed=3", {"seed": 4}, inkwell.BadArgument, "seed is given twice"),
                ("virtual", {"seed": -1}, inkwell.BadArgument, "seed is -1"),
                ("usbip:127.0.0.1:1", {"elf": "a.elf"}, inkwell.BadArgument, "elf requires a virtual board"),
                (None, {"seed": 1}, inkwell.BadArgument, "seed requires a virtual board, not None")):
            with self.subTest(address, **options), self.assertRaisesRegex(error, words):
                inkwell.open(address, **options)

    def test_another_version_of_the_protocol(self):
        with VirtualBoard(BUILD, elf="next-protocol.elf") as board:
            with self.assertRaisesRegex(inkwell.Incompatible, "uses protocol version"):
                inkwell.open(board.address)

    def test_an_arm_that_does_not_know_where_it_is(self):
        with VirtualBoard(BUILD, in_inkwell=False) as board, inkwell.open(board.address) as arm:
            wait_until(arm, lambda pose: pose.state == inkwell.State.UNREFERENCED)
            self.assertFalse(arm.is_referenced)
            with self.assertRaisesRegex(inkwell.Refused, "Put the stylus into the inkwell"):
                arm.enable_force(0.1)
            board.call("dock", docked=True)
            wait_until(arm, lambda pose: pose.state == inkwell.State.READY)
            self.assertTrue(arm.is_referenced)

    def test_devices(self):
        said = run("import os; os.environ['INKWELL_DEVICE'] = 'virtual'\n"
                   "import inkwell; print(inkwell.devices()[-1], inkwell.devices()[-1].is_virtual)")
        self.assertEqual(said.stdout, "<inkwell.Device 'virtual', a simulation> True\n", said.stderr)


class States(unittest.TestCase):
    """States, abilities, joint torques, claims, time limits and the list of arms."""

    def test_state_and_abilities(self):
        with inkwell.open("virtual", seed=3) as arm:
            pose = arm.wait_for_pose()
            state = arm.state
            self.assertEqual(state.pose, pose)
            self.assertTrue(state.is_referenced)
            self.assertLess(abs(state.received_ns - time.time_ns()), 3600e9)
            self.assertLess(state.received_monotonic_ns, time.monotonic_ns())
            self.assertAlmostEqual(np.linalg.norm(state.quaternion), 1, places=5)
            self.assertEqual(state.joint_speed_rad_per_s.shape, (3,))
            abilities = arm.abilities
            self.assertAlmostEqual(abilities.workspace_maximum_m[0], arm.parameters.box_maximum_x_m, places=6)
            self.assertTrue(abilities.third_joint_is_absolute)
            self.assertTrue((abilities.joint_minimum_rad < abilities.joint_maximum_rad).all())

    def test_kinematics_and_joint_torques(self):
        with inkwell.open("virtual", seed=3) as arm:
            pose = arm.wait_for_pose()
            position_m, jacobian = arm.forward_kinematics(pose.joint_rad)
            np.testing.assert_allclose(position_m, pose.position_m, atol=1e-4)
            wanted_N = np.array([0.4, 0.6, -0.3])
            np.testing.assert_allclose(arm.force_of_torques(pose.joint_rad, jacobian.T @ wanted_N), wanted_N, atol=1e-4)
            with self.assertRaisesRegex(inkwell.Refused, "stretched"):
                arm.force_of_torques((0, 0.5, 0.5 + math.pi / 2), (1, 1, 1))
            arm.virtual_hand.move((0, 0, -0.03))
            arm.sleep(0.5)
            arm.enable_force()
            for _ in range(400):
                arm.set_joint_torques(arm.forward_kinematics(arm.pose.joint_rad)[1].T @ wanted_N)
                pose = arm.wait_for_pose()
            np.testing.assert_allclose(pose.force_N, wanted_N, atol=0.05)
            with self.assertRaisesRegex(TypeError, "joint torques in Nm"):
                arm.set_joint_torques("strong")

    def test_a_claim_is_a_separate_step(self):
        with inkwell.open("virtual") as arm:
            self.assertFalse(arm.driver.is_driven)
            arm.claim()
            self.assertTrue(arm.driver.is_this_arm)
            arm.release()
            self.assertFalse(arm.driver.is_driven)
            with self.assertRaisesRegex(inkwell.BadArgument, "1 to 99"):
                arm.set_thread_priority(100)

    def test_opening_has_a_time_limit(self):
        with self.assertRaises(inkwell.TimedOut):
            inkwell.open("virtual", timeout_s=0)
        with inkwell.open("virtual", timeout_s=60) as arm:
            self.assertTrue(arm.is_referenced)
        with self.assertRaisesRegex(TypeError, "time-out in seconds"):
            inkwell.open("virtual", timeout_s="soon")

    def test_changes_of_the_list_of_arms(self):
        known = inkwell.devices()
        with self.assertRaises(inkwell.TimedOut):
            inkwell.wait_for_devices(known, timeout_s=0.3)
        with mock.patch.dict(os.environ, INKWELL_DEVICE="virtual"):
            found = inkwell.wait_for_devices(known)
            self.assertEqual(found[:-1], known)
            self.assertEqual(found[-1].address, "virtual")
        with mock.patch.dict(os.environ, INKWELL_DEVICE="usbip:127.0.0.1:1"):
            self.assertEqual(inkwell.devices(), known)
        with self.assertRaises(inkwell.BadArgument):
            inkwell.wait_for_devices(known, timeout_s=math.nan)


class Help(unittest.TestCase):
    def test_units_and_ranges_of_parameters(self):
        text = pydoc.render_doc(inkwell.Parameters, renderer=pydoc.plaintext)
        self.assertRegex(text, r"wall_stiffness_N_per_m\n +\| +0 to 3000 N/m, default 800 N/m. Spring constant")

    def test_each_public_name_has_a_docstring(self):
        for name in inkwell.__all__:
            self.assertTrue(inspect.getdoc(getattr(inkwell, name)), name)
        for kind in inkwell.Arm, inkwell.VirtualHand:
            for name, member in inspect.getmembers(kind):
                self.assertTrue(name.startswith("_") or inspect.getdoc(member), f"{kind.__name__}.{name}")

    def test_an_error_for_each_result(self):
        header = (pathlib.Path(__file__).parents[2] / "host/bindings/library/include/inkwell/inkwell.h").read_text()
        for result, kind in errors.BY_RESULT.items():
            name = "".join(f"_{letter}" if letter.isupper() else letter.upper() for letter in kind.__name__)
            self.assertIn(f"INKWELL{name} = {result}", header)
        self.assertEqual(len(errors.BY_RESULT), header[:header.index("} inkwell_result")].count(" = ") - 2)

    def test_faults_have_the_names_of_the_header(self):
        header = (pathlib.Path(__file__).parents[2] / "host/bindings/library/include/inkwell/inkwell.h").read_text()
        for fault in inkwell.Fault:
            self.assertIn(f"INKWELL_FAULT_{fault.name} = {fault.value}", header)
        self.assertEqual(inkwell.Fault.OVER_SPEED, 6)

    def test_stub_and_module_agree(self):
        def names(thing):
            return {name for name in vars(thing) if not name.startswith("_")}

        package = pathlib.Path(inkwell.__file__).parent
        self.assertTrue((package / "py.typed").exists())
        stub = {node.name: node for node in ast.parse((package / "_native.pyi").read_text()).body
                if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(stub), names(_native))
        for name, node in stub.items():
            if isinstance(node, ast.ClassDef):
                told = {each.name if isinstance(each, ast.FunctionDef) else each.targets[0].id for each in node.body
                        if isinstance(each, (ast.FunctionDef, ast.Assign))} - {"__init__"}
                member = getattr(_native, name)
                of_every_enum = {"name", "value"} if hasattr(member, "__members__") else set()
                self.assertEqual(told, names(member) - of_every_enum, name)


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv[1]).resolve()
    os.environ.pop("INKWELL_DEVICE", None)
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
