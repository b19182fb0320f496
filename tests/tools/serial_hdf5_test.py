"""tools/cmake/serial_hdf5.cmake chooses the serial HDF5, and refuses a parallel one with a sentence.

    serial_hdf5_test.py REPOSITORY
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(sys.argv[1])
PROJECT = f"""cmake_minimum_required(VERSION 3.25)
project(any LANGUAGES NONE)
include({REPOSITORY}/tools/cmake/serial_hdf5.cmake)
message(STATUS "chosen: ${{hdf5_INCLUDE_DIRS}}")
"""


class SerialHdf5(unittest.TestCase):
    def configure(self, builds: dict[str, bool]) -> subprocess.CompletedProcess:
        """With HDF5 builds by their name for pkg-config, and whether each is parallel."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "CMakeLists.txt").write_text(PROJECT)
            for module, is_parallel in builds.items():
                include = folder / f"include-{module}"
                include.mkdir()
                (include / "H5pubconf.h").write_text(
                    "#define H5_HAVE_PARALLEL 1\n" if is_parallel else "/* #undef H5_HAVE_PARALLEL */\n")
                (folder / f"{module}.pc").write_text(
                    f"includedir={include}\nName: HDF5\nDescription: HDF5\nVersion: 1.10.8\n"
                    "Cflags: -I${includedir}\nLibs: -lhdf5\n")
            return subprocess.run(["cmake", "-S", folder, "-B", folder / "build"], capture_output=True, text=True,
                                  env=os.environ | {"PKG_CONFIG_LIBDIR": name, "PKG_CONFIG_PATH": ""})

    def test_a_parallel_one_is_refused(self):
        result = self.configure({"hdf5": True})
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("is a parallel build", " ".join(result.stderr.split()))
        self.assertIn("libhdf5-dev", result.stderr)

    def test_of_both_the_serial_one_is_chosen(self):
        result = self.configure({"hdf5": True, "hdf5-openmpi": True, "hdf5-serial": False})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, "chosen: .*/include-hdf5-serial\n")

    def test_a_library_without_the_serial_name_is_accepted(self):
        result = self.configure({"hdf5": False})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, "chosen: .*/include-hdf5\n")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
