// Stores data in memory that start-up does not clear.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

namespace inkwell::drivers {

/// Place objects of this class in .noinit. Memory is undefined after power-on, so the contents are checked.
template <class Facts>
class KeptOverReset {
 public:
  static_assert(std::is_trivially_copyable_v<Facts> && sizeof(Facts) % sizeof(std::uint32_t) == 0);

  void store(const Facts& facts) {
    facts_ = facts;
    check_ = check_of(facts_);
  }

  void erase() { check_ = ~check_of(facts_); }

  /// Returns the data of the previous run. Only the first call returns data.
  std::optional<Facts> load_and_erase() {
    const bool is_valid = check_ == check_of(facts_);
    erase();
    if (!is_valid) return std::nullopt;
    return facts_;
  }

 private:
  /// The check value changes if a single bit changes or if words are exchanged.
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
