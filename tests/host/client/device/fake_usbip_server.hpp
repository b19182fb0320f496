// A USB/IP server with an Inkwell device, for tests. The test sets the answers.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/client/device/transport.hpp"
#include "protocol/black_box.hpp"
#include "protocol/reports.hpp"
#include "protocol/store.hpp"

#include "firmware/link/driver_claim.hpp"

#include "tests/host/client/device/answered_commands.hpp"
#include "tests/host/client/device/local_server.hpp"

namespace inkwell::tests {

using Bytes = std::vector<std::byte>;

template <class Report>
Bytes bytes_of(const Report& report) {
  const auto bytes = std::as_bytes(std::span(&report, 1));
  return {bytes.begin(), bytes.end()};
}

class FakeUsbipServer {
 public:
  explicit FakeUsbipServer(const device::SocketAddress& where = {});

  std::uint16_t port() const { return server_.port(); }
  device::Endpoint endpoint() const;

  // The test sets these members before a client connects.
  std::string path;  ///< path of the device on the server
  std::uint16_t vendor_id = 0x1209;
  std::uint16_t product_id = 0x0001;
  std::string serial_number = "0123456789ABCDEF01234567";
  bool refuses_import = false;
  /// Modifies the reply to a client's first request.
  std::function<void(Bytes&)> spoil_reply = [](Bytes&) {};
  Bytes device_descriptor;
  Bytes configuration;  ///< descriptor
  protocol::InformationReport information{};
  protocol::FrameReport bus_frame{};
  std::optional<protocol::BlackBoxReport> black_box;  ///< empty: the request is stalled
  protocol::ParameterSet parameters = protocol::default_parameters();
  protocol::StoreReport store{};
  link::DriverClaim driver;
  AnsweredCommands request_results;
  protocol::ParameterSet at_next_start = protocol::default_parameters();
  /// Decides the result of a store or erase command. While the result is `under_way`, nothing is written.
  std::function<protocol::StoreResult(protocol::Command)> judge_store = [](protocol::Command) {
    return protocol::StoreResult::done;
  };
  /// If true, the server ignores store and erase commands.
  bool ignores_store = false;
  /// Decides the result of a transaction from its entries.
  std::function<protocol::Refusal(const protocol::ParametersReport&)> judge = [](const protocol::ParametersReport&) {
    return protocol::Refusal::accepted;
  };
  /// If true, an accepted transaction is answered with a stall.
  bool stalls_accepted = false;
  std::function<void(protocol::ReportId, std::size_t length)> on_get = [](auto, auto) {};
  std::function<protocol::RequestResult()> judge_shapes = [] { return protocol::RequestResult::accepted; };
  /// Changes the content of a feature report that is sent to the client.
  std::map<protocol::ReportId, std::function<void(Bytes&)>> spoil;
  /// The server answers this number of transactions by closing the connection.
  std::atomic<int> transactions_to_break_at = 0;
  /// This function is called before the server closes the connection at a transaction.
  std::function<void()> on_break = [] {};
  /// If true, the scope belongs to another program, so scope transfers fail immediately.
  std::atomic<bool> scope_is_taken = false;
  /// If true, control requests are received but not answered, as if board time did not advance.
  std::atomic<bool> holds_requests = false;
  /// If true, the server answers an output report only when answer_output() is called.
  std::atomic<bool> holds_outputs = false;
  /// Status in the answer to an output report: 0 or a negative errno.
  std::atomic<std::int32_t> output_status = 0;
  /// If true, the server accepts connections and sends no answer.
  bool silent = false;

  /// Answers the oldest pending or the next transfer of this IN endpoint (1 pose, 2 scope).
  void send(std::uint8_t endpoint, Bytes data);
  /// Fails the oldest pending transfer of this IN endpoint with a negative errno.
  void fail(std::uint8_t endpoint, std::int32_t status);
  /// Answers the oldest unanswered output report.
  void answer_output();
  /// Sends bytes that do not answer any request.
  void send_unasked(std::span<const std::byte> bytes);
  /// Closes the connection, like a stopped board.
  void hang_up() { server_.hang_up(); }

  std::vector<protocol::CommandReport> commands();
  std::vector<protocol::ForceReport> forces();
  /// Shape reports with their received lengths.
  std::vector<Bytes> shapes_placed();
  std::size_t waiting_transfers(std::uint8_t endpoint);
  /// Number of transfers that the client has canceled.
  std::size_t transfers_taken_back();
  std::size_t transactions();
  std::size_t imports();

 private:
  void serve(int client);
  void serve_requests(int client);
  void serve_transfers(int client);
  void take_back(int client, std::uint32_t sequence, std::uint32_t unlinked_sequence);
  void match(std::uint8_t endpoint);
  void take_output(const Bytes& data);
  void take_store_command(protocol::Command command);
  void answer(int client, std::uint32_t sequence, std::int32_t status, const Bytes& data, std::uint32_t length);
  std::optional<Bytes> answer_report_request(const std::uint8_t (&setup)[8], const Bytes& data);
  std::optional<Bytes> answer_control(const std::uint8_t (&setup)[8], const Bytes& data);
  std::optional<Bytes> feature_report(protocol::ReportId id);

  std::mutex mutex_;
  int client_ = -1;
  bool is_configured_ = false;
  std::map<std::uint8_t, std::deque<std::uint32_t>> waiting_;
  std::map<std::uint8_t, std::deque<Bytes>> ready_;
  std::deque<std::uint32_t> held_outputs_;
  std::vector<protocol::CommandReport> commands_;
  std::vector<protocol::ForceReport> forces_;
  std::vector<Bytes> shapes_placed_;
  protocol::TransactionReport transaction_{};
  std::size_t taken_back_ = 0;
  std::size_t imports_ = 0;
  LocalServer server_;
};

/// A scope frame with one sample of one float signal.
Bytes scope_frame(std::uint8_t token, std::uint32_t first_period, float value);

/// Waits for at most one minute until the condition is true.
bool eventually(const std::function<bool()>& condition);

}  // namespace inkwell::tests
