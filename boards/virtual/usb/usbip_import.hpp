// Import of the device by one client.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <unordered_map>

#include "boards/virtual/usb/urb.hpp"

namespace inkwell::virtual_board {

class UsbIpImport {
 public:
  explicit UsbIpImport(std::uint32_t session) : session_(session) {}

  /// Number of the import. Late answers of an earlier import have a different number and are discarded.
  std::uint32_t session() const { return session_; }

  /// Throws std::runtime_error if the sequence number is in use or the server's limit is exceeded.
  void add(const Urb& urb) {
    if (!lengths_.emplace(urb.sequence, urb.length).second)
      throw std::runtime_error("it reuses the sequence number of an unanswered request");
    bytes_ += urb.length;
    if (lengths_.size() > transfers_maximum || bytes_ > bytes_maximum)
      throw std::runtime_error("it has more pending transfers than the server allows");
  }
  void forget(std::uint32_t sequence) {
    const auto found = lengths_.find(sequence);
    if (found == lengths_.end()) return;
    bytes_ -= found->second;
    lengths_.erase(found);
  }
  /// Throws std::runtime_error if the number of pending unlink requests exceeds the allowed number of transfers.
  void add_unlink() {
    if (++unlinks_ > transfers_maximum)
      throw std::runtime_error("it has more pending unlink requests than the server allows");
  }
  void forget_unlink() { --unlinks_; }

 private:
  static constexpr std::size_t transfers_maximum = 4096;
  static constexpr std::uint64_t bytes_maximum = 64u << 20;

  std::uint32_t session_;
  std::unordered_map<std::uint32_t, std::uint32_t> lengths_;  ///< of unanswered transfers, by sequence number
  std::uint64_t bytes_ = 0;
  std::size_t unlinks_ = 0;  ///< unanswered
};

}  // namespace inkwell::virtual_board
