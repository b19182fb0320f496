#include "boards/stm32f405/peripherals/rcc.hpp"

#include <algorithm>

#include "boards/stm32f405/core/processor.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr std::uint32_t internal_Hz = 16'000'000;
constexpr Ticks microsecond = ticks_per_s / 1'000'000;

struct OscillatorBits {
  std::uint32_t offset;
  Field on, ready;
  Ticks start_up;  ///< typical value of the data sheet
};
constexpr OscillatorBits oscillator_bits[] = {
    {rcc_map.cr, rcc_map.cr.hsion, rcc_map.cr.hsirdy, 2 * microsecond},
    {rcc_map.cr, rcc_map.cr.hseon, rcc_map.cr.hserdy, 500 * microsecond},
    {rcc_map.cr, rcc_map.cr.pllon, rcc_map.cr.pllrdy, 100 * microsecond},
    {rcc_map.cr, rcc_map.cr.plli2son, rcc_map.cr.plli2srdy, 100 * microsecond},
    {rcc_map.csr, rcc_map.csr.lsion, rcc_map.csr.lsirdy, 15 * microsecond},
    {rcc_map.bdcr, rcc_map.bdcr.lseon, rcc_map.bdcr.lserdy, 2'000'000 * microsecond},
};

constexpr unsigned ahb_divider(std::uint32_t field) {
  constexpr unsigned dividers[] = {2, 4, 8, 16, 64, 128, 256, 512};
  return (field & 8) != 0 ? dividers[field & 7] : 1;
}
constexpr unsigned apb_divider(std::uint32_t field) { return (field & 4) != 0 ? 2u << (field & 3) : 1; }

}  // namespace

Rcc::Rcc(Machine& machine, Processor& processor, StartingClock& starting_clock, CrystalFailure& failure)
    : machine_(machine),
      processor_(processor),
      starting_clock_(starting_clock),
      failure_(failure),
      slot_(machine.timeline.add(*this)) {}

void Rcc::reset() {
  words_.fill(0);
  words_[rcc_map.cr / 4] = rcc_map.cr.reset_value & writable(rcc_map.cr);
  words_[rcc_map.pllcfgr / 4] = rcc_map.pllcfgr.reset_value;
  words_[rcc_map.ahb1enr / 4] = rcc_map.ahb1enr.reset_value;
  words_[rcc_map.plli2scfgr / 4] = rcc_map.plli2scfgr.reset_value;
  ready_at_.fill(never);
  ready_at_[hsi] = 0;
  system_clock_ = 0;
  machine_.clock_is_lost = false;
  voltage_scale_1_ = true;
  crystal_failed_ = false;
  machine_.timeline.set(slot_, never, never);
  update_tree();
}

void Rcc::record_reset(ResetCause cause) {
  if (cause == ResetCause::brown_out)
    reset_flags_ |= rcc_map.csr.borrstf.mask();
  else
    reset_flags_ |= rcc_map.csr.pinrstf.mask() << static_cast<unsigned>(cause);
  // Every internal reset pulls the NRST pin low. A power-on reset sets BORRSTF (RM0090, "System reset").
  reset_flags_ |= rcc_map.csr.pinrstf.mask();
  if (cause == ResetCause::power_on) reset_flags_ |= rcc_map.csr.borrstf.mask();
}

bool Rcc::is_on(unsigned oscillator) const {
  const auto& bits = oscillator_bits[oscillator];
  return bits.on.in(words_[bits.offset / 4]);
}

bool Rcc::is_ready(unsigned oscillator) const {
  const bool needs_crystal =
      oscillator == hse || (oscillator == pll && rcc_map.pllcfgr.pllsrc.in(words_[rcc_map.pllcfgr / 4]));
  if (needs_crystal && !crystal_swings_) return false;
  return is_on(oscillator) && ready_at_[oscillator] <= machine_.timeline.now();
}

bool Rcc::runs_from_crystal() const {
  return system_clock_ == 1 || (system_clock_ == 2 && rcc_map.pllcfgr.pllsrc.in(words_[rcc_map.pllcfgr / 4]));
}

void Rcc::let_crystal_swing(bool swings) {
  if (swings == crystal_swings_) return;
  crystal_swings_ = swings;
  ready_at_[hse] = never;
  if (!swings) return lose_crystal();
  machine_.clock_is_lost = false;
  start_oscillators();
  update_tree();
}

void Rcc::drift_crystal(std::int32_t ppm) {
  machine_.options.crystal_ppm = ppm;
  update_tree();
}

void Rcc::lose_crystal() {
  auto& control = words_[rcc_map.cr / 4];
  if (runs_from_crystal())
    machine_.log.say(rcc_map.cr.csson.in(control)
                         ? "The crystal has stopped: the clock security system switches to HSI and raises the NMI."
                         : "The crystal has stopped: without the clock security system (RCC_CR.CSSON) the core stops.");
  if (!rcc_map.cr.csson.in(control) || !rcc_map.cr.hseon.in(control)) {
    machine_.clock_is_lost = runs_from_crystal();
    return update_tree();
  }
  control &= ~rcc_map.cr.hseon.mask();
  if (runs_from_crystal()) {
    if (system_clock_ == 2) control &= ~rcc_map.cr.pllon.mask();
    control |= rcc_map.cr.hsion.mask();
    auto& configuration = words_[rcc_map.cfgr / 4];
    configuration &= ~rcc_map.cfgr.sw.mask();
    system_clock_ = 0;
  }
  start_oscillators();
  update_tree();
  crystal_failed_ = true;
  machine_.nvic.set_non_maskable(true);
  failure_.crystal_failed();
}

std::uint32_t Rcc::pll_output_Hz(PllOutput output) const {
  const std::uint32_t value = words_[rcc_map.pllcfgr / 4];
  const std::uint32_t source_Hz = rcc_map.pllcfgr.pllsrc.in(value) ? machine_.options.crystal_Hz : internal_Hz;
  const std::uint32_t m = rcc_map.pllcfgr.pllm.of(value), n = rcc_map.pllcfgr.plln.of(value);
  if (m < 2 || n < 2) return 0;
  const std::uint64_t oscillator_Hz = std::uint64_t{source_Hz} / m * n;
  if (source_Hz / m < 1'000'000 || source_Hz / m > 2'000'000)
    machine_.violations.violate(Rule::pll_input, std::to_string(source_Hz / m) + " Hz");
  if (oscillator_Hz < 100'000'000 || oscillator_Hz > 432'000'000)
    machine_.violations.violate(Rule::pll_output, std::to_string(oscillator_Hz) + " Hz");
  const std::uint32_t divider =
      output == PllOutput::system ? 2 * (rcc_map.pllcfgr.pllp.of(value) + 1) : rcc_map.pllcfgr.pllq.of(value);
  return divider < 2 ? 0 : static_cast<std::uint32_t>(oscillator_Hz / divider);
}

// Frequency limits apply to the nominal frequencies, without the crystal deviation.
std::uint32_t Rcc::real_Hz(std::uint32_t nominal_Hz) const {
  const std::int64_t off_Hz = std::int64_t{nominal_Hz} * machine_.options.crystal_ppm / 1'000'000;
  return static_cast<std::uint32_t>(nominal_Hz + off_Hz);
}

std::uint32_t Rcc::real_time_clock_Hz() const {
  const std::uint32_t domain = words_[rcc_map.bdcr / 4];
  if (!rcc_map.bdcr.rtcen.in(domain)) return 0;
  constexpr std::uint32_t low_speed_external_Hz = 32'768;
  switch (rcc_map.bdcr.rtcsel.of(domain)) {
    case 1: return is_ready(lse) ? low_speed_external_Hz : 0;
    case 2: return is_ready(lsi) ? machine_.options.low_speed_internal_Hz : 0;
    case 3: {
      const std::uint32_t divider = rcc_map.cfgr.rtcpre.of(words_[rcc_map.cfgr / 4]);
      return is_ready(hse) && divider >= 2 ? real_Hz(machine_.options.crystal_Hz) / divider : 0;
    }
    default: return 0;
  }
}

void Rcc::start_oscillators() {
  const Ticks now = machine_.timeline.now();
  Ticks next = never;
  if (is_on(hse) && !crystal_swings_)
    machine_.log.say_once("RCC_CR: HSEON is set, but the crystal does not oscillate: HSERDY stays 0.");
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

// An AHB peripheral clock starts two AHB cycles after the enable bit is set (ES0182). An APB peripheral clock starts
// after 1 + prescaler AHB cycles.
void Rcc::note_enabled(std::uint32_t offset, std::uint32_t risen) {
  if (risen == 0 || machine_.options.mode != Mode::exact) return;
  const auto& clocks = machine_.clocks.frequencies;
  std::uint32_t cycles = 2;
  if (offset == rcc_map.apb1enr) cycles = 1 + clocks.hclk_Hz / clocks.pclk1_Hz;
  if (offset == rcc_map.apb2enr) cycles = 1 + clocks.hclk_Hz / clocks.pclk2_Hz;
  starting_clock_.start(enable_register(offset), risen, processor_.cycles() + cycles);
}

void Rcc::switch_system_clock() {
  constexpr unsigned oscillator_of[] = {hsi, hse, pll};
  const unsigned wanted = rcc_map.cfgr.sw.of(words_[rcc_map.cfgr / 4]);
  // A switch to a clock source takes effect when the source is ready (RM0090, "System clock (SYSCLK) selection").
  if (wanted < 3 && is_ready(oscillator_of[wanted])) system_clock_ = wanted;
  update_tree();
}

void Rcc::check_limits(const Clocks& clocks) const {
  const auto check = [&](std::uint32_t clock_Hz, std::uint32_t limit_Hz, Rule rule) {
    if (clock_Hz > limit_Hz) machine_.violations.violate(rule, std::to_string(clock_Hz) + " Hz");
  };
  check(clocks.hclk_Hz, 168'000'000, Rule::hclk_too_fast);
  check(clocks.pclk1_Hz, 42'000'000, Rule::pclk1_too_fast);
  check(clocks.pclk2_Hz, 84'000'000, Rule::pclk2_too_fast);
  constexpr std::uint32_t scale_2_limit_Hz = 144'000'000;
  if (!voltage_scale_1_) check(clocks.hclk_Hz, scale_2_limit_Hz, Rule::voltage_scale);
}

void Rcc::set_voltage_scale(bool scale_1) {
  voltage_scale_1_ = scale_1;
  check_limits(nominal_);
}

void Rcc::update_tree() {
  const std::uint32_t configuration = words_[rcc_map.cfgr / 4];
  Clocks f{};
  f.system_Hz = system_clock_ == 0   ? internal_Hz
                : system_clock_ == 1 ? machine_.options.crystal_Hz
                                     : pll_output_Hz(PllOutput::system);
  f.hclk_Hz = f.system_Hz / ahb_divider(rcc_map.cfgr.hpre.of(configuration));
  const unsigned divider1 = apb_divider(rcc_map.cfgr.ppre1.of(configuration)),
                 divider2 = apb_divider(rcc_map.cfgr.ppre2.of(configuration));
  f.pclk1_Hz = f.hclk_Hz / divider1;
  f.pclk2_Hz = f.hclk_Hz / divider2;
  f.timer1_Hz = f.pclk1_Hz * (divider1 == 1 ? 1 : 2);
  f.timer2_Hz = f.pclk2_Hz * (divider2 == 1 ? 1 : 2);
  f.usb_Hz = is_ready(pll) && !machine_.clock_is_lost ? pll_output_Hz(PllOutput::usb) : 0;
  if (f.hclk_Hz == 0) return;  // the PLL dividers are invalid, so the clocks do not change
  nominal_ = f;
  check_limits(nominal_);
  if (runs_from_crystal())
    for (auto* clock_Hz : {&f.system_Hz, &f.hclk_Hz, &f.pclk1_Hz, &f.pclk2_Hz, &f.timer1_Hz, &f.timer2_Hz})
      *clock_Hz = real_Hz(*clock_Hz);
  if (rcc_map.pllcfgr.pllsrc.in(words_[rcc_map.pllcfgr / 4])) f.usb_Hz = real_Hz(f.usb_Hz);

  ClockTree tree{Clock::of(f.hclk_Hz),
                 Clock::of(f.pclk1_Hz),
                 Clock::of(f.pclk2_Hz),
                 Clock::of(f.timer1_Hz),
                 Clock::of(f.timer2_Hz),
                 Clock::of(f.usb_Hz),
                 Clock::of(machine_.options.low_speed_internal_Hz),
                 f};
  if (machine_.clock_is_lost) tree.timer1 = tree.timer2 = Clock{};
  if (tree == machine_.clocks) {
    machine_.clocks.frequencies = f;
    return;
  }
  for (auto* user : machine_.clock_users) user->before_clock_change();
  machine_.clocks = tree;
  for (auto* user : machine_.clock_users) user->after_clock_change();
}

std::uint32_t Rcc::read_word(std::uint32_t offset) {
  if (offset >= bytes) {
    machine_.log.note("RCC", offset, false, 0);
    return 0;
  }
  std::uint32_t value = words_[offset / 4];
  for (unsigned i = 0; i < oscillators; ++i)
    if (oscillator_bits[i].offset == offset && is_ready(i)) value |= oscillator_bits[i].ready.mask();
  if (offset == rcc_map.cfgr) value = (value & ~rcc_map.cfgr.sws.mask()) | rcc_map.cfgr.sws.with(system_clock_);
  if (offset == rcc_map.csr) value |= reset_flags_;
  if (offset == rcc_map.cir) value |= rcc_map.cir.cssf.with(crystal_failed_);
  return value;
}

void Rcc::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset >= bytes) return machine_.log.note("RCC", offset, true, value);
  std::uint32_t& word = words_[offset / 4];
  const std::uint32_t risen = value & ~word;
  switch (offset) {
    case rcc_map.cr:
      word = value & writable(rcc_map.cr);
      // Firmware cannot stop the oscillator of the system clock.
      if (system_clock_ == 0) word |= rcc_map.cr.hsion.mask();
      if (system_clock_ == 1) word |= rcc_map.cr.hseon.mask();
      if (system_clock_ == 2) word |= rcc_map.cr.pllon.mask();
      start_oscillators();
      switch_system_clock();
      return;
    case rcc_map.pllcfgr:
      if (rcc_map.cr.pllon.in(words_[rcc_map.cr / 4])) return machine_.violations.violate(Rule::pll_written_while_on);
      word = value;
      return;
    case rcc_map.cfgr:
      word = value;
      switch_system_clock();
      return;
    case rcc_map.cir:
      if (rcc_map.cir.cssc.in(value)) {
        crystal_failed_ = false;
        machine_.nvic.set_non_maskable(false);
      }
      if ((value & writable(rcc_map.cir)) != 0) machine_.log.note("RCC interrupts, RCC", offset, true, value);
      return;
    case rcc_map.csr:
      if (rcc_map.csr.rmvf.in(value)) reset_flags_ = 0;
      word = (value | word) & rcc_map.csr.lsion.mask();
      start_oscillators();
      return;
    case rcc_map.bdcr:
      word = value & writable(rcc_map.bdcr);
      start_oscillators();
      return;
    case rcc_map.ahb1enr:
      word = value;
      processor_.set_core_coupled_memory(rcc_map.ahb1enr.ccmdataramen.in(word));
      break;
    default: word = value; break;
  }
  if (offset >= rcc_map.ahb1enr && offset <= rcc_map.apb2enr) note_enabled(offset, risen);
  if (offset >= rcc_map.ahb1rstr && offset <= rcc_map.apb2rstr)
    for (const auto& line : resets_)
      if (line.offset == offset && (risen & line.mask) != 0) line.peripheral->reset();
}

}  // namespace inkwell::virtual_board
