#include "firmware/drivers/encoders.hpp"

#include "firmware/drivers/peripheral_clocks.hpp"
#include "firmware/drivers/pins.hpp"
#include "firmware/placement/interrupt.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {
namespace {

using TIM3 = RegistersOf<Encoders, registers::TIM3>;
using TIM4 = RegistersOf<Encoders, registers::TIM4>;
using TIM5 = RegistersOf<Encoders, registers::TIM5>;

static_assert(board::facts.encoders[0].timer == 5 && board::facts.encoders[1].timer == 3 &&
              board::facts.encoders[2].timer == 4);

template <class Timer>
void set_up() {
  constexpr std::uint32_t both_edges = 0b011;
  constexpr std::uint32_t direct_input = 0b01;
  static_assert(board::encoder_filter_samples == 8 && board::encoder_filter_divider == 4);
  constexpr std::uint32_t filter = 0b0111;
  Timer::CCMR1::write(typename Timer::CCMR1::CC1S(direct_input), typename Timer::CCMR1::CC2S(direct_input),
                      typename Timer::CCMR1::IC1F(filter), typename Timer::CCMR1::IC2F(filter));
  Timer::SMCR::write(typename Timer::SMCR::SMS(both_edges));
  Timer::CR1::write(typename Timer::CR1::CEN(1));
}

template <board::EncoderWiring wiring>
void connect_encoder() {
  connect<Encoders, wiring.a>(Pull::up, Speed::low);
  connect<Encoders, wiring.b>(Pull::up, Speed::low);
}

/// Settling time of 10 us. In 10 us an internal pull resistor charges 250 pF.
constexpr std::uint32_t pull_cycles = board::processor_Hz / 100'000;

}  // namespace

bool Encoders::wire_a_floats(std::size_t encoder) const {
  switch (encoder) {
    case 0: return follows_pulls<Encoders, board::facts.encoders[0].a.pin>(pull_cycles);
    case 1: return follows_pulls<Encoders, board::facts.encoders[1].a.pin>(pull_cycles);
    default: return follows_pulls<Encoders, board::facts.encoders[2].a.pin>(pull_cycles);
  }
}

bool Encoders::wire_b_floats(std::size_t encoder) const {
  switch (encoder) {
    case 0: return follows_pulls<Encoders, board::facts.encoders[0].b.pin>(pull_cycles);
    case 1: return follows_pulls<Encoders, board::facts.encoders[1].b.pin>(pull_cycles);
    default: return follows_pulls<Encoders, board::facts.encoders[2].b.pin>(pull_cycles);
  }
}

void Encoders::start() {
  start_clocks_of<Encoders, registers::TIM3, registers::TIM4, registers::TIM5>();
  connect_encoder<board::facts.encoders[0]>();
  connect_encoder<board::facts.encoders[1]>();
  connect_encoder<board::facts.encoders[2]>();
  set_up<TIM5>();
  set_up<TIM3>();
  set_up<TIM4>();
}

// After a reset, TIM5 counts with 32 bits, and the other timers count with 16 bits. The lower 16 bits of all timers
// wrap in the same way.
INKWELL_INTERRUPT std::array<std::uint16_t, 3> Encoders::read() const {
  return {static_cast<std::uint16_t>(TIM5::CNT::read()), static_cast<std::uint16_t>(TIM3::CNT::read()),
          static_cast<std::uint16_t>(TIM4::CNT::read())};
}

}  // namespace inkwell::drivers
