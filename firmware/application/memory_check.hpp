// Background check of firmware and parameters for changed bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace inkwell::application {

/// One round takes about 0.2 s. The image in flash is compared with the checksum at its end
/// (tools/generate/seal_image.py). The interrupt code and tables in RAM are compared with the flash. The settings of
/// the control interrupt and the parameters are compared with their checksums.
class MemoryCheck {
 public:
  /// Checks the whole memory once before a motor is driven. Returns false if a memory bit is wrong.
  [[nodiscard]] bool start();

  /// Checks a few words. Call this function in each round of the main loop. Returns false as soon as a wrong bit has
  /// been found.
  [[nodiscard]] bool step();

 private:
  void check_flash();
  void check_copy();
  void check_parameters();
  void begin_round();

  bool intact_ = true;
  std::size_t part_ = 0;  ///< part of the round: flash, each copy, settings, parameters, stored parameters
  const std::uint32_t* next_ = nullptr;  ///< next word of this part
};

}  // namespace inkwell::application
