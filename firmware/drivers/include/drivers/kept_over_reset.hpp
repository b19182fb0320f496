// What a run leaves for the next one: it lies in memory that start-up does not clear.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

namespace inkwell::drivers {

/// Put it into .noinit. Memory after power-up holds anything, so what is there is checked.
template <class Facts>
class KeptOverReset {
 public:
  static_assert(std::is_trivially_copyable_v<Facts> && sizeof(Facts) % sizeof(std::uint32_t) == 0);

  void leave(const Facts& facts) {
    facts_ = facts;
    check_ = check_of(facts_);
  }

  void forget() { check_ = ~check_of(facts_); }

  /// What the run before left, once.
  std::optional<Facts> take() {
    const bool is_sound = check_ == check_of(facts_);
    forget();
    if (!is_sound) return std::nullopt;
    return facts_;
  }

 private:
  /// Each bit that changes changes it, and so do words that change places.
  static std::uint32_t check_of(const Facts& facts) {
    std::uint32_t check = 0x696E6B77;
    for (std::size_t i = 0; i < sizeof facts; i += sizeof(std::uint32_t)) {
      std::uint32_t word;
      std::memcpy(&word, reinterpret_cast<const char*>(&facts) + i, sizeof word);
      check = (check << 1 | check >> 31) ^ word;
    }
    return check;
  }

  Facts facts_;
  std::uint32_t check_;
};

}  // namespace inkwell::drivers
