#include "boards/stm32f405/wiring/chip.hpp"
#include <fstream>
#include <iterator>

#include "boards/stm32f405/wiring/boot_loader.hpp"
#include "boards/stm32f405/wiring/execution.hpp"
#include "boards/stm32f405/wiring/parts.hpp"

namespace inkwell::virtual_board {
namespace {

std::vector<char> contents_of(const std::filesystem::path& image) {
  std::error_code ignored;
  if (std::filesystem::is_directory(image, ignored))
    throw ChipError(image.string() + " is a folder. Use the ELF file of the firmware.");
  std::ifstream stream(image, std::ios::binary);
  if (!stream)
    throw ChipError("There is no readable file " + image.string() + ". Build the firmware first, or correct the path.");
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

struct Chip::Parts : ChipParts {
  using ChipParts::ChipParts;
  Scheduler::Id end_of_halt = 0;
  std::array<std::uint32_t, exception_numbers> late_cycles{};
};

Chip::Chip(Circuit& circuit, const ChipOptions& options) : parts_(std::make_unique<Parts>(circuit, options)) {
  auto& p = *parts_;
  p.adcs.on_injected_sequence = [this](std::uint64_t index, Ticks when) {
    if (on_injected_sequence) on_injected_sequence(index, when);
  };
  p.machine.violations.on_first = [this](const Violation& violation) {
    if (on_violation) on_violation(violation);
  };
  p.execution.on_console = [this](std::uint8_t byte) {
    if (on_console) on_console(byte);
  };
  p.execution.on_boot_loader = [this] { return on_boot_loader ? on_boot_loader() : LoaderOrder{}; };
  p.execution.on_reset = [this](ResetCause cause) {
    if (on_reset) on_reset(cause);
  };
  for (auto& usart : p.usarts)
    usart.on_sent = [this](unsigned number, std::uint8_t byte) {
      if (on_usart) on_usart(number, byte);
      if (on_console) on_console(byte);
    };
  p.machine.nvic.on_held = [&p](unsigned exception) {
    const Ticks late = p.machine.clocks.hclk.duration(p.late_cycles[exception]);
    p.events.at(p.machine.timeline.now() + late, [&p, exception] { p.machine.nvic.let_go(exception); });
  };
  p.execution.reset(ResetCause::power_on);
}

Chip::~Chip() = default;

void Chip::load_elf(const std::filesystem::path& path) {
  const std::vector<char> file = contents_of(path);
  if (const std::string oddity = program_elf(file, path.string(), parts_->machine.memory); !oddity.empty())
    parts_->machine.log.say(oddity);
  parts_->machine.request_reset(ResetCause::power_on);
}

void Chip::reset(ResetCause cause) {
  // The reset waits until the running processor has stopped.
  if (parts_->execution.running()) {
    parts_->machine.request_reset(cause);
    parts_->processor.end_slice();
    return;
  }
  parts_->machine.reset_requested = false;
  parts_->execution.reset(cause);
}

Stop Chip::run_until(Ticks when) { return parts_->execution.run_until(when); }
void Chip::start_by_boot_loader() {
  jump(loader_go);
  parts_->exti.show_boot_loader_chosen();
}
void Chip::start_boot_loader() {
  jump(loader_entry);
  parts_->exti.show_boot_loader_chosen();
}
void Chip::jump(std::uint32_t address) { parts_->execution.jump(address); }
void Chip::stall(Ticks duration) { parts_->execution.stall(duration); }
void Chip::stall_thread(Ticks duration) { parts_->execution.stall_thread(duration); }
void Chip::halt(Ticks duration) {
  auto& p = *parts_;
  p.execution.halt(duration);
  p.events.cancel(p.end_of_halt);
  p.end_of_halt = p.events.at(now() + duration, [&p] { p.machine.debug_halt.set_halted(false); });
}
void Chip::glitch(char port, unsigned pin, Ticks duration) {
  auto& p = *parts_;
  const auto index = static_cast<unsigned>(port - 'A');
  p.pins.invert(index, pin, true);
  p.events.at(now() + duration, [&p, index, pin] { p.pins.invert(index, pin, false); });
}
void Chip::cut_power_at_flash_operation(std::uint64_t number) {
  parts_->flash.cut_power_at(number == 0 ? 0 : parts_->flash.operations() + number);
}
std::uint64_t Chip::flash_operations() const { return parts_->flash.operations(); }
void Chip::set_supply_V(double volts) {
  auto& machine = parts_->machine;
  machine.supply_V = machine.analog_supply_V = volts;
  parts_->power.update_supply();
  const auto threshold = parts_->flash.brown_out();
  const bool was_low = machine.supply_is_low;
  machine.supply_is_low = volts < (was_low ? threshold.rising_V : threshold.falling_V);
  if (machine.supply_is_low != was_low) reset(ResetCause::brown_out);
  parts_->flash.check_wait_states();
}
void Chip::set_analog_supply_V(double volts) { parts_->machine.analog_supply_V = volts; }
void Chip::lose_exception(unsigned exception, bool lost) { parts_->machine.nvic.lose(exception, lost); }
void Chip::delay_exception(unsigned exception, std::uint32_t cycles) {
  parts_->late_cycles[exception] = cycles;
  parts_->machine.nvic.hold_back(exception, cycles != 0);
}
bool Chip::flip_bit(std::uint32_t address, unsigned bit) {
  std::uint8_t* byte = parts_->machine.memory.at(address, 1);
  if (byte == nullptr) return false;
  *byte = static_cast<std::uint8_t>(*byte ^ 1u << (bit & 7));
  // Discards the translated blocks that contain the byte.
  parts_->processor.forget_code(address & ~3u, 4);
  return true;
}
void Chip::stop_converter(unsigned number, bool stopped) { parts_->adcs.converter(number - 1).stop(stopped); }
void Chip::stop_dma(bool stopped) {
  for (const unsigned number : {1u, 2u}) parts_->dma.controller(number).stop(stopped);
}
void Chip::drift_crystal(std::int32_t ppm) { parts_->rcc.drift_crystal(ppm); }
void Chip::let_crystal_swing(bool swings) { parts_->rcc.let_crystal_swing(swings); }
unsigned Chip::current_exception() const { return parts_->processor.current_exception(); }
void Chip::request_stop() { parts_->execution.request_stop(); }

DebugPort& Chip::debug_port() { return parts_->debug_port; }
Scheduler& Chip::scheduler() { return parts_->events; }
InterruptController& Chip::interrupts() { return parts_->machine.nvic; }
InputPins& Chip::input_pins() { return parts_->pins; }
PinLevel Chip::pin_level(char port, unsigned pin) const {
  return parts_->pins.level(static_cast<unsigned>(port - 'A'), pin);
}
PinLevel Chip::pin_output(char port, unsigned pin) const {
  return parts_->pins.output(static_cast<unsigned>(port - 'A'), pin);
}

void Chip::watch_pins(std::function<void(char, unsigned, PinLevel, Ticks)> changed) {
  auto& p = *parts_;
  if (!changed) {
    p.pins.on_level = {};
    return;
  }
  p.pins.on_level = [&p, changed = std::move(changed)](unsigned port, unsigned pin, PinLevel level) {
    changed(static_cast<char>('A' + port), pin, level, p.machine.timeline.now());
  };
  for (unsigned port = 0; port < Pins::ports; ++port)
    for (unsigned pin = 0; pin < 16; ++pin) p.pins.update(port, pin);
}

void Chip::watch_exceptions(std::function<void(unsigned, Ticks)> changed) {
  auto& p = *parts_;
  if (!changed) {
    p.processor.on_exception = {};
    return;
  }
  p.processor.on_exception = [&p, changed = std::move(changed)](unsigned exception) {
    changed(exception, p.processor.now());
  };
}
ChipConnections Chip::connections() {
  auto& machine = parts_->machine;
  return {parts_->events, machine.nvic, machine.log, machine.violations, *parts_, parts_->timers};
}

void Chip::add_peripheral(std::uint32_t base, std::uint32_t size, const std::string& name, Peripheral& peripheral) {
  parts_->add_outside_peripheral(base, size, name, peripheral);
}

void Chip::usart_receive(unsigned number, std::uint8_t byte) {
  if (number >= 1 && number <= parts_->usarts.size()) parts_->usarts[number - 1].receive(byte);
}

bool Chip::usart_listens(unsigned number) const {
  return number >= 1 && number <= parts_->usarts.size() && parts_->usarts[number - 1].listens();
}

std::size_t Chip::usart_waiting(unsigned number) const {
  return number >= 1 && number <= parts_->usarts.size() ? parts_->usarts[number - 1].waiting() : 0;
}

Ticks Chip::now() const { return parts_->machine.timeline.now(); }
Mode Chip::mode() const { return parts_->machine.options.mode; }
Clocks Chip::clocks() const { return parts_->machine.clocks.frequencies; }
const Counters& Chip::counters() const { return parts_->execution.counters(); }
void Chip::clear_counters() { parts_->execution.clear_counters(); }
int Chip::exit_code() const { return parts_->execution.exit_code(); }
const std::string& Chip::lockup_reason() const { return parts_->execution.lockup_reason(); }
const std::optional<Fault>& Chip::first_fault() const { return parts_->execution.first_fault(); }
const std::vector<Violation>& Chip::violations() const { return parts_->machine.violations.list(); }
const std::vector<std::string>& Chip::unmodelled_accesses() const { return parts_->machine.log.lines(); }
std::vector<RegisterMap> Chip::register_maps() const { return parts_->bus.register_maps(); }
bool Chip::sram1_is_at_zero() const { return parts_->machine.memory.at_zero() == MemoryAtZero::sram1; }
std::uint32_t Chip::memory_word(std::uint32_t address) const { return parts_->machine.memory.word(address); }

std::span<std::uint8_t> Chip::flash() { return {parts_->machine.memory.flash(), flash_bytes}; }

std::uint64_t Chip::state_hash() const {
  // FNV-1a hash of SRAM, CCM, cycle count and core registers.
  std::uint64_t hash = 0xCBF2'9CE4'8422'2325;
  const auto add = [&](const std::uint8_t* data, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) hash = (hash ^ data[i]) * 0x100'0000'01B3;
  };
  auto& memory = parts_->machine.memory;
  add(memory.sram(), sram_bytes);
  add(memory.ccm(), ccm_bytes);
  const std::uint64_t cycles = parts_->processor.cycles();
  add(reinterpret_cast<const std::uint8_t*>(&cycles), sizeof cycles);
  for (const int id : {UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3, UC_ARM_REG_R4, UC_ARM_REG_R5,
                       UC_ARM_REG_R6, UC_ARM_REG_R7, UC_ARM_REG_R8, UC_ARM_REG_R9, UC_ARM_REG_R10, UC_ARM_REG_R11,
                       UC_ARM_REG_R12, UC_ARM_REG_MSP, UC_ARM_REG_PSP, UC_ARM_REG_LR, UC_ARM_REG_XPSR}) {
    const std::uint32_t value = parts_->processor.read(id);
    add(reinterpret_cast<const std::uint8_t*>(&value), sizeof value);
  }
  return hash;
}

}  // namespace inkwell::virtual_board
