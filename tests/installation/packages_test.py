"""The Debian packages have what they should, and say what they are.

    packages_test.py BUILD_DIRECTORY WORK_DIRECTORY CPACK VERSION
"""

import gzip
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from binaries import BINARIES, host_binaries, missing, unsafe_folders
from kinds import DEBIAN, KINDS, differences

BUILD, WORK = (pathlib.Path(argument) for argument in sys.argv[1:3])
CPACK, VERSION = sys.argv[3:]
PACKAGES = WORK / "packages"


def run(*command, **how) -> str:
    result = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            check=False, **how)
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))} failed:\n{result.stdout}")
    return result.stdout


def package(name: str) -> pathlib.Path:
    [file] = PACKAGES.glob(f"{name}_{VERSION}_*.deb")
    return file


def content(name: str) -> pathlib.Path:
    folder = WORK / f"{name}-content"
    shutil.rmtree(folder, ignore_errors=True)
    run("dpkg-deb", "-R", package(name), folder)
    return folder


def setUpModule():
    shutil.rmtree(PACKAGES, ignore_errors=True)
    # The packages are not compressed, because compression would take most of the time.
    run(CPACK, "--config", BUILD / "CPackConfig.cmake", "-B", PACKAGES, "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=none")


class Packages(unittest.TestCase):
    def test_files_are_of_the_kinds_of_their_package(self):
        for name, kinds in KINDS.items():
            with self.subTest(name):
                lines = [line.split(maxsplit=5) for line in run("dpkg-deb", "-c", package(name)).splitlines()]
                files = [line[5].split(" -> ")[0].removeprefix("./usr/") for line in lines if not line[0].startswith("d")]
                self.assertEqual([], differences(files, kinds + DEBIAN[name]))
                self.assertEqual({"root/root"}, {line[1] for line in lines})
                self.assertEqual([], [line for line in lines if line[0] not in
                                      ("drwxr-xr-x", "-rw-r--r--", "lrwxrwxrwx") and not re.search("/bin/|/helpers/", line[5])])

    def test_packages_have_the_right_sections_and_dependencies(self):
        def field(name: str, key: str) -> str:
            return run("dpkg-deb", "-f", package(name), key).strip()

        self.assertEqual(f"inkwell (= {VERSION})", field("inkwell-dev", "Depends"))
        # The lab runs virtual boards, but it opens no window.
        self.assertIn(f"inkwell (= {VERSION})", field("inkwell-lab", "Depends").split(", "))
        self.assertNotIn("libglfw3", field("inkwell-lab", "Depends"))
        for library in ("libunicorn2", "libusb-1.0-0", "libhidapi-hidraw0", "libgl1"):
            self.assertRegex(field("inkwell", "Depends"), rf"\b{re.escape(library)}(t64)?\b")  # t64: Debian 13
        self.assertRegex(field("inkwell", "Depends"), r"\blibhdf5-[0-9]")  # the serial HDF5
        self.assertNotIn("mpi", field("inkwell", "Depends"))
        self.assertIn("gnuplot", field("inkwell", "Recommends"))
        self.assertEqual(("science", "libdevel", "science"),
                         tuple(field(name, "Section") for name in ("inkwell", "inkwell-dev", "inkwell-lab")))

    def test_packages_register_the_library_with_the_system(self):
        control = content("inkwell") / "DEBIAN"
        self.assertEqual(f"libinkwell 1 inkwell (>= {VERSION})\n", (control / "shlibs").read_text())
        self.assertEqual("activate-noawait ldconfig\n", (control / "triggers").read_text())
        for script in ("postinst", "postrm"):
            run("sh", "-n", control / script)
            # Without udev, as in a container, the script has nothing to do.
            run("env", "PATH=/nowhere", "/bin/sh", control / script, "configure")

    def test_programs_and_libraries_are_stripped(self):
        for path in [*content("inkwell").glob("usr/bin/*"), *content("inkwell").glob("usr/lib/**/*.so*"),
                     *content("inkwell").glob("usr/lib/inkwell/helpers/*"),
                     *content("inkwell-lab").glob("usr/bin/*")]:
            self.assertIn("no symbols", run("objdump", "-t", path))

    def test_binaries_are_protected_and_load_no_library_from_the_current_folder(self):
        for folder in (content("inkwell"), content("inkwell-lab")):
            for path in host_binaries(folder):
                installed = str(path.relative_to(folder / "usr"))
                with self.subTest(installed):
                    [row] = [binary for binary in BINARIES if binary.kind and re.fullmatch(binary.kind, installed)]
                    self.assertEqual([], missing(path, row) + unsafe_folders(path))

    def test_only_the_virtual_board_is_linked_to_unicorn_and_its_license_is_stated(self):
        folder = content("inkwell")
        linked = [path.name for path in [*folder.rglob("*"), *content("inkwell-lab").rglob("*")]
                  if path.is_file() and not path.is_symlink() and path.read_bytes()[:4] == b"\x7fELF"
                  and path.suffix != ".elf" and "libunicorn" in run("objdump", "-p", path)]
        self.assertEqual(["virtual-board"], linked)
        stanzas = (folder / "usr/share/doc/inkwell/copyright").read_text().split("\n\n")
        [stanza] = [stanza for stanza in stanzas if stanza.startswith("Files: usr/bin/virtual-board\n")]
        self.assertIn("\nLicense: GPL-2\n", stanza)

    def test_checksums_of_packages_and_firmware_images(self):
        names = [line.split("  ")[1] for line in (PACKAGES / "SHA256SUMS").read_text().splitlines()]
        made = [path.name for path in PACKAGES.iterdir() if path.is_file() and path.name != "SHA256SUMS"]
        self.assertEqual(sorted(made), sorted(names))
        self.assertLessEqual({package("inkwell").name, package("inkwell-dev").name, "inkwell.elf", "inkwell.bin"}, set(names))
        run("sha256sum", "--check", "--strict", "SHA256SUMS", cwd=PACKAGES)
        damaged = PACKAGES / "inkwell.bin"
        damaged.write_bytes(damaged.read_bytes()[:-1])
        with self.assertRaisesRegex(AssertionError, "inkwell.bin: FAILED"):
            run("sha256sum", "--check", "--strict", "SHA256SUMS", cwd=PACKAGES)

    def test_changelog_begins_with_this_version(self):
        for name in KINDS:
            text = gzip.decompress((content(name) / f"usr/share/doc/{name}/changelog.gz").read_bytes()).decode()
            self.assertRegex(text, rf"^inkwell \({re.escape(VERSION)}\) ")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
