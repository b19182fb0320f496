"""What the documents name beneath build/pc after `tools/build` is among what that command makes.

usage: built_test.py REPOSITORY BUILD_DIRECTORY NINJA
"""
import json
import pathlib
import re
import subprocess
import sys


def named_in(page):
    """Paths beneath build/pc, but those that the page builds by their names."""
    paths = re.findall(r"build/pc/([\w.-]+(?:/[\w.-]+)*)", page)
    by_name = re.findall(r"ninja -C build/pc ([\w-]+)", page)
    return sorted({path.rstrip(".") for path in paths} - set(by_name))


def made_by(targets, build_directory, ninja):
    graph = subprocess.run([ninja, "-C", build_directory, "-t", "graph", *targets], capture_output=True, text=True,
                           check=True).stdout
    return set(re.findall(r'label="([^" ]+)"', graph))


def main():
    repository, build_directory, ninja = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    presets = json.loads((repository / "CMakePresets.json").read_text(encoding="utf-8"))["buildPresets"]
    made = made_by(next(preset for preset in presets if preset["name"] == "pc")["targets"], build_directory, ninja)
    pages = 0
    missing = []
    for page_file in [repository / "README.md", *sorted((repository / "docs").glob("*.md"))]:
        page = page_file.read_text(encoding="utf-8")
        if not re.search(r"^    tools/build$", page, re.MULTILINE):
            continue
        pages += 1
        missing += [f"{page_file.name}: tools/build does not make build/pc/{path}" for path in named_in(page)
                    if not any(node == path or node.startswith(path + "/") for node in made)]
    print("\n".join(missing) or f"{pages} pages name what tools/build makes")
    sys.exit(1 if missing or pages == 0 else 0)


main()
