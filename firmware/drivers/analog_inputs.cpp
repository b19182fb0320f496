#include "firmware/drivers/analog_inputs.hpp"

#include "firmware/drivers/interrupts.hpp"
#include "firmware/drivers/peripheral_clocks.hpp"
#include "firmware/drivers/pins.hpp"
#include "firmware/placement/interrupt.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {
namespace {

using ADC1 = RegistersOf<AnalogInputs, registers::ADC1>;
using ADC2 = RegistersOf<AnalogInputs, registers::ADC2>;
using ADC3 = RegistersOf<AnalogInputs, registers::ADC3>;
using ADC_COMMON = RegistersOf<AnalogInputs, registers::ADC_COMMON>;
using DMA2 = RegistersOfStream<AnalogInputs, registers::DMA2, 0>;

/// Values of JEXTSEL and JEXTEN (RM0090, ADC_CR2).
constexpr std::uint32_t trigger_tim1_trgo = 0b0001, rising_edge = 0b01;

/// Sampling time of a channel. The channels of the fast shunt amplifiers use the reset value of 3 cycles.
struct Sampling {
  std::uint32_t code, cycles;
  constexpr float time_s() const { return static_cast<float>(cycles) / board::adc_Hz; }
  /// Cycles including the conversion.
  constexpr std::uint32_t whole_cycles() const { return cycles + 12; }
};
/// A capacitor at the pin charges the sampling capacitor, because potentiometers and supply divider have a high
/// resistance.
constexpr Sampling wiper_sampling{0b011, 56}, supply_sampling = wiper_sampling;
/// The internal reference needs a sampling time of 10 us (data sheet, "Embedded internal reference voltage").
constexpr Sampling reference_sampling{0b111, 480};
static_assert(reference_sampling.time_s() > 10e-6f);

constexpr std::uint32_t slow_channels = 5;
constexpr std::uint32_t reference_channel = 17;
static_assert(static_cast<float>(3 * wiper_sampling.whole_cycles() + supply_sampling.whole_cycles() +
                                 reference_sampling.whole_cycles()) /
                      board::adc_Hz <
                  0.8f / board::servo_rate_Hz,
              "the slow conversions must be over when the next injected ones come");

/// Worst-case values of the converter (data sheet, ADC characteristics). The sampling capacitor may have the voltage of
/// the previous channel. The resulting charge must change the voltage at the pin by less than half a converter step.
/// The sampling time must be at least ten time constants of the sampling switch.
constexpr float switch_ohm = 6000.0f, sampling_F = 4e-12f;
constexpr bool is_settled(const Sampling& sampling, float filter_F) {
  return filter_F > 2.0f * board::adc_counts * sampling_F && sampling.time_s() > 10.0f * switch_ohm * sampling_F;
}
static_assert(is_settled(wiper_sampling, board::facts.gimbal_filter_F) &&
                  is_settled(supply_sampling, board::facts.supply_filter_F),
              "a channel would show in the next one's reading");

/// Slow channels in conversion order. The supply is last, because the next sampled signal, a motor current, has a
/// similar voltage.
struct SlowChannel {
  std::uint32_t channel;
  Sampling sampling;
};
constexpr SlowChannel slow_sequence[slow_channels] = {{board::facts.gimbal[0].channel, wiper_sampling},
                                                      {board::facts.gimbal[1].channel, wiper_sampling},
                                                      {board::facts.gimbal[2].channel, wiper_sampling},
                                                      {reference_channel, reference_sampling},
                                                      {board::facts.supply.channel, supply_sampling}};

/// Returns the SMPRx value for the ten channels from `first` on. SMPR2 contains channels 0 to 9, and SMPR1 contains the
/// higher channels.
constexpr std::uint32_t sampling_from(std::uint32_t first) {
  std::uint32_t bits = 0;
  for (const auto& [channel, sampling] : slow_sequence)
    if (channel / 10 * 10 == first) bits |= sampling.code << channel % 10 * 3;
  return bits;
}

/// Value of ADC_CR2 for ADC1 after arm(). SWSTART starts the slow conversions.
constexpr std::uint32_t adc1_armed = ADC1::CR2::ADON(1).bits | ADC1::CR2::DMA(1).bits | ADC1::CR2::DDS(1).bits |
                                     ADC1::CR2::JEXTSEL(trigger_tim1_trgo).bits | ADC1::CR2::JEXTEN(rising_edge).bits;

template <class Converter>
void set_up_injected(const board::AnalogInput& input) {
  // After a reset, the injected sequence has one channel and uses only the field JSQ4.
  Converter::JSQR::write(typename Converter::JSQR::JSQ4(input.channel));
}

template <class Converter>
float take_current_A(bool& is_new) {
  is_new &= Converter::SR::JEOC::is_set();
  const auto counts = static_cast<std::int32_t>(Converter::JDR1::JDATA::read());
  Converter::SR::write(~(Converter::SR::JEOC::mask | Converter::SR::JSTRT::mask));
  constexpr float step_A = board::facts.current_step_A(), range_A = board::facts.current_range_A();
  return static_cast<float>(counts) * step_A - range_A;
}

void set_up_slow_sequence() {
  ADC1::SMPR1::write(sampling_from(10));
  ADC1::SMPR2::write(sampling_from(0));
  ADC1::SQR1::write(ADC1::SQR1::L(slow_channels - 1));
  ADC1::SQR3::write(ADC1::SQR3::SQ1(slow_sequence[0].channel), ADC1::SQR3::SQ2(slow_sequence[1].channel),
                    ADC1::SQR3::SQ3(slow_sequence[2].channel), ADC1::SQR3::SQ4(slow_sequence[3].channel),
                    ADC1::SQR3::SQ5(slow_sequence[4].channel));
  ADC1::CR1::write(ADC1::CR1::SCAN(1), ADC1::CR1::JEOCIE(1));
}

/// The flags of the stream must be clear before a transfer (RM0090, DMA stream configuration procedure).
constexpr std::uint32_t flags_of_stream = DMA2::LIFCR::CFEIF0::mask | DMA2::LIFCR::CDMEIF0::mask |
                                          DMA2::LIFCR::CTEIF0::mask | DMA2::LIFCR::CHTIF0::mask |
                                          DMA2::LIFCR::CTCIF0::mask;

/// Sets up and enables the DMA stream. Before the call, the stream must be disabled.
INKWELL_INTERRUPT void set_up_memory_access(const volatile std::uint16_t* destination) {
  constexpr std::uint32_t channel_adc1 = 0, half_word = 0b01, from_peripheral = 0b00;
  DMA2::LIFCR::write(flags_of_stream);
  DMA2::S0PAR::write(ADC1::DR::address);
  DMA2::S0M0AR::write(reinterpret_cast<std::uint32_t>(destination));
  DMA2::S0NDTR::write(slow_channels);
  const auto control = DMA2::S0CR::CHSEL(channel_adc1).bits | DMA2::S0CR::DIR(from_peripheral).bits |
                       DMA2::S0CR::PSIZE(half_word).bits | DMA2::S0CR::MSIZE(half_word).bits |
                       DMA2::S0CR::MINC(1).bits | DMA2::S0CR::CIRC(1).bits;
  DMA2::S0CR::write(control);
  DMA2::S0CR::write(control | DMA2::S0CR::EN::mask);
}

/// The sequence is restarted after four periods without a complete sequence. A late control interrupt causes one period
/// without a complete sequence.
constexpr std::uint32_t patience_periods = 4;

}  // namespace

void AnalogInputs::start_clocks() {
  start_clock_of_stream<AnalogInputs, registers::DMA2, 0>();
  start_clocks_of<AnalogInputs, registers::ADC1, registers::ADC2, registers::ADC3>();
}

void AnalogInputs::start() {
  connect_analog<AnalogInputs, board::facts.motor_current[0]>();
  connect_analog<AnalogInputs, board::facts.motor_current[1]>();
  connect_analog<AnalogInputs, board::facts.motor_current[2]>();
  connect_analog<AnalogInputs, board::facts.gimbal[0]>();
  connect_analog<AnalogInputs, board::facts.gimbal[1]>();
  connect_analog<AnalogInputs, board::facts.gimbal[2]>();
  connect_analog<AnalogInputs, board::facts.supply>();

  static_assert(board::adc_divider == 2 || board::adc_divider == 4 || board::adc_divider == 6 ||
                board::adc_divider == 8);
  // The internal reference starts within 10 us (data sheet, "Embedded internal reference voltage"), before arm() is
  // called.
  ADC_COMMON::CCR::write(ADC_COMMON::CCR::ADCPRE(board::adc_divider / 2 - 1), ADC_COMMON::CCR::TSVREFE(1));
  set_up_injected<ADC1>(board::facts.motor_current[0]);
  set_up_injected<ADC2>(board::facts.motor_current[1]);
  set_up_injected<ADC3>(board::facts.motor_current[2]);
  set_up_slow_sequence();
}

// The converters are accurate 3 us after they are switched on (data sheet, ADC characteristics, t_STAB).
void AnalogInputs::arm() {
  ADC3::CR2::write(ADC3::CR2::ADON(1), ADC3::CR2::JEXTSEL(trigger_tim1_trgo), ADC3::CR2::JEXTEN(rising_edge));
  ADC2::CR2::write(ADC2::CR2::ADON(1), ADC2::CR2::JEXTSEL(trigger_tim1_trgo), ADC2::CR2::JEXTEN(rising_edge));
  ADC1::CR2::write(adc1_armed);
  InterruptLine<AnalogInputs, Interrupt::analog_converters>::enable();
}

// All three converters start together, so all converters have finished when ADC1 raises its interrupt. A missing result
// indicates a broken converter.
INKWELL_INTERRUPT AnalogInputs::Currents AnalogInputs::take_currents() {
  bool are_new = true;
  const std::array current_A{take_current_A<ADC1>(are_new), take_current_A<ADC2>(are_new),
                             take_current_A<ADC3>(are_new)};
  return {current_A, are_new};
}

INKWELL_INTERRUPT void AnalogInputs::start_slow_conversions() {
  if (!slow_runs_) return set_up_slow();
  if (!DMA2::LISR::TCIF0::is_set()) {
    // After a late control interrupt the sequence may be incomplete. A restart in the middle of a sequence would shift
    // all later results by one position. A converter overrun or a transfer error stops the sequence permanently.
    if (++slow_age_periods_ % patience_periods == 0) stop_slow();
    return;
  }
  slow_age_periods_ = 0;
  DMA2::LIFCR::write(DMA2::LIFCR::CTCIF0(1));
  ADC1::CR2::write(adc1_armed | ADC1::CR2::SWSTART::mask);
}

// Stops the conversions according to RM0090, "Overrun detection". The recovery takes two periods, so that the interrupt
// does not have to wait. A stream finishes its current transfer before it is disabled. DMA requests are disabled, so
// that no old request remains when the stream restarts.
INKWELL_INTERRUPT void AnalogInputs::stop_slow() {
  ADC1::CR2::write(adc1_armed & ~ADC1::CR2::DMA::mask);
  DMA2::S0CR::write(0);
  slow_runs_ = false;
}

INKWELL_INTERRUPT void AnalogInputs::set_up_slow() {
  ++slow_age_periods_;
  slow_runs_ = true;
  set_up_memory_access(slow_.data());
  // An unread result would cause an overrun at the next result.
  ADC1::SR::write(~(ADC1::SR::OVR::mask | ADC1::SR::EOC::mask));
  ADC1::CR2::write(adc1_armed | ADC1::CR2::SWSTART::mask);
}

INKWELL_INTERRUPT std::array<float, 3> AnalogInputs::gimbal_ratio() const {
  constexpr float per_count = 1.0f / (board::adc_counts - 1);
  return {static_cast<float>(slow_[0]) * per_count, static_cast<float>(slow_[1]) * per_count,
          static_cast<float>(slow_[2]) * per_count};
}

INKWELL_INTERRUPT float AnalogInputs::supply_V() const {
  constexpr float step_V = board::facts.supply_step_V();
  return static_cast<float>(slow_[4]) * step_V;
}

static_assert(board::adc_reference_V == 3.3f, "the reference's calibration is for 3.3 V");
std::uint16_t AnalogInputs::calibrated_reference_counts() { return registers::SIGNATURE::VREFIN_CAL::read(); }

}  // namespace inkwell::drivers
