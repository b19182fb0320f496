// Sets up a memory protection region with one setting that the manual leaves undefined. Port D selects the region.
#include "tests/boards/stm32f405/firmware/protection.hpp"

namespace {

struct Region {
  std::uint32_t base, attributes;
};
constexpr std::uint32_t region_base = 0x2001'0000, one_eighth = 1 << 8, written_back = 0x0B << 16;
constexpr Region regions[] = {
    {region_base + 256, size(8) | one_eighth | all << 24 | written_back},  // valid settings
    {region_base + 32, size(6) | all << 24 | normal},
    {region_base, size(4) | all << 24 | normal},
    {region_base, size(7) | one_eighth | all << 24 | normal},
    {region_base, size(8) | 4 << 24 | normal},
    {region_base, size(8) | all << 24 | 3 << 19},
    {region_base, size(8) | all << 24 | 1 << 19 | 1 << 16},
    {region_base, size(8) | all << 24 | 2 << 19 | 1 << 16},
};

}  // namespace

void run() {
  word(rcc::ahb1enr) |= 8;
  [[maybe_unused]] const std::uint32_t ready = word(rcc::ahb1enr);
  const Region& region = regions[word(0x40020C00 + gpio::idr) & 7];
  set_region(0, region.base, region.attributes);
  set_region(0, region_base, size(8));
  word(mpu_attributes) = 0;
  results[0] = finished;
}
