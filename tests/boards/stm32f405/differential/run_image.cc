// Runs an image on the virtual chip without a board, and prints its semihosting output.
#include <cstdio>
#include <cstring>
#include <exception>
#include "boards/stm32f405/wiring/chip.hpp"

namespace {

struct NoCircuit final : inkwell::virtual_board::Circuit {
  void output_changed(char, unsigned, inkwell::virtual_board::PinLevel, inkwell::virtual_board::Ticks) override {}
  double analog_V(char, unsigned, inkwell::virtual_board::Ticks) override { return 0.0; }
  void advance(inkwell::virtual_board::Ticks) override {}
};

}  // namespace

int main(int argc, char** argv) {
  using namespace inkwell::virtual_board;
  const bool exact = argc == 3 && std::strcmp(argv[1], "exact") == 0;
  if (argc != 3 || (!exact && std::strcmp(argv[1], "fast") != 0)) {
    std::fprintf(stderr, "usage: run-image exact|fast ELF\n");
    return 2;
  }
  try {
    NoCircuit circuit;
    ChipOptions options;
    options.mode = exact ? Mode::exact : Mode::fast;
    Chip chip(circuit, options);
    chip.on_console = [](std::uint8_t byte) { std::putchar(byte); };
    chip.load_elf(argv[2]);
    chip.reset();
    constexpr double patience_s = 60.0;  // in board time
    const Stop stop = chip.run_until(ticks(patience_s));
    if (stop != Stop::firmware_exit) {
      std::printf("the image did not end: %s\n",
                  stop == Stop::locked_up ? chip.lockup_reason().c_str() : "it still runs");
      return 1;
    }
    std::fprintf(stderr, "%llu\n", static_cast<unsigned long long>(chip.counters().exceptions[15].count));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "run-image: %s\n", error.what());
    return 1;
  }
}
