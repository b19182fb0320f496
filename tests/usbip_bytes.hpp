// Concatenates USB/IP messages.
#pragma once

#include <cstddef>
#include <vector>

#include "protocol/usbip/messages.hpp"

namespace inkwell::tests {

template <class... Messages>
std::vector<std::byte> joined(const Messages&... messages) {
  std::vector<std::byte> bytes;
  const auto append = [&](const auto& part) { bytes.insert(bytes.end(), part.begin(), part.end()); };
  (append(usbip::bytes_of(messages)), ...);
  return bytes;
}

}  // namespace inkwell::tests
