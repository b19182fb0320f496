// Peripherals of a few registers: power control, cyclic redundancy check, random numbers (RM0090, PWR, CRC, RNG).
#pragma once

#include <cstdint>

#include "bus.hpp"

namespace inkwell::virtual_board {

class PowerControl final : public RegisterBlock {
 public:
  explicit PowerControl(Machine& machine) : machine_(machine) {}
  void reset() override {
    control_ = 0x4000;
    status_ = 0;
  }

 protected:
  static constexpr std::uint32_t regulator_ready = 1u << 14;
  std::uint32_t read_word(std::uint32_t offset) override {
    return offset == 0 ? control_ : offset == 4 ? status_ | regulator_ready : 0;
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == 0) {
      control_ = value & 0x43F3;
      if ((value & 2) != 0) machine_.log.say_once("PWR_CR.PDDS: standby is not modelled, the chip only sleeps");
    }
    if (offset == 4) status_ = value & 0x300;
  }
  std::uint32_t stored(std::uint32_t offset) const override { return offset == 0 ? control_ : status_; }

 private:
  Machine& machine_;
  std::uint32_t control_ = 0x4000, status_ = 0;
};

class CrcUnit final : public RegisterBlock {
 public:
  void reset() override {
    data_ = 0xFFFF'FFFF;
    independent_ = 0;
  }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    return offset == 0 ? data_ : offset == 4 ? independent_ : 0;
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == 4) independent_ = value & 0xFF;
    if (offset == 8 && (value & 1) != 0) data_ = 0xFFFF'FFFF;
    if (offset != 0) return;
    constexpr std::uint32_t polynomial = 0x04C1'1DB7;
    data_ ^= value;
    for (int bit = 0; bit < 32; ++bit) data_ = (data_ & 0x8000'0000) != 0 ? data_ << 1 ^ polynomial : data_ << 1;
  }

 private:
  std::uint32_t data_ = 0xFFFF'FFFF, independent_ = 0;
};

/// Repeatable for the seed that the options give.
class RandomNumbers final : public RegisterBlock {
 public:
  explicit RandomNumbers(std::uint32_t seed) : state_(seed != 0 ? seed : 1) {}
  void reset() override { control_ = 0; }

 protected:
  std::uint32_t read_word(std::uint32_t offset) override {
    const bool on = (control_ & 4) != 0;
    if (offset == 0) return control_;
    if (offset == 4) return on ? 1 : 0;
    if (offset != 8 || !on) return 0;
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return state_;
  }
  void write_word(std::uint32_t offset, std::uint32_t value) override {
    if (offset == 0) control_ = value & 0xC;
  }

 private:
  std::uint32_t control_ = 0, state_;
};

}  // namespace inkwell::virtual_board
