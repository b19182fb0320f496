// Common clock of simultaneous virtual boards. The board times of a group differ by at most one millisecond.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace inkwell::virtual_board {

/// The boards of a group share a small file with one slot per board. Each board has a file lock on its slot. The
/// operating system releases the lock when the board's process exits.
class SharedClock {
 public:
  static constexpr std::size_t boards_maximum = 16;

  /// Joins or creates the group of boards. A board that joins later starts at the group's time. Throws
  /// std::runtime_error with an error sentence.
  explicit SharedClock(const std::filesystem::path& file);
  ~SharedClock();
  SharedClock(const SharedClock&) = delete;
  SharedClock& operator=(const SharedClock&) = delete;

  /// Publishes the milliseconds since this board joined the group.
  void note(std::uint64_t milliseconds);
  /// Returns true if all other boards have reached this board's time.
  bool lets_pass();

 private:
  /// A slot contains 0 if it is free, and otherwise 1 plus the board's group time in milliseconds.
  using Slot = std::atomic<std::uint64_t>;
  static_assert(Slot::is_always_lock_free, "processes share it");
  using Slots = std::array<Slot, boards_maximum>;

  void join();
  bool is_taken(std::size_t slot) const;
  /// Returns the largest value of all slots, or 1 if all slots are free.
  std::uint64_t farthest() const;

  int file_ = -1;
  Slots* slots_ = nullptr;  ///< mapping of the file
  std::size_t mine_ = 0;
  std::uint64_t joined_at_ = 1;
};

}  // namespace inkwell::virtual_board
