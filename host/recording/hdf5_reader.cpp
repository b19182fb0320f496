#include "formats.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "hdf5_file.hpp"
#include "hdf5_layout.hpp"

namespace inkwell::recording {
namespace {

class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& file) : name_(file.string()) {
    // A file of an earlier version that its writer did not close says so until someone clears the mark; readers of
    // HDF5's single-writer mode may open it all the same.
    const Handle access = file_access();
    file_ = Handle(H5Fopen(name_.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
    if (!file_) file_ = Handle(H5Fopen(name_.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.id()), H5Fclose);
    if (!file_) fail("is damaged, or is being written: HDF5 cannot open it. Try again once its recorder has ended");
    if (read_text_attribute(file_.id(), "format") != format_name) fail("is an HDF5 file, but no recording");
  }

  Recording read() {
    read_information();
    std::uint64_t samples = 0;
    read_scalar("/samples", H5T_NATIVE_UINT64, &samples);
    std::size_t whole = std::min<std::size_t>(samples, length("/period"));
    for (const auto& path : columns_) whole = std::min(whole, length(path));
    recording_.periods.resize(whole);
    read_values("/period", H5T_NATIVE_UINT32, whole, recording_.periods.data());
    for (const auto& path : columns_) {
      auto& place = recording_.columns.size() < recording_.information.signals.size() ? recording_.columns
                                                                                      : recording_.simulated_columns;
      auto& column = place.emplace_back(whole);
      read_values(path, H5T_NATIVE_FLOAT, whole, column.data());
    }
    std::int32_t complete = 0;
    read_scalar("/complete", H5T_NATIVE_INT32, &complete);
    try {
      read_marks();
    } catch (const device::Error&) {
      if (complete == 1) throw;
      recording_.marks.clear();
      recording_.remarks.push_back(fmt::format(
          "The marks of {} are left out: its program ended while it wrote one, or writes one just now.", name_));
    }
    recording_.complete = complete == 1 && whole == samples;
    return std::move(recording_);
  }

 private:
  void read_information() {
    auto& about = recording_.information;
    const hid_t root = file_.id();
    if (read_number_attribute(root, "format_version") > format_version)
      recording_.remarks.push_back(fmt::format("{} was written by a newer version of this program.", name_));
    about.created_utc = read_text_attribute(root, "created_utc");
    about.firmware_version = read_text_attribute(root, "firmware_version");
    about.protocol_version = static_cast<std::uint16_t>(read_number_attribute(root, "protocol_version"));
    about.serial_number = read_text_attribute(root, "serial_number");
    about.arm = read_text_attribute(root, "arm");
    about.simulation = read_number_attribute(root, "simulation") != 0;
    about.step_periods = step_periods_of(static_cast<double>(read_number_attribute(root, "step_periods")));
    take_force_law(recording_, read_text_attribute(root, "force_law"), name_);
    for (const auto& name : names("/parameters")) {
      const auto parameter = protocol::find_parameter(name);
      if (!parameter) {
        recording_.remarks.push_back(
            fmt::format("The parameter {} of {} is not known here; it was left out.", name, name_));
        continue;
      }
      read_scalar("/parameters/" + name, H5T_NATIVE_FLOAT, &about.parameters[*parameter]);
    }
    about.signals = read_columns("/signals", protocol::find_signal);
    // A file of an earlier version has no such group.
    if (H5Lexists(root, "/simulated", H5P_DEFAULT) > 0)
      about.simulated = read_columns("/simulated", protocol::find_simulated_quantity);
  }
  /// What the columns of a group hold, by their names.
  template <class Value>
  std::vector<Value> read_columns(const char* group_name, std::optional<Value> (*find)(std::string_view)) {
    std::vector<Value> found;
    for (const auto& name : names(group_name)) {
      if (const auto value = find(name))
        found.push_back(*value);
      else
        recording_.remarks.push_back(
            fmt::format("The signal {} of {} is not known here; it was left out.", name, name_));
    }
    // HDF5 gives names in alphabetical order; in the table's order those that belong together stand together.
    std::sort(found.begin(), found.end());
    for (const auto value : found) columns_.push_back(fmt::format("{}/{}", group_name, info(value).name));
    return found;
  }
  void read_marks() {
    const std::size_t count = std::min(length("/marks/period"), length("/marks/text"));
    if (count == 0) return;
    std::vector<std::uint32_t> periods(count);
    read_values("/marks/period", H5T_NATIVE_UINT32, count, periods.data());
    const auto texts = read_texts("/marks/text", count);
    // A file of an earlier version has neither.
    const bool has_kinds = H5Lexists(file_.id(), "/marks/kind", H5P_DEFAULT) > 0;
    const auto kinds = has_kinds ? read_texts("/marks/kind", count) : std::vector<std::string>(count);
    const auto clocks = has_kinds ? read_texts("/marks/clock_utc", count) : std::vector<std::string>(count);
    for (std::size_t i = 0; i < count; ++i)
      recording_.marks.push_back(
          {periods[i], texts[i], device::find_event_kind(kinds[i]).value_or(device::EventKind::mark), clocks[i]});
  }
  std::vector<std::string> read_texts(const std::string& path, std::size_t count) {
    constexpr std::size_t bytes_maximum = 4096;
    const Handle type(H5Dget_type(open(path).id()), H5Tclose);
    const std::size_t bytes = H5Tget_size(type.id());
    if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) > 0 || bytes > bytes_maximum ||
        length(path) < count)
      fail(fmt::format("is damaged: {} is no text for each mark", path));
    std::vector<char> places(count * bytes);
    read_values(path, type.id(), count, places.data());
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string_view text(places.data() + i * bytes, bytes);
      texts.emplace_back(text.substr(0, text.find('\0')));
    }
    return texts;
  }
  std::vector<std::string> names(const char* group_name) {
    const Handle group(H5Gopen2(file_.id(), group_name, H5P_DEFAULT), H5Gclose);
    H5G_info_t about{};
    if (!group || H5Gget_info(group.id(), &about) < 0) fail(fmt::format("is damaged: it has no {}", group_name));
    std::vector<std::string> found;
    for (hsize_t i = 0; i < about.nlinks; ++i) {
      char name[128] = {};
      H5Lget_name_by_idx(group.id(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name, H5P_DEFAULT);
      found.emplace_back(name);
    }
    return found;
  }
  Handle open(const std::string& path) {
    Handle dataset(H5Dopen2(file_.id(), path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset) fail(fmt::format("is damaged: {} cannot be read", path));
    return dataset;
  }
  std::size_t length(const std::string& path) {
    const Handle dataset = open(path);
    const Handle space(H5Dget_space(dataset.id()), H5Sclose);
    const auto count = H5Sget_simple_extent_npoints(space.id());
    return count < 0 ? 0 : static_cast<std::size_t>(count);
  }
  void read_scalar(const std::string& path, hid_t type, void* value) {
    const Handle dataset = open(path);
    if (H5Dread(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) < 0)
      fail(fmt::format("is damaged: {} cannot be read", path));
  }
  void read_values(const std::string& path, hid_t type, std::size_t count, void* values) {
    if (count == 0) return;
    const Handle dataset = open(path);
    const Handle space(H5Dget_space(dataset.id()), H5Sclose);
    const hsize_t from = 0, size = count;
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &from, nullptr, &size, nullptr);
    const Handle memory(H5Screate_simple(1, &size, nullptr), H5Sclose);
    if (H5Dread(dataset.id(), type, memory.id(), space.id(), H5P_DEFAULT, values) < 0)
      fail(fmt::format("is damaged: {} cannot be read", path));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw device::Error(fmt::format("{} {}. Nothing was loaded.", name_, what));
  }

  std::string name_;
  Handle file_;
  Recording recording_;
  std::vector<std::string> columns_;
};

}  // namespace

Recording read_hdf5(const std::filesystem::path& file) {
  const QuietHdf5 quiet;
  return Hdf5Reader(file).read();
}

}  // namespace inkwell::recording
