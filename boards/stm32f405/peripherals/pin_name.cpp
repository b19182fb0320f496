#include "boards/stm32f405/peripherals/pin_name.hpp"

#include <charconv>
#include <stdexcept>

namespace inkwell::virtual_board {

std::optional<PinName> PinName::find(std::string_view name) {
  if (name.size() < 3 || name.size() > 4 || name[0] != 'P' || name[1] < 'A' || name[1] > 'I') return std::nullopt;
  unsigned pin = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + 2, end, pin);
  if (error != std::errc() || rest != end || pin > 15) return std::nullopt;
  return PinName{name[1], pin};
}

PinName PinName::of(std::string_view name) {
  if (const auto found = find(name)) return *found;
  throw std::invalid_argument("\"" + std::string(name) + "\" is not a pin; pins are PA0 to PI15.");
}

}  // namespace inkwell::virtual_board
