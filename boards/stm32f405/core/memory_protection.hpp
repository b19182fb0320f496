// The memory protection unit (ARMv7-M, B3.5): eight regions and their access rights.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include "boards/stm32f405/core/register_map.hpp"

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
/// RBAR and RASR each have three aliases, so that one STM instruction can set four regions.
inline constexpr std::uint32_t mpu_base = 0xE000'ED90, mpu_bytes = 0x2C;

class MemoryProtection {
 public:
  void reset() { *this = {}; }
  /// Returns true if the register at this offset is RBAR or one of its aliases.
  static bool is_base(std::uint32_t offset) { return offset >= mpu.rbar && (offset - mpu.rbar) % 8 == 0; }
  std::uint32_t read(std::uint32_t offset) const {
    if (offset == mpu.typer) return mpu.typer.reset_value;
    if (offset == mpu.ctrl) return control_;
    if (offset == mpu.rnr) return region_;
    return is_base(offset) ? bases_[region_] | mpu.rbar.region.with(region_) : attributes_[region_];
  }
  /// Returns false if the value selects a region that does not exist.
  static bool names_region(std::uint32_t offset, std::uint32_t value) {
    if (offset == mpu.rnr) return mpu.rnr.region.of(value) < regions;
    return !is_base(offset) || !mpu.rbar.valid.in(value) || mpu.rbar.region.of(value) < regions;
  }
  void write(std::uint32_t offset, std::uint32_t value) {
    if (offset == mpu.typer) return;
    if (offset == mpu.ctrl) {
      control_ = value & writable(mpu.ctrl);
    } else if (offset == mpu.rnr) {
      region_ = mpu.rnr.region.of(value) % regions;
    } else if (is_base(offset)) {
      if (mpu.rbar.valid.in(value)) region_ = mpu.rbar.region.of(value) % regions;
      bases_[region_] = value & mpu.rbar.addr.mask();
    } else {
      attributes_[region_] = value & writable(mpu.rasr);
    }
  }
  /// Returns true if all enabled regions have defined behavior. The base of a region must be a multiple of its size.
  /// The size must be at least 32 bytes. Regions smaller than 256 bytes must not have disabled subregions. The fields
  /// AP, TEX, C and B must not have reserved values.
  bool is_defined() const {
    for (unsigned i = 0; i < regions; ++i) {
      const std::uint32_t attributes = attributes_[i];
      if (!mpu.rasr.enable.in(attributes)) continue;
      const unsigned kind = mpu.rasr.tex.of(attributes);
      const bool cached = mpu.rasr.c.in(attributes), buffered = mpu.rasr.b.in(attributes);
      const bool is_reserved_kind =
          kind == 3 || (kind == 1 && cached != buffered) || (kind == 2 && (cached || buffered));
      if (region_bytes(i) < smallest || (bases_[i] & (region_bytes(i) - 1)) != 0 || is_reserved_kind ||
          mpu.rasr.ap.of(attributes) == reserved_rights ||
          (mpu.rasr.srd.of(attributes) != 0 && region_bytes(i) < smallest_with_subregions))
        return false;
    }
    return true;
  }
  /// Returns true if the memory protection unit checks accesses. `above_faults` is true in HardFault, in NMI, and while
  /// FAULTMASK is set.
  bool is_on(bool above_faults) const {
    return mpu.ctrl.enable.in(control_) && (!above_faults || mpu.ctrl.hfnmiena.in(control_));
  }
  bool allows(std::uint32_t address, bool write, bool fetch, bool privileged) const {
    if (const auto* attributes = region_at(address)) return region_allows(*attributes, write, fetch, privileged);
    return privileged && mpu.ctrl.privdefena.in(control_);
  }
  /// Returns true if the region of the address is Device or Strongly-ordered memory (PM0214, table "TEX, C, B, and S
  /// encoding"). Returns nothing if no region contains the address.
  std::optional<bool> makes_device(std::uint32_t address) const {
    const auto* attributes = region_at(address);
    if (attributes == nullptr) return {};
    const unsigned kind = mpu.rasr.tex.of(*attributes);
    const bool cached = mpu.rasr.c.in(*attributes), buffered = mpu.rasr.b.in(*attributes);
    return !cached && (kind == 0 || (kind == 2 && !buffered));
  }
  /// Returns true if the page may contain a region boundary.
  bool divides(std::uint32_t page, std::uint32_t bytes) const {
    for (unsigned i = 0; i < regions; ++i) {
      if (!mpu.rasr.enable.in(attributes_[i])) continue;
      const std::uint64_t size = region_bytes(i), first = bases_[i] & ~(size - 1);
      const std::uint64_t grain = mpu.rasr.srd.in(attributes_[i]) ? size / subregions : size;
      const bool touches = first < std::uint64_t{page} + bytes && page < first + size;
      if (touches && grain < bytes) return true;
    }
    return false;
  }

 private:
  static constexpr unsigned regions = 8, subregions = 8, reserved_rights = 4;
  static constexpr std::uint64_t smallest = 32, smallest_with_subregions = 256;
  std::uint64_t region_bytes(unsigned i) const { return std::uint64_t{2} << mpu.rasr.size.of(attributes_[i]); }
  /// Returns the attributes of the region at the address. If regions overlap, the region with the highest number has
  /// priority.
  const std::uint32_t* region_at(std::uint32_t address) const {
    for (unsigned i = regions; i-- > 0;)
      if (covers(i, address)) return &attributes_[i];
    return nullptr;
  }
  bool covers(unsigned i, std::uint32_t address) const {
    const std::uint64_t size = region_bytes(i), first = bases_[i] & ~(size - 1);
    if (!mpu.rasr.enable.in(attributes_[i]) || address < first || address - first >= size) return false;
    const auto subregion = static_cast<unsigned>((address - first) * subregions / size);
    return size < smallest_with_subregions || (mpu.rasr.srd.of(attributes_[i]) >> subregion & 1) == 0;
  }
  /// ARMv7-M, table B3-15.
  static bool region_allows(std::uint32_t attributes, bool write, bool fetch, bool privileged) {
    if (fetch && mpu.rasr.xn.in(attributes)) return false;
    switch (mpu.rasr.ap.of(attributes)) {
      case 1: return privileged;
      case 2: return privileged || !write;
      case 3: return true;
      case 5: return privileged && !write;
      case 6:
      case 7: return !write;
      default: return false;
    }
  }
  std::uint32_t control_ = 0, region_ = 0;
  std::array<std::uint32_t, regions> bases_{}, attributes_{};
};

}  // namespace inkwell::virtual_board
