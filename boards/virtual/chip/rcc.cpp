#include "rcc.hpp"

#include <algorithm>

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t internal_Hz = 16'000'000, low_speed_internal_Hz = 32'000;
constexpr std::uint32_t remove_reset_flags = 1u << 24;
constexpr Ticks microsecond = ticks_per_s / 1'000'000;

struct OscillatorBits {
  std::uint32_t offset;
  unsigned on_bit;
  unsigned ready_bit;
  Ticks start_up;  ///< typical values of the data sheet
};
constexpr OscillatorBits oscillator_bits[] = {
    {Rcc::cr, 0, 1, 2 * microsecond},     {Rcc::cr, 16, 17, 500 * microsecond},
    {Rcc::cr, 24, 25, 100 * microsecond}, {Rcc::cr, 26, 27, 100 * microsecond},
    {Rcc::csr, 0, 1, 15 * microsecond},   {Rcc::bdcr, 0, 1, 2'000'000 * microsecond},
};

constexpr unsigned ahb_divider(std::uint32_t cfgr) {
  constexpr unsigned dividers[] = {2, 4, 8, 16, 64, 128, 256, 512};
  return (cfgr >> 4 & 8) != 0 ? dividers[cfgr >> 4 & 7] : 1;
}
constexpr unsigned apb_divider(std::uint32_t field) { return (field & 4) != 0 ? 2u << (field & 3) : 1; }

}  // namespace

Rcc::Rcc(Machine& machine) : machine_(machine), slot_(machine.timeline.add(*this)) { machine.rcc = this; }

void Rcc::reset() {
  words_.fill(0);
  words_[cr / 4] = 0x0000'0081;
  words_[pllcfgr / 4] = 0x2400'3010;
  words_[ahb1enr / 4] = 0x0010'0000;
  words_[0x84 / 4] = 0x2000'3000;
  ready_at_.fill(never);
  ready_at_[hsi] = 0;
  system_clock_ = 0;
  machine_.timeline.set(slot_, never, never);
  update_tree();
}

void Rcc::record_reset(ResetCause cause) {
  reset_flags_ |= 1u << (26 + static_cast<unsigned>(cause));
  // Every internal reset pulls the pin NRST too; power-on comes with a brown-out reset (RM0090, "System reset").
  reset_flags_ |= 1u << 26;
  if (cause == ResetCause::power_on) reset_flags_ |= 1u << 25;
}

bool Rcc::is_on(unsigned oscillator) const {
  const auto& bits = oscillator_bits[oscillator];
  return (words_[bits.offset / 4] >> bits.on_bit & 1) != 0;
}

bool Rcc::is_ready(unsigned oscillator) const {
  return is_on(oscillator) && ready_at_[oscillator] <= machine_.timeline.now();
}

std::uint32_t Rcc::pll_output_Hz(unsigned shift_of_divider) const {
  const std::uint32_t value = words_[pllcfgr / 4];
  const std::uint32_t source_Hz = (value & 1u << 22) != 0 ? machine_.options.crystal_Hz : internal_Hz;
  const std::uint32_t m = value & 0x3F, n = value >> 6 & 0x1FF;
  if (m < 2 || n < 2) return 0;
  const std::uint64_t oscillator_Hz = std::uint64_t{source_Hz} / m * n;
  if (oscillator_Hz < 100'000'000 || oscillator_Hz > 432'000'000)
    machine_.log.say_once("RCC_PLLCFGR asks for a PLL of " + std::to_string(oscillator_Hz) +
                          " Hz, outside of 100 to 432 MHz");
  const std::uint32_t divider = shift_of_divider == 16 ? 2 * ((value >> 16 & 3) + 1) : value >> 24 & 0xF;
  return divider < 2 ? 0 : static_cast<std::uint32_t>(oscillator_Hz / divider);
}

void Rcc::start_oscillators() {
  const Ticks now = machine_.timeline.now();
  Ticks next = never;
  for (unsigned i = 0; i < oscillators; ++i) {
    if (!is_on(i))
      ready_at_[i] = never;
    else if (ready_at_[i] == never)
      ready_at_[i] = now + oscillator_bits[i].start_up;
    if (is_on(i) && ready_at_[i] > now) next = std::min(next, ready_at_[i]);
  }
  machine_.timeline.set(slot_, next, next);
}

void Rcc::step(Ticks) {
  start_oscillators();
  switch_system_clock();
}

void Rcc::switch_system_clock() {
  constexpr unsigned oscillator_of[] = {hsi, hse, pll};
  const unsigned wanted = words_[cfgr / 4] & 3;
  // A switch to a clock that is not ready happens once it is (RM0090, "System clock (SYSCLK) selection").
  if (wanted < 3 && is_ready(oscillator_of[wanted])) system_clock_ = wanted;
  update_tree();
}

void Rcc::update_tree() {
  const std::uint32_t configuration = words_[cfgr / 4];
  Clocks f{};
  f.system_Hz = system_clock_ == 0 ? internal_Hz : system_clock_ == 1 ? machine_.options.crystal_Hz : pll_output_Hz(16);
  f.hclk_Hz = f.system_Hz / ahb_divider(configuration);
  const unsigned divider1 = apb_divider(configuration >> 10), divider2 = apb_divider(configuration >> 13);
  f.pclk1_Hz = f.hclk_Hz / divider1;
  f.pclk2_Hz = f.hclk_Hz / divider2;
  f.timer1_Hz = f.pclk1_Hz * (divider1 == 1 ? 1 : 2);
  f.timer2_Hz = f.pclk2_Hz * (divider2 == 1 ? 1 : 2);
  f.usb_Hz = is_ready(pll) ? pll_output_Hz(24) : 0;
  if (f.hclk_Hz == 0) return;  // the PLL's dividers make no sense: stay as it was
  if (f.hclk_Hz > 168'000'000 || f.pclk1_Hz > 42'000'000 || f.pclk2_Hz > 84'000'000)
    machine_.log.say_once("RCC_CFGR asks for clocks beyond the data sheet (168, 42 and 84 MHz)");

  ClockTree tree{Clock::of(f.hclk_Hz),
                 Clock::of(f.pclk1_Hz),
                 Clock::of(f.pclk2_Hz),
                 Clock::of(f.timer1_Hz),
                 Clock::of(f.timer2_Hz),
                 Clock::of(f.usb_Hz),
                 Clock::of(low_speed_internal_Hz),
                 f};
  if (tree == machine_.clocks) {
    machine_.clocks.frequencies = f;
    return;
  }
  for (auto* user : machine_.clock_users) user->before_clock_change();
  machine_.clocks = tree;
  for (auto* user : machine_.clock_users) user->after_clock_change();
}

std::uint32_t Rcc::read_word(std::uint32_t offset) {
  if (offset >= 0x90) {
    machine_.log.note("RCC", offset, false, 0);
    return 0;
  }
  std::uint32_t value = words_[offset / 4];
  for (unsigned i = 0; i < oscillators; ++i)
    if (oscillator_bits[i].offset == offset && is_ready(i)) value |= 1u << oscillator_bits[i].ready_bit;
  if (offset == cfgr) value = (value & ~0xCu) | system_clock_ << 2;
  if (offset == csr) value |= reset_flags_;
  return value;
}

void Rcc::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset >= 0x90) return machine_.log.note("RCC", offset, true, value);
  std::uint32_t& word = words_[offset / 4];
  const std::uint32_t risen = value & ~word;
  switch (offset) {
    case cr:
      word = value & 0x050D'00F9;
      // The oscillator that is in use can not be stopped.
      if (system_clock_ == 0) word |= 1;
      if (system_clock_ == 1) word |= 1u << 16;
      if (system_clock_ == 2) word |= 1u << 24;
      start_oscillators();
      switch_system_clock();
      return;
    case pllcfgr:
      if ((words_[cr / 4] & 1u << 24) != 0)
        return machine_.log.say_once("RCC_PLLCFGR was written while the PLL is on: ignored");
      word = value;
      return;
    case cfgr:
      word = value;
      switch_system_clock();
      return;
    case cir:
      if ((value & 0x7F00) != 0) machine_.log.note("RCC interrupts, RCC", offset, true, value);
      return;
    case csr:
      if ((value & remove_reset_flags) != 0) reset_flags_ = 0;
      word = (value & 1) | (word & 1);
      start_oscillators();
      return;
    case bdcr:
      word = value & 0x0001'8305;
      start_oscillators();
      return;
    default: word = value; break;
  }
  if (offset >= ahb1rstr && offset <= apb2rstr)
    for (const auto& line : resets_)
      if (line.offset == offset && (risen & line.mask) != 0) line.peripheral->reset();
}

}  // namespace inkwell::virtual_board
