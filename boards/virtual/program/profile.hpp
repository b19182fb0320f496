// Profile of the longest interrupt.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace inkwell::virtual_board {

/// Records the longest run of an exception handler, instruction by instruction. If a handler is preempted, the sections
/// before and after the preemption count as separate runs.
class Profile {
 public:
  /// Call this before each instruction. `exception` is 0 in thread mode.
  void instruction(unsigned exception, std::uint32_t address, std::uint64_t cycles);

  /// Writes one line per instruction of the longest run: the hexadecimal address and the cycles. Throws
  /// std::runtime_error if the file cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  struct Step {
    std::uint32_t address;
    std::uint64_t begin_cycle;
  };
  unsigned exception_ = 0;
  std::vector<Step> run_, longest_;  ///< the last step of longest_ is the end of the handler
  std::uint64_t longest_cycles_ = 0;
};

}  // namespace inkwell::virtual_board
