"""An installation that was moved works there: nothing in it looks into the build or the sources.

    prefix_test.py BUILD_DIRECTORY WORK_DIRECTORY CMAKE CXX_COMPILER VERSION
"""

import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from kinds import KINDS, differences

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
BUILD, WORK = (pathlib.Path(argument) for argument in sys.argv[1:3])
CMAKE, COMPILER, VERSION = sys.argv[3:]
PREFIX = WORK / "moved"
PROGRAM, LAB = PREFIX / "bin/inkwell", PREFIX / "bin/inkwell-lab"


def run(*command, expected: int = 0, **how) -> str:
    result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            check=False, **how)
    if result.returncode != expected:
        raise AssertionError(f"{' '.join(map(str, command))} ended with {result.returncode}:\n{result.stdout}")
    return result.stdout


def setUpModule():
    staging = WORK / "staged"
    for folder in (staging, PREFIX):
        shutil.rmtree(folder, ignore_errors=True)
    run(CMAKE, "--install", BUILD, "--prefix", staging)
    staging.rename(PREFIX)


class Files(unittest.TestCase):
    def test_each_is_of_a_kind(self):
        files = [str(path.relative_to(PREFIX)) for path in PREFIX.rglob("*") if not path.is_dir() or path.is_symlink()]
        self.assertEqual([], differences(files, [kind for kinds in KINDS.values() for kind in kinds]))

    def test_none_names_the_sources_or_the_build(self):
        # The debug information of the firmware's ELF contains source paths, which no program opens.
        files = [path for path in PREFIX.rglob("*") if path.is_file() and path.suffix != ".elf"]
        naming = [path for path in files for folder in (REPOSITORY, BUILD, WORK)
                  if str(folder).encode() in path.read_bytes()]
        self.assertEqual([], naming)

    def test_udev_rule_is_for_this_device_and_comes_before_the_one_that_hands_out(self):
        [file] = PREFIX.glob("lib/udev/rules.d/*.rules")
        self.assertLess(int(file.name.split("-")[0]), 73)
        rules = [line for line in file.read_text().splitlines() if line and not line.startswith("#")]
        identity = re.match(r"USB ([0-9a-f]{4}):([0-9a-f]{4})[., ]", run(PROGRAM, "reference").splitlines()[2])
        self.assertEqual(f'SUBSYSTEM=="usb|hidraw", SUBSYSTEMS=="usb", ATTRS{{idVendor}}=="{identity[1]}", '
                         f'ATTRS{{idProduct}}=="{identity[2]}", TAG+="uaccess"', rules[0])
        self.assertTrue(all(rule.endswith('TAG+="uaccess"') for rule in rules))

    def test_desktop_entry_names_program_and_icon(self):
        entry = (PREFIX / "share/applications/inkwell.desktop").read_text()
        self.assertIn("\nExec=inkwell\n", entry)
        self.assertIn("\nIcon=inkwell\n", entry)
        self.assertIn("<svg ", (PREFIX / "share/icons/hicolor/scalable/apps/inkwell.svg").read_text())

    def test_each_command_has_a_page(self):
        for program, one_command in (("inkwell", "record"), ("inkwell-lab", "soak")):
            commands = re.findall(r"^  (\w+) ", run(PREFIX / "bin" / program, "--help").split("\nSubcommands:\n")[1].split("\n\n")[0],
                                  re.MULTILINE)
            self.assertIn(one_command, commands)
            command_page = (PREFIX / "share/doc/inkwell/commands.md").read_text()
            for command in commands:
                self.assertIn(f"\n### {program} {command}\n", command_page)
                page = gzip.decompress((PREFIX / f"share/man/man1/{program}-{command}.1.gz").read_bytes()).decode()
                name = f"{program}-{command}".replace("-", "\\-")
                self.assertIn(f".SH NAME\n{name} \\- ", page)
                self.assertIn(f'"Inkwell {VERSION}"', page)

    def test_bash_completes(self):
        script = PREFIX / "share/bash-completion/completions/inkwell"

        def completed(*words: str) -> list[str]:
            quoted = " ".join(f"'{word}'" for word in words)
            return run("bash", "--norc", "-c", f"source {script}; compopt() {{ :; }}; COMP_WORDS=({quoted}); "
                       f"COMP_CWORD={len(words) - 1}; _inkwell; printf '%s\\n' \"${{COMPREPLY[@]}}\"").split()

        self.assertEqual(["parameters"], completed("inkwell", "par"))
        self.assertEqual(["set", "save", "store", "stored"], completed("inkwell", "--virtual", "parameters", "s"))
        self.assertEqual(["wall_stiffness_N_per_m="], completed("inkwell", "parameters", "set", "wall_stiff"))
        self.assertEqual(["exact", "fast"], completed("inkwell", "info", "--mode", ""))
        self.assertEqual(["paper"], completed("inkwell", "--layout", "pa"))
        self.assertEqual(["--seconds", "--seed", "--serial", "--signals"], sorted(completed("inkwell", "record", "--se")
                                                                                + completed("inkwell", "record", "--si")))


class Programs(unittest.TestCase):
    def test_version(self):
        for program in (PROGRAM, LAB):
            self.assertEqual(VERSION, run(program, "--version").split()[-1])

    def test_lab_finds_virtual_board_and_firmware(self):
        run(LAB, "campaign", "run", "1", "--out", WORK / "cases")
        self.assertEqual("", json.loads((WORK / "cases/case-00001.json").read_text())["error"])

    def test_companion_finds_virtual_board_firmware_and_arm(self):
        information = json.loads(run(PROGRAM, "info", "--virtual", "--json"))
        self.assertEqual((VERSION, "ready"), (information["firmware_version"], information["state"]))

    def test_they_are_those_of_the_prefix(self):
        for part in ("bin/virtual-board", "lib/inkwell/firmware/inkwell.elf", "share/inkwell/arms/omni.toml"):
            away = PREFIX / (part + ".away")
            (PREFIX / part).rename(away)
            try:
                self.assertIn(str(PREFIX / part), run(PROGRAM, "info", "--virtual", expected=1))
            finally:
                away.rename(PREFIX / part)

    def test_drop_in_libraries(self):
        environment = {key: value for key, value in os.environ.items() if key != "LD_LIBRARY_PATH"}
        told = run(PROGRAM, "run", "--virtual", "/bin/sh", "-c", "echo $LD_LIBRARY_PATH; ldd $LD_LIBRARY_PATH/libhdPhantom.so",
                   env=environment)
        self.assertIn(f"\n{PREFIX}/lib/inkwell/dropins\n", told)
        for library in ("libHD.so.3.4", "libinkwell.so.1"):
            [path] = re.findall(rf"{re.escape(library)} => (\S+)", told)
            self.assertTrue(pathlib.Path(path).resolve().is_relative_to(PREFIX), path)


class OutsideProject(unittest.TestCase):
    """A project of somebody else builds against the installation, and its program opens a virtual board."""

    def test_cmake_package(self):
        build = WORK / "project"
        run(CMAKE, "--fresh", "-S", pathlib.Path(__file__).parent / "project", "-B", build, "-G", "Ninja",
            f"-DCMAKE_CXX_COMPILER={COMPILER}", f"-DCMAKE_PREFIX_PATH={PREFIX}")
        run(CMAKE, "--build", build)
        self.assertEqual(f"{VERSION} 1", run(build / "outside").strip())
        # Warnings, optimization and other options of this project do not apply to the user's sources.
        [command] = json.loads((build / "compile_commands.json").read_text())
        self.assertNotRegex(command["command"], r" -[WfO]")

    def test_pkg_config(self):
        environment = os.environ | {"PKG_CONFIG_PATH": str(PREFIX / "lib/pkgconfig")}
        flags = run("pkg-config", "--cflags", "--libs", "inkwell", env=environment).split()
        self.assertEqual(VERSION, run("pkg-config", "--modversion", "inkwell", env=environment).strip())
        example = PREFIX / "share/doc/inkwell-dev/examples/spring_to_a_point.c"
        program = WORK / "spring"
        run(COMPILER, "-x", "c", example, "-x", "none", *flags, "-o", program)
        libraries = run("ldd", program, env=os.environ | {"LD_LIBRARY_PATH": str(PREFIX / "lib")})
        self.assertIn(str(PREFIX), libraries)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
