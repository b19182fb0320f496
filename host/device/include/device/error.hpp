// What can go wrong with a device, and with everything that is made of it.
#pragma once

#include <stdexcept>
#include <string>

#include <protocol/plain_text.hpp>

namespace inkwell::device {

/// Every failure of this library: `what()` is a sentence that says what is wrong and what to do. It may quote a file, a
/// device or another program, and is safe to print.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& sentence) : std::runtime_error(protocol::plain_lines(sentence)) {}
};

/// The device went away (unplugged, board stopped). A Session reconnects by itself.
class Disconnected : public Error {
 public:
  using Error::Error;
};

/// The device answered a request with a stall: it does not know it, or does not accept it.
class Stalled : public Error {
 public:
  using Error::Error;
};

/// Another program has what was asked for.
class InUse : public Error {
 public:
  using Error::Error;
};

/// The device is there, but this user may not open it. `what()` holds the udev line to install.
class NoPermission : public Error {
 public:
  using Error::Error;
};

}  // namespace inkwell::device
