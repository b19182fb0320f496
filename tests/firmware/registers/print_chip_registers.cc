// print-chip-registers: all registers and fields of the emulated chip as JSON.
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include "boards/stm32f405/otg_fs/otg_fs_device.hpp"
#include "boards/stm32f405/wiring/chip.hpp"

namespace {

using namespace inkwell::virtual_board;

class NoCircuit final : public Circuit {
 public:
  void output_changed(char, unsigned, PinLevel, Ticks) override {}
  double analog_V(char, unsigned, Ticks) override { return 0.0; }
  void advance(Ticks) override {}
};

/// Replaces `#` in the name by the number, or by a letter if the numbers of the entry start at 'A'.
std::string numbered(const MapEntry& entry, unsigned number) {
  std::string name = entry.name.data();
  const auto position = name.find('#');
  if (position == std::string::npos) return name;
  const std::string text = entry.first >= 'A' ? std::string(1, static_cast<char>(number)) : std::to_string(number);
  return name.replace(position, 1, text);
}

nlohmann::json fields_of(std::span<const MapEntry> fields, unsigned register_number) {
  nlohmann::json result = nlohmann::json::array();
  for (const MapEntry& field : fields)
    for (unsigned i = 0; i < field.count; ++i)
      result.push_back({{"name", numbered(field, field.count > 1 ? field.first + i : register_number)},
                        {"position", field.first_position + field.stride * i},
                        {"width", field.width}});
  return result;
}

nlohmann::json registers_of(std::span<const MapEntry> entries) {
  nlohmann::json result = nlohmann::json::array();
  for (std::size_t at = 0; at < entries.size();) {
    const MapEntry& entry = entries[at];
    std::size_t end = at + 1;
    while (end < entries.size() && entries[end].is_register == 0) ++end;
    for (unsigned i = 0; i < entry.count; ++i)
      result.push_back({{"name", numbered(entry, entry.first + i)},
                        {"offset", entry.first_position + entry.stride * i},
                        {"fields", fields_of(entries.subspan(at + 1, end - at - 1), entry.first + i)}});
    at = end;
  }
  return result;
}

}  // namespace

int main() {
  NoCircuit circuit;
  Chip chip(circuit);
  OtgFsDevice usb(chip.connections());
  chip.add_peripheral(OtgFsDevice::base, OtgFsDevice::size, "OTG_FS", usb);
  nlohmann::json peripherals = nlohmann::json::array();
  for (const RegisterMap& map : chip.register_maps())
    peripherals.push_back({{"name", map.name}, {"base", map.base}, {"registers", registers_of(map.entries)}});
  std::puts(peripherals.dump(1).c_str());
}
