// What the library itself refuses; what the device refuses is in device/error.hpp and its neighbours.
#pragma once

#include <device/error.hpp>

namespace inkwell::library {

using device::Error;

/// What was waited for did not come.
class TimedOut : public Error {
 public:
  using Error::Error;
};
/// A value that the function can not take.
class BadArgument : public Error {
 public:
  using Error::Error;
};
/// The force went off, and this program did not switch it off.
class ForceLost : public Error {
 public:
  using Error::Error;
};
/// The device does not take it, or not now.
class NotNow : public Error {
 public:
  using Error::Error;
};

}  // namespace inkwell::library
