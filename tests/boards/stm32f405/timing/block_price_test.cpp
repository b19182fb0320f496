// Checks the cycle counts of short programs against the rules in the core's manuals.
#include <doctest/doctest.h>

#include <cstring>
#include <initializer_list>
#include <vector>
#include "boards/stm32f405/timing/block_price.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr Costs likely{Pricing::likely}, conservative{Pricing::conservative};
constexpr std::uint32_t start = 0x0800'0000;

BlockPrice price_of(const std::vector<std::uint16_t>& program, std::uint32_t address = start,
                    const Costs& costs = likely, CodeMemory memory = CodeMemory::flash) {
  std::vector<std::uint8_t> code(program.size() * 2);
  std::memcpy(code.data(), program.data(), code.size());
  return price(code, address, memory, costs);
}
unsigned cycles(std::initializer_list<std::uint16_t> program, std::uint32_t address = start) {
  return price_of(program, address).cycles;
}

// adds r0, r0, #1
constexpr std::uint16_t add_r0 = 0x3001, add_r1 = 0x3101, nop = 0xBF00;
constexpr std::uint16_t load_r0_from_r4 = 0x6820, load_r1_from_r5 = 0x6829, load_r2_from_r6 = 0x6832;
constexpr std::uint16_t load_r1_from_r0 = 0x6801, store_r1_to_r5 = 0x6029, store_r2_to_r6 = 0x6032;
constexpr std::uint16_t store_r1_to_r5_r6 = 0x51A9;

TEST_CASE("each addition or multiplication of integers takes one cycle") {
  CHECK(cycles({add_r0, add_r1, nop}) == 3);
  CHECK(cycles({0x4348}) == 1);          // muls r0, r1, r0
  CHECK(cycles({0xFBA0, 0x1202}) == 1);  // umull r1, r2, r0, r2
}

TEST_CASE("n loads that do not depend on each other take n + 1 cycles") {
  CHECK(cycles({load_r0_from_r4, add_r1}) == 3);
  CHECK(cycles({load_r0_from_r4, load_r1_from_r5, add_r1}) == 4);
  CHECK(cycles({load_r0_from_r4, load_r1_from_r5, load_r2_from_r6, add_r1}) == 5);
}

TEST_CASE("an address that the instruction before has computed costs a cycle") {
  CHECK(cycles({0x3401, load_r0_from_r4, add_r1}) == 5);                       // adds r4, #1
  CHECK(cycles({0x3401, add_r1, load_r0_from_r4, add_r1}) == 5);               // hidden by the instruction in between
  CHECK(cycles({load_r0_from_r4, load_r1_from_r0, add_r1}) == 2 + 1 + 2 + 1);  // a pointer chain
}

TEST_CASE("a store takes one cycle, even after a load, and a load after a store waits") {
  CHECK(cycles({store_r1_to_r5, store_r2_to_r6, add_r0}) == 3);
  CHECK(cycles({load_r0_from_r4, store_r1_to_r5, add_r1}) == 3);
  CHECK(cycles({store_r1_to_r5, load_r0_from_r4, add_r1}) == 5);
  CHECK(cycles({store_r1_to_r5_r6, add_r0}) == 3);
  CHECK(cycles({store_r1_to_r5_r6, nop, add_r0}) == 3);
}

TEST_CASE("several registers: one and a cycle each") {
  CHECK(cycles({0xB4F0}) == 5);          // push {r4-r7}
  CHECK(cycles({0xC80F}) == 5);          // ldm r0!, {r0-r3}
  CHECK(cycles({0xE9D0, 0x1200}) == 3);  // ldrd r1, r2, [r0]
}

TEST_CASE("branches: one cycle, and the refill if they are taken") {
  CHECK(price_of({0xD1FE}).cycles == 1);  // bne
  CHECK(price_of({0xD1FE}).taken_cycles == 1);
  CHECK(price_of({0x4770}).taken_cycles == 2);  // bx lr
  const auto pop = price_of({0xBD10});          // pop {r4, pc}
  CHECK(pop.cycles + pop.taken_cycles == 1 + 2 + 3);
  CHECK(price_of({0xD1FE}, start, conservative).taken_cycles == 2);
  CHECK(price_of({0xD1FE}, 0x2000'0000, likely, CodeMemory::sram).taken_cycles == 2);
}

TEST_CASE("code in SRAM1 at address 0 waits for no bus, but literals delay its fetch") {
  const auto price_in = [](CodeMemory memory, const std::vector<std::uint16_t>& code, const Costs& costs = likely) {
    return price_of(code, 0x1'4000, costs, memory);
  };
  CHECK(price_in(CodeMemory::remapped_sram, {0xD1FE}).taken_cycles == 1);  // bne
  // Each instruction of four bytes needs the next fetched word, so a delayed fetch costs a cycle.
  const std::vector<std::uint16_t> literals{0xF8DF, 0x0010, 0xF8DF, 0x1010, 0xF8DF,
                                            0x2010, 0xF8DF, 0x3010, 0xF100, 0x0001};
  const std::vector<std::uint16_t> data{0xF8D4, 0x0010, 0xF8D4, 0x1010, 0xF8D4, 0x2010, 0xF8D4, 0x3010, 0xF100, 0x0001};
  CHECK(price_in(CodeMemory::remapped_sram, data).cycles == price_in(CodeMemory::flash, data).cycles);
  CHECK(price_in(CodeMemory::remapped_sram, literals).cycles > price_in(CodeMemory::flash, literals).cycles);
  CHECK(price_in(CodeMemory::remapped_sram, data, conservative).cycles ==
        price_in(CodeMemory::sram, data, conservative).cycles);
}

TEST_CASE("a branch to a wide instruction across two words waits for the second") {
  CHECK(price_of({0xF100, 0x0001}, start).refill_cycles == 0);  // add.w r0, r0, #1
  CHECK(price_of({0xF100, 0x0001}, start + 2).refill_cycles == 1);
  CHECK(price_of({add_r0, add_r1}, start + 2).refill_cycles == 0);
}

TEST_CASE("IT folds into a narrow instruction before it") {
  CHECK(cycles({add_r1, 0xBF08, 0x2001}) == 2);  // adds; it eq; moveq
  CHECK(cycles({0xBF08, 0x2001}) == 2);
  CHECK(cycles({0xF100, 0x0001, 0xBF08, 0x2001}) == 3);
}

TEST_CASE("the cycle count includes FPU latency, multiply-accumulate latency and a division in parallel to the core") {
  // vadd.f32 s0, s1, s2; vmul.f32 s3, s0, s4 / s5
  CHECK(cycles({0xEE30, 0x0A81, 0xEE60, 0x1A02}) == 3);
  CHECK(cycles({0xEE30, 0x0A81, 0xEE62, 0x1A82}) == 2);
  CHECK(cycles({0xEEA0, 0x0A81}) == 3);                      // vfma.f32 s0, s1, s2
  CHECK(cycles({0xEE30, 0x0A81, 0xEEA1, 0x0A21}) == 1 + 3);  // the addend is needed late enough
  CHECK(cycles({0xEE80, 0x0A81}) == 1);                      // vdiv.f32 s0, s1, s2
  CHECK(price_of({0xEE80, 0x0A81}).float_busy_cycles == 13);
  CHECK(cycles({0xEE80, 0x0A81, add_r0, 0xEE30, 0x1A81}) == 15);  // the next FPU instruction waits
  CHECK(cycles({0xED90, 0x0A00}) == 2);                           // vldr s0, [r0]
  CHECK(cycles({0xEC90, 0x0A04}) == 5);                           // vldm r0, {s0-s3}
}

TEST_CASE("a divide costs by the bits of its quotient, between 2 and 12 cycles") {
  CHECK(divide_cycles(3, 5, false, likely) == 2);
  CHECK(divide_cycles(7, 0, false, likely) == 2);
  CHECK(divide_cycles(0xFFFF'FFFF, 1, false, likely) == 12);
  CHECK(divide_cycles(100, 10, false, likely) < divide_cycles(100'000, 10, false, likely));
  CHECK(divide_cycles(0xFFFF'FFF0, 4, true, likely) == divide_cycles(16, 4, true, likely));  // -16 / 4
  CHECK(divide_cycles(3, 5, false, conservative) == 12);
}

TEST_CASE("a block records the flash lines that it fetches and the time of each fetch") {
  // Nine 16-bit instructions start at 0x...E. The first instruction is in one flash line, and the next eight
  // instructions are in the next flash line.
  const auto block = price_of({add_r0, add_r0, add_r0, add_r0, add_r0, add_r0, add_r0, add_r0, add_r0}, start + 14);
  REQUIRE(block.requests.size() == 2);
  CHECK(block.requests[0].address == start);
  CHECK(block.requests[1].address == start + 16);
  CHECK(block.requests[1].after_cycles == 1);
  CHECK(price_of({add_r0}, 0x2000'0000, likely, CodeMemory::sram).requests.empty());
}

TEST_CASE("a block records the addresses of literals and the base registers of table reads") {
  const auto literal = price_of({0x4801, add_r0});  // ldr r0, [pc, #4]
  REQUIRE(literal.requests.size() == 2);
  CHECK(literal.requests[1].is_data);
  CHECK(literal.requests[1].address == start + 8);
  // add r1, #1; ldrb r0, [r2, r1]: only the index register changes.
  const auto table = price_of({add_r1, 0x5C50});
  REQUIRE(table.reads.size() == 1);
  CHECK(table.reads[0].base_at_entry);
  CHECK_FALSE(table.reads[0].index_at_entry);
  // adr r2, .+4; ldrb r0, [r2, r1]
  const auto near = price_of({0xA200, 0x5C50});
  REQUIRE(near.reads.size() == 1);
  CHECK(near.reads[0].constant == start + 4);
  // movw r2, #0x1234; movt r2, #0x0801; ldr r0, [r2, #4]
  const auto far = price_of({0xF241, 0x2234, 0xF6C0, 0x0201, 0x6850});
  REQUIRE(far.reads.size() == 1);
  CHECK(far.reads[0].constant == 0x0801'1234);
  CHECK(far.reads[0].offset == 4);
}

}  // namespace
}  // namespace inkwell::virtual_board
