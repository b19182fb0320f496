"""Every relative link and picture of the pages leads somewhere, to headings too."""

import re
import sys
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PAGES = [TOP / "README.md", TOP / "CONTRIBUTING.md", TOP / "SECURITY.md", TOP / "tools/README.md",
         *sorted((TOP / "docs").glob("**/*.md")), *sorted((TOP / "boards").glob("*/README.md"))]
LINK = re.compile(r"\]\(([^()\s]+)\)")
HEADING = re.compile(r"^#+ +(.+)$", re.MULTILINE)


def without_code(text: str) -> str:
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL))


def anchor(heading: str) -> str:
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


class Links(unittest.TestCase):
    def test_each_leads_somewhere(self):
        links = 0
        for page in PAGES:
            for link in LINK.findall(without_code(page.read_text())):
                if re.match(r"[a-z]+:", link):
                    continue
                links += 1
                path, _, fragment = link.partition("#")
                target = (page.parent / path).resolve() if path else page
                with self.subTest(page=page.name, link=link):
                    self.assertTrue(target.exists())
                    if fragment and target.suffix == ".md":
                        self.assertIn(fragment, [anchor(heading) for heading in HEADING.findall(target.read_text())])
        self.assertGreater(links, 50)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
