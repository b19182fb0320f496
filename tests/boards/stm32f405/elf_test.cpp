#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include "tests/failure.hpp"

#include "tests/temporary_directory.hpp"

#include "tests/boards/stm32f405/chip_fixture.hpp"

using namespace inkwell::virtual_board;
using inkwell::tests::contains;
using inkwell::tests::message_of;
using namespace inkwell::virtual_board::test;

namespace {

std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Returns the error message of load_elf for a file with this content.
std::string complaint(const std::string& content) {
  const inkwell::tests::TemporaryDirectory directory;
  const auto path = directory / "corrupt.elf";
  std::ofstream(path, std::ios::binary) << content;
  RecordingCircuit circuit;
  Chip chip(circuit);
  const std::string said = message_of<ChipError>([&] { chip.load_elf(path); });
  return said;
}

}  // namespace

TEST_SUITE("virtual chip: ELF") {
  TEST_CASE("a file that can not be loaded is refused with a sentence") {
    RecordingCircuit circuit;
    Chip chip(circuit);
    CHECK_THROWS_AS(chip.load_elf("/nowhere/at/all.elf"), ChipError);
    CHECK_THROWS_AS(chip.load_elf("/tmp"), ChipError);
    CHECK(contains(complaint(""), "not an ELF"));
    CHECK(contains(complaint("#!/bin/sh\n"), "not an ELF"));
    CHECK(contains(complaint(read_file("/proc/self/exe")), "not for a 32-bit ARM"));

    const std::string good = read_file(firmware_path("watchdog"));
    REQUIRE(complaint(good).empty());
    CHECK(contains(complaint(good.substr(0, 40)), "truncated"));
    CHECK(contains(complaint(good.substr(0, 60)), "truncated"));
    const std::string first_pages = good.substr(0, 0x1010);
    CHECK(contains(complaint(first_pages), "truncated"));

    std::string elsewhere = good;
    const std::uint32_t outside = 0x0900'0000;
    std::uint32_t headers = 0;
    std::memcpy(&headers, good.data() + 28, 4);
    std::memcpy(elsewhere.data() + headers + 12, &outside, 4);  // p_paddr of the first segment
    CHECK(contains(complaint(elsewhere), "0x09000000"));
    std::string relocatable = good;
    relocatable[16] = 1;
    CHECK(contains(complaint(relocatable), "not a linked executable"));
  }

  TEST_CASE("firmware for another address or another chip is named as that") {
    const std::string good = read_file(firmware_path("watchdog"));
    std::uint32_t headers = 0, vectors = 0;
    std::memcpy(&headers, good.data() + 28, 4);
    std::memcpy(&vectors, good.data() + headers + 4, 4);  // p_offset of the first segment
    const auto with_word = [&](std::uint32_t offset, std::uint32_t value) {
      std::string changed = good;
      std::memcpy(changed.data() + offset, &value, sizeof value);
      return changed;
    };
    CHECK(contains(complaint(with_word(headers + 12, 0x0800'4000)), "boot loader"));
    CHECK(contains(complaint(with_word(headers + 12, 0x0800'4000)), "0x08004000"));
    CHECK(contains(complaint(with_word(vectors + 4, 0)), "no vector table"));
    CHECK(contains(complaint(with_word(vectors + 4, 0x0900'0001)), "0x09000001"));
    CHECK(contains(complaint(with_word(18, 243)), "RISC-V"));

    // A second segment overlaps the vectors of the first segment. The last segment determines the flash content.
    std::string covered = good;
    const std::uint32_t segment_bytes = 32, header_words[] = {vectors, 0x0800'0004, 0x0800'0004, 1, 1};
    std::memcpy(covered.data() + headers + segment_bytes, good.data() + headers, segment_bytes);
    std::memcpy(covered.data() + headers + segment_bytes + 4, header_words, sizeof header_words);
    covered[vectors] = '\x3A';
    CHECK(contains(complaint(covered), "no vector table"));

    // A stack pointer beyond the RAM is a warning, because firmware can change the stack pointer.
    const inkwell::tests::TemporaryDirectory directory;
    const auto path = directory / "other_chip.elf";
    std::ofstream(path, std::ios::binary) << with_word(vectors, 0x2003'0000);
    ChipUnderTest test("watchdog");
    test.breaks_rules = true;
    CHECK(test.log.empty());
    test.chip.load_elf(path);
    REQUIRE(test.log.size() == 1);
    CHECK(contains(test.log[0], "0x20030000"));
    CHECK(contains(test.log[0], "another chip"));
    CHECK(test.chip.run_until(test.chip.now() + ticks(0.001)) == Stop::locked_up);
    REQUIRE(test.chip.first_fault());
    CHECK(contains(test.chip.first_fault()->what, "0x2002F"));
    CHECK(test.has_broken(Rule::stack_outside_memory));
  }

  TEST_CASE("a refused file leaves the flash as it was") {
    ChipUnderTest test("watchdog");
    const std::uint32_t before = test.chip.memory_word(0x0800'0004);
    CHECK_THROWS_AS(test.chip.load_elf("/proc/self/exe"), ChipError);
    CHECK(test.chip.memory_word(0x0800'0004) == before);
    test.run_for(0.2);
    CHECK(test.result(0) == finished);
  }
}
