"""The checks of the firmware image find errors in small images that are built with these errors."""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[3]
PLACEMENT = REPOSITORY
LINKER_SCRIPT = REPOSITORY / "boards/facts/stm32f405.ld"
CORE = ["-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"]

# Smallest program that the tools accept as firmware. `work` is the code under test.
FRAME = """
#include "firmware/placement/interrupt.hpp"
extern "C" {
volatile float value = 1.0f;
volatile int sink;
INKWELL_INTERRUPT [[gnu::noinline]] void work();
INKWELL_INTERRUPT void control_interrupt() { work(); asm volatile("dsb" ::: "memory"); }
void reset_handler() { for (;;) work(); }
[[gnu::section(".vectors"), gnu::used]] void (*const vectors[])() = {reset_handler, control_interrupt};
}
"""


class ImageChecks(unittest.TestCase):
    def check(self, source: str, linker_script: pathlib.Path = LINKER_SCRIPT) -> tuple[subprocess.CompletedProcess, subprocess.CompletedProcess]:
        """Builds an image and returns the output of check_image and stack_bound."""
        with tempfile.TemporaryDirectory() as folder:
            file, elf = pathlib.Path(folder) / "image.cpp", pathlib.Path(folder) / "image.elf"
            file.write_text(FRAME + source)
            subprocess.run(
                ["arm-none-eabi-g++", "-std=c++20", "-O2", "-g", *CORE, "-fno-exceptions", "-fno-rtti", "-I", PLACEMENT,
                 "-nostartfiles", "-T", linker_script, file, "-o", elf, "-lm", "-lc", "-lnosys"],
                check=True, capture_output=True)
            commands = (["check_image.py", elf], ["stack_bound.py", elf])
            check_image, stack_bound = (
                subprocess.run([sys.executable, REPOSITORY / "tools/check" / command[0], *command[1:]],
                               capture_output=True, text=True, check=False)
                for command in commands)
            return check_image, stack_bound

    def assert_refused(self, result: subprocess.CompletedProcess, sentence: str) -> None:
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn(sentence, result.stderr)

    def test_a_sound_image_passes(self):
        for result in self.check("void work() { value = value * 2.0f; }"):
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_the_free_memory_is_printed(self):
        line = r"image\.elf: interrupt code (\d+) of 32768 bytes, (\d+) left; interrupt tables 0 of 2048 bytes, 2048 left; " \
               r"RAM (\d+) of 81920 bytes, (\d+) left; SRAM2 0 of 16384 bytes, 16384 left; core-coupled RAM 8192 of 63488 bytes, 55296 left"
        source = "[[gnu::used]] char memory[%d];\nvoid work() { value = value * 2.0f; }"
        small, large = (re.fullmatch(line, self.check(source % size)[0].stdout.splitlines()[0]) for size in (1000, 3000))
        self.assertIsNotNone(small)
        for code, code_left, ram, ram_left in (small.groups(), large.groups()):
            self.assertEqual((int(code) + int(code_left), int(ram) + int(ram_left)), (32768, 81920))
        self.assertEqual(int(large[3]) - int(small[3]), 2000)

    def test_too_much_interrupt_code_is_refused_with_the_share_of_the_force_law(self):
        check_image, _ = self.check("INKWELL_INTERRUPT [[gnu::noipa]] void step_force_law() { asm volatile(\".space 40000\"); }\n"
                                    "void work() { step_force_law(); value = 1.0f; }")
        self.assertEqual(check_image.returncode, 1)
        used, law, allowed = map(int, re.search(
            r"the interrupt code needs (\d+) bytes, but its memory has 32768\. "
            r"The force law needs (\d+) bytes and may need (\d+)\.", check_image.stderr).groups())
        self.assertGreater(law, 40000)
        self.assertEqual(used - law + allowed, 32768)

    def test_too_large_tables_of_interrupt_code_are_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder) / "stm32f405.ld"
            script.write_text(LINKER_SCRIPT.read_text().replace("*installed_force_law.cpp.obj(.rodata", "*(.law_table .rodata.law"))
            check_image, _ = self.check('[[gnu::used, gnu::section(".law_table")]] extern const int table[600] = {1};\n'
                                        "void work() { value = 1.0f; }", script)
        self.assert_refused(check_image, "the tables of interrupt code need 2400 bytes, but their memory has 2048. "
                                         "The tables of the force law need 2400 bytes and may need 2048.")

    def test_a_library_function_is_refused_with_the_line_of_its_call(self):
        check_image, _ = self.check('extern "C" float sinf(float);\n\nvoid work() { value = sinf(value); }')
        line = FRAME.count("\n") + 3
        self.assert_refused(check_image, "the image holds sinf: the mathematical library")
        self.assertRegex(check_image.stderr, rf"called at \S*image\.cpp:{line}\n")
        self.assertEqual(check_image.stderr.count("ERROR"), 2)  # library functions that sinf calls are not listed

    def test_errors_contain_the_names_of_the_source(self):
        check_image, _ = self.check("namespace haptic { [[gnu::noipa]] void other(int) { sink = 1; } }\n"
                                    "void work() { haptic::other(2); sink = 2; }")
        self.assert_refused(check_image, "work runs in an interrupt and calls haptic::other which lies outside")
        _, stack_bound = self.check("namespace haptic {\n"
                                    "[[gnu::noipa]] int other(int n);\n"
                                    "[[gnu::noipa]] int one(int n) { return n ? other(n - 1) + sink : 0; }\n"
                                    "[[gnu::noipa]] int other(int n) { return n ? one(n - 1) + sink : 1; }\n"
                                    "}\n"
                                    "void work() { sink = haptic::one(sink); }")
        self.assert_refused(stack_bound, "recursion: haptic::one -> haptic::other -> haptic::one")

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
        self.assert_refused(check_image, "division in an interrupt, in work at")
        check_image, _ = self.check("void work() { sink = 7 / sink; }")
        self.assert_refused(check_image, "division in an interrupt, in work at")
        check_image, _ = self.check("void work() { sink = 7000000000LL / sink; }")
        self.assert_refused(check_image, "work runs in an interrupt and calls __aeabi_ldivmod, a 64-bit division,")

    def test_the_mathematical_library_is_found(self):
        check_image, _ = self.check("void work() { value = __builtin_sinf(value); }")
        self.assert_refused(check_image, "the image holds sinf: the mathematical library")
        self.assert_refused(check_image, "work runs in an interrupt and calls sinf which lies outside")

    def test_an_unmarked_function_in_an_interrupt_is_found(self):
        check_image, _ = self.check("[[gnu::noipa]] void other() { sink = 1; }\nvoid work() { other(); sink = 2; }")
        self.assert_refused(check_image, "which lies outside .interrupt_text: mark it INKWELL_INTERRUPT or do without it")
        check_image, _ = self.check("[[gnu::noipa]] void other() { sink = 1; }\nvoid work() { sink = 2; other(); }")
        self.assert_refused(check_image, "which lies outside .interrupt_text")  # a tail call also counts as a call

    def test_an_interrupt_that_reads_the_flash_is_refused(self):
        reads = "work runs in an interrupt and reads the flash: its tables belong into .interrupt_tables"
        check_image, _ = self.check("const int table[16] = {7, 1, 8};\nvoid work() { sink = table[sink & 15]; }")
        self.assert_refused(check_image, reads)
        check_image, _ = self.check(
            'extern "C" const int table[16];\nconst int table[16] = {7, 1, 8};\n'
            'void work() { int address; asm("movw %0, #:lower16:table\\n movt %0, #:upper16:table" : "=r"(address)); '
            "sink = address; }\n[[gnu::used]] const int* volatile keep = table;")
        self.assert_refused(check_image, reads)

    def test_an_unmarked_handler_is_found(self):
        check_image, _ = self.check("void more_interrupt() { sink = 1; }\nvoid work() { sink = 2; }\n"
                                    "[[gnu::section(\".vectors\"), gnu::used]] void (*const more)() = more_interrupt;")
        self.assert_refused(check_image, "handles an interrupt but lies outside .interrupt_text")

    def test_the_handler_behind_every_interrupt_is_part_of_the_main_loop(self):
        source = ("void behind() { value = 1.0f / value; asm volatile(\"dsb\"); }\nvoid work() { sink = 2; }\n"
                  "[[gnu::section(\".vectors\"), gnu::used]] void (*const more[])() = {%s};")
        words_before = ["control_interrupt"] * 14  # the compiler places the newest table first
        check_image, stack_bound = self.check(source % ", ".join([*words_before, "behind"]))
        self.assertEqual(check_image.returncode, 0, check_image.stderr)
        self.assertIn("behind", stack_bound.stdout)
        for elsewhere in ([*words_before, "behind", "behind"], [*words_before, "control_interrupt", "behind"]):
            check_image, _ = self.check(source % ", ".join(elsewhere))
            self.assert_refused(check_image, "handles an interrupt but lies outside .interrupt_text")

    def test_a_handler_that_returns_with_a_store_under_way_is_found(self):
        under_way = "handles an interrupt and may return with a store under way"
        handler = ("INKWELL_INTERRUPT void more_interrupt() { %s }\nvoid work() { sink = 2; }\n"
                   "[[gnu::section(\".vectors\"), gnu::used]] void (*const more)() = more_interrupt;")
        for body in ("sink = 1;",
                     "work();",
                     'work(); asm volatile("");',
                     'sink = 1; asm volatile("it eq\\n bxeq lr\\n dsb" ::: "memory");',
                     'asm volatile("dsb" ::: "memory"); sink = 1;',
                     'if (sink == 4) return; work(); if (sink == 3) return; asm volatile("dsb" ::: "memory");'):
            with self.subTest(body):
                check_image, _ = self.check(handler % body)
                self.assert_refused(check_image, under_way)
        for body in ('sink = 1; asm volatile("dsb" ::: "memory");',
                     'if (sink == 3) work(); asm volatile("dsb" ::: "memory");',
                     'if (sink == 3) return; sink = 1; asm volatile("dsb" ::: "memory");'):
            with self.subTest(body):
                check_image, _ = self.check(handler % body)
                self.assertEqual(check_image.returncode, 0, check_image.stderr)

    def test_a_mark_that_lies_is_found(self):
        check_image, _ = self.check("INKWELL_INTERRUPT [[gnu::used]] void other() { sink = 1; }\nvoid work() { sink = 2; }")
        self.assert_refused(check_image, "lies in .interrupt_text but no interrupt calls it: take its mark away")

    def test_a_call_through_a_pointer_in_an_interrupt_is_found(self):
        check_image, _ = self.check("void (*volatile pointer)();\nvoid work() { pointer(); sink = 1; }")
        self.assert_refused(check_image, "work runs in an interrupt and calls through a pointer at")
        check_image, _ = self.check("struct Base { virtual void act() = 0; };\nBase* volatile base;\n"
                                    "void work() { base->act(); }")
        self.assert_refused(check_image, "work runs in an interrupt and calls through a pointer at")

    def test_a_wait_in_an_interrupt_is_found(self):
        wait = "work runs in an interrupt and waits at"
        for loop in ("while (sink == 0) {}",
                     "while ((sink & 4) == 0) {}",
                     "const int from = sink; while (sink - from < 100) {}",
                     "for (int i = 0; i < 9; ++i) { value = value + 1.0f; while (sink < i) {} }",
                     "while (sink == 0) for (int i = 0; i < 9; ++i) value = 2.0f;",
                     "for (;;) {}",
                     'asm volatile("wfi");'):
            with self.subTest(loop):
                check_image, _ = self.check("void work() { %s }" % loop)
                self.assert_refused(check_image, wait)

    def test_loops_that_count_are_no_waits(self):
        check_image, _ = self.check("""
        unsigned words[64], * volatile begin = words;
        [[gnu::noipa]] INKWELL_INTERRUPT unsigned other(unsigned n) { return n; }
        void work() {
          for (unsigned* word = begin; word != words + 64; ++word) *word = static_cast<unsigned>(sink);
          for (unsigned left = words[3]; left != 0; --left) words[left % 64] = other(left);
          for (unsigned bits = words[1]; bits != 0; bits >>= 1) sink = 1;
          for (unsigned i = 0; i < words[1]; ++i)
            for (unsigned k = i; k < 64; k += words[2]) words[k] += words[i];
          while (words[5] != 0) { words[5] -= 1; sink = sink; }
        }""")
        self.assertEqual(check_image.returncode, 0, check_image.stderr)

    def test_an_image_that_is_too_large_is_found(self):
        check_image, _ = self.check("[[gnu::used]] extern const char text[70000] = {1};\nvoid work() { value = 1.0f; }")
        self.assert_refused(check_image, "the code of the main loop takes 7")

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
        result = subprocess.run([sys.executable, REPOSITORY / "tools/check/check_image.py", __file__],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn("cannot read", result.stderr)


if __name__ == "__main__":
    unittest.main()
