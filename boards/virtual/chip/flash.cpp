#include "flash.hpp"

#include <cmath>
#include <cstring>

#include "processor.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t errors =
    flash_map.sr.operr.mask() | flash_map.sr.pgaerr.mask() | flash_map.sr.pgperr.mask() | flash_map.sr.pgserr.mask();
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

FlashController::FlashController(Machine& machine)
    : machine_(machine),
      slot_(machine.timeline.add(*this)),
      option_bytes_((flash_map.optcr.reset_value & writable(flash_map.optcr) & ~flash_map.optcr.bor_lev.mask()) |
                    flash_map.optcr.bor_lev.with(3 - machine.options.brown_out_level)) {
  machine.flash = this;
  machine.clock_users.push_back(this);
}

void FlashController::reset() {
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
  // RM0090, table "Number of wait states": so much for each of them, by the supply.
  const double supply_V = machine_.supply_V;
  const std::uint32_t step_Hz = supply_V >= 2.7   ? 30'000'000
                                : supply_V >= 2.4 ? 24'000'000
                                : supply_V >= 2.1 ? 22'000'000
                                                  : 20'000'000;
  const std::uint32_t hclk_Hz = machine_.clocks.frequencies.hclk_Hz;
  const bool was_misread = machine_.flash_is_misread;
  machine_.flash_is_misread = hclk_Hz > step_Hz * (flash_map.acr.latency.of(access_) + 1);
  if (machine_.flash_is_misread != was_misread) machine_.processor->end_slice();
  if (machine_.flash_is_misread)
    machine_.violations.violate(Rule::flash_wait_states, std::to_string(flash_map.acr.latency.of(access_)) + " at " +
                                                             std::to_string(hclk_Hz) + " Hz and " +
                                                             std::to_string(std::lround(1000 * supply_V)) + " mV");
}

void FlashController::set_accelerator(std::uint32_t access) {
  auto& accelerator = machine_.processor->flash();
  // The caches are emptied only while they are off (RM0090, "FLASH_ACR").
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

void FlashController::begin(Ticks duration) {
  // On silicon a fetch from the flash stalls meanwhile; here the processor goes on and sees BSY.
  status_ |= flash_map.sr.bsy.mask();
  const Ticks done = machine_.timeline.now() + duration;
  machine_.timeline.set(slot_, done, done);
}

void FlashController::step(Ticks) {
  status_ &= ~flash_map.sr.bsy.mask();
  if (flash_map.cr.eopie.in(control_)) status_ |= flash_map.sr.eop.mask();
  control_ &= ~flash_map.cr.strt.mask();
  options_start_ = false;
  machine_.timeline.set(slot_, never, never);
  update_interrupt();
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
  if (flash_map.sr.bsy.in(status_)) return;
  options_ = value & writable(flash_map.optcr);
  options_locked_ = flash_map.optcr.optlock.in(value);
  if (!flash_map.optcr.optstrt.in(value)) return;
  option_bytes_ = options_;
  options_start_ = true;
  begin(sector(0).erase_time);
}

std::optional<std::uint32_t> FlashController::program(std::uint32_t address, std::uint32_t value, unsigned size) {
  const std::uint8_t* place = machine_.memory.at(address, size);
  const std::uint32_t offset = address < flash_bytes ? address : address - flash_base;
  if (place == nullptr || offset >= flash_bytes) return {};
  std::uint32_t content = 0;
  std::memcpy(&content, place, size);
  const unsigned parallelism = 1u << flash_map.cr.psize.of(control_);
  if (flash_map.cr.lock.in(control_) || !flash_map.cr.pg.in(control_))
    status_ |= flash_map.sr.pgserr.mask();
  else if (address % size != 0)
    status_ |= flash_map.sr.pgaerr.mask();
  else if (parallelism != size && !(parallelism == 8 && size == 4))
    status_ |= flash_map.sr.pgperr.mask();
  else {
    content &= value;  // programming only clears bits
    begin(16 * (ticks_per_s / 1'000'000));
  }
  update_interrupt();
  return content;
}

void FlashController::erase() {
  if (flash_map.cr.mer.in(control_)) {
    std::memset(machine_.memory.flash(), 0xFF, flash_bytes);
    machine_.processor->forget_code(flash_base, flash_bytes);
    begin(8000 * millisecond);
    return;
  }
  const unsigned number = flash_map.cr.snb.of(control_);
  if (!flash_map.cr.ser.in(control_) || number > 11) {
    status_ |= flash_map.sr.pgserr.mask();
    control_ &= ~flash_map.cr.strt.mask();
    update_interrupt();
    return;
  }
  const Sector erased = sector(number);
  std::memset(machine_.memory.flash() + erased.base, 0xFF, erased.bytes);
  machine_.processor->forget_code(flash_base + erased.base, erased.bytes);
  begin(erased.erase_time);
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
      // A wrong key locks until the next reset.
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
      if (flash_map.cr.lock.in(control_) || flash_map.sr.bsy.in(status_)) return;
      control_ = value & (writable(flash_map.cr) | bits_of(flash_map.cr, Access::rs));
      if (flash_map.cr.strt.in(control_)) erase();
      update_interrupt();
      return;
    default: machine_.log.note("FLASH", offset, true, value);
  }
}

}  // namespace inkwell::virtual_board
