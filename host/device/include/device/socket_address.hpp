// Where a USB/IP server or the control socket of a virtual board listens.
#pragma once

#include <local/socket_address.hpp>

namespace inkwell::device {

using local::SocketAddress;

}  // namespace inkwell::device
