// usage: board-facts NAME. Prints one line per pin use of a board: fact, pin, function and timer channel. Example lines
// are `encoders[0].a PA0 AF2 TIM5_CH1` and `supply PB0 IN8 -`.
#include <cstdio>
#include <string>

#include "boards/known/boards.hpp"

namespace board = inkwell::board;

namespace {

std::string timer_channel(const board::Facts& facts, const board::Pin& pin) {
  const auto name = [](int timer, int channel) {
    return "TIM" + std::to_string(timer) + "_CH" + std::to_string(channel);
  };
  for (const auto& encoder : facts.encoders) {
    if (pin == encoder.a.pin) return name(encoder.timer, 1);
    if (pin == encoder.b.pin) return name(encoder.timer, 2);
  }
  for (const auto& bridge : facts.bridges) {
    if (pin == bridge.leg_a.pin) return name(1, bridge.channel);
    if (pin == bridge.leg_b.pin) return name(8, bridge.channel);
  }
  return "-";
}

}  // namespace

int main(int argc, char** argv) {
  const board::Facts* const facts = argc == 2 ? board::find_board(argv[1]) : nullptr;
  if (facts == nullptr) {
    std::fprintf(stderr, "usage: board-facts NAME, one of %s\n", board::names_of_boards().c_str());
    return 2;
  }
  for (const board::PinUse& use : facts->pin_uses())
    std::printf("%s P%c%d %s%s %s\n", std::string(use.name).c_str(), use.pin.port, use.pin.number, use.function,
                use.number < 0 ? "" : std::to_string(use.number).c_str(), timer_channel(*facts, use.pin).c_str());
}
