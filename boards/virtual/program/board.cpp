#include "boards/virtual/program/board.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include "boards/stm32f405/debugger/cpu_fault_report.hpp"

#include "boards/virtual/program/log.hpp"

namespace inkwell::virtual_board {
namespace {

std::string_view name_of(ResetCause cause) {
  switch (cause) {
    case ResetCause::pin: return "the reset pin";
    case ResetCause::power_on: return "power-on";
    case ResetCause::software: return "software";
    case ResetCause::independent_watchdog: return "the independent watchdog";
    case ResetCause::window_watchdog: return "the window watchdog";
    case ResetCause::low_power: return "low-power management";
    case ResetCause::brown_out: return "a supply voltage that fell below or rose above the brown-out level";
  }
  return "an unknown cause";
}

}  // namespace

Board::Board(const Options& options, const local::SocketAddress& usbip, std::function<void()> on_usb_request,
             std::function<bool()> is_ending)
    : elf_(options.elf),
      facts_(*options.board),
      plant_(arms::read(options.arm), facts_, {.seed = options.seed}),
      chip_(wires_, {.mode = options.mode,
                     .pricing = options.pricing,
                     .crystal_Hz = options.crystal_Hz.value_or(facts_.crystal_Hz),
                     .crystal_ppm = options.crystal_ppm,
                     .low_speed_internal_Hz = options.low_speed_internal_Hz,
                     .brown_out_level = options.brown_out_level,
                     .slowest_flash = options.slowest_flash,
                     .unique_id = options.unique_id,
                     .random_seed = static_cast<std::uint32_t>(options.seed),
                     .log = [](const std::string& line) { log_line(line); },
                     .name_of_code = [this](std::uint32_t address) { return symbols_.name(address); },
                     .on_instruction = observer(options)}) {
  if (options.strict) chip_.on_violation = [this](const Violation&) { chip_.request_stop(); };
  if (!options.flash.empty()) flash_file_.emplace(options.flash, chip_.flash());
  if (!elf_.empty()) {
    chip_.load_elf(elf_);
    symbols_ = Symbols(elf_);
  }
  if (flash_file_) flash_file_->save(chip_.flash());
  usb_.emplace(chip_.connections(), usbip, options.host_clock_ppm, std::move(on_usb_request), std::move(is_ending));
  if (options.real_time && !options.lock_step) usb_->limit_waiting();
  if (options.lock_step) usb_->keep_in_lock_step([this] { chip_.request_stop(); });
  chip_.add_peripheral(OtgFsDevice::base, OtgFsDevice::size, "OTG_FS", usb_->connector());
  chip_.on_boot_loader = [this] { return usb_->connector().boot_loader_order(chip_.debug_port()); };
  chip_.on_injected_sequence = [this](std::uint64_t index, Ticks when) {
    control_period_ = {index, when};
    if (trace_.is_running()) trace_.record(index, plant_.truth(when));
  };
  chip_.on_console = [this](std::uint8_t byte) { console(byte); };
  wires_.connect(chip_.input_pins());
  plant_.connect(wires_);
  injector_.emplace(Injector::Victims{chip_, plant_, wires_, options.crystal_ppm, [this](bool in) { plug(in); },
                                      [this](bool polls) { usb_->set_host_polling(polls); }},
                    options.seed);
  plug(true);
  chip_.reset(ResetCause::power_on);
  if (options.from_boot_loader) chip_.start_by_boot_loader();
  if (options.boot_loader) chip_.start_boot_loader();
  if (!options.waveform.empty()) waveform_.emplace(options.waveform, options.waveform_pins, chip_);
  for (const Injection& injection : options.injections) injector_->add(injection);
  chip_.clear_counters();  // initial resets are not counted
  chip_.on_reset = [this](ResetCause cause) {
    locked_up_ = false;
    if (trace_.is_running()) trace_.start();  // control periods restart from 0
    log_line(chip_.now(), fmt::format("the chip was reset by {}", name_of(cause)));
  };
}

std::function<void(std::uint32_t, std::uint64_t)> Board::observer(const Options& options) {
  if (!options.profile) return {};
  return [this](std::uint32_t address, std::uint64_t cycles) {
    profile_.instruction(chip_.current_exception(), address, cycles);
  };
}

Board::~Board() {
  if (!flash_file_ || chip_.flash_operations() == flash_saved_) return;
  try {
    flash_file_->save(chip_.flash());
  } catch (const std::runtime_error& error) {
    log_line(error.what());
  }
}

void Board::follow_flash() {
  if (!flash_file_) return;
  const std::uint64_t operations = chip_.flash_operations();
  if (operations != flash_saved_ && operations == flash_seen_) {
    flash_file_->save(chip_.flash());
    flash_saved_ = operations;
  }
  flash_seen_ = operations;
}

Stop Board::run_until(Ticks when) {
  follow_flash();
  for (;;) {
    if (injector_->next() <= chip_.now()) injector_->carry_out();
    const Ticks next = injector_->next();
    const Stop stop = run_chip_until(std::min(when, next));
    const bool goes_on = stop == Stop::time_reached || stop == Stop::locked_up;
    if (!goes_on || next >= when) return stop;
  }
}

Stop Board::run_chip_until(Ticks when) {
  const Stop stop = chip_.run_until(when);
  if (stop == Stop::locked_up && !locked_up_) {
    locked_up_ = true;
    for (const auto& line : explain_cpu_fault(chip_, symbols_, elf_)) log_line(line);
  }
  return stop;
}

void Board::plug(bool in) {
  if (in)
    usb_->connect();
  else
    usb_->disconnect();
  plant_.set_usb_supply(in);
}

void Board::reset() { chip_.reset(ResetCause::pin); }

void Board::console(std::uint8_t byte) {
  constexpr std::size_t longest_line = 400;  // limits the memory for firmware that never ends its line
  if (byte == '\r') return;
  if (byte != '\n') console_line_ += byte >= 32 && byte < 127 ? static_cast<char>(byte) : '?';
  if (byte != '\n' && console_line_.size() < longest_line) return;
  log_line(chip_.now(), "firmware: " + console_line_);
  console_line_.clear();
}

}  // namespace inkwell::virtual_board
