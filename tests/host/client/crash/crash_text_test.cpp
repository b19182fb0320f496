// Text of a firmware crash. tests/system/black_box_test.cpp tests the symbol names of a crash.
#include <doctest/doctest.h>

#include "host/client/crash/crash_text.hpp"
#include "host/client/device/error.hpp"

namespace inkwell::crash {
namespace {

using protocol::CrashFacts;

constexpr std::uint32_t address_of_protection = 1u << 7, address_of_bus = 1u << 15;

}  // namespace

TEST_CASE("the cause of a crash is a sentence with the fault address if the processor recorded it") {
  CHECK(cause({.exception = 2}) == "The crystal stopped.");
  CHECK(cause({.exception = 14}) == "The main loop hung, and the watchdog expired.");
  CHECK(cause({.exception = 83}) == "Interrupt 67 occurred, although it is not used.");
  CHECK(cause({.exception = 3, .hard_fault_status = 2}) ==
        "A handler's address could not be read from the vector table.");
  CHECK(cause({.exception = 3, .configurable_fault_status = 1u << 1 | address_of_protection, .fault_address = 4}) ==
        "The processor could not continue: it accessed memory in a way that memory protection forbids, 0x00000004.");
  CHECK(cause({.exception = 3, .configurable_fault_status = 1u << 9 | address_of_bus, .fault_address = 0x6000'0000}) ==
        "The processor could not continue: it accessed an unmapped address, 0x60000000.");
  CHECK(cause({.exception = 3, .configurable_fault_status = 1u << 12, .fault_address = 0x1234}) ==
        "The processor could not continue: the stack was in unmapped memory on exception entry: the stack has "
        "overflowed, "
        "or the stack pointer is wrong.");
  CHECK(cause({.exception = 3, .configurable_fault_status = 1u << 1 | 1u << 4 | address_of_protection})
            .find("overflowed") != std::string::npos);
  CHECK(cause({.exception = 3, .configurable_fault_status = 1u << 25}) ==
        "The processor could not continue: it divided by zero.");
  CHECK(cause({.exception = 7}) == "The processor raised exception 7.");
}

TEST_CASE("the chain of calls begins where the crash was, and ends with the first that is missing") {
  CHECK(chain({.exception = 3}).empty());
  CrashFacts crash{.exception = 3, .program_counter = 0x100, .stack_pointer = 0x1000, .callers = {0x200, 0x200, 0x300}};
  CHECK(chain(crash) == std::vector<std::uint32_t>{0x100, 0x200, 0x300});
  crash.program_counter = 0;  // a call through a null pointer
  CHECK(chain(crash) == std::vector<std::uint32_t>{0, 0x200, 0x300});
}

TEST_CASE("without an image the text has the addresses, the registers and how to get names") {
  const std::string with_stack = text(
      {.exception = 3, .program_counter = 0x800'1234, .stack_pointer = 0x1000'1000, .registers = {0xABCD}}, nullptr);
  CHECK(with_stack.find("at   0x08001234\n") != std::string::npos);
  CHECK(with_stack.find("r0  0000abcd") != std::string::npos);
  CHECK(with_stack.find("sp 10001000") != std::string::npos);
  CHECK(with_stack.find("`inkwell fault --elf FILE`") != std::string::npos);
  const std::string without_stack = text({.exception = 3}, nullptr);
  CHECK(without_stack.find("the stack could not be read") != std::string::npos);
  CHECK(without_stack.find("--elf") == std::string::npos);
}

TEST_CASE("a file that is not an ELF image of the board is refused") {
  CHECK_THROWS_WITH_AS(FirmwareImage("/nowhere/inkwell.elf"),
                       "Cannot read /nowhere/inkwell.elf: No such file or directory. Check its name.", device::Error);
  CHECK_THROWS_AS(FirmwareImage("/proc/self/exe"), device::Error);
  CHECK_THROWS_AS(FirmwareImage("/proc/self/cmdline"), device::Error);
}

}  // namespace inkwell::crash
