// Exceptions of the library. error.hpp declares the device errors.
#pragma once

#include "host/client/device/error.hpp"

namespace inkwell::library {

using device::Error;

/// The expected event did not occur in time.
class TimedOut : public Error {
 public:
  using Error::Error;
};
/// The function does not accept this value.
class BadArgument : public Error {
 public:
  using Error::Error;
};
/// The board or another program switched the force off.
class ForceLost : public Error {
 public:
  using Error::Error;
};
/// The device does not accept the request in its current state.
class NotNow : public Error {
 public:
  using Error::Error;
};

}  // namespace inkwell::library
