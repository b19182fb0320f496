// Who drives an arm: only one program may ask for forces, however many look on.
#pragma once

#include <string>

namespace inkwell::device {

/// Held by the program that drives; it ends with this object and with the process, even if it is killed. It is a lock
/// on a file in the folder for temporary files, so it binds the programs of one computer, on a real arm and on a
/// virtual one.
class DriverClaim {
 public:
  /// Throws InUse, naming the program that drives this arm already.
  explicit DriverClaim(const std::string& serial_number);
  ~DriverClaim();
  DriverClaim(const DriverClaim&) = delete;
  DriverClaim& operator=(const DriverClaim&) = delete;

 private:
  int file_ = -1;
};

}  // namespace inkwell::device
