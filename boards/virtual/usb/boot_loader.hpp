// USB interface of ST's boot loader in the system memory of the chip: DFU 1.1 with ST's extensions (AN3156, AN2606).
// The virtual chip executes the erase and program operations with realistic timing (loader_order.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "boards/stm32f405/core/debug_port.hpp"
#include "boards/stm32f405/otg_fs/bus.hpp"
#include "boards/stm32f405/wiring/loader_order.hpp"

namespace inkwell::virtual_board {

/// Contents of a SETUP packet (USB 2.0, section 9.3).
struct SetupPacket {
  std::uint8_t type, request;
  std::uint16_t value, index, length;
};

/// Executes DFU requests.
class BootLoaderDfu {
 public:
  static constexpr std::uint16_t transfer_bytes = 2048;

  /// Restores the start-up state.
  void start();
  /// Returns the next order for the virtual chip. Board time does not pass during next_order().
  LoaderOrder next_order(DebugPort& memory);
  /// Returns true while the chip executes an order. No request can be answered during an order.
  bool is_busy() const { return asked_.has_value() || is_working_; }
  /// Returns true if the next order starts the program.
  bool is_about_to_leave() const { return asked_ && asked_->kind == Operation::Kind::leave; }
  /// Handles a request with its complete data. Returns false if the endpoint must stall.
  bool take(const SetupPacket& request, std::span<const std::byte> data);
  /// Answers a request for data. Returns std::nullopt if the endpoint must stall. If is_busy() is true after the call,
  /// call answer() again when is_busy() is false.
  std::optional<std::vector<std::byte>> answer(const SetupPacket& request);
  /// Returns true if the loader has started the program or reset the chip.
  bool has_left() const { return has_left_; }

 private:
  enum class State : std::uint8_t {  ///< DFU 1.1, appendix A
    idle = 2,
    download_sync = 3,
    download_busy = 4,
    download_idle = 5,
    manifest_sync = 6,
    manifest = 7,
    upload_idle = 9,
    error = 10,
  };
  enum class Status : std::uint8_t { ok = 0, target = 1, programming = 6, address = 8, vendor = 0xB, stalled = 0xF };
  struct Operation {
    enum class Kind : std::uint8_t { set_address, erase, erase_all, write, write_options, read, leave };
    Kind kind;
    std::uint32_t address = 0;
    std::vector<std::byte> data{};
    std::uint32_t length = 0;
  };
  struct Step {
    LoaderOrder::Kind kind;
    std::uint32_t address, word;
    std::vector<std::byte> data{};
  };

  bool download(std::uint16_t block, std::span<const std::byte> data);
  std::optional<Operation> command_of(std::span<const std::byte> data);
  std::vector<std::byte> status();
  bool fail(Status status);
  void begin(DebugPort& memory);
  void unlock();
  void store(std::uint32_t address, std::uint32_t word);
  void finish(DebugPort& memory);
  std::optional<std::vector<std::byte>> read(DebugPort& memory, std::uint32_t address, std::uint32_t length);
  static unsigned poll_time_ms(const Operation& operation);

  State state_ = State::idle;
  Status status_ = Status::ok;
  std::uint32_t pointer_ = 0;
  std::optional<Operation> waiting_;  ///< until the host reads the status
  std::optional<Operation> asked_;    ///< starts with the next order
  std::deque<Step> steps_;            ///< of the running operation
  Step current_{};                    ///< stores its data until the next order
  bool is_working_ = false, has_left_ = false;
  std::optional<std::vector<std::byte>> read_;  ///< result of an upload
};

/// The USB device of the boot loader: endpoint 0, descriptors and standard requests.
class BootLoader final : public BusDevice {
 public:
  /// Returns the next order of the loader. The first call of next_order() connects the loader to the bus.
  LoaderOrder next_order(DebugPort& memory);
  /// Call this function at each reset of the chip.
  void stop() { is_running_ = false; }
  bool is_running() const { return is_running_; }

  std::uint32_t attachment() const override { return is_running_ ? attachments_ : 0; }
  void set_bus_power(bool) override {}  // ST's loader enables the pull-up on D+ with or without a cable
  void begin_reset() override;
  void end_reset() override { is_silent_ = false; }
  void start_of_frame(std::uint16_t) override {}
  void suspend() override {}
  void resume() override {}
  Handshake setup(unsigned address, unsigned endpoint, std::span<const std::byte, 8> request) override;
  Handshake out(unsigned address, unsigned endpoint, bool data1, std::span<const std::byte> data) override;
  InReply in(unsigned address, unsigned endpoint, std::span<std::byte, full_speed_packet_maximum> data) override;
  bool finish_in(unsigned endpoint) override;

 private:
  bool is_addressed(unsigned address, unsigned endpoint) const;
  bool has_to_wait() const;
  std::optional<std::vector<std::byte>> answer();
  std::optional<std::vector<std::byte>> descriptor() const;
  bool take();

  BootLoaderDfu dfu_;
  std::string serial_number_;
  bool is_running_ = false, is_silent_ = true;
  std::uint32_t attachments_ = 0;
  unsigned address_ = 0;
  std::optional<unsigned> next_address_;
  std::uint8_t configuration_ = 0, alternate_ = 0;

  SetupPacket request_{};
  std::vector<std::byte> data_;                    ///< received
  std::optional<std::vector<std::byte>> to_send_;  ///< empty until the answer is known
  std::size_t sent_ = 0, on_wire_ = 0;
  bool data1_ = false;
  bool is_refused_ = false, is_taken_ = false;
  bool is_answering_ = false;  ///< a request for data whose status stage has not arrived
};

}  // namespace inkwell::virtual_board
