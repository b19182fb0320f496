// The protocol on top of a link: poses, commands, parameters, scope. Synchronous; see session.hpp for the
// threaded client that the window uses.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <device/link.hpp>
#include <protocol/reports.hpp>
#include <protocol/scope.hpp>

namespace inkwell::device {

struct Information {
  std::string firmware_version;
  std::uint16_t protocol_version;
  std::string serial_number;
  protocol::InformationReport report;
};

/// A transaction was refused; the device keeps its old values.
class Refused : public Error {
 public:
  Refused(protocol::TransactionReport report);
  protocol::TransactionReport report;
};

/// Samples of consecutive control periods, decoded: values[i * signals.size() + j] is signal j of sample i.
struct ScopeSamples {
  std::vector<protocol::Signal> signals;
  std::uint32_t first_period = 0;
  std::size_t count = 0;
  std::vector<float> values;
  std::uint64_t lost_before = 0;  ///< control periods missing between the samples before and these
};

using ParameterChange = std::pair<protocol::Parameter, float>;

class Device {
 public:
  /// Opens the device and checks the protocol version first. Throws Error with the remedy if it differs.
  static std::unique_ptr<Device> open(const Endpoint& endpoint);
  explicit Device(std::unique_ptr<Link> link);
  ~Device();

  Information information();

  /// Waits for the next pose report; none on time-out.
  std::optional<protocol::PoseReport> read_pose(std::chrono::milliseconds timeout);

  /// Sends a command and returns its token, which comes back in PoseReport::command_token.
  std::uint8_t send(protocol::Command command);
  std::uint8_t send(protocol::Command command, const protocol::TestPulse& pulse);
  std::uint8_t select_signals(std::span<const protocol::Signal> signals);  ///< none stops the scope

  protocol::ParameterSet parameters();
  /// One transaction: all take effect at one control period, or none does and Refused is thrown.
  protocol::TransactionReport set_parameters(std::span<const ParameterChange> changes);
  protocol::TransactionReport restore_default_parameters();

  /// Waits for the next scope frame; none on time-out. May be called from a second thread.
  std::optional<ScopeSamples> read_scope(std::chrono::milliseconds timeout);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace inkwell::device
