// Errors of the device code.
#pragma once

#include <stdexcept>
#include <string>

#include "protocol/plain_text.hpp"

namespace inkwell::device {

/// Base class of all errors. `what()` states the problem and the remedy, and is safe to print.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& sentence) : std::runtime_error(protocol::plain_lines(sentence)) {}
};

/// The device was unplugged, or its board has stopped. A Session reconnects automatically.
class Disconnected : public Error {
 public:
  using Error::Error;
};

/// The device refused a request with a stall.
class Stalled : public Error {
 public:
  using Error::Error;
};

/// Another program uses the requested resource.
class InUse : public Error {
 public:
  using Error::Error;
};

/// The user has no permission to open the connected device. `what()` contains the required udev rule.
class NoPermission : public Error {
 public:
  using Error::Error;
};

}  // namespace inkwell::device
