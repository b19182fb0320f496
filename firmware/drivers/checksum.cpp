#include "firmware/drivers/checksum.hpp"

#include "firmware/drivers/peripheral_clocks.hpp"

namespace inkwell::drivers {

using CRC = RegistersOf<Checksum, registers::CRC>;

void Checksum::start() {
  start_clocks_of<Checksum, registers::CRC>();
  begin();
}

void Checksum::begin() { CRC::CR::write(CRC::CR::RESET(1)); }

void Checksum::add(std::uint32_t word) { CRC::DR::write(word); }

std::uint32_t Checksum::value() const { return CRC::DR::read(); }

}  // namespace inkwell::drivers
