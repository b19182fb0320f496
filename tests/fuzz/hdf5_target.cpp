// HDF5 recordings. The input chooses the declarations in a valid file, so that every declaration of the format is
// tried. Random bytes would mostly test the HDF5 library.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/client/device/error.hpp"
#include "host/client/recording/recording.hpp"

#include "host/client/recording/formats.hpp"
#include "host/client/recording/hdf5_file.hpp"
#include "tests/fuzz/target.hpp"

namespace inkwell::fuzz {
namespace {

using recording::Handle;

/// Chooses options from the input bytes. Missing input bytes count as 0. A recording is valid if all choices are 0.
class Choices {
 public:
  explicit Choices(Input left) : left_(left) {}
  std::size_t of(std::size_t count) {
    if (left_.empty()) return 0;
    const auto choice = std::to_integer<std::size_t>(left_.front()) % count;
    left_ = left_.subspan(1);
    return choice;
  }

 private:
  Input left_;
};

Handle text_of(std::size_t bytes) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), bytes);
  return type;
}

Handle copy_of(hid_t type) { return {H5Tcopy(type), H5Tclose}; }

Handle chosen_type(Choices& choices, hid_t wanted) {
  switch (choices.of(16)) {
    case 1: return copy_of(H5T_STD_I8LE);
    case 2: return copy_of(H5T_STD_U64BE);
    case 3: return copy_of(H5T_IEEE_F32BE);
    case 4: return copy_of(H5T_IEEE_F64LE);
    case 5: return copy_of(H5T_NATIVE_LDOUBLE);
    case 6: return text_of(1);
    case 7: return text_of(300);
    case 8: return text_of(5000);
    case 9: return text_of(H5T_VARIABLE);
    case 10: return {H5Tvlen_create(H5T_IEEE_F32LE), H5Tclose};
    case 11: return {H5Tcreate(H5T_OPAQUE, 100), H5Tclose};
    case 12: return {H5Tenum_create(H5T_STD_I32LE), H5Tclose};
    case 13: return copy_of(H5T_STD_REF_OBJ);
    case 14: {
      Handle wide = copy_of(H5T_STD_I64LE);
      H5Tset_size(wide.id(), 32);
      H5Tset_precision(wide.id(), 256);
      return wide;
    }
    case 15: {
      Handle compound(H5Tcreate(H5T_COMPOUND, 64), H5Tclose);
      H5Tinsert(compound.id(), "number", 0, H5T_IEEE_F32LE);
      return compound;
    }
    default: return copy_of(wanted);
  }
}

Handle simple_space(std::vector<hsize_t> sizes) {
  return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose};
}

enum class Rank { scalar, column };

Handle chosen_space(Choices& choices, Rank wanted) {
  switch (choices.of(8)) {
    case 1: return {H5Screate(wanted == Rank::scalar ? H5S_NULL : H5S_SCALAR), H5Sclose};
    case 2: return simple_space({1});
    case 3: return simple_space({0});
    case 4: return simple_space({1000});
    case 5: return simple_space({hsize_t{1} << 38});
    case 6: return simple_space({3, 1});
    case 7: return simple_space({1, 1, 1, 1});
    default: return wanted == Rank::scalar ? Handle(H5Screate(H5S_SCALAR), H5Sclose) : simple_space({3});
  }
}

/// Returns arbitrary bytes for this dataspace, or an empty string if it is too large.
std::string values_of(hid_t type, hid_t space) {
  constexpr std::uint64_t bytes_maximum = 65'536;
  const auto count = static_cast<std::uint64_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space)));
  const std::size_t bytes = H5Tget_size(type);
  const auto kind = H5Tget_class(type);
  const bool has_pointers = kind == H5T_VLEN || kind == H5T_REFERENCE || H5Tis_variable_str(type) > 0;
  if (has_pointers || count > bytes_maximum || count * bytes > bytes_maximum) return {};
  return std::string(count * bytes, '\1');
}

void put_attribute(hid_t file, Choices& choices, const char* name, hid_t wanted, const std::string& text = {}) {
  const Handle type = chosen_type(choices, wanted), space = chosen_space(choices, Rank::scalar);
  const Handle attribute(H5Acreate2(file, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  std::string values = values_of(type.id(), space.id());
  std::copy_n(text.begin(), std::min(text.size(), values.size()), values.begin());
  if (attribute && !values.empty()) H5Awrite(attribute.id(), type.id(), values.data());
}

void put_dataset(hid_t file, Choices& choices, const char* path, hid_t wanted, Rank rank) {
  constexpr char elsewhere[] = "/dev/null";
  const Handle type = chosen_type(choices, wanted), space = chosen_space(choices, rank);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const hsize_t chunk = 2, huge_chunk = hsize_t{1} << 30;
  switch (choices.of(12)) {
    case 1: H5Pset_layout(properties.id(), H5D_COMPACT); break;
    case 2: H5Pset_chunk(properties.id(), 1, &chunk); break;
    case 3:
      H5Pset_chunk(properties.id(), 1, &chunk);
      H5Pset_shuffle(properties.id());
      H5Pset_deflate(properties.id(), 1);
      break;
    case 4:
      H5Pset_chunk(properties.id(), 1, &chunk);
      H5Pset_nbit(properties.id());
      break;
    case 5: H5Pset_chunk(properties.id(), 1, &huge_chunk); break;
    case 6: H5Pset_external(properties.id(), elsewhere, 0, H5F_UNLIMITED); break;
    case 7: H5Pset_virtual(properties.id(), space.id(), elsewhere, path, space.id()); break;
    case 8: H5Lcreate_soft("/period", file, path, H5P_DEFAULT, H5P_DEFAULT); return;
    case 9: H5Lcreate_hard(file, "/period", file, path, H5P_DEFAULT, H5P_DEFAULT); return;
    case 10: Handle(H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose); return;
    case 11: return;
    default: break;
  }
  const Handle dataset(H5Dcreate2(file, path, type.id(), space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
                       H5Dclose);
  const std::string values = values_of(type.id(), space.id());
  const bool is_written = choices.of(2) == 0 && !values.empty();
  if (dataset && is_written) H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

Bytes file_of(Choices choices) {
  constexpr std::size_t increment = 4096;
  const Handle access = recording::file_access();
  H5Pset_fapl_core(access.id(), increment, false);
  const Handle file(H5Fcreate("made.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
  const hid_t id = file.id();
  for (const char* group : {"/parameters", "/signals", "/simulated", "/marks"})
    if (choices.of(16) != 1) Handle(H5Gcreate2(id, group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  put_attribute(id, choices, "format_version", H5T_STD_I64LE);
  put_attribute(id, choices, "step_periods", H5T_STD_I64LE);
  put_attribute(id, choices, "arm", text_of(12).id(), "PHANTOM Omni");
  put_attribute(id, choices, "force_law", text_of(12).id(), "150000000600");
  put_dataset(id, choices, "/samples", H5T_STD_U64LE, Rank::scalar);
  put_dataset(id, choices, "/complete", H5T_STD_I32LE, Rank::scalar);
  put_dataset(id, choices, "/period", H5T_STD_U32LE, Rank::column);
  put_dataset(id, choices, "/parameters/wall_stiffness_N_per_m", H5T_IEEE_F32LE, Rank::scalar);
  put_dataset(id, choices, "/parameters/wobble_m", H5T_IEEE_F32LE, Rank::scalar);
  put_dataset(id, choices, "/signals/force_N", H5T_IEEE_F32LE, Rank::column);
  put_dataset(id, choices, "/signals/force_x_N", H5T_IEEE_F32LE, Rank::column);
  put_dataset(id, choices, "/simulated/hand_force_x_N", H5T_IEEE_F32LE, Rank::column);
  put_dataset(id, choices, "/marks/period", H5T_STD_U32LE, Rank::column);
  for (const char* path : {"/marks/text", "/marks/kind", "/marks/clock_utc"})
    put_dataset(id, choices, path, text_of(24).id(), Rank::column);
  put_attribute(id, choices, "format", text_of(17).id(), recording::format_name);
  H5Fflush(id, H5F_SCOPE_GLOBAL);
  Bytes bytes(static_cast<std::size_t>(std::max<ssize_t>(0, H5Fget_file_image(id, nullptr, 0))));
  H5Fget_file_image(id, bytes.data(), bytes.size());
  return bytes;
}

const Registered recording_hdf5{"recording_hdf5",
                                [](Input input) {
                                  const recording::QuietHdf5 quiet;
                                  const Bytes file = file_of(Choices(input));
                                  refuse_or_take<device::Error>([&] {
                                    const auto stored = recording::open_hdf5(file, "recording.h5");
                                    const auto recording = stored.load(stored.quantities());
                                    for (const auto quantity : recording.quantities())
                                      if (recording.column(quantity).size() != recording.size())
                                        throw std::logic_error("a column is too short");
                                    if (recording.size() > 1000)
                                      throw std::logic_error("there are more samples than any file has");
                                    recording::log_text(stored);
                                  });
                                },
                                [] { return std::vector<Bytes>{Bytes(1)}; }};

}  // namespace
}  // namespace inkwell::fuzz
