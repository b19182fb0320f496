// Whether a bit of the firmware or of its parameters has changed by itself, looked for in the background.
#pragma once

#include <cstddef>
#include <cstdint>

namespace inkwell::application {

/// One round goes through the image in the flash, against the checksum that the build has put behind it
/// (tools/seal_image.py), through the copies from which interrupts run, against the image, and through the settings
/// that the control interrupt works with and the parameters that the next ones would be made of. It takes about a fifth
/// of a second.
class MemoryCheck {
 public:
  /// The first round, at once: nothing that is damaged shall drive a motor. False if a bit is wrong.
  [[nodiscard]] bool start();

  /// A few words. Call it each time that the main loop comes round; false from the first wrong bit on.
  [[nodiscard]] bool step();

 private:
  void check_flash();
  void check_copy();
  void check_parameters();
  void begin_round();

  bool sound_ = true;
  std::size_t part_ = 0;  ///< of the round: the flash, then each copy, then settings, parameters, and those stored
  const std::uint32_t* next_ = nullptr;  ///< word of that part
};

}  // namespace inkwell::application
