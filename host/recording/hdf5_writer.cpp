// HDF5 recordings. They are written in HDF5's single-writer-multiple-reader mode, which orders its writes so
// that the file can be read at any moment, also after this process was killed.
#include "formats.hpp"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "hdf5_file.hpp"
#include "hdf5_layout.hpp"

namespace inkwell::recording {
namespace {

constexpr hsize_t chunk_samples = 4096;
constexpr hsize_t chunk_marks = 16;
constexpr unsigned compression_level = 2;  // of 9; low, since the writer keeps up with 20 kHz

class Hdf5Writer final : public Writer {
 public:
  Hdf5Writer(const std::filesystem::path& file, const Information& information)
      : name_(file.string()),
        width_(information.signals.size()),
        values_(information.signals.size() + information.simulated.size()) {
    const QuietHdf5 quiet;
    lay_out(information);
    open_for_writing(information);
  }
  ~Hdf5Writer() override {
    // Closing writes what is left, which fails again on a full disk: nothing more can be done about it here.
    const QuietHdf5 quiet;
    close();
  }

  void append(const device::ScopeSamples& samples, std::span<const float> simulated) override {
    const std::size_t simulated_width = values_.size() - width_;
    for (std::size_t i = 0; i < samples.count; ++i) {
      const std::uint32_t period = samples.first_period + static_cast<std::uint32_t>(i);
      periods_.push_back(period);
      times_s_.push_back(static_cast<double>(period) / protocol::servo_rate_Hz);
      for (std::size_t j = 0; j < width_; ++j) values_[j].push_back(samples.values[i * width_ + j]);
      for (std::size_t j = 0; j < simulated_width; ++j)
        values_[width_ + j].push_back(simulated[i * simulated_width + j]);
    }
    // A scope frame has some tens of samples, and HDF5 takes as long for them as for thousands.
    if (periods_.size() >= chunk_samples) write_samples();
  }
  void mark(const Mark& mark) override {
    const QuietHdf5 quiet;
    extend(mark_period_, mark_count_, 1, H5T_NATIVE_UINT32, &mark.period);
    write_mark_text(mark_text_, mark.text, mark_text_bytes);
    write_mark_text(mark_kind_, name_of(mark.kind), mark_kind_bytes);
    write_mark_text(mark_clock_, mark.clock_utc, mark_clock_bytes);
    ++mark_count_;
  }
  void flush() override {
    const QuietHdf5 quiet;
    write_samples();
    if (H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) < 0) fail();
    // Only now are the samples known to be on the disk: a column may have grown without its values.
    if (H5Dwrite(samples_.id(), H5T_NATIVE_HSIZE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &size_) < 0) fail();
    if (H5Dflush(samples_.id()) < 0) fail();
  }
  void finish() override {
    const QuietHdf5 quiet;
    flush();
    const std::int32_t yes = 1;
    if (H5Dwrite(complete_.id(), H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, &yes) < 0) fail();
    if (H5Dflush(complete_.id()) < 0) fail();
    close();
  }

 private:
  static Handle access() {
    Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_libver_bounds(list.id(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    return list;
  }
  Handle group(hid_t file, const char* name) {
    Handle made(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    if (!made) fail();
    return made;
  }
  Handle growing(hid_t place, const std::string& name, hid_t type, hsize_t chunk) {
    const hsize_t none = 0, unlimited = H5S_UNLIMITED;
    const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(properties.id(), 1, &chunk);
    H5Pset_shuffle(properties.id());  // bytes of the same weight together, which then resemble each other
    H5Pset_deflate(properties.id(), compression_level);
    Handle made(H5Dcreate2(place, name.c_str(), type, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT), H5Dclose);
    if (!made) fail();
    return made;
  }
  Handle scalar(hid_t place, const std::string& name, hid_t type, const void* value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    Handle made(H5Dcreate2(place, name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    if (!made || H5Dwrite(made.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) < 0) fail();
    return made;
  }

  /// In single-writer mode nothing can be created any more, so everything is laid out first.
  void lay_out(const Information& about) {
    const Handle file(H5Fcreate(name_.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access().id()), H5Fclose);
    if (!file) fail();
    write_attribute(file.id(), "format", std::string(format_name));
    write_attribute(file.id(), "format_version", std::int64_t{format_version});
    write_attribute(file.id(), "created_utc", about.created_utc);
    write_attribute(file.id(), "firmware_version", about.firmware_version);
    write_attribute(file.id(), "protocol_version", std::int64_t{about.protocol_version});
    write_attribute(file.id(), "serial_number", about.serial_number);
    write_attribute(file.id(), "arm", about.arm);
    write_attribute(file.id(), "force_law", force_law_digits(about));
    write_attribute(file.id(), "simulation", std::int64_t{about.simulation});
    write_attribute(file.id(), "servo_rate_Hz", std::int64_t{protocol::servo_rate_Hz});
    write_attribute(file.id(), "step_periods", std::int64_t{about.step_periods});

    const Handle parameters = group(file.id(), "parameters");
    for (std::size_t i = 0; i < protocol::known_parameters().size(); ++i) {
      const auto& row = protocol::known_parameters()[i];
      const Handle value =
          scalar(parameters.id(), std::string(row.name), H5T_NATIVE_FLOAT, &about.parameters.values[i]);
      write_attribute(value.id(), "unit", std::string(row.unit));
      write_attribute(value.id(), "help", std::string(row.help));
    }
    growing(file.id(), "period", H5T_STD_U32LE, chunk_samples);
    write_attribute(growing(file.id(), "time_s", H5T_IEEE_F64LE, chunk_samples).id(), "unit", std::string("s"));
    const Handle signals = group(file.id(), "signals");
    for (const auto signal : about.signals) lay_out_column(signals, protocol::info(signal));
    const Handle simulated = group(file.id(), "simulated");
    for (const auto quantity : about.simulated) lay_out_column(simulated, protocol::info(quantity));
    const Handle marks = group(file.id(), "marks");
    growing(marks.id(), "period", H5T_STD_U32LE, chunk_marks);
    growing(marks.id(), "text", byte_text_type(mark_text_bytes).id(), chunk_marks);
    growing(marks.id(), "kind", byte_text_type(mark_kind_bytes).id(), chunk_marks);
    growing(marks.id(), "clock_utc", byte_text_type(mark_clock_bytes).id(), chunk_marks);
    const std::int32_t no = 0;
    scalar(file.id(), "complete", H5T_NATIVE_INT32, &no);
    const hsize_t none = 0;
    scalar(file.id(), "samples", H5T_NATIVE_HSIZE, &none);
  }
  template <class Row>
  void lay_out_column(const Handle& place, const Row& row) {
    const Handle column = growing(place.id(), std::string(row.name), H5T_IEEE_F32LE, chunk_samples);
    write_attribute(column.id(), "unit", std::string(row.unit));
    write_attribute(column.id(), "help", std::string(row.help));
  }
  void open_for_writing(const Information& about) {
    file_ = Handle(H5Fopen(name_.c_str(), H5F_ACC_RDWR | H5F_ACC_SWMR_WRITE, access().id()), H5Fclose);
    if (!file_) fail();
    const auto open = [&](const std::string& path) {
      Handle dataset(H5Dopen2(file_.id(), path.c_str(), H5P_DEFAULT), H5Dclose);
      if (!dataset) fail();
      return dataset;
    };
    period_ = open("/period");
    time_ = open("/time_s");
    for (const auto signal : about.signals)
      columns_.push_back(open(fmt::format("/signals/{}", protocol::info(signal).name)));
    for (const auto quantity : about.simulated)
      columns_.push_back(open(fmt::format("/simulated/{}", protocol::info(quantity).name)));
    mark_period_ = open("/marks/period");
    mark_text_ = open("/marks/text");
    mark_kind_ = open("/marks/kind");
    mark_clock_ = open("/marks/clock_utc");
    complete_ = open("/complete");
    samples_ = open("/samples");
  }
  void write_samples() {
    const QuietHdf5 quiet;
    const hsize_t count = periods_.size();
    if (count == 0) return;
    extend(period_, size_, count, H5T_NATIVE_UINT32, periods_.data());
    extend(time_, size_, count, H5T_NATIVE_DOUBLE, times_s_.data());
    for (std::size_t j = 0; j < values_.size(); ++j) {
      extend(columns_[j], size_, count, H5T_NATIVE_FLOAT, values_[j].data());
      values_[j].clear();
    }
    size_ += count;
    periods_.clear();
    times_s_.clear();
  }
  /// Cut to its place in the file.
  void write_mark_text(const Handle& column, std::string_view text, std::size_t bytes) {
    std::string place(text.substr(0, bytes));
    place.resize(bytes);
    extend(column, mark_count_, 1, byte_text_type(bytes).id(), place.data());
  }
  void extend(const Handle& dataset, hsize_t at, hsize_t count, hid_t type, const void* values) {
    const hsize_t size = at + count;
    if (H5Dset_extent(dataset.id(), &size) < 0) fail();
    const Handle space(H5Dget_space(dataset.id()), H5Sclose);
    const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose);
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, &at, nullptr, &count, nullptr);
    if (H5Dwrite(dataset.id(), type, memory.id(), space.id(), H5P_DEFAULT, values) < 0) fail();
  }
  void close() {
    columns_.clear();
    for (Handle* handle :
         {&period_, &time_, &mark_period_, &mark_text_, &mark_kind_, &mark_clock_, &complete_, &samples_, &file_})
      *handle = Handle();
  }
  [[noreturn]] void fail() const {
    std::error_code error;
    const auto space = std::filesystem::space(std::filesystem::absolute(name_).parent_path(), error);
    // What is no disk, such as /proc, has no room at all and is not full.
    const bool full = !error && space.capacity > 0 && space.available < 1'000'000;
    throw device::Error(fmt::format("{} cannot be written: {}.", name_,
                                    full ? "the disk is full. Free some space or choose another place"
                                         : "the system refused it. Check that the folder exists and may be written"));
  }

  std::string name_;
  std::size_t width_;  ///< how many signals there are
  Handle file_, period_, time_, mark_period_, mark_text_, mark_kind_, mark_clock_, complete_, samples_;
  std::vector<Handle> columns_;         ///< of the signals, then of the simulated quantities
  std::vector<std::uint32_t> periods_;  ///< of samples that are not in the file yet, and the columns beside them
  std::vector<double> times_s_;
  std::vector<std::vector<float>> values_;
  hsize_t size_ = 0;  ///< samples in the file
  hsize_t mark_count_ = 0;
};

}  // namespace

std::unique_ptr<Writer> create_hdf5(const std::filesystem::path& file, const Information& information) {
  return std::make_unique<Hdf5Writer>(file, information);
}

}  // namespace inkwell::recording
