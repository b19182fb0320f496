// Errors of a device, and of the code that uses the device.
#pragma once

#include <stdexcept>
#include <string>

#include "protocol/plain_text.hpp"

namespace inkwell::device {

/// Base class of all errors of this library. `what()` states the problem and the remedy. The text may quote a file, a
/// device or another program, and is safe to print.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& sentence) : std::runtime_error(protocol::plain_lines(sentence)) {}
};

/// The device is gone (unplugged, board stopped). A Session reconnects automatically.
class Disconnected : public Error {
 public:
  using Error::Error;
};

/// The device answered a request with a stall: the request is unknown or not accepted.
class Stalled : public Error {
 public:
  using Error::Error;
};

/// Another program uses the requested resource.
class InUse : public Error {
 public:
  using Error::Error;
};

/// The device is connected, but this user may not open it. `what()` contains the udev rule to install.
class NoPermission : public Error {
 public:
  using Error::Error;
};

}  // namespace inkwell::device
