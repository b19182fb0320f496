// Where the cycles of the longest interrupt go.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace inkwell::virtual_board {

/// Keeps the longest run of any handler, instruction by instruction. A handler that is preempted counts in pieces.
class Profile {
 public:
  /// Before each instruction: the exception that runs (0 is none), its address, and the cycles so far.
  void instruction(unsigned exception, std::uint32_t address, std::uint64_t cycles);

  /// A line for each instruction of the longest run, in order: its address, hexadecimal, and its cycles. Throws
  /// std::runtime_error if the file can not be written.
  void write(const std::filesystem::path& file) const;

 private:
  struct Step {
    std::uint32_t address;
    std::uint64_t begin_cycle;
  };
  unsigned exception_ = 0;
  std::vector<Step> run_, longest_;  ///< the last one of longest_ is where the handler ended
  std::uint64_t longest_cycles_ = 0;
};

}  // namespace inkwell::virtual_board
