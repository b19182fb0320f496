// One clock for virtual boards that run at the same time: none gets more than a millisecond ahead of another.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace inkwell::virtual_board {

/// The boards of a group share a small file. Each has a place in it, which the system gives back when the board's
/// process ends in any way: its lock on the place is gone then.
class SharedClock {
 public:
  static constexpr std::size_t boards_maximum = 16;

  /// Joins the group, or begins one. A board that comes later starts where the group is. Throws std::runtime_error with
  /// a sentence.
  explicit SharedClock(const std::filesystem::path& file);
  ~SharedClock();
  SharedClock(const SharedClock&) = delete;
  SharedClock& operator=(const SharedClock&) = delete;

  /// Tells the others that `milliseconds` of this board's time have passed since it joined.
  void note(std::uint64_t milliseconds);
  /// Whether all others are as far as this board, so that its next millisecond may begin.
  bool lets_pass();

 private:
  /// 0: no board is there. Else one more than the milliseconds that have passed for the group.
  using Place = std::atomic<std::uint64_t>;
  static_assert(Place::is_always_lock_free, "processes share it");
  using Places = std::array<Place, boards_maximum>;

  void join();
  bool is_taken(std::size_t place) const;
  /// How far the boards are; 1 if there is none.
  std::uint64_t farthest() const;

  int file_ = -1;
  Places* places_ = nullptr;  ///< in the file
  std::size_t mine_ = 0;
  std::uint64_t joined_at_ = 1;
};

}  // namespace inkwell::virtual_board
