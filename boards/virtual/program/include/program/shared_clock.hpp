// Common clock of simultaneous virtual boards: no board gets more than a millisecond ahead of another.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace inkwell::virtual_board {

/// The boards of a group share a small file with one slot per board. Each board owns a file lock on its slot. The
/// system releases the lock when the board's process exits for any reason.
class SharedClock {
 public:
  static constexpr std::size_t boards_maximum = 16;

  /// Joins the group or creates it. A later board starts at the group's time. Throws std::runtime_error with a
  /// sentence.
  explicit SharedClock(const std::filesystem::path& file);
  ~SharedClock();
  SharedClock(const SharedClock&) = delete;
  SharedClock& operator=(const SharedClock&) = delete;

  /// Publishes that `milliseconds` of this board's time have passed since it joined.
  void note(std::uint64_t milliseconds);
  /// Returns true if all other boards have reached this board's time. The next millisecond of this board may then
  /// begin.
  bool lets_pass();

 private:
  /// 0: the slot is free. Otherwise 1 plus the group time of the board in milliseconds.
  using Place = std::atomic<std::uint64_t>;
  static_assert(Place::is_always_lock_free, "processes share it");
  using Places = std::array<Place, boards_maximum>;

  void join();
  bool is_taken(std::size_t place) const;
  /// Largest value of all slots; 1 if there is no board.
  std::uint64_t farthest() const;

  int file_ = -1;
  Places* places_ = nullptr;  ///< mapping of the file
  std::size_t mine_ = 0;
  std::uint64_t joined_at_ = 1;
};

}  // namespace inkwell::virtual_board
