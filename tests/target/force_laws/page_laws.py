"""Writes each force law that a page prints to a file, and prints the file names.

    page_laws.py FOLDER PAGE...
"""

import pathlib
import re
import sys

folder, pages = pathlib.Path(sys.argv[1]), map(pathlib.Path, sys.argv[2:])
folder.mkdir(parents=True, exist_ok=True)
for page in pages:
    for block in re.findall(r"```cpp\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        if "control/force_law.hpp" not in block:
            continue
        file = folder / (re.search(r"\bstruct (\w+) \{", block)[1] + ".hpp")
        if not file.exists() or file.read_text() != block:  # an unchanged file is not compiled again
            file.write_text(block)
        print(file)
