#include "host/client/guides/session_port.hpp"

namespace inkwell::guides {

Observation observe(const device::Session& session) {
  const auto status = session.status();
  Observation now;
  now.connected = status.connection == device::Connection::connected;
  now.message = status.message;
  now.information = status.information;
  now.is_simulation = status.is_simulation;
  now.pose = session.newest_pose();
  // The revision is read first, so that the parameters are at least as new as the revision.
  now.parameters_revision = session.parameters_revision();
  now.parameters = session.parameters();
  now.refusal = session.refusal();
  return now;
}

}  // namespace inkwell::guides
