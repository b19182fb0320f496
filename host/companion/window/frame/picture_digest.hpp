// A digest of a picture, computed without drawing. Equal pictures have equal digests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <type_traits>

namespace inkwell::window {

class PictureDigest {
 public:
  void add_bytes(const void* data, std::size_t size) {
    const std::string_view bytes{static_cast<const char*>(data), size};
    value_ = value_ * 0x9E3779B97F4A7C15u + std::hash<std::string_view>{}(bytes);
  }
  /// Adds a value. The type of the value must have no padding bytes.
  template <class Value>
  void add(const Value& value) {
    static_assert(!std::is_pointer_v<Value>, "an address does not identify the content");
    static_assert(std::has_unique_object_representations_v<Value> || std::is_floating_point_v<Value>);
    add_bytes(&value, sizeof value);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0;
};

}  // namespace inkwell::window
