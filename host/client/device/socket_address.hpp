// The address of a USB/IP server or of the control socket of a virtual board.
#pragma once

#include "host/client/local/socket_address.hpp"

namespace inkwell::device {

using local::SocketAddress;

}  // namespace inkwell::device
