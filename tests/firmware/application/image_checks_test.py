"""The checks of the firmware's image find what is planted into a small image made for the purpose."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
FACTS = REPOSITORY / "boards/omni_driver/include/board/omni_driver.hpp"
LINKER_SCRIPT = REPOSITORY / "boards/omni_driver/omni_driver.ld"
CORE = ["-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"]

# The least that the tools take for a firmware. `work` stands for what is under test.
FRAME = """
extern "C" {
volatile float value = 1.0f;
volatile int sink;
[[gnu::noinline]] void work();
void control_interrupt() { work(); }
void reset_handler() { for (;;) work(); }
[[gnu::section(".vectors"), gnu::used]] void (*const vectors[])() = {reset_handler, control_interrupt};
}
"""


class ImageChecks(unittest.TestCase):
    def check(self, source: str) -> tuple[subprocess.CompletedProcess, subprocess.CompletedProcess]:
        """Builds an image and returns what check_image and stack_bound say about it."""
        with tempfile.TemporaryDirectory() as folder:
            file, elf = pathlib.Path(folder) / "image.cpp", pathlib.Path(folder) / "image.elf"
            file.write_text(FRAME + source)
            subprocess.run(
                ["arm-none-eabi-g++", "-std=c++20", "-O2", *CORE, "-fno-exceptions", "-fno-rtti", "-nostartfiles",
                 "-T", LINKER_SCRIPT, file, "-o", elf, "-lc", "-lnosys"],
                check=True, capture_output=True)
            commands = (["check_image.py", elf, "--facts", FACTS], ["stack_bound.py", elf])
            check_image, stack_bound = (
                subprocess.run([sys.executable, REPOSITORY / "tools" / command[0], *command[1:]],
                               capture_output=True, text=True, check=False)
                for command in commands)
            return check_image, stack_bound

    def assert_refused(self, result: subprocess.CompletedProcess, sentence: str) -> None:
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn(sentence, result.stderr)

    def test_a_sound_image_passes(self):
        for result in self.check("void work() { value = value * 2.0f; }"):
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_heap_is_found(self):
        check_image, _ = self.check("void work() { delete[] new char[static_cast<unsigned>(sink)]; }\n"
                                    "void* operator new[](decltype(sizeof(0))) { return nullptr; }\n"
                                    "void operator delete[](void*) noexcept {}\n")
        self.assert_refused(check_image, "operator new or delete")

    def test_double_precision_is_found(self):
        check_image, _ = self.check("void work() { value = static_cast<float>(value * 1.1); }")
        self.assert_refused(check_image, "double precision")

    def test_division_in_the_interrupt_is_found(self):
        check_image, _ = self.check("void work() { value = 1.0f / value; }")
        self.assert_refused(check_image, "division in the control interrupt, in work at")
        check_image, _ = self.check("void work() { sink = 7 / sink; }")
        self.assert_refused(check_image, "division in the control interrupt, in work at")

    def test_an_image_that_is_too_large_is_found(self):
        check_image, _ = self.check("[[gnu::used]] extern const char text[70000] = {1};\nvoid work() {}")
        self.assert_refused(check_image, "more than the board's 65536")

    def test_a_deep_stack_is_found(self):
        _, stack_bound = self.check("void work() { volatile char room[9000]; room[0] = 1; }")
        self.assert_refused(stack_bound, "the stack needs")

    def test_a_virtual_call_counts(self):
        source = """struct Base { virtual void act() = 0; };
        struct Derived final : Base { void act() override { volatile char room[%d]; room[0] = 1; } } derived;
        Base* volatile base = &derived;
        extern "C" void __cxa_pure_virtual() {}
        void work() { base->act(); sink = 1; }"""
        small, large = (self.check(source % size)[1] for size in (400, 3400))
        self.assertEqual(small.returncode, 0, small.stdout + small.stderr)
        bounds = [int(result.stdout.rsplit("bound", 1)[1].split(":")[1].split()[0]) for result in (small, large)]
        self.assertEqual(bounds[1] - bounds[0], 2 * 3000)  # in the main loop and in the interrupt

    def test_recursion_is_found(self):
        _, stack_bound = self.check("[[gnu::noipa]] int other(int n);\n"
                                    "[[gnu::noipa]] int one(int n) { return n ? other(n - 1) + sink : 0; }\n"
                                    "[[gnu::noipa]] int other(int n) { return n ? one(n - 1) + sink : 1; }\n"
                                    "void work() { sink = one(sink); }")
        self.assert_refused(stack_bound, "recursion: ")

    def test_a_file_that_is_no_image_is_refused(self):
        result = subprocess.run([sys.executable, REPOSITORY / "tools/check_image.py", __file__, "--facts", FACTS],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn("cannot read", result.stderr)


if __name__ == "__main__":
    unittest.main()
