#include "flash.hpp"

#include <cstring>

#include "processor.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t acr = 0x00, keyr = 0x04, optkeyr = 0x08, sr = 0x0C, cr = 0x10, optcr = 0x14;
constexpr std::uint32_t end_of_operation = 1u << 0, operation_error = 1u << 1, alignment_error = 1u << 5,
                        size_error = 1u << 6, sequence_error = 1u << 7, busy = 1u << 16;
constexpr std::uint32_t programming = 1u << 0, sector_erase = 1u << 1, mass_erase = 1u << 2, start = 1u << 16,
                        end_interrupt = 1u << 24, error_interrupt = 1u << 25, lock = 1u << 31;
constexpr unsigned position = 4;
constexpr Ticks millisecond = ticks_per_s / 1000;

struct Sector {
  std::uint32_t base, bytes;
  Ticks erase_time;  ///< typical, x32 parallelism, data sheet
};
constexpr Sector sector(unsigned number) {
  if (number < 4) return {number * 0x4000, 0x4000, 250 * millisecond};
  if (number == 4) return {0x1'0000, 0x1'0000, 550 * millisecond};
  return {(number - 4) * 0x2'0000, 0x2'0000, 1000 * millisecond};
}

}  // namespace

FlashController::FlashController(Machine& machine) : machine_(machine), slot_(machine.timeline.add(*this)) {
  machine.flash = this;
  machine.clock_users.push_back(this);
}

void FlashController::reset() {
  access_ = status_ = 0;
  control_ = lock;
  unlock_step_ = 0;
  unlock_failed_ = false;
  machine_.timeline.set(slot_, never, never);
  update_interrupt();
}

void FlashController::check_wait_states() {
  // One wait state for each 30 MHz at 2.7 V to 3.6 V (RM0090, table "Number of wait states").
  const std::uint32_t hclk_Hz = machine_.clocks.frequencies.hclk_Hz;
  if (hclk_Hz > 30'000'000 * ((access_ & 7) + 1))
    machine_.log.say_once("FLASH_ACR.LATENCY " + std::to_string(access_ & 7) + " is too small for HCLK " +
                          std::to_string(hclk_Hz) + " Hz: a real chip would read wrong instructions");
}

void FlashController::update_interrupt() {
  const std::uint32_t errors = operation_error | alignment_error | size_error | sequence_error;
  machine_.nvic.set_source(position, 0,
                           ((control_ & end_interrupt) != 0 && (status_ & end_of_operation) != 0) ||
                               ((control_ & error_interrupt) != 0 && (status_ & errors) != 0));
}

void FlashController::begin(Ticks duration) {
  // On silicon a fetch from the flash stalls meanwhile; here the processor goes on and sees BSY.
  status_ |= busy;
  const Ticks done = machine_.timeline.now() + duration;
  machine_.timeline.set(slot_, done, done);
}

void FlashController::step(Ticks) {
  status_ &= ~busy;
  if ((control_ & end_interrupt) != 0) status_ |= end_of_operation;
  control_ &= ~start;
  machine_.timeline.set(slot_, never, never);
  update_interrupt();
}

std::optional<std::uint32_t> FlashController::program(std::uint32_t address, std::uint32_t value, unsigned size) {
  const std::uint8_t* place = machine_.memory.at(address, size);
  const std::uint32_t offset = address < flash_bytes ? address : address - flash_base;
  if (place == nullptr || offset >= flash_bytes) return {};
  std::uint32_t content = 0;
  std::memcpy(&content, place, size);
  const unsigned parallelism = 1u << (control_ >> 8 & 3);
  if ((control_ & lock) != 0 || (control_ & programming) == 0)
    status_ |= sequence_error;
  else if (address % size != 0)
    status_ |= alignment_error;
  else if (parallelism != size && !(parallelism == 8 && size == 4))
    status_ |= size_error;
  else {
    content &= value;  // programming only clears bits
    begin(16 * (ticks_per_s / 1'000'000));
  }
  update_interrupt();
  return content;
}

void FlashController::erase() {
  if ((control_ & mass_erase) != 0) {
    std::memset(machine_.memory.flash(), 0xFF, flash_bytes);
    machine_.processor->forget_code(flash_base, flash_bytes);
    begin(8000 * millisecond);
    return;
  }
  const unsigned number = control_ >> 3 & 0xF;
  if ((control_ & sector_erase) == 0 || number > 11) {
    status_ |= sequence_error;
    control_ &= ~start;
    update_interrupt();
    return;
  }
  const Sector erased = sector(number);
  std::memset(machine_.memory.flash() + erased.base, 0xFF, erased.bytes);
  machine_.processor->forget_code(flash_base + erased.base, erased.bytes);
  begin(erased.erase_time);
}

std::uint32_t FlashController::stored(std::uint32_t offset) const {
  return offset == acr ? access_ : offset == cr ? control_ : 0;
}

std::uint32_t FlashController::read_word(std::uint32_t offset) {
  switch (offset) {
    case acr: return access_;
    case sr: return status_;
    case cr: return control_;
    case optcr: return 0x0FFF'AAED;  // factory option bytes, locked
    case keyr:
    case optkeyr: return 0;
    default: machine_.log.note("FLASH", offset, false, 0); return 0;
  }
}

void FlashController::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case acr:
      access_ = value & 0x0707;
      check_wait_states();
      return;
    case keyr: {
      constexpr std::uint32_t keys[] = {0x4567'0123, 0xCDEF'89AB};
      // A wrong key locks until the next reset.
      if (unlock_failed_ || (control_ & lock) == 0) return;
      if (value != keys[unlock_step_])
        unlock_failed_ = true;
      else if (++unlock_step_ == 2) {
        control_ &= ~lock;
        unlock_step_ = 0;
      }
      return;
    }
    case sr:
      status_ &= ~(value & 0xF3);
      update_interrupt();
      return;
    case cr:
      if ((control_ & lock) != 0 || (status_ & busy) != 0) return;
      control_ = value & 0x8301'03FF;
      if ((control_ & start) != 0) erase();
      update_interrupt();
      return;
    default: machine_.log.note("FLASH", offset, true, value);
  }
}

}  // namespace inkwell::virtual_board
