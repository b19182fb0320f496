"""The tables that tools/generate/generate_tables.py accepts and refuses, and that headers contain no texts.

usage: tables_test.py REPOSITORY
"""

import importlib.util
import pathlib
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(sys.argv.pop(1))
TABLES = REPOSITORY / "protocol/tables"
ARM = REPOSITORY / "boards/arms/omni.toml"
sys.dont_write_bytecode = True
specification = importlib.util.spec_from_file_location("generate_tables", REPOSITORY / "tools/generate/generate_tables.py")
generate_tables = importlib.util.module_from_spec(specification)
specification.loader.exec_module(generate_tables)


def header(path: pathlib.Path) -> list[str]:
    return generate_tables.header(path, ARM if path.name == "parameters.toml" else None)


class Tables(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def change(self, name: str, before: str, after: str) -> pathlib.Path:
        """A copy of a table in which the first `before` is replaced."""
        source = (TABLES / name).read_text()
        self.assertIn(before, source)
        path = self.folder / name
        path.write_text(source.replace(before, after, 1))
        return path

    def refuse(self, name: str, before: str, after: str, *words: str, generate=header) -> None:
        path = self.change(name, before, after)
        with self.assertRaises(SystemExit) as refused:
            generate(path)
        for word in (name, *words):
            self.assertIn(word, str(refused.exception))

    def test_a_changed_text_changes_no_header(self):
        for name, before in (("parameters.toml", "Upper limit of the force on the hand."), ("faults.toml", "No fault."),
                             ("signals.toml", "Angle of joint 1, the waist."), ("injections.toml", "The crystal stops."),
                             ("supervision.toml", "The force is off."), ("limits.toml", "The energy reserve is empty")):
            changed = self.change(name, before, "Another text.")
            self.assertEqual(header(TABLES / name), header(changed))
            self.assertIn("Another text.", "".join(generate_tables.texts([changed])))
            self.assertNotIn("Another text.", "".join(generate_tables.texts([TABLES / name])))

    def test_rows_need_every_column_and_no_other(self):
        line = (TABLES / "parameters.toml").read_text().split("[force_limit_N]")[0].count("\n") + 1
        self.refuse("parameters.toml", '[force_limit_N]\nid = 203\n', "[force_limit_N]\n", f"parameters.toml:{line}",
                    "force_limit_N", "`id` is missing")
        self.refuse("parameters.toml", "default = 3.3", "default = 3.3\ncolor = 1", "force_limit_N", "`color`", "columns are")
        self.refuse("parameters.toml", "id = 203", 'id = "203"', "force_limit_N", "wrong type")
        self.refuse("faults.toml", 'cause = "No fault."', 'cause = "No fault"', "none", "period")

    def test_names_are_unique(self):
        self.refuse("parameters.toml", "[force_ramp_s]", "[force_limit_N]", "its own name")
        self.refuse("parameters.toml", "[force_ramp_s]", '["force ramp"]', "identifier")

    def test_defaults_are_in_the_range(self):
        self.refuse("parameters.toml", "default = 3.3", "default = 8.1", "force_limit_N", "outside the range 0 to 8")
        self.refuse("parameters.toml", "range = [0, 8]", "range = [8, 0]", "force_limit_N", "not a range")
        self.refuse("parameters.toml", "range = [0.1, 100]", "range = [50, 100]", "motor_resistance_1_ohm", "`range` differs")
        self.refuse("parameters.toml", "range = [0.25, 1000]", "range = [999, 1000]", "winding_time_constant_s",
                    "outside the range", "arm description")
        self.refuse("parameters.toml", "default = 3.3", 'default = "arm"', "force_limit_N", "boards/arms")
        self.refuse("injections.toml", "default = 1000", "default = 0.5", "wire_spikes", "outside the range")

    def test_ids_and_groups_are_ordered(self):
        self.refuse("parameters.toml", "id = 203", "id = 202", "force_limit_N", "above 202")
        self.refuse("parameters.toml", 'id = 204\ngroup = "contact"', 'id = 204\ngroup = "box"', "force_ramp_s", "apart")
        self.refuse("signals.toml", "id = 3\n", "id = 4\n", "joint_1_rad", "`id` must be 3")
        self.refuse("faults.toml", "code = 2\n", "code = 3\n", "supply_low", "`code` must be 2")
        self.refuse("limits.toml", "bit = 4\n", "bit = 3\n", "change", "`bit` must be 4")

    def test_rows_of_three_axes_agree(self):
        self.refuse("parameters.toml", "[gear_ratio_2]", "[gear_ratio_two]", "gear_ratio_1", "gear_ratio_2 is missing")
        self.refuse("signals.toml", 'id = 2\nunit = "counts"', 'id = 2\nunit = "rad"', "encoder_3_counts", "`unit` differs")
        self.refuse("parameters.toml", 'id = 402\ngroup = "limits"\nunit = "A"\nrange = [0, 3]',
                    'id = 402\ngroup = "limits"\nunit = "A"\nrange = [0, 4]', "current_limit_3_A", "`range` differs")

    def test_supervision_names_known_rows(self):
        for before, after, word in (('to = "testing"', 'to = "test"', "`test`"), ('needs = ["update"]', 'needs = ["x"]', "`x`"),
                                    ('monitored_in = ["every"]', 'monitored_in = ["none"]', "`none`"),
                                    ('fault = "watchdog"', 'fault = "crystal_failed"', "two rows"),
                                    (', off = "coast"', "", "`off` is missing")):
            self.refuse("supervision.toml", before, after, word, generate=generate_tables.monitoring_code)


if __name__ == "__main__":
    unittest.main()
