#include "host/client/recording/hdf5_input.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host/client/device/error.hpp"

namespace inkwell::recording {
namespace {

constexpr std::size_t attribute_bytes_maximum = 65'536;  // a force law description has at most 16,384 bytes
constexpr std::size_t mark_bytes_maximum = 4096;
constexpr hsize_t names_maximum = 4096;
constexpr std::uint64_t samples_maximum = std::uint64_t{1} << 32;  // range of the board's counter
constexpr std::uint64_t chunk_bytes_maximum = 16 << 20;
constexpr std::uint64_t deflate_ratio_maximum = 1100;  // zlib compresses by a factor of at most 1032
constexpr std::uint64_t harmless_bytes = 65'536;       // may be declared without content, as after a crash

bool is_whole_number(hid_t type) {
  const std::size_t bytes = H5Tget_size(type);
  return H5Tget_class(type) == H5T_INTEGER && (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8) &&
         H5Tget_precision(type) == 8 * bytes && H5Tget_offset(type) == 0;
}

bool is_real_number(hid_t type) {
  const std::array known{H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE};
  return H5Tget_class(type) == H5T_FLOAT &&
         std::ranges::any_of(known, [&](hid_t each) { return H5Tequal(type, each) > 0; });
}

bool is_text(hid_t type, std::size_t bytes_maximum) {
  return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Tget_size(type) <= bytes_maximum;
}

std::string text_before_zero(std::string_view bytes) { return std::string(bytes.substr(0, bytes.find('\0'))); }

}  // namespace

Hdf5Input::Hdf5Input(const std::filesystem::path& file, Index index) : name_(file.string()) {
  // A file of an earlier version can still be marked as open if its writer did not close the file. Readers in HDF5's
  // single-writer mode may open the file regardless.
  const Handle access = file_access();
  if (index == Index::stays) keep_metadata(access);
  for (const unsigned mode : {H5F_ACC_RDONLY, H5F_ACC_RDONLY | H5F_ACC_SWMR_READ})
    if (!file_) file_ = Handle(H5Fopen(name_.c_str(), mode, access.id()), H5Fclose);
  if (!file_) fail("is damaged, or is being written: HDF5 cannot open it. Try again after the recording has finished");
  hsize_t bytes = 0;
  if (H5Fget_filesize(file_.id(), &bytes) < 0) fail("is damaged: HDF5 cannot determine its size");
  bytes_left_ = bytes;
}

Hdf5Input::Hdf5Input(std::span<const std::byte> content, std::string name)
    : name_(std::move(name)), bytes_left_(content.size()) {
  constexpr std::size_t increment = 65'536;
  const Handle access = file_access();
  H5Pset_fapl_core(access.id(), increment, false);
  // HDF5 copies the content and does not modify it.
  H5Pset_file_image(access.id(), const_cast<std::byte*>(content.data()), content.size());
  file_ = Handle(H5Fopen(name_.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!file_) fail("is damaged: HDF5 cannot open it");
}

void Hdf5Input::fail(const std::string& what) const {
  throw device::Error(fmt::format("{} {}. Nothing was loaded.", name_, what));
}

bool Hdf5Input::has(const std::string& path) const { return H5Lexists(file_.id(), path.c_str(), H5P_DEFAULT) > 0; }

/// Accepts only hard links, because other links lead to another file or to no object.
void Hdf5Input::check_is_here(const std::string& path) const {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    H5L_info_t link{};
    if (H5Lget_info(file_.id(), part.c_str(), &link, H5P_DEFAULT) < 0)
      fail(fmt::format("is damaged: it has no {}", part));
    if (link.type != H5L_TYPE_HARD) fail(fmt::format("is damaged: {} is a link to another object", part));
    if (end == std::string::npos) return;
  }
}

void Hdf5Input::check_one_element(hid_t space, const std::string& path) const {
  const auto kind = H5Sget_simple_extent_type(space);
  const bool has_rank = kind == H5S_SCALAR || (kind == H5S_SIMPLE && H5Sget_simple_extent_ndims(space) == 1);
  if (!has_rank || H5Sget_simple_extent_npoints(space) != 1)
    fail(fmt::format("is damaged: {} must have exactly one element", path));
}

Handle Hdf5Input::open_attribute(const char* name) const {
  const htri_t exists = H5Aexists(file_.id(), name);
  if (exists == 0) return {};
  Handle attribute(exists < 0 ? -1 : H5Aopen(file_.id(), name, H5P_DEFAULT), H5Aclose);
  if (!attribute) fail(fmt::format("is damaged: {} cannot be read", name));
  check_one_element(Handle(H5Aget_space(attribute.id()), H5Sclose).id(), name);
  return attribute;
}

std::optional<std::string> Hdf5Input::text_attribute(const char* name) const {
  const Handle attribute = open_attribute(name);
  if (!attribute) return std::string();
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  if (H5Tis_variable_str(type.id()) > 0) return std::nullopt;
  if (!is_text(type.id(), attribute_bytes_maximum))
    fail(fmt::format("is damaged: {} must be a text of at most {} bytes", name, attribute_bytes_maximum));
  std::string text(H5Tget_size(type.id()), '\0');
  if (H5Aread(attribute.id(), type.id(), text.data()) < 0) fail(fmt::format("is damaged: {} cannot be read", name));
  return text_before_zero(text);
}

std::int64_t Hdf5Input::number_attribute(const char* name) const {
  const Handle attribute = open_attribute(name);
  if (!attribute) return 0;
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  if (!is_whole_number(type.id())) fail(fmt::format("is damaged: {} must be a whole number", name));
  std::int64_t number = 0;
  if (H5Aread(attribute.id(), H5T_NATIVE_INT64, &number) < 0) fail(fmt::format("is damaged: {} cannot be read", name));
  return number;
}

std::vector<std::string> Hdf5Input::names_in(const std::string& group_path) const {
  check_is_here(group_path);
  const Handle group(H5Gopen2(file_.id(), group_path.c_str(), H5P_DEFAULT), H5Gclose);
  H5G_info_t about{};
  if (!group || H5Gget_info(group.id(), &about) < 0) fail(fmt::format("is damaged: {} is not a group", group_path));
  if (about.nlinks > names_maximum)
    fail(fmt::format("is damaged: {} has {} entries, more than {}", group_path, about.nlinks, names_maximum));
  std::vector<std::string> found;
  for (hsize_t i = 0; i < about.nlinks; ++i) {
    char name[128] = {};
    if (H5Lget_name_by_idx(group.id(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name, H5P_DEFAULT) < 0)
      fail(fmt::format("is damaged: the entries of {} cannot be read", group_path));
    found.emplace_back(name);
  }
  return found;
}

/// Refuses values in external files, values that need a filter plug-in, and values of unlimited decompressed size.
Hdf5Input::Dataset Hdf5Input::open(const std::string& path) const {
  check_is_here(path);
  Dataset dataset{.path = path,
                  .itself = {H5Dopen2(file_.id(), path.c_str(), H5P_DEFAULT), H5Dclose},
                  .type = {},
                  .space = {},
                  .is_compressed = false};
  const Handle about(H5Dget_create_plist(dataset.itself.id()), H5Pclose);
  if (!about) fail(fmt::format("is damaged: {} cannot be read", path));
  const auto layout = H5Pget_layout(about.id());
  bool is_known = (layout == H5D_COMPACT || layout == H5D_CONTIGUOUS || layout == H5D_CHUNKED) &&
                  H5Pget_external_count(about.id()) == 0;
  const int filters = H5Pget_nfilters(about.id());
  for (int i = 0; i < filters; ++i) {
    std::size_t no_values = 0;
    unsigned flags = 0;
    const auto filter =
        H5Pget_filter2(about.id(), static_cast<unsigned>(i), &flags, &no_values, nullptr, 0, nullptr, nullptr);
    is_known &= filter == H5Z_FILTER_DEFLATE || filter == H5Z_FILTER_SHUFFLE || filter == H5Z_FILTER_FLETCHER32;
    dataset.is_compressed |= filter == H5Z_FILTER_DEFLATE;
  }
  const std::string unknown = fmt::format("is damaged: {} has a storage format that recordings do not use", path);
  if (!is_known) fail(unknown);

  // Type and size are read only after the checks above, because HDF5 opens other files to determine the size of a
  // virtual dataset.
  dataset.type = Handle(H5Dget_type(dataset.itself.id()), H5Tclose);
  dataset.space = Handle(H5Dget_space(dataset.itself.id()), H5Sclose);
  const std::size_t element_bytes = H5Tget_size(dataset.type.id());
  if (element_bytes == 0 || !dataset.space) fail(fmt::format("is damaged: {} cannot be read", path));
  hsize_t chunk = 0;
  if (layout == H5D_CHUNKED &&
      (H5Pget_chunk(about.id(), 1, &chunk) != 1 || chunk > chunk_bytes_maximum / element_bytes))
    fail(unknown);
  return dataset;
}

void Hdf5Input::read_scalar(const Dataset& dataset, hid_t type, void* value) const {
  check_one_element(dataset.space.id(), dataset.path);
  if (H5Dread(dataset.itself.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) < 0)
    fail(fmt::format("is damaged: {} cannot be read", dataset.path));
}

std::int64_t Hdf5Input::whole_number(const std::string& path) const {
  const Dataset dataset = open(path);
  if (!is_whole_number(dataset.type.id())) fail(fmt::format("is damaged: {} must be a whole number", path));
  std::int64_t number = 0;
  read_scalar(dataset, H5T_NATIVE_INT64, &number);
  return number;
}

float Hdf5Input::real_number(const std::string& path) const {
  const Dataset dataset = open(path);
  if (!is_real_number(dataset.type.id())) fail(fmt::format("is damaged: {} must be a real number", path));
  float number = 0;
  read_scalar(dataset, H5T_NATIVE_FLOAT, &number);
  return number;
}

Hdf5Input::Dataset Hdf5Input::open_column(const std::string& path) const {
  Dataset column = open(path);
  const hid_t space = column.space.id();
  if (H5Sget_simple_extent_type(space) != H5S_SIMPLE || H5Sget_simple_extent_ndims(space) != 1)
    fail(fmt::format("is damaged: {} must be a column", path));
  return column;
}

std::uint64_t Hdf5Input::length_of(const std::string& path) const {
  const Dataset column = open_column(path);
  const auto count = H5Sget_simple_extent_npoints(column.space.id());
  return count < 0 ? 0 : static_cast<std::uint64_t>(count);
}

/// Checks the content, so that memory is allocated only for stored elements.
void Hdf5Input::check_content(const Dataset& column, std::uint64_t count) {
  const auto declared =
      static_cast<std::uint64_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(column.space.id())));
  if (count > declared)
    fail(fmt::format("is damaged: {} has {} elements where {} are expected", column.path, declared, count));
  if (count > samples_maximum)
    fail(fmt::format("is damaged: {} declares {} elements, more than {}", column.path, count, samples_maximum));
  const std::uint64_t stored = H5Dget_storage_size(column.itself.id());
  const std::uint64_t unpacked = stored * (column.is_compressed ? deflate_ratio_maximum : 1) + harmless_bytes;
  if (stored > bytes_left_ || count * H5Tget_size(column.type.id()) > unpacked)
    fail(fmt::format("is damaged: {} declares {} elements, but the file does not contain them", column.path, count));
  bytes_left_ -= stored;
}

void Hdf5Input::read_column(const Dataset& column, hid_t type, std::uint64_t begin, std::uint64_t count,
                            void* values) const {
  if (count == 0) return;
  const hsize_t from = begin, size = count;
  const Handle memory(H5Screate_simple(1, &size, nullptr), H5Sclose);
  if (H5Sselect_hyperslab(column.space.id(), H5S_SELECT_SET, &from, nullptr, &size, nullptr) < 0 ||
      H5Dread(column.itself.id(), type, memory.id(), column.space.id(), H5P_DEFAULT, values) < 0)
    fail(fmt::format("is damaged: {} cannot be read", column.path));
}

Hdf5Input::Dataset Hdf5Input::whole_number_column(const std::string& path, std::uint64_t count) {
  Dataset column = open_column(path);
  if (!is_whole_number(column.type.id())) fail(fmt::format("is damaged: {} must be whole numbers", path));
  check_content(column, count);
  return column;
}

Hdf5Input::Dataset Hdf5Input::real_number_column(const std::string& path, std::uint64_t count) {
  Dataset column = open_column(path);
  if (!is_real_number(column.type.id())) fail(fmt::format("is damaged: {} must be real numbers", path));
  check_content(column, count);
  return column;
}

void Hdf5Input::read(const Dataset& column, std::uint64_t begin, std::span<std::int64_t> numbers) const {
  read_column(column, H5T_NATIVE_INT64, begin, numbers.size(), numbers.data());
}

void Hdf5Input::read(const Dataset& column, std::uint64_t begin, std::span<float> numbers) const {
  read_column(column, H5T_NATIVE_FLOAT, begin, numbers.size(), numbers.data());
}

std::vector<std::int64_t> Hdf5Input::whole_numbers(const std::string& path, std::uint64_t count) {
  const Dataset column = whole_number_column(path, count);
  std::vector<std::int64_t> numbers(count);
  read(column, 0, numbers);
  return numbers;
}

std::vector<std::string> Hdf5Input::texts(const std::string& path, std::uint64_t count) {
  const Dataset column = open_column(path);
  if (!is_text(column.type.id(), mark_bytes_maximum))
    fail(fmt::format("is damaged: {} must be texts of at most {} bytes", path, mark_bytes_maximum));
  check_content(column, count);
  const std::size_t bytes = H5Tget_size(column.type.id());
  std::vector<char> buffer(count * bytes);
  read_column(column, column.type.id(), 0, count, buffer.data());
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) texts.push_back(text_before_zero({buffer.data() + i * bytes, bytes}));
  return texts;
}

}  // namespace inkwell::recording
