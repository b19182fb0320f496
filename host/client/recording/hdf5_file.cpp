#include "host/client/recording/hdf5_file.hpp"

#include "host/client/device/error.hpp"
#include "host/client/process/fork.hpp"

namespace inkwell::recording {
namespace {

std::recursive_mutex use_of_hdf5;
// Without this lock, a child forked during a write would inherit the library in an inconsistent state.
const process::HeldAtFork use_of_hdf5_at_fork(use_of_hdf5);

std::recursive_mutex& hdf5_mutex() {
  // Every file is closed by its owner. At exit the library would retry writes that a full disk has refused, and print
  // its own errors. The call has an effect only before the first use of the library.
  [[maybe_unused]] static const herr_t stays_quiet = H5dont_atexit();
  return use_of_hdf5;
}

void write_attribute_value(hid_t object, const char* name, hid_t type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute || H5Awrite(attribute.id(), type, value) < 0)
    throw device::Error(
        "The header of the recording could not be written. Free some space or choose another location.");
}

}  // namespace

Handle file_access() {
  Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(list.id(), false, true);
  return list;
}

void keep_metadata(const Handle& access) {
  H5AC_cache_config_t cache{};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  H5Pget_mdc_config(access.id(), &cache);
  cache.evictions_enabled = false;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  H5Pset_mdc_config(access.id(), &cache);
}

Handle text_type(std::size_t bytes) {
  Handle type = byte_text_type(bytes);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

Handle byte_text_type(std::size_t bytes) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), bytes == 0 ? 1 : bytes);
  // The text is padded with zeros and not terminated, so it may fill all bytes.
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  return type;
}

QuietHdf5::QuietHdf5() : lock_(hdf5_mutex()) {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietHdf5::~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

void write_attribute(hid_t object, const char* name, const std::string& text) {
  write_attribute_value(object, name, text_type(text.size()).id(), text.c_str());
}

void write_attribute(hid_t object, const char* name, std::int64_t number) {
  write_attribute_value(object, name, H5T_NATIVE_INT64, &number);
}

}  // namespace inkwell::recording
