"""The words that tools/check/language finds in pages and sources.

usage: check_language_test.py REPOSITORY
"""

import importlib.machinery
import importlib.util
import pathlib
import sys
import unittest

REPOSITORY = pathlib.Path(sys.argv.pop(1))
loader = importlib.machinery.SourceFileLoader("check_language", str(REPOSITORY / "tools/check/language"))
check_language = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_language", loader))
sys.dont_write_bytecode = True
loader.exec_module(check_language)

GLOSSARY = """# Glossary

**arm**: a word.

## Rejected words

| rejected | use |
| --- | --- |
| bear, bears | tolerate |
| at once | immediately |
"""


class Words(unittest.TestCase):
    def setUp(self):
        self.rejected = check_language.read_rejected_words(GLOSSARY)

    def found(self, text):
        return [(line, word) for line, word, _ in check_language.find_rejected_words(text, self.rejected)]

    def test_table(self):
        self.assertEqual(["tolerate", "tolerate", "immediately"], list(self.rejected.values()))

    def test_whole_words_in_any_case_and_over_a_line_end(self):
        self.assertEqual([(1, "Bears"), (2, "at once")], self.found("Bears, not bearing:\nit stops at\nonce."))

    def test_pages_without_code_and_targets_of_links(self):
        text = check_language.page_text("It `bears` [x](bears.md).\n\n    bears\n\n```\nbears\n```\nIt bears.\n")
        self.assertEqual([(8, "bears")], self.found(text))

    def test_the_table_of_the_glossary_is_not_checked(self):
        self.assertEqual([], self.found(check_language.page_text(GLOSSARY)))

    def test_texts_of_tables_over_a_line_end(self):
        text = check_language.table_text('# bears\nhelp = """\\\n  It stops at \\\n  once."""\n')
        self.assertEqual([(1, "bears"), (3, "at\nonce")], [(line, word.replace(" ", "\n")) for line, word in self.found(text)])

    def test_strings_of_sources_without_code_and_comments(self):
        source = '#include "bears.hpp"\nint bear;  // "bear"\nconst char* text = "A \\"bear\\" stops at once.";\n'
        self.assertEqual([(3, "at once"), (3, "bear")], self.found(check_language.string_text(source)))


if __name__ == "__main__":
    unittest.main()
