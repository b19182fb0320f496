"""Runs random Thumb-2 programs on the virtual chip in exact and fast mode and under QEMU, and compares their results.

A difference is reported with program and register. The image and the assembly source remain in the folder of --work.
"""
import argparse
import pathlib
import subprocess
import sys

import programs

HERE = pathlib.Path(__file__).parent
BATCH = 200  # the text of all their registers must fit into the SRAM
QEMU = ["qemu-system-arm", "-M", "netduinoplus2", "-nographic", "-monitor", "none", "-serial", "null",
        "-semihosting-config", "enable=on,target=native", "-icount", "shift=0,sleep=off", "-kernel"]
STATE = [f"R{i}" for i in range(13)] + ["LR", "APSR", "FPSCR"] + [f"S{i}" for i in range(32)] + ["hash"]


def build(work, first, count, seed, dump):
    assembler = work / "programs.s"
    assembler.write_text(programs.programs(seed, first, count))
    image = work / ("dump.elf" if dump else "image.elf")
    subprocess.run(["arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard",
                    "-nostdlib", *(["-DDUMP"] if dump else []), "-T", HERE / "image.ld", "-Wl,--build-id=none",
                    HERE / "harness.S", assembler, "-o", image], check=True)
    return image


def run(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=600)
    return done


def results(run_image, image):
    """Returns the output lines of each machine, and the number of SysTick interrupts of the virtual chip in exact
    mode."""
    exact, fast = (run([run_image, mode, image]) for mode in ("exact", "fast"))
    qemu = run([*QEMU, image])
    lines = {"exact": exact.stdout, "fast": fast.stdout, "QEMU": qemu.stdout + qemu.stderr}
    interrupts = int(exact.stderr) if exact.returncode == 0 else 0
    return {name: text.split() for name, text in lines.items()}, interrupts


def explain(arguments, first, count, index):
    image = build(arguments.work, first, count, arguments.seed, dump=True)
    lines, _ = results(arguments.run_image, image)
    for i, name in enumerate(STATE):
        position = index * len(STATE) + i
        values = {machine: text[position] if position < len(text) else "-" for machine, text in lines.items()}
        if len(set(values.values())) > 1:
            print(f"  {name:5}", *(f"{machine} {value}" for machine, value in values.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", type=int, default=1000, help="how many (%(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the sequence of programs (%(default)s)")
    parser.add_argument("--run-image", required=True, type=pathlib.Path, help="the program run-image")
    parser.add_argument("--work", required=True, type=pathlib.Path, help="folder for images")
    arguments = parser.parse_args()
    arguments.run_image = arguments.run_image.resolve()
    arguments.work.mkdir(parents=True, exist_ok=True)

    differing, interrupts = 0, 0
    for first in range(0, arguments.programs, BATCH):
        count = min(BATCH, arguments.programs - first)
        image = build(arguments.work, first, count, arguments.seed, dump=False)
        lines, came = results(arguments.run_image, image)
        interrupts += came
        if any(len(text) != count for text in lines.values()):
            for machine, text in lines.items():
                print(f"programs {first} to {first + count - 1}, {machine}: {len(text)} of {count} results,",
                      " ".join(text[-12:]))
            return 1
        for index, values in enumerate(zip(*lines.values())):
            if len(set(values)) == 1:
                continue
            differing += 1
            print(f"program {first + index} of seed {arguments.seed} differs:",
                  *(f"{machine} {value}" for machine, value in zip(lines, values)))
            explain(arguments, first, count, index)
            if differing == 10:
                return 1
        if sys.stdout.isatty():
            print(f"\r{first + count} programs", end="", flush=True)
    print(f"{arguments.programs} programs, {differing} differ, interrupted {interrupts} times")
    # The run fails if too few interrupts occurred.
    return 0 if differing == 0 and interrupts > arguments.programs else 1


if __name__ == "__main__":
    sys.exit(main())
