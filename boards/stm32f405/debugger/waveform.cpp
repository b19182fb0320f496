#include "boards/stm32f405/debugger/waveform.hpp"
#include <stdexcept>

#include <fmt/format.h>

namespace inkwell::virtual_board {
namespace {

constexpr char exception_code[] = "e";
constexpr unsigned exception_bits = 7;

unsigned index_of(char port, unsigned pin) { return static_cast<unsigned>(port - 'A') * 16 + pin; }

char value_of(PinLevel level) { return level == PinLevel::high ? '1' : level == PinLevel::low ? '0' : 'z'; }

}  // namespace

Waveform::Waveform(const std::filesystem::path& path, std::vector<PinName> pins, Chip& chip)
    : chip_(chip), file_(path) {
  if (!file_)
    throw std::runtime_error(fmt::format(
        "{} cannot be written. For --vcd, use a file in an existing folder that you may write.", path.string()));
  if (pins.empty())
    for (unsigned index = 0; index < pin_count; ++index)
      pins.push_back({static_cast<char>('A' + index / 16), index % 16});
  file_ << "$comment Inkwell virtual board: simulation $end\n$timescale 1 ps $end\n$scope module chip $end\n";
  for (const PinName& pin : pins) {
    auto& code = codes_[index_of(pin.port, pin.pin)];
    code = pin.text();  // a code may be any text without spaces
    file_ << fmt::format("$var wire 1 {} {} $end\n", code, code);
  }
  file_ << fmt::format("$var reg {} {} exception $end\n$upscope $end\n$enddefinitions $end\n", exception_bits,
                       exception_code);
  set_time(chip.now());
  file_ << "$dumpvars\n";
  for (const PinName& pin : pins) file_ << value_of(chip.pin_level(pin.port, pin.pin)) << pin.text() << '\n';
  note_exception(chip.current_exception());
  file_ << "$end\n";
  chip.watch_pins([this](char port, unsigned pin, PinLevel level, Ticks when) {
    const std::string& code = codes_[index_of(port, pin)];
    if (code.empty()) return;
    set_time(when);
    file_ << value_of(level) << code << '\n';
  });
  chip.watch_exceptions([this](unsigned exception, Ticks when) {
    set_time(when);
    note_exception(exception);
  });
}

Waveform::~Waveform() {
  chip_.watch_pins({});
  chip_.watch_exceptions({});
  set_time(chip_.now());
}

// Time in the file must never decrease.
void Waveform::set_time(Ticks when) {
  if (begun_ && when <= written_until_) return;
  begun_ = true;
  written_until_ = when;
  constexpr Ticks some_ticks = 42, their_ps = 5000;
  static_assert(ticks_per_s / some_ticks * their_ps == 1'000'000'000'000);
  file_ << '#' << when / some_ticks * their_ps + when % some_ticks * their_ps / some_ticks << '\n';
}

void Waveform::note_exception(unsigned exception) {
  file_ << 'b';
  for (unsigned bit = exception_bits; bit-- > 0;) file_ << (exception >> bit & 1);
  file_ << ' ' << exception_code << '\n';
}

}  // namespace inkwell::virtual_board
