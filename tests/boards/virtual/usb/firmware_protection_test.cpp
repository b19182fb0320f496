// Checks that the memory protection stops the flashed firmware after deliberate errors.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "boards/stm32f405/core/debug_port.hpp"
#include "boards/stm32f405/core/memory_map.hpp"
#include "protocol/black_box.hpp"

#include "tests/boards/virtual/usb/firmware_on_bus.hpp"

namespace inkwell::virtual_usb_test {
namespace {

using virtual_board::CoreRegisters;

constexpr std::uint16_t load_by_r0 = 0x6800, store_by_r0 = 0x6000;  // ldr r0, [r0]; str r0, [r0]
constexpr std::uint32_t if_then_bits = 0x0600'FC00;                 // in xPSR: IT state

// Addresses within .text and .interrupt_text (boards/facts/stm32f405.ld).
constexpr std::uint32_t code = virtual_board::flash_base + 0x1'5000, interrupt_code = 0x1'4200;

std::uint16_t half_word(const FirmwareOnBus& bus, std::uint32_t address) {
  return static_cast<std::uint16_t>(bus.chip.memory_word(address & ~3u) >> 8 * (address & 2));
}

/// Returns the address of a flash half word with the value of this instruction.
std::uint32_t address_of(const FirmwareOnBus& bus, std::uint16_t instruction) {
  for (std::uint32_t address = code; address < code + 0x1'0000; address += 2)
    if (half_word(bus, address) == instruction) return address;
  return 0;
}

/// Returns the crash record of the board.
protocol::CrashFacts crash_of(FirmwareOnBus& bus) {
  const auto answer = bus.control(0xA1, 1, 0x0300 | static_cast<std::uint16_t>(protocol::ReportId::black_box), 0,
                                  sizeof(protocol::BlackBoxReport));
  protocol::BlackBoxReport report;
  REQUIRE(answer.data.size() == sizeof report);
  std::memcpy(&report, answer.data.data(), sizeof report);
  return report.crash;
}

/// At this time the control interrupt runs, and the self-test has not started. Without motors the self-test would fail
/// and store a fault.
constexpr double before_self_test_s = 0.05;

constexpr unsigned control_interrupt = 16 + 18;

void run_into_control_interrupt(FirmwareOnBus& bus) {
  while (bus.chip.current_exception() != control_interrupt) bus.run_for(1e-6);
}

/// Runs until a control interrupt has returned. A fault in the main loop's sleep would have another type, because
/// interrupts are masked.
void run_into_main_loop(FirmwareOnBus& bus) {
  run_into_control_interrupt(bus);
  while (bus.chip.current_exception() != 0) bus.run_for(1e-6);
}

/// During sleep the stack does not change before the next interrupt.
void run_into_sleep(FirmwareOnBus& bus) {
  constexpr double step_s = 1e-6;
  for (Ticks before = 0; bus.chip.counters().asleep - before < virtual_board::ticks(step_s);) {
    before = bus.chip.counters().asleep;
    bus.run_for(step_s);
  }
}

/// Returns the crash record of a fault with this program counter and r0.
protocol::CrashFacts crash_at(std::uint32_t program_counter, std::uint32_t r0) {
  FirmwareOnBus bus(flashed_image());
  bus.run_for(before_self_test_s);
  run_into_main_loop(bus);
  CoreRegisters registers = bus.chip.debug_port().core_registers();
  for (std::uint32_t i = 1; i <= 12; ++i) registers.general[i] = 0x1111'1111 * i;
  registers.general[0] = r0;
  registers.general[CoreRegisters::pc] = program_counter;
  bus.chip.debug_port().set_core_registers(registers);
  bus.run_for(0.2);
  bus.connect();
  const auto crash = crash_of(bus);
  CHECK(crash.stack_pointer == registers.general[CoreRegisters::sp]);
  CHECK(crash.registers[0] == r0);
  for (std::uint32_t i = 1; i <= 12; ++i) CHECK(crash.registers[i] == 0x1111'1111 * i);
  return crash;
}

/// Returns the first address at or after `begin` for which the two preceding half words satisfy `are_such`.
std::uint32_t address_after(const FirmwareOnBus& bus, std::uint32_t begin,
                            const std::function<bool(std::uint16_t last, std::uint16_t before)>& are_such) {
  std::uint32_t address = begin + 4;
  while (!are_such(half_word(bus, address - 2), half_word(bus, address - 4))) {
    address += 2;
    REQUIRE(address < begin + 0x1'0000);
  }
  return address;
}

// Encodings: ARMv7-M, A7.7.18 and A7.7.19.
bool is_first_half_of_bl(std::uint16_t half) { return half >> 11 == 0b11110; }
bool is_second_half_of_bl(std::uint16_t half) { return (half >> 14 & 3) == 3 && (half >> 12 & 1) == 1; }
bool is_blx(std::uint16_t half) { return half >> 7 == 0b0100'0111'1 && half % 8 == 0; }
bool is_bl(std::uint16_t last, std::uint16_t before) {
  return is_first_half_of_bl(before) && is_second_half_of_bl(last);
}
bool is_call(std::uint16_t last, std::uint16_t before) { return is_blx(last) || is_bl(last, before); }

/// Reads a null pointer with these values in the link register and on the stack. Returns the resulting crash record.
protocol::CrashFacts crash_with_stack(std::uint32_t link_register, std::span<const std::uint32_t> words) {
  FirmwareOnBus bus(flashed_image());
  bus.run_for(before_self_test_s);
  run_into_main_loop(bus);
  CoreRegisters registers = bus.chip.debug_port().core_registers();
  const std::uint32_t stack_top = bus.chip.memory_word(virtual_board::flash_base);
  registers.general[0] = 0;
  registers.general[CoreRegisters::sp] = stack_top - static_cast<std::uint32_t>(words.size_bytes());
  registers.general[CoreRegisters::lr] = link_register;
  registers.general[CoreRegisters::pc] = address_of(bus, load_by_r0);
  constexpr std::uint32_t negative_and_carry = 0xA000'0000, is_thumb = 1u << 24, all_flags = 0xF800'0000;
  registers.xpsr = (registers.xpsr & ~(if_then_bits | all_flags)) | negative_and_carry;
  std::vector<std::uint8_t> bytes(words.size_bytes());
  if (!words.empty()) std::memcpy(bytes.data(), words.data(), bytes.size());
  REQUIRE(bus.chip.debug_port().write(registers.general[CoreRegisters::sp], bytes));
  bus.chip.debug_port().set_core_registers(registers);
  bus.run_for(0.2);
  bus.connect();
  const auto crash = crash_of(bus);
  CHECK(crash.exception == 4);
  CHECK(crash.stack_pointer == registers.general[CoreRegisters::sp]);
  CHECK(crash.link_register == link_register);
  constexpr std::uint32_t stack_was_aligned = 1u << 9;
  CHECK(crash.program_status ==
        (negative_and_carry | is_thumb | (crash.stack_pointer % 8 != 0 ? stack_was_aligned : 0)));
  return crash;
}

}  // namespace

TEST_CASE("each invalid memory access or jump raises a CPU fault with its program counter") {
  const FirmwareOnBus bus(flashed_image());
  const std::uint32_t load = address_of(bus, load_by_r0), store = address_of(bus, store_by_r0);
  REQUIRE(load != 0);
  REQUIRE(store != 0);
  constexpr std::uint32_t no_instruction = 1, no_data = 2, valid_address = 0x80;
  struct Error {
    std::string name;
    std::uint32_t program_counter, r0, status;
  };
  const Error errors[] = {
      {"a null pointer is read", load, 0, no_data | valid_address},
      {"a null pointer is written", store, 8, no_data | valid_address},
      {"the flash is written", store, 0x0801'8000, no_data | valid_address},
      {"behind the flash", load, 0x0810'0000, no_data | valid_address},
      {"the interrupt code is written", store, 0x0001'4100, no_data | valid_address},
      {"the last word of the interrupt code is written", store, 0x0001'BFFC, no_data | valid_address},
      {"the interrupt code is written at its address in SRAM1", store, 0x2001'4100, no_data | valid_address},
      {"SRAM1 is read at address 0, before the interrupt code", load, 0x0001'3FFC, no_data | valid_address},
      {"SRAM2 is run", 0x2001'C100, 0, no_instruction},
      {"the tables of interrupts are written", store, 0x1000'F800, no_data | valid_address},
      {"a bit's alias", store, 0x2200'0004, no_data | valid_address},
      {"data are run", 0x2000'0100, 0, no_instruction},
      {"null is run", 0x0000'0000, 0, no_instruction},
      {"nothing answers", load, 0x6000'0000, (no_data | valid_address) << 8},
  };
  for (const Error& error : errors) {
    CAPTURE(error.name);
    const auto crash = crash_at(error.program_counter, error.r0);
    CHECK(crash.exception == (error.status < 1u << 8 ? 4 : 5));  // MemManage, BusFault
    CHECK(crash.hard_fault_status == 0);
    CHECK(crash.configurable_fault_status == error.status);
    CHECK(crash.program_counter == error.program_counter);
    if ((error.status & (valid_address | valid_address << 8)) != 0) CHECK(crash.fault_address == error.r0);
  }
}

TEST_CASE("without a stack the bridges switch off immediately, although no exception frame can be stored") {
  constexpr std::uint32_t memory_bottom = virtual_board::ccm_base, behind_ram = 0x2002'1000;
  constexpr std::uint16_t push = 0xB510, undefined = 0xDEFF;
  enum class Context { main_loop, control_interrupt, sleep };
  struct Loss {
    std::string name;
    std::uint32_t stack_pointer;
    Context context;
    std::uint16_t instruction;  ///< instruction that the core executes; 0: its next instruction
    std::uint32_t status, exception;
  };
  const Loss losses[] = {
      {"it overflows by a push", memory_bottom, Context::main_loop, push, 1u << 4, 3},
      {"the same in the control interrupt", memory_bottom, Context::control_interrupt, push, 1u << 4, 3},
      {"it overflows by an interrupt", memory_bottom, Context::sleep, 0, 1u << 4, 4},
      {"it lies where nothing is", behind_ram, Context::main_loop, push, 1u << 12, 3},
      {"the same, and an interrupt comes", behind_ram, Context::sleep, 0, 1u << 12, 5},
      {"the same, and then no instruction", behind_ram, Context::main_loop, undefined, 1u << 12 | 1u << 16,
       5},  // a BusFault of the stack
  };
  for (const Loss& loss : losses) {
    CAPTURE(loss.name);
    FirmwareOnBus bus(flashed_image());
    bus.run_for(before_self_test_s);
    bus.chip.clear_counters();
    switch (loss.context) {
      case Context::main_loop: run_into_main_loop(bus); break;
      case Context::control_interrupt: run_into_control_interrupt(bus); break;
      case Context::sleep: run_into_sleep(bus); break;
    }
    CoreRegisters registers = bus.chip.debug_port().core_registers();
    registers.general[CoreRegisters::sp] = loss.stack_pointer;
    if (loss.instruction != 0) {
      registers.general[CoreRegisters::pc] = address_of(bus, loss.instruction);
      registers.xpsr &= ~if_then_bits;
      REQUIRE(registers.general[CoreRegisters::pc] != 0);
    }
    bus.chip.debug_port().set_core_registers(registers);
    bus.run_for(0.001);  // shorter than the watchdog time
    using virtual_board::ResetCause;
    CHECK(bus.chip.counters().resets[static_cast<std::size_t>(ResetCause::software)] == 1);
    bus.run_for(0.2);
    bus.connect();
    const auto crash = crash_of(bus);
    CHECK(crash.exception == loss.exception);
    CHECK((crash.configurable_fault_status & loss.status) == loss.status);
    constexpr std::uint32_t forced = 1u << 30;
    CHECK(crash.hard_fault_status == (loss.exception == 3 ? forced : 0));
    CHECK(crash.stack_pointer == 0);
  }
}

TEST_CASE("a crash report contains the first eight return addresses from the link register and the stack") {
  FirmwareOnBus bus(flashed_image());
  bus.run_for(before_self_test_s);  // by this time, the startup code has copied the interrupt code
  const auto behind_bl = [&](std::uint32_t begin) { return address_after(bus, begin, is_bl); };
  const std::uint32_t by_address = behind_bl(code), later = behind_bl(by_address),
                      in_interrupt = behind_bl(interrupt_code);
  const std::uint32_t by_register = address_after(
      bus, code, [](std::uint16_t last, std::uint16_t before) { return is_blx(last) && !is_bl(last, before); });
  REQUIRE(later != by_address);

  SUBCASE("words that are not return addresses are ignored") {
    const std::uint32_t only_first_half = address_after(bus, code, [](std::uint16_t last, std::uint16_t before) {
      return is_first_half_of_bl(before) && !is_call(last, before);
    });
    const std::uint32_t only_second_half = address_after(bus, code, [](std::uint16_t last, std::uint16_t before) {
      return is_second_half_of_bl(last) && !is_call(last, before);
    });
    const std::uint32_t words[] = {
        by_address,  // a return address in Thumb code is odd
        only_first_half | 1,
        only_second_half | 1,
        in_interrupt | 1,
        0x0000'0101,                         // null
        virtual_board::flash_base + 0x8101,  // the parameters
        0x0810'0001,                         // after the flash
        0x2002'0101,                         // after the memory
        0x4001'0001,                         // a peripheral
        0xFFFF'FFFF,
        by_register | 1,
    };
    const auto crash = crash_with_stack(by_address | 1, words);
    const std::vector<std::uint32_t> expected{by_address, in_interrupt, by_register, 0, 0, 0, 0, 0};
    CHECK(std::ranges::equal(crash.callers, expected));
  }

  SUBCASE("more than have room") {
    std::vector<std::uint32_t> words(10, by_address | 1);
    words[6] = by_register | 1;  // the eighth caller, counted with the link register
    const auto crash = crash_with_stack(later | 1, words);
    const std::vector<std::uint32_t> expected{later,      by_address, by_address, by_address,
                                              by_address, by_address, by_address, by_register};
    CHECK(std::ranges::equal(crash.callers, expected));
    CHECK(crash.image_check == crash_with_stack(0, {}).image_check);
  }
}

}  // namespace inkwell::virtual_usb_test
