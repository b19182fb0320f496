// The address of a USB/IP server or control socket.
#pragma once

#include "host/client/local/socket_address.hpp"

namespace inkwell::device {

using local::SocketAddress;

}  // namespace inkwell::device
