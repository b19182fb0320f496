"""The kinds of files that an installation has: each file is of one kind, and there is a file of each kind."""

import re

LIBRARY = r"lib/(?:[\w-]+-linux-gnu/)?"
# Files of each package, relative to the prefix.
KINDS = {
    "inkwell": [
        r"bin/inkwell", r"bin/virtual-board", r"lib/inkwell/helpers/inkwell-import",
        LIBRARY + r"libinkwell\.so\.1", LIBRARY + r"libinkwell\.so\.\d+\.\d+\.\d+",
        r"lib/inkwell/dropins/libHD\.so", r"lib/inkwell/dropins/libHD\.so\.3\.0", r"lib/inkwell/dropins/libHD\.so\.3\.4",
        r"lib/inkwell/dropins/libhdPhantom\.so",
        r"lib/inkwell/firmware/inkwell\.elf", r"lib/inkwell/firmware/inkwell\.bin",
        r"lib/inkwell/firmware/inkwell-bench_modules\.elf", r"lib/inkwell/firmware/inkwell-bench_modules\.bin",
        r"lib/udev/rules\.d/60-inkwell\.rules",
        r"share/applications/inkwell\.desktop", r"share/icons/hicolor/scalable/apps/inkwell\.svg",
        r"share/bash-completion/completions/inkwell", r"share/bash-completion/completions/virtual-board",
        r"share/fish/vendor_completions\.d/inkwell\.fish", r"share/fish/vendor_completions\.d/virtual-board\.fish",
        r"share/zsh/vendor-completions/_inkwell", r"share/zsh/vendor-completions/_virtual-board",
        r"share/doc/inkwell/[\w-]+\.md", r"share/doc/inkwell/tutorial\.md", r"share/doc/inkwell/campaign/[\w-]+\.(?:md|svg)",
        r"share/doc/inkwell/pictures/[\w-]+\.(?:png|svg)",
        r"share/inkwell/arms/omni\.toml", r"share/inkwell/arms/(?!omni)\w+\.toml",
        r"share/man/man1/inkwell\.1\.gz", r"share/man/man1/inkwell-(?!lab)[\w-]+\.1\.gz", r"share/man/man1/virtual-board\.1\.gz",
    ],
    "inkwell-lab": [
        r"bin/inkwell-lab",
        r"share/bash-completion/completions/inkwell-lab", r"share/fish/vendor_completions\.d/inkwell-lab\.fish",
        r"share/zsh/vendor-completions/_inkwell-lab",
        r"share/man/man1/inkwell-lab\.1\.gz", r"share/man/man1/inkwell-lab-[\w-]+\.1\.gz",
    ],
    "inkwell-dev": [
        r"include/inkwell/inkwell\.h", r"include/inkwell/inkwell\.hpp",
        LIBRARY + r"libinkwell\.so", LIBRARY + r"cmake/Inkwell/InkwellConfig\.cmake",
        LIBRARY + r"cmake/Inkwell/InkwellConfig-\w+\.cmake", LIBRARY + r"cmake/Inkwell/InkwellConfigVersion\.cmake",
        LIBRARY + r"pkgconfig/inkwell\.pc",
        r"share/doc/inkwell-dev/examples/\w+\.(?:c|cpp|hpp)",
    ],
}
# Additional files that Debian requires in packages.
DEBIAN = {
    "inkwell": [r"share/doc/inkwell/changelog\.gz", r"share/doc/inkwell/copyright", r"share/lintian/overrides/inkwell"],
    "inkwell-lab": [r"share/doc/inkwell-lab/changelog\.gz", r"share/doc/inkwell-lab/copyright"],
    "inkwell-dev": [r"share/doc/inkwell-dev/changelog\.gz", r"share/doc/inkwell-dev/copyright"],
}


def differences(files: list[str], kinds: list[str]) -> list[str]:
    """One line for each file of no kind, and for each kind without a file."""
    problems = [f"{file} is of no kind" for file in files if not any(re.fullmatch(kind, file) for kind in kinds)]
    return problems + [f"there is no {kind}" for kind in kinds if not any(re.fullmatch(kind, file) for file in files)]
