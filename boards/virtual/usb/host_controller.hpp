// A full-speed host controller with one device on its bus: frames, transactions, transfers.
//
// A frame lasts 1 ms of the host's clock. A frame contains, in this order, the start of frame, due interrupt endpoints,
// control endpoints, and bulk endpoints in rotation (USB 2.0, section 5). Transactions are sequential and last as long
// as on a 12 Mbit/s bus, including stuffed bits. A transaction that does not fit in the frame waits for the next frame.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>

#include "boards/stm32f405/core/interfaces.hpp"
#include "boards/stm32f405/otg_fs/bus.hpp"

#include "boards/virtual/usb/descriptors.hpp"
#include "boards/virtual/usb/urb.hpp"

namespace inkwell::virtual_board {

class HostController {
 public:
  /// Callbacks to the client. The callbacks run on the simulation thread.
  class Client {
   public:
    virtual ~Client() = default;
    /// Callback between two transactions. The callback may submit and unlink transfers.
    virtual void between_transactions() = 0;
    /// Callback before each start of frame.
    virtual void frame() = 0;
    virtual void completed(Urb&& urb, std::int32_t status) = 0;
  };

  /// The host's clock runs faster than board time by `clock_ppm` parts per million.
  HostController(Scheduler& scheduler, BusDevice& device, Client& client, double clock_ppm = 0.0);
  ~HostController();
  HostController(const HostController&) = delete;
  HostController& operator=(const HostController&) = delete;

  /// Starts or stops the frames. The device suspends after 3 ms without frames.
  void run_frames(bool run);
  /// If `polls` is false, the host sends frames but starts no transactions.
  void set_polling(bool polls) { is_polling_ = polls; }
  /// Sets the device address in tokens and the packet size of endpoint 0.
  void address_device(unsigned address, std::uint16_t control_packet_maximum);
  /// Enables the endpoints of all interfaces in `configuration` and sets their data toggles to DATA0.
  void configure(const ConfigurationDescription* configuration);
  void select_alternate(const ConfigurationDescription& configuration, std::uint8_t interface, std::uint8_t alternate);
  /// Call after CLEAR_FEATURE(ENDPOINT_HALT).
  void reset_toggle(std::uint8_t endpoint_address);

  void submit(Urb&& urb);
  /// Removes and returns a transfer, or returns std::nullopt if the transfer does not exist or has completed.
  std::optional<Urb> unlink(std::uint32_t sequence);
  /// Discards all transfers without calling completed().
  void cancel_all();

 private:
  struct Pipe {
    bool open = false;
    TransferType type = TransferType::control;
    std::uint16_t packet_maximum = 0;
    unsigned interval_frames = 1;
    bool data1 = false;
    std::deque<Urb> urbs;
    Ticks retry_at = 0;
    Ticks retry_after = 0;
    std::uint64_t due_frame = 0;
    unsigned errors = 0;
  };
  enum class Token : std::uint8_t { setup, out, in };
  struct Transaction {
    unsigned pipe;
    Token token;
    InReply reply;           ///< of an IN transaction
    bool abandoned = false;  ///< its transfer was unlinked meanwhile
  };
  static constexpr unsigned pipe_count = 32;  ///< 0..15 OUT and control, 16..31 IN

  void step();
  void begin_frame();
  void start_next_transaction();
  bool start(unsigned pipe_index);
  void finish_transaction();
  void handle_in(unsigned pipe_index, Urb& urb, const InReply& reply);
  void handle_out(unsigned pipe_index, Urb& urb, Token token);
  void handle_refusal(unsigned pipe_index, Handshake handshake);
  void complete(unsigned pipe_index, std::int32_t status);
  void close(Pipe& pipe);
  void open(const EndpointDescription& endpoint);
  static Token next_token(const Urb& urb, TransferType type);
  static std::uint32_t next_out_length(const Pipe& pipe, const Urb& urb, Token token);
  static std::span<const std::byte> next_out_data(const Pipe& pipe, const Urb& urb, Token token);

  Scheduler& scheduler_;
  BusDevice& device_;
  Client& client_;
  const Ticks frame_ticks_;
  Scheduler::Id event_ = 0;
  std::array<Pipe, pipe_count> pipes_{};
  std::uint32_t busy_pipes_ = 0;  ///< bit i: pipe i has transfers
  unsigned next_bulk_pipe_ = 0;
  unsigned address_ = 0;
  bool frames_run_ = false, is_polling_ = true;
  unsigned frames_idle_ = 0;
  std::uint64_t frame_ = 0;
  Ticks frame_begin_ = 0;
  Ticks bus_free_at_ = 0;
  std::optional<Transaction> transaction_;
  std::array<std::byte, full_speed_packet_maximum> packet_{};
};

}  // namespace inkwell::virtual_board
