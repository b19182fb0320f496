"""How a program's --help is read, and what manual pages and completion make of it."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/docs"))

import generate_command_page  # noqa: E402: in tools/docs/
import generate_completion  # noqa: E402
import generate_manual  # noqa: E402
import help_text  # noqa: E402

HELP = """Records. Until it is told to end.

  a line that keeps its form

Usage: probe record [OPTIONS] FILE

Positionals:
  FILE                  Where to; `-` is the terminal

Options:
  -h,--help             Print this help
  --mode {slow,fast} (slow)
                        How;
                        .never mind
  --seconds SECONDS     How long
  --all                 Everything

Examples:
  probe record a.h5

It ends with 1 if it can not.
"""


class Help(unittest.TestCase):
    def setUp(self):
        self.command = help_text.parse(["probe", "record"], HELP)

    def test_parts(self):
        self.assertEqual("probe record [OPTIONS] FILE", self.command.usage)
        self.assertEqual(["Positionals", "Options"], list(self.command.blocks))
        help_row, mode, seconds, everything = self.command.options()
        self.assertEqual(["-h", "--help"], help_row.names)
        self.assertEqual((["slow", "fast"], "How;\n.never mind"), (mode.choices(), mode.text))
        self.assertEqual([False, True, True, False], [row.takes_value() for row in (help_row, mode, seconds, everything)])
        self.assertTrue(self.command.positionals()[0].takes_file())
        self.assertTrue(self.command.footer.startswith("Examples:\n"))

    def test_choices_of_both_forms(self):
        for text in ("{exact,fast}", "exact|fast=fast"):
            self.assertEqual(["exact", "fast"], help_text.Row(["--mode"], text, "").choices())

    def test_a_help_of_another_form_is_refused(self):
        with self.assertRaisesRegex(help_text.Unreadable, "probe has no line that begins with Usage:"):
            help_text.parse(["probe"], "Aims to help.")

    def test_page(self):
        page = generate_manual.page(self.command, "1.2.3")
        self.assertIn("probe\\-record \\- records\n", page)
        self.assertIn(".EX\n  a line that keeps its form\n.EE", page)
        self.assertIn("\\fB\\-\\-mode\\fR {slow,fast} (slow unless given)\nHow;\n\\&.never mind", page)
        self.assertIn(".SH EXAMPLES\n.EX\n  probe record a.h5\n.EE\n.SH NOTES\nIt ends with 1", page)
        self.assertIn("Where to; \\fB\\-\\fR is the terminal", page)
        self.assertNotIn("help", page)

    def test_section_of_the_command_page(self):
        page = "\n".join(generate_command_page.section(self.command))
        self.assertTrue(page.startswith("### probe record\n\nRecords. Until it is told to end."))
        self.assertIn("\n    probe record [OPTIONS] FILE\n", page)
        self.assertIn("| `--mode {slow,fast} (slow)` | How; .never mind |\n", page)
        self.assertIn("| `FILE` | Where to; `-` is the terminal |\n", page)
        self.assertIn("Examples:\n\n      probe record a.h5\n", page)
        self.assertNotIn("Print this help", page)

    def test_completion(self):
        root = help_text.Command(["probe"], "", "", {}, "", [self.command])
        for shell in (generate_completion.bash, generate_completion.zsh):
            text = shell("probe", root)
            self.assertIn("'record|--mode') choices='slow fast' ;;", text)
            self.assertIn("'record|'*) options='-h --help --mode --seconds --all'; choices=''; files=1 ;;", text)
        self.assertIn("complete -c probe -n '__fish_seen_subcommand_from record' -l mode -x -a 'slow fast' -d 'How; .never mind'",
                      generate_completion.fish("probe", root))


if __name__ == "__main__":
    unittest.main()
