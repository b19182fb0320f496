// Common part of the three converters: triggers, simultaneous and interleaved modes, common registers.
#include "boards/stm32f405/peripherals/adc.hpp"

#include <algorithm>

#include "boards/stm32f405/peripherals/rcc_map.hpp"

namespace inkwell::virtual_board {
namespace {

struct TriggerSource {
  std::uint8_t timer;    ///< 0: EXTI line
  std::uint8_t channel;  ///< of the timer (0: trigger output); EXTI line if `timer` is 0
};
// RM0090, ADC_CR2: JEXTSEL and EXTSEL.
constexpr TriggerSource injected_sources[16] = {{1, 4}, {1, 0}, {2, 1}, {2, 0}, {3, 2}, {3, 4}, {4, 1}, {4, 2},
                                                {4, 3}, {4, 0}, {5, 4}, {5, 0}, {8, 2}, {8, 3}, {8, 4}, {0, 15}};
constexpr TriggerSource regular_sources[16] = {{1, 1}, {1, 2}, {1, 3}, {2, 2}, {2, 3}, {2, 4}, {2, 0}, {3, 1},
                                               {3, 0}, {4, 4}, {5, 1}, {5, 2}, {5, 3}, {8, 1}, {8, 0}, {0, 11}};
/// Two results in one half-word of ADC_CDR (DMA mode 3).
constexpr Field byte_pair{"BYTE#", 0, 8, Access::r, {2, 8, 0}};
constexpr std::uint32_t converter_bytes = 0x100, common = 3 * converter_bytes;

}  // namespace

Adcs::Adcs(Machine& machine, DmaRequests& requests, const PinFunctions& pins, TimerEventUsers& timers)
    : machine_(machine), dma_(requests), timers_(timers) {
  for (unsigned i = 0; i < 3; ++i) adcs_.emplace_back(machine, *this, i, requests, pins);
}

void Adcs::reset() {
  ccr_ = common_data_ = 0;
  shared_.clear();
  injected_sequences_ = 0;
  last_injected_ = never;
  for (auto& converter : adcs_) converter.reset();
  connect_triggers();
}

bool Adcs::is_clocked(unsigned index) const {
  if (rcc_map.apb2enr.adcen.in(*enable_register_, index)) return true;
  machine_.violations.violate(Rule::clock_off, adcs_[index].name());
  return false;
}

MultiMode Adcs::mode() const { return MultiMode(adc_common.ccr.multi.of(ccr_) & ~multi_triple); }

bool Adcs::injected_simultaneous() const {
  return mode() == MultiMode::regular_and_injected || mode() == MultiMode::injected;
}

bool Adcs::regular_simultaneous() const {
  return mode() == MultiMode::regular_and_injected || mode() == MultiMode::regular_and_alternate ||
         mode() == MultiMode::regular;
}

bool Adcs::interleaved() const { return mode() == MultiMode::interleaved; }

// Delay between the starts of two converters: ADC_CCR.DELAY, but at least the sampling time plus two cycles (RM0090,
// "Interleaved mode").
Ticks Adcs::interleaving_delay() const {
  const unsigned asked = 5 + adc_common.ccr.delay.of(ccr_), sampling = adcs_[0].regular_sampling_cycles() + 2;
  return machine_.clocks.pclk2.duration(std::uint64_t{std::max(asked, sampling)} * prescaler());
}

unsigned Adcs::group_size() const { return (adc_common.ccr.multi.of(ccr_) & multi_triple) != 0 ? 3 : 2; }

bool Adcs::is_slave(unsigned index, bool injected) const {
  return index != 0 && index < group_size() && (injected ? injected_simultaneous() : converts_together());
}

// DMA mode 1 transfers one result (RM0090, "Multi ADC mode"). DMA mode 2 transfers two results as half-words. DMA mode
// 3 transfers two results as bytes.
void Adcs::share(std::uint32_t result) {
  shared_.push_back(result);
  const std::uint32_t mode = adc_common.ccr.dma.of(ccr_);
  const std::size_t together = mode == 1 ? 1 : 2;
  while (shared_.size() >= together) {
    const Field& part = mode == 3 ? byte_pair : adc_common.cdr.data;
    common_data_ = 0;
    for (unsigned i = 0; i < together; ++i) common_data_ |= part.with(shared_[i], i);
    shared_.erase(shared_.begin(), shared_.begin() + static_cast<std::ptrdiff_t>(together));
    if (!dma_.adc_request(0)) continue;
    for (unsigned i = 0; i < group_size(); ++i) adcs_[i].result_taken();
  }
}

void Adcs::note_injected_sequence(Ticks now) {
  if (now == last_injected_) return;
  last_injected_ = now;
  if (on_injected_sequence) on_injected_sequence(injected_sequences_, now);
  ++injected_sequences_;
}

void Adcs::start_injected(unsigned index, Ticks now) {
  if (is_slave(index, true)) return;  // started together with the master
  if (adcs_[index].is_on()) note_injected_sequence(now);
  adcs_[index].start_injected(now);
  if (index == 0 && injected_simultaneous())
    for (unsigned i = 1; i < group_size(); ++i) adcs_[i].start_injected(now);
}

void Adcs::start_regular(unsigned index, Ticks now) {
  if (is_slave(index, false)) return;
  adcs_[index].start_regular(now);
  if (index == 0 && regular_simultaneous())
    for (unsigned i = 1; i < group_size(); ++i) adcs_[i].start_regular(now);
  if (index == 0 && interleaved())
    for (unsigned i = 1; i < group_size(); ++i) adcs_[i].start_regular_at(now + i * interleaving_delay());
}

void Adcs::trigger(unsigned timer, unsigned channel) {
  const Ticks now = machine_.timeline.now();
  const auto matches = [&](int selected, const TriggerSource(&sources)[16]) {
    return selected >= 0 && sources[selected].timer == timer && sources[selected].channel == channel;
  };
  for (unsigned i = 0; i < 3; ++i) {
    if (matches(adcs_[i].injected_trigger(), injected_sources)) start_injected(i, now);
    if (matches(adcs_[i].regular_trigger(), regular_sources)) start_regular(i, now);
  }
}

void Adcs::external_line(unsigned line) { trigger(0, line); }

void Adcs::connect_triggers() {
  const auto connected_before = connected_, awaited_before = awaited_;
  connected_.fill(0);
  awaited_.fill(0);
  const bool any_injected_matters =
      adcs_[0].injected_matters() || adcs_[1].injected_matters() || adcs_[2].injected_matters();
  const bool any_regular_matters =
      adcs_[0].regular_matters() || adcs_[1].regular_matters() || adcs_[2].regular_matters();
  const auto connect = [&](int selected, const TriggerSource(&sources)[16], bool matters) {
    if (selected < 0 || sources[selected].timer == 0) return;
    const auto bit = static_cast<std::uint8_t>(1u << sources[selected].channel);
    connected_[sources[selected].timer] |= bit;
    if (matters) awaited_[sources[selected].timer] |= bit;
  };
  for (const auto& converter : adcs_) {
    connect(converter.injected_trigger(), injected_sources, any_injected_matters);
    connect(converter.regular_trigger(), regular_sources, any_regular_matters);
  }
  if (connected_ != connected_before || awaited_ != awaited_before) timers_.timer_events_changed();
}

std::vector<RegisterMap> Adcs::register_maps(const std::string& name, std::uint32_t base) const {
  std::vector<RegisterMap> maps;
  for (std::uint32_t i = 0; i < 3; ++i)
    maps.push_back({name + std::to_string(i + 1), base + i * converter_bytes, shown<adc>()});
  maps.push_back({name + "_COMMON", base + common, shown<adc_common>()});
  return maps;
}

std::uint32_t Adcs::stored(std::uint32_t offset) const {
  if (offset < common) return adcs_[offset / converter_bytes].stored(offset % converter_bytes);
  return offset == common + adc_common.ccr ? ccr_ : 0;
}

std::uint32_t Adcs::read_word(std::uint32_t offset) {
  if (offset < common) {
    const unsigned index = offset / converter_bytes;
    return is_clocked(index) ? adcs_[index].read(offset % converter_bytes) : 0;
  }
  switch (offset) {
    case common + adc_common.csr: {
      std::uint32_t value = 0;
      for (unsigned i = 0; i < 3; ++i) value |= adcs_[i].status() << adc_common.csr.awd.position(i);
      return value;
    }
    case common + adc_common.ccr: return ccr_;
    case common + adc_common.cdr:
      if (shares_dma()) return common_data_;
      return adc_common.cdr.data.with(adcs_[0].data(), 0) | adc_common.cdr.data.with(adcs_[1].data(), 1);
    default: machine_.log.note("ADC common", offset, false, 0); return 0;
  }
}

void Adcs::write_word(std::uint32_t offset, std::uint32_t value) {
  if (offset < common) {
    const unsigned index = offset / converter_bytes;
    if (is_clocked(index)) adcs_[index].write(offset % converter_bytes, value);
    return;
  }
  if (offset != common + adc_common.ccr) return machine_.log.note("ADC common", offset, true, value);
  const bool was_on = temperature_on();
  ccr_ = value & writable(adc_common.ccr);
  if (temperature_on() && !was_on) internal_ready_at_ = machine_.timeline.now() + internal_source_time;
  shared_.clear();
  if (adc_common.ccr.multi.of(ccr_) != 0 && !injected_simultaneous() && !converts_together())
    machine_.log.note("ADC alternate-trigger mode,", offset, true, value);
}

}  // namespace inkwell::virtual_board
