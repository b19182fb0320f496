"""Explains why this Python cannot import the package. Older versions of Python must be able to read this file."""

import importlib.machinery
import importlib.util
import pathlib
import re
import sys


def check() -> None:
    """Raises ImportError with the remedy if the native module does not suit this Python, or numpy is missing."""
    running = "Python {}.{} ({})".format(sys.version_info[0], sys.version_info[1], sys.executable)
    folder = pathlib.Path(__file__).parent
    modules = sorted(file.name for file in folder.glob("_native.*so"))
    if not any("_native" + suffix in modules for suffix in importlib.machinery.EXTENSION_SUFFIXES):
        built_for = re.search(r"cpython-(\d)(\d+)", " ".join(modules))
        if not built_for:
            raise ImportError("The package inkwell in {} has no native module. Build it with tools/build.".format(folder))
        version = "{}.{}".format(built_for[1], built_for[2])
        remedy = "Start python{}".format(version)
        if sys.version_info >= (3, 11):
            remedy += ", or build the package again with the CMake option -DINKWELL_PYTHON=" + sys.executable
        raise ImportError("The package inkwell in {} was built for Python {}, but this is {}. {}."
                          .format(folder, version, running, remedy))
    if importlib.util.find_spec("numpy") is None:
        raise ModuleNotFoundError(
            "The package inkwell requires numpy, which is not installed for {}. Install Debian's package python3-numpy, or "
            "run: {} -m pip install numpy".format(running, sys.executable), name="numpy")
