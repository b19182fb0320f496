// Prints the board's pins for scripts, a line for each use: name of the fact, pin, function, and for timers the
// channel.
//
//   encoders[0].a PA0 AF2 TIM5_CH1
//   supply PB0 IN8 -
#include <cstdio>
#include <string>

#include <board/board.hpp>

namespace board = inkwell::board;

namespace {

std::string timer_channel(const board::Pin& pin) {
  const auto name = [](int timer, int channel) {
    return "TIM" + std::to_string(timer) + "_CH" + std::to_string(channel);
  };
  for (const auto& encoder : board::encoders) {
    if (pin == encoder.a.pin) return name(encoder.timer, 1);
    if (pin == encoder.b.pin) return name(encoder.timer, 2);
  }
  for (const auto& bridge : board::bridges) {
    if (pin == bridge.leg_a.pin) return name(1, bridge.channel);
    if (pin == bridge.leg_b.pin) return name(8, bridge.channel);
  }
  return "-";
}

}  // namespace

int main() {
  for (const board::PinUse& use : board::pin_uses)
    std::printf("%s P%c%d %s%s %s\n", std::string(use.name).c_str(), use.pin.port, use.pin.number, use.function,
                use.number < 0 ? "" : std::to_string(use.number).c_str(), timer_channel(use.pin).c_str());
}
