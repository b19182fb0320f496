"""docs/architecture.md names every folder and all that it uses, the README those at the top; and the test that says so
notices when it does not. Each file of the index exists and contains its identifier.

    architecture_test.py TARGET_GRAPH...
"""

import pathlib
import re
import sys
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tools/docs"))

import architecture  # noqa: E402: located in tools/docs/

GRAPHS: list[pathlib.Path] = []


class Architecture(unittest.TestCase):
    def test_table_agrees_with_targets_and_sources(self):
        table = architecture.read_table((REPOSITORY / "docs/architecture.md").read_text())
        tree = architecture.read_tree(REPOSITORY, GRAPHS)
        self.assertEqual([], architecture.differences(table, tree))

    def test_paths_of_the_data_go_through_folders_of_the_table(self):
        document = (REPOSITORY / "docs/architecture.md").read_text()
        paths = architecture.read_paths(document)
        self.assertEqual([6, 5, 5], [len(path) for path in paths])
        self.assertLessEqual({folder for path in paths for folder in path}, architecture.read_table(document).keys())

    def test_readme_lists_the_top_folders_of_the_table(self):
        section = (REPOSITORY / "README.md").read_text().split("## Folders")[1].split("\n## ")[0]
        table = architecture.read_table((REPOSITORY / "docs/architecture.md").read_text())
        self.assertEqual(list(dict.fromkeys(folder.split("/")[0] for folder in table)),
                         re.findall(r"^    (\w+)/ ", section, re.MULTILINE))


class Index(unittest.TestCase):
    """The table "Where is it": thing, file, identifier."""

    def test_each_file_contains_its_identifier(self):
        section = (REPOSITORY / "docs/architecture.md").read_text().split("## Where is it")[1].split("\n## ")[0]
        lines = [line for line in section.splitlines() if line.startswith("| ")][2:]
        rows = [re.fullmatch(r"\| ([^|]+) \| \[(\S+)\]\(\.\./(\S+)\) \| `(\S+)` \|", line) for line in lines]
        self.assertGreater(len(rows), 20)
        for line, row in zip(lines, rows):
            with self.subTest(line):
                self.assertIsNotNone(row)
                self.assertEqual(row[2], row[3])
                self.assertRegex((REPOSITORY / row[2]).read_text(), rf"(?<!\w){re.escape(row[4])}(?!\w)")
        things = [row[1] for row in rows]
        self.assertEqual(things, sorted(things, key=lambda thing: thing.lower()))


class Differences(unittest.TestCase):
    """On a small tree: host/window uses firmware/control and imgui."""

    TABLE = ("| `firmware/control/` | the signal path | - | - |\n"
             "| `host/window/` | the window | control | imgui |\n")

    def setUp(self):
        self.tree = architecture.Tree(folders={"firmware/control", "host/window"},
                                      links={"firmware/control": set(), "host/window": {"firmware/control"}},
                                      libraries={"host/window": {"imgui"}}, includes={}, private={})

    def differences(self, table=TABLE):
        return architecture.differences(architecture.read_table(table), self.tree)

    def test_agreement(self):
        self.assertEqual([], self.differences())

    def test_folder_without_row(self):
        self.tree.folders.add("host/new")
        self.assertEqual(["host/new/ has no row in docs/architecture.md"], self.differences())

    def test_row_without_folder(self):
        self.assertRegex(self.differences(self.TABLE + "| `host/gone/` | - | - | - |\n")[0], "a row for host/gone/")

    def test_dependency_that_is_not_named(self):
        self.tree.links["firmware/control"].add("host/window")
        self.assertEqual(["firmware/control/ uses host/window/, which its row does not name"], self.differences())

    def test_dependency_that_is_gone(self):
        self.tree.links["host/window"].clear()
        self.assertEqual(["host/window/ does not use firmware/control/, which its row names"], self.differences())

    def test_library_that_is_not_named(self):
        self.tree.libraries["host/window"].add("hdf5")
        self.assertEqual(["host/window/ links to hdf5, which its row does not name"], self.differences())

    def test_include_without_link(self):
        self.tree.includes["firmware/control"] = {"host/window": 'contact.cpp: #include "host/window/window.hpp"'}
        self.assertEqual(['contact.cpp: #include "host/window/window.hpp": firmware/control/ has no target that links to '
                          "one of host/window/"], self.differences())

    def test_include_of_a_private_header(self):
        line = 'window.cpp: #include "firmware/control/stage.hpp"'
        self.tree.private["host/window"] = {"firmware/control": line}
        self.assertEqual([f"{line}: firmware/control/ does not publish this header "
                          "(inkwell_publish_headers in its CMakeLists.txt)"], self.differences())

    def test_private_header_in_the_same_library(self):
        self.tree.folders.add("host/window/scope")
        self.tree.includes["host/window/scope"] = {"host/window": 'scope.cpp: #include "host/window/detail.hpp"'}
        self.tree.private["host/window/scope"] = self.tree.includes["host/window/scope"]
        self.assertEqual([], self.differences(self.TABLE + "| `host/window/scope/` | - | window | - |\n"))

    def test_a_folder_without_target_must_not_include_more_than_its_library(self):
        self.tree.folders.add("firmware/control/stages")
        line = 'stage.cpp: #include "host/window/window.hpp"'
        self.tree.includes["firmware/control/stages"] = {"host/window": line}
        self.assertEqual([f"{line}: firmware/control/stages/ has no target that links to one of host/window/"],
                         self.differences(self.TABLE + "| `firmware/control/stages/` | - | window | - |\n"))

    def test_the_row_of_a_folder_without_target_names_its_includes(self):
        self.tree.folders.add("host/window/scope")
        self.tree.includes["host/window/scope"] = {"host/window": 'scope.cpp: #include "host/window/window.hpp"'}
        self.assertEqual([], self.differences(self.TABLE + "| `host/window/scope/` | - | window | - |\n"))
        self.assertEqual(["host/window/scope/ uses host/window/, which its row does not name"],
                         self.differences(self.TABLE + "| `host/window/scope/` | - | - | - |\n"))

    def test_ambiguous_name(self):
        table = "| `host/usb/` | - | - | - |\n| `firmware/usb/` | - | - | - |\n| `host/window/` | - | usb | - |\n"
        with self.assertRaisesRegex(architecture.Unreadable, "usb, which is the name of host/usb, firmware/usb"):
            architecture.read_table(table)


if __name__ == "__main__":
    GRAPHS = [pathlib.Path(argument) for argument in sys.argv[1:]]
    unittest.main(argv=sys.argv[:1])
