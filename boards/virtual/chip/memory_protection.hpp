// Registers of the memory protection unit (ARMv7-M, B3.5): regions are kept, accesses are not checked.
#pragma once

#include <array>
#include <chip/register_map.hpp>
#include <cstdint>

namespace inkwell::virtual_board {

struct MemoryProtectionRegisters {
  struct : Register {
    Field separate{"SEPARATE", 0, 1, Access::r}, dregion{"DREGION", 8, 8, Access::r},
        iregion{"IREGION", 16, 8, Access::r};
  } typer{{"MPU_TYPER", 0x00, 0x800}};
  struct : Register {
    Field enable{"ENABLE", 0}, hfnmiena{"HFNMIENA", 1}, privdefena{"PRIVDEFENA", 2};
  } ctrl{{"MPU_CTRL", 0x04}};
  struct : Register {
    Field region{"REGION", 0, 8};
  } rnr{{"MPU_RNR", 0x08}};
  struct : Register {
    Field region{"REGION", 0, 4}, valid{"VALID", 4, 1, Access::w}, addr{"ADDR", 5, 27};
  } rbar{{"MPU_RBAR", 0x0C}};
  struct : Register {
    Field enable{"ENABLE", 0}, size{"SIZE", 1, 5}, srd{"SRD", 8, 8}, b{"B", 16}, c{"C", 17}, s{"S", 18},
        tex{"TEX", 19, 3}, ap{"AP", 24, 3}, xn{"XN", 28};
  } rasr{{"MPU_RASR", 0x10}};
};
inline constexpr MemoryProtectionRegisters mpu;
/// RBAR and RASR come three times more behind themselves, so that four regions are one block of stores.
inline constexpr std::uint32_t mpu_base = 0xE000'ED90, mpu_bytes = 0x2C;

class MemoryProtection {
 public:
  void reset() { *this = {}; }
  std::uint32_t read(std::uint32_t offset) const {
    if (offset == mpu.typer) return mpu.typer.reset_value;
    if (offset == mpu.ctrl) return control_;
    if (offset == mpu.rnr) return region_;
    return is_base(offset) ? bases_[region_] | mpu.rbar.region.with(region_) : attributes_[region_];
  }
  /// True if the unit is on after a write to its control register.
  bool write(std::uint32_t offset, std::uint32_t value) {
    if (offset == mpu.typer) return false;
    if (offset == mpu.ctrl) {
      control_ = value & writable(mpu.ctrl);
      return mpu.ctrl.enable.in(control_);
    }
    if (offset == mpu.rnr) {
      region_ = mpu.rnr.region.of(value) % regions;
    } else if (is_base(offset)) {
      if (mpu.rbar.valid.in(value)) region_ = mpu.rbar.region.of(value) % regions;
      bases_[region_] = value & mpu.rbar.addr.mask();
    } else {
      attributes_[region_] = value & writable(mpu.rasr);
    }
    return false;
  }

 private:
  static constexpr unsigned regions = 8;
  static bool is_base(std::uint32_t offset) { return (offset - mpu.rbar) % 8 == 0; }
  std::uint32_t control_ = 0, region_ = 0;
  std::array<std::uint32_t, regions> bases_{}, attributes_{};
};

}  // namespace inkwell::virtual_board
