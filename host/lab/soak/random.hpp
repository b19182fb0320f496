// Random numbers with the same values on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace inkwell::soak {

class Random {
 public:
  /// Each sitting has a separate `stream` of random numbers.
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(mixed(seed + 0x9E3779B97F4A7C15u * (stream + 1))) {}

  double from(double low, double high) { return low + (high - low) * part(); }
  /// Returns a number from 0 to `count` - 1. `count` must not be 0.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(part() * static_cast<double>(count)); }
  bool chance(double probability) { return part() < probability; }
  template <class Container>
  const auto& pick(const Container& some) {
    return some[below(std::size(some))];
  }
  template <class Value>
  void shuffle(std::vector<Value>& values) {
    for (std::size_t left = values.size(); left > 1; --left) std::swap(values[left - 1], values[below(left)]);
  }

 private:
  /// Returns a number of at least 0 and less than 1.
  double part() { return static_cast<double>(engine_() >> 11) / 9007199254740992.0; }
  /// Decorrelates adjacent seeds (splitmix64).
  static std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
  }
  std::mt19937_64 engine_;
};

}  // namespace inkwell::soak
