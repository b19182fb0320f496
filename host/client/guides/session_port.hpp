// Runs guides on a device::Session, which connects and reconnects automatically.
#pragma once

#include <functional>
#include <utility>

#include "host/client/device/session.hpp"
#include "host/client/guides/device_port.hpp"

namespace inkwell::guides {

class SessionPort final : public DevicePort {
 public:
  /// `select` selects the scope signals if the scope has several users.
  SessionPort(device::Session& session, std::function<void(std::vector<protocol::Signal>)> select)
      : session_(session), select_(std::move(select)) {}
  explicit SessionPort(device::Session& session)
      : SessionPort(session,
                    [&session](std::vector<protocol::Signal> signals) { session.select_signals(std::move(signals)); }) {
  }

  void send(protocol::Command command) override { session_.send(command); }
  void send(protocol::Command command, const protocol::TestPulse& pulse) override { session_.send(command, pulse); }
  void set_parameters(std::vector<device::ParameterChange> changes) override {
    session_.set_parameters(std::move(changes));
  }
  void select_signals(std::vector<protocol::Signal> signals) override { select_(std::move(signals)); }

 private:
  device::Session& session_;
  std::function<void(std::vector<protocol::Signal>)> select_;
};

Observation observe(const device::Session& session);

}  // namespace inkwell::guides
