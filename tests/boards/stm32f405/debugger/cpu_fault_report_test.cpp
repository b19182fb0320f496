#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include "boards/stm32f405/debugger/cpu_fault_report.hpp"

#include "tests/temporary_directory.hpp"

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using namespace inkwell::virtual_board::test;

TEST_SUITE("virtual board: debugger") {
  TEST_CASE(
      "a symbol table returns the function and offset of a code address, and an empty name for any other address") {
    const Symbols symbols{firmware_path("lock_up")};
    ChipUnderTest test("lock_up");
    const std::uint32_t reset = test.chip.memory_word(0x0800'0004) & ~1u;
    CHECK(symbols.name(reset) == "reset_handler");
    CHECK(symbols.name(reset + 2) == "reset_handler+0x2");
    CHECK(symbols.name(0x0800'0000).empty());
    CHECK(symbols.name(0x2000'0000).empty());
    CHECK(Symbols().name(reset).empty());
    CHECK(Symbols("/nowhere/at/all.elf").name(reset).empty());

    // If a file is truncated at any position, the reader returns all symbols or no symbols.
    std::ifstream whole(firmware_path("lock_up"), std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(whole), {}};
    const inkwell::tests::TemporaryDirectory directory;
    const auto path = directory / "cut_symbols.elf";
    for (std::size_t bytes = 0; bytes < content.size(); bytes += 997) {
      std::ofstream(path, std::ios::binary) << content.substr(0, bytes);
      Symbols{path}.name(reset);
    }
  }

  TEST_CASE("callers are the words in LR and on the stack that point to an instruction after a call") {
    std::map<std::uint32_t, std::uint32_t> memory{
        {0x0800'0100, 0xF800'F000},                                                          // BL at 0x08000100
        {0x0800'0200, 0x4798'BF00},                                                          // BLX R3 at 0x08000202
        {0x0800'0300, 0xBF00'BF00}, {0x2000'0000, 0x0800'0205}, {0x2000'0004, 0x0800'0204},  // even: data
        {0x2000'0008, 0x0800'0305},                                                          // not after a call
        {0x2000'000C, 0x0800'0105},
    };
    CoreRegisters registers;
    registers.general[CoreRegisters::lr] = 0x0800'0105;
    registers.general[CoreRegisters::sp] = 0x2000'0000;
    const auto word = [&](std::uint32_t address) { return memory[address]; };
    CHECK(guess_callers(registers, word, 8) == std::vector<std::uint32_t>{0x0800'0104, 0x0800'0204, 0x0800'0104});
    CHECK(guess_callers(registers, word, 2).size() == 2);
    registers.general[CoreRegisters::lr] = 0xFFFF'FFF9;
    CHECK(guess_callers(registers, word, 8) == std::vector<std::uint32_t>{0x0800'0204, 0x0800'0104});
  }

  TEST_CASE("a lock-up is explained by its first fault, not by the breakpoint in the handler") {
    for (const Mode mode : {Mode::exact, Mode::fast}) {
      CAPTURE(static_cast<int>(mode));
      ChipUnderTest test("lock_up", mode);
      CHECK(explain_cpu_fault(test.chip, {}, "x.elf").empty());
      REQUIRE(test.chip.run_until(ticks(0.01)) == Stop::locked_up);
      CHECK(test.chip.lockup_reason().find("breakpoint") != std::string::npos);
      std::string text;
      const std::filesystem::path elf = firmware_path("lock_up");
      for (const auto& line : explain_cpu_fault(test.chip, Symbols(elf), elf)) text += line + "\n";
      CAPTURE(text);
      for (const char* part : {"nothing answers on the bus at 0x60000000", "thread mode", "read_too_far", "sum_up+0x",
                               "run()+0x", "reset_handler+0x", "R0  60000000", "addr2line"})
        CHECK(text.find(part) != std::string::npos);
      CHECK(text.find("read_too_far") < text.find("sum_up"));
      CHECK(text.find("sum_up") < text.find("run()"));
      test.chip.reset();
      CHECK_FALSE(test.chip.first_fault());
    }
  }
}
