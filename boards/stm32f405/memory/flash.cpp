#include "boards/stm32f405/memory/flash.hpp"

#include <array>
#include <cmath>
#include <cstring>

#include "boards/stm32f405/core/processor.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t errors =
    flash_map.sr.operr.mask() | flash_map.sr.pgaerr.mask() | flash_map.sr.pgperr.mask() | flash_map.sr.pgserr.mask();
constexpr unsigned position = 4;
constexpr Ticks millisecond = ticks_per_s / 1000, microsecond = ticks_per_s / 1'000'000;

/// Typical erase times for the parallelism x8, x16, x32, x64 (data sheet, table "Flash memory programming"). The
/// maximum erase times are twice the typical times.
using Times = std::array<Ticks, 4>;
constexpr Times small_sector_ms{400, 300, 250, 250}, middle_sector_ms{1200, 700, 550, 550},
    large_sector_ms{2000, 1300, 1000, 1000}, mass_ms{16'000, 11'000, 8000, 8000};
constexpr Ticks word_time = 16 * microsecond, slowest_word_time = 100 * microsecond;

constexpr const Times& erase_times_ms(std::uint32_t bytes) {
  return bytes == 0x4000 ? small_sector_ms : bytes == 0x1'0000 ? middle_sector_ms : large_sector_ms;
}

}  // namespace

FlashController::FlashController(Machine& machine, Processor& processor)
    : machine_(machine),
      processor_(processor),
      slot_(machine.timeline.add(*this)),
      option_bytes_((flash_map.optcr.reset_value & writable(flash_map.optcr) & ~flash_map.optcr.bor_lev.mask()) |
                    flash_map.optcr.bor_lev.with(3 - machine.options.brown_out_level)),
      random_(machine.options.random_seed) {
  machine.clock_users.push_back(this);
}

void FlashController::reset() {
  if (operation_) tear();
  if (busy()) set_busy(false);
  access_ = status_ = 0;
  set_accelerator(0);
  control_ = flash_map.cr.reset_value;
  unlock_step_ = 0;
  unlock_failed_ = false;
  options_ = option_bytes_;
  options_locked_ = true;
  options_start_ = options_unlock_failed_ = false;
  options_unlock_step_ = 0;
  machine_.timeline.set(slot_, never, never);
  update_interrupt();
}

void FlashController::check_wait_states() {
  // Frequency step per wait state at the present supply voltage (RM0090, table "Number of wait states").
  const double supply_V = machine_.supply_V;
  const std::uint32_t step_Hz = supply_V >= 2.7   ? 30'000'000
                                : supply_V >= 2.4 ? 24'000'000
                                : supply_V >= 2.1 ? 22'000'000
                                                  : 20'000'000;
  const std::uint32_t hclk_Hz = machine_.clocks.frequencies.hclk_Hz;
  const bool was_misread = machine_.flash_is_misread;
  machine_.flash_is_misread = hclk_Hz > step_Hz * (flash_map.acr.latency.of(access_) + 1);
  if (machine_.flash_is_misread != was_misread) processor_.end_slice();
  if (machine_.flash_is_misread)
    machine_.violations.violate(Rule::flash_wait_states, std::to_string(flash_map.acr.latency.of(access_)) + " at " +
                                                             std::to_string(hclk_Hz) + " Hz and " +
                                                             std::to_string(std::lround(1000 * supply_V)) + " mV");
}

void FlashController::set_accelerator(std::uint32_t access) {
  auto& accelerator = processor_.flash();
  // A cache can be cleared only while it is off (RM0090, "FLASH_ACR").
  const bool instruction_cache = flash_map.acr.icen.in(access), data_cache = flash_map.acr.dcen.in(access);
  if (flash_map.acr.icrst.in(access) && !instruction_cache) accelerator.forget_instructions();
  if (flash_map.acr.dcrst.in(access) && !data_cache) accelerator.forget_data();
  accelerator.set(flash_map.acr.latency.of(access), flash_map.acr.prften.in(access), instruction_cache, data_cache);
}

void FlashController::update_interrupt() {
  machine_.nvic.set_source(position, 0,
                           (flash_map.cr.eopie.in(control_) && flash_map.sr.eop.in(status_)) ||
                               (flash_map.cr.errie.in(control_) && (status_ & errors) != 0));
}

void FlashController::set_busy(bool busy) {
  status_ = busy ? status_ | flash_map.sr.bsy.mask() : status_ & ~flash_map.sr.bsy.mask();
  processor_.set_flash_busy(busy);
}

void FlashController::begin(Ticks typical, bool erases, std::uint32_t offset, std::uint32_t bytes) {
  const std::uint8_t* memory = machine_.memory.flash() + offset;
  operation_ = Operation{erases, offset, {memory, memory + bytes}};
  Ticks duration = typical;
  if (machine_.options.slowest_flash) duration = typical == word_time ? slowest_word_time : 2 * typical;
  if (++operations_ == cut_at_) {
    std::uniform_real_distribution<double> part(0.02, 0.98);
    duration = static_cast<Ticks>(part(random_) * static_cast<double>(duration));
  }
  set_busy(true);
  done_ = processor_.now() + duration;
  machine_.timeline.set(slot_, done_, done_);
}

void FlashController::step(Ticks) {
  set_busy(false);
  machine_.timeline.set(slot_, never, never);
  if (operations_ == cut_at_) {
    cut_at_ = 0;
    return machine_.request_reset(ResetCause::power_on);  // the reset finds the operation incomplete
  }
  operation_.reset();
  if (flash_map.cr.eopie.in(control_)) status_ |= flash_map.sr.eop.mask();
  control_ &= ~flash_map.cr.strt.mask();
  options_start_ = false;
  update_interrupt();
}

void FlashController::hold_up() {
  while (busy()) {
    processor_.wait(static_cast<unsigned>(processor_.cycles_until(done_)));
    machine_.timeline.catch_up(processor_.now());
  }
}

// If programming is interrupted, each bit to be cleared is randomly 0 or 1. If an erase is interrupted, each word of
// the sector is unchanged, erased, or random.
void FlashController::tear() {
  const auto& before = operation_->before;
  std::uint8_t* memory = machine_.memory.flash() + operation_->offset;
  enum Extent : unsigned { nothing, all, some, some_too };
  const auto extent = static_cast<Extent>(random_() / 7 % 4);
  for (std::size_t i = 0; i < before.size() && extent != all; ++i) {
    const auto any = static_cast<std::uint8_t>(random_() / 7);
    const unsigned kind = operation_->erases ? random_() / 7 % 3 : 3;
    memory[i] = extent == nothing ? before[i]
                : kind == 0       ? before[i]
                : kind == 1       ? memory[i]
                : kind == 2       ? any
                                  : static_cast<std::uint8_t>(before[i] & (memory[i] | any));
  }
  processor_.forget_code(flash_base + operation_->offset, static_cast<std::uint32_t>(before.size()));
  operation_.reset();
}

FlashController::Threshold FlashController::brown_out() const {
  constexpr Threshold thresholds[] = {{2.83, 2.92}, {2.50, 2.59}, {2.19, 2.29}, {1.68, 1.72}};
  return thresholds[flash_map.optcr.bor_lev.of(option_bytes_)];
}

void FlashController::write_option_key(std::uint32_t key) {
  constexpr std::uint32_t keys[] = {0x0819'2A3B, 0x4C5D'6E7F};
  if (!options_locked_ || options_unlock_failed_) return;
  if (key != keys[options_unlock_step_]) {
    options_unlock_failed_ = true;
    return machine_.violations.violate(Rule::option_bytes_locked, "key");
  }
  if (++options_unlock_step_ < std::size(keys)) return;
  options_locked_ = false;
  options_unlock_step_ = 0;
}

void FlashController::write_options(std::uint32_t value) {
  if (options_locked_) return machine_.violations.violate(Rule::option_bytes_locked);
  hold_up();
  options_ = value & writable(flash_map.optcr);
  options_locked_ = flash_map.optcr.optlock.in(value);
  if (!flash_map.optcr.optstrt.in(value)) return;
  option_bytes_ = options_;
  options_start_ = true;
  begin(small_sector_ms[2] * millisecond, false, 0, 0);
}

std::optional<std::uint32_t> FlashController::program(std::uint32_t address, std::uint32_t value, unsigned size) {
  const std::uint8_t* memory = machine_.memory.at(address, size);
  if (memory == nullptr || !machine_.memory.is_in_flash(address)) return {};
  const std::uint32_t offset = address < flash_bytes ? address : address - flash_base;
  hold_up();
  std::uint32_t content = 0;
  std::memcpy(&content, memory, size);
  const unsigned parallelism = 1u << flash_map.cr.psize.of(control_);
  if (flash_map.cr.lock.in(control_) || !flash_map.cr.pg.in(control_))
    status_ |= flash_map.sr.pgserr.mask();
  else if (address % size != 0)
    status_ |= flash_map.sr.pgaerr.mask();
  else if (parallelism != size && !(parallelism == 8 && size == 4))
    status_ |= flash_map.sr.pgperr.mask();
  else if (!machine_.reset_requested) {
    content &= value;  // programming can only clear bits
    begin(word_time, false, offset, size);
  }
  update_interrupt();
  return content;
}

void FlashController::erase() {
  const unsigned parallelism = flash_map.cr.psize.of(control_);
  const auto erase_range = [&](std::uint32_t base, std::uint32_t bytes, Ticks typical) {
    begin(typical, true, base, bytes);
    std::memset(machine_.memory.flash() + base, 0xFF, bytes);
    processor_.forget_code_later(flash_base + base, bytes);
  };
  if (flash_map.cr.mer.in(control_)) return erase_range(0, flash_bytes, mass_ms[parallelism] * millisecond);
  const unsigned number = flash_map.cr.snb.of(control_);
  if (!flash_map.cr.ser.in(control_) || number >= flash_sectors) {
    status_ |= flash_map.sr.pgserr.mask();
    control_ &= ~flash_map.cr.strt.mask();
    update_interrupt();
    return;
  }
  const auto [base, bytes] = flash_sector(number);
  erase_range(base, bytes, erase_times_ms(bytes)[parallelism] * millisecond);
}

std::uint32_t FlashController::stored(std::uint32_t offset) const {
  return offset == flash_map.acr     ? access_
         : offset == flash_map.cr    ? control_
         : offset == flash_map.optcr ? options_
                                     : 0;
}

std::uint32_t FlashController::read_word(std::uint32_t offset) {
  switch (offset) {
    case flash_map.acr: return access_;
    case flash_map.sr: return status_;
    case flash_map.cr: return control_;
    case flash_map.optcr:
      return options_ | flash_map.optcr.optlock.with(options_locked_) | flash_map.optcr.optstrt.with(options_start_);
    case flash_map.keyr:
    case flash_map.optkeyr: return 0;
    default: machine_.log.note("FLASH", offset, false, 0); return 0;
  }
}

void FlashController::write_word(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case flash_map.acr:
      access_ = value & writable(flash_map.acr);
      set_accelerator(value);
      check_wait_states();
      return;
    case flash_map.keyr: {
      constexpr std::uint32_t keys[] = {0x4567'0123, 0xCDEF'89AB};
      // A wrong key locks the flash until the next reset.
      if (unlock_failed_ || !flash_map.cr.lock.in(control_)) return;
      if (value != keys[unlock_step_])
        unlock_failed_ = true;
      else if (++unlock_step_ == 2) {
        control_ &= ~flash_map.cr.lock.mask();
        unlock_step_ = 0;
      }
      return;
    }
    case flash_map.optkeyr: return write_option_key(value);
    case flash_map.optcr: return write_options(value);
    case flash_map.sr:
      status_ &= ~(value & bits_of(flash_map.sr, Access::rc_w1));
      update_interrupt();
      return;
    case flash_map.cr:
      hold_up();
      if (flash_map.cr.lock.in(control_)) return;
      control_ = value & (writable(flash_map.cr) | bits_of(flash_map.cr, Access::rs));
      if (flash_map.cr.strt.in(control_)) erase();
      update_interrupt();
      return;
    default: machine_.log.note("FLASH", offset, true, value);
  }
}

}  // namespace inkwell::virtual_board
