#include "firmware/drivers/otg_fs/frame_clock.hpp"

#include <board/board.hpp>
#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/registers/peripherals.hpp"

#include "firmware/drivers/otg_fs/core.hpp"

namespace inkwell::drivers {

namespace {

using TIM2 = RegistersOf<OtgFs, registers::TIM2>;

constexpr std::uint32_t cycles_per_count = board::processor_Hz / board::timer_apb1_Hz;
static_assert(cycles_per_count * board::timer_apb1_Hz == board::processor_Hz);

constexpr std::uint32_t nominal_length = board::timer_apb1_Hz / 1000;
/// Ten times the allowed frequency difference between host and board (USB 2.0, section 7.1.11).
constexpr std::uint32_t length_tolerance = nominal_length / 1000 * 5;
/// The driver considers the bus silent after 3 ms without a start of frame.
constexpr std::uint32_t silence = 3 * nominal_length;

}  // namespace

void FrameClock::start() {
  constexpr std::uint32_t usb_start_of_frame = 2, internal_trigger_1 = 1, capture_at_trigger = 3;
  TIM2::OR::write(TIM2::OR::ITR1_RMP(usb_start_of_frame));
  TIM2::SMCR::write(TIM2::SMCR::TS(internal_trigger_1));
  TIM2::CCMR1::write(TIM2::CCMR1::CC1S(capture_at_trigger));
  TIM2::CCER::write(TIM2::CCER::CC1E(1));
  TIM2::CR1::write(TIM2::CR1::CEN(1));
  length_ = nominal_length;
}

void FrameClock::note_capture() {
  const std::uint32_t captured = TIM2::CCR1::read();  // this read clears the flag
  const std::uint32_t passed = captured - captured_;
  // A damaged or missed start of frame results in a gap of several frame lengths.
  count_ += is_known_ ? (passed + nominal_length / 2) / nominal_length : 1;
  if (is_known_ && passed - (nominal_length - length_tolerance) <= 2 * length_tolerance) length_ = passed;
  captured_ = captured;
  number_ = static_cast<std::uint16_t>(Device::DSTS::FNSOF::read());
  is_known_ = true;
}

std::optional<usb::BusFrame> FrameClock::newest() {
  if (TIM2::SR::CC1IF::is_set()) note_capture();
  if (!is_known_) return std::nullopt;
  // The two reads are repeated if an interrupt occurs between the reads. The control interrupt cannot occur between the
  // reads twice in succession.
  constexpr std::uint32_t both_reads_cycles = 60;
  constexpr int tries = 4;
  std::uint32_t cycles = 0, count = 0;
  for (int i = 0; i < tries; ++i) {
    cycles = CycleCounter::now();
    count = TIM2::CNT::read();
    if (CycleCounter::now() - cycles <= both_reads_cycles) break;
  }
  const std::uint32_t age = count - captured_;
  if (age > silence) {
    is_known_ = false;
    return std::nullopt;
  }
  return usb::BusFrame{.number = number_,
                       .count = count_,
                       .begin_cycles = cycles - age * cycles_per_count,
                       .length_cycles = length_ * cycles_per_count,
                       .now_cycles = cycles};
}

}  // namespace inkwell::drivers
