"""Runs cppcheck on the firmware sources, once for each board that they are compiled for.

    cppcheck_test.py CPPCHECK BUILD_DIRECTORY WORK_DIRECTORY OPTION...

Test images compile the same sources again with other definitions; these copies are not checked. cppcheck stores its
results in the work directory, so sources that have not changed are not analyzed again.
"""

import json
import pathlib
import re
import subprocess
import sys

CPPCHECK, BUILD, WORK = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
REPOSITORY = pathlib.Path(__file__).resolve().parents[3]


def is_of_tests(path: str | pathlib.Path) -> bool:
    return pathlib.Path(path).parts[0] == "tests"


def is_checked(entry: dict) -> bool:
    source = pathlib.Path(entry["file"]).resolve()
    [output] = re.findall(r" -o (\S+)", entry["command"])
    return source.is_relative_to(REPOSITORY) and not is_of_tests(source.relative_to(REPOSITORY)) and not is_of_tests(output)


def projects() -> list[list[dict]]:
    """The compilations, such that each project contains each source once: cppcheck's cache needs this."""
    split: list[list[dict]] = []
    seen: dict[str, int] = {}
    for entry in filter(is_checked, json.loads((BUILD / "compile_commands.json").read_text())):
        number = seen.get(entry["file"], 0)
        seen[entry["file"]] = number + 1
        if number == len(split):
            split.append([])
        split[number].append(entry)
    return split


def main() -> int:
    is_clean = True
    found = projects()
    for number, entries in enumerate(found):
        cache = WORK / f"cppcheck-{number}"
        cache.mkdir(parents=True, exist_ok=True)
        project = cache / "compile_commands.json"
        project.write_text(json.dumps(entries))
        is_clean &= subprocess.run([CPPCHECK, f"--project={project}", f"--cppcheck-build-dir={cache}", *sys.argv[4:]],
                                   check=False).returncode == 0
    print(f"{sum(map(len, found))} compilations in {len(found)} projects")
    return 0 if is_clean and found else 1


if __name__ == "__main__":
    sys.exit(main())
