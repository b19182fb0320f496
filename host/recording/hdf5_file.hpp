// A little order over the C interface of HDF5: handles that close themselves, and errors that throw.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <utility>

#include <hdf5.h>

namespace inkwell::recording {

/// An open HDF5 object of any kind.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t id() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Held around every use of HDF5: one thread at a time, because the library is not made for more, and without
/// its own printing, because errors become exceptions with sentences instead.
class QuietHdf5 {
 public:
  QuietHdf5();
  ~QuietHdf5();

 private:
  std::lock_guard<std::recursive_mutex> lock_;
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// For opening a file, without the library's own lock on it, unless the environment's HDF5_USE_FILE_LOCKING wants it.
/// That lock goes over to every process that is started meanwhile, and stays until the last of them has ended: nobody
/// could open the recording until then. Two recorders are kept apart by the file's name, which must be new; other
/// programs are not kept from writing into a recording that is being made.
Handle file_access();

/// Fixed-length UTF-8 text.
Handle text_type(std::size_t bytes);
/// The same for programs that know no UTF-8 and refuse the whole file for it, as Octave's `load` does: bytes of which
/// HDF5 takes no notice.
Handle byte_text_type(std::size_t bytes);

void write_attribute(hid_t object, const char* name, const std::string& text);
void write_attribute(hid_t object, const char* name, std::int64_t number);

}  // namespace inkwell::recording
