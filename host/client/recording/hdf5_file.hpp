// C++ wrapper for the C interface of HDF5: handles that close automatically, and errors that throw.
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

/// Every use of HDF5 requires this object. The object serializes the threads, because the library is not thread-safe.
/// The object also disables the library's error output, because the wrapper throws exceptions.
class QuietHdf5 {
 public:
  QuietHdf5();
  ~QuietHdf5();

 private:
  std::lock_guard<std::recursive_mutex> lock_;
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Access list that disables the library's file lock, unless the environment variable HDF5_USE_FILE_LOCKING enables it.
/// Child processes would inherit this lock until they exit, and no program could then open the recording. Two recorders
/// cannot use one file, because its name must be new. Other programs are not prevented from writing into an unfinished
/// recording.
Handle file_access();

/// Disables all early writes and evictions of the metadata cache, which has up to some megabytes.
void keep_metadata(const Handle& access);

/// Fixed-length UTF-8 text.
Handle text_type(std::size_t bytes);
/// Fixed-length text without the UTF-8 mark. Some programs, such as Octave's `load`, refuse a file with UTF-8 text.
Handle byte_text_type(std::size_t bytes);

void write_attribute(hid_t object, const char* name, const std::string& text);
void write_attribute(hid_t object, const char* name, std::int64_t number);

}  // namespace inkwell::recording
