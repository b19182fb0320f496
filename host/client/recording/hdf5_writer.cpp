// HDF5 recordings. Any program can open the file after this process was killed, for three reasons.
//
// (1) The file has the format of HDF5 1.8 or earlier. This format has no mark "open for writing".
// (2) The index of the samples is written only in flush(), after the samples, and only if it fits on the disk.
// (3) Written data does not move, because a compressed chunk is written once, when it is full.
//
// A risk remains while HDF5 splits a full node with 64 chunks of a column: a few writes every 13 s at 20 kHz.
#include "host/client/recording/formats.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include "host/client/process/fork.hpp"

#include "host/client/recording/hdf5_file.hpp"
#include "host/client/recording/hdf5_layout.hpp"
#include "host/client/recording/overview.hpp"

namespace inkwell::recording {
namespace {

constexpr hsize_t chunk_periods = 4096;      ///< 0.2 s, lost in a crash in addition to flush_interval
constexpr hsize_t chunk_samples_least = 16;  ///< a chunk has some tens of bytes of overhead
constexpr hsize_t chunk_overview_blocks = 512;
static_assert(chunk_periods % overview_block_samples == 0);
constexpr hsize_t chunk_marks = 16;
constexpr unsigned compression_level = 2;  // of 9; low, so that the writer keeps up with 20 kHz

class Hdf5Writer final : public Writer {
 public:
  Hdf5Writer(const std::filesystem::path& file, const Information& information, std::string name)
      : name_(std::move(name)),
        file_name_(file.string()),
        width_(information.signals.size()),
        has_overview_(information.step_periods == 1),
        chunk_samples_(std::max(chunk_samples_least, chunk_periods / std::max(1u, information.step_periods))),
        values_(information.signals.size() + information.simulated.size()),
        waiting_overviews_(values_.size()) {
    const QuietHdf5 quiet;
    lay_out(information);
    open_for_writing(information);
    own_ = process::OwnDescriptor(descriptor());
  }
  ~Hdf5Writer() override {
    const QuietHdf5 quiet;
    if (file_) let_go();
    close();
  }

  void append(const device::ScopeSamples& samples, std::span<const float> simulated) override {
    const std::size_t simulated_width = values_.size() - width_;
    for (std::size_t i = 0; i < samples.count; ++i) {
      const std::int64_t period = samples.first_period + static_cast<std::int64_t>(i);
      periods_.push_back(period);
      times_s_.push_back(device::board_time_s(period));
      for (std::size_t j = 0; j < width_; ++j) values_[j].push_back(samples.values[i * width_ + j]);
      for (std::size_t j = 0; j < simulated_width; ++j)
        values_[width_ + j].push_back(simulated[i * simulated_width + j]);
    }
    // A scope frame has some tens of samples. HDF5 needs as much time for some tens of samples as for thousands.
    if (periods_.size() >= chunk_samples_) write_samples(periods_.size() / chunk_samples_ * chunk_samples_);
  }
  void mark(const Mark& mark) override {
    const QuietHdf5 quiet;
    extend(mark_period_, mark_count_, 1, H5T_NATIVE_INT64, &mark.period);
    write_mark_text(mark_text_, mark.text, mark_text_bytes);
    write_mark_text(mark_kind_, name_of(mark.kind), mark_kind_bytes);
    write_mark_text(mark_clock_, mark.clock_utc, mark_clock_bytes);
    ++mark_count_;
  }
  void clock(const ClockReading& reading) override {
    const QuietHdf5 quiet;
    extend(clock_period_, clock_count_, 1, H5T_NATIVE_INT64, &reading.period);
    extend(clock_utc_us_, clock_count_, 1, H5T_NATIVE_INT64, &reading.utc_us);
    ++clock_count_;
  }
  void flush() override {
    const QuietHdf5 quiet;
    find_room();
    if (H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) < 0) fail();
    // The number of samples is written only after the samples are on disk. Until then, a column may contain more
    // elements than were written.
    if (H5Dwrite(samples_.id(), H5T_NATIVE_HSIZE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &size_) < 0) fail();
    if (H5Dflush(samples_.id()) < 0) fail();
    if (!has_overview_) return;
    if (H5Dwrite(overview_blocks_.id(), H5T_NATIVE_HSIZE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &blocks_) < 0) fail();
    if (H5Dflush(overview_blocks_.id()) < 0) fail();
  }
  void end(bool is_complete) override {
    const QuietHdf5 quiet;
    write_samples(periods_.size());
    write_overview(waiting_blocks());
    flush();
    const std::int32_t written = is_complete ? 1 : 0;
    if (H5Dwrite(complete_.id(), H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, &written) < 0) fail();
    if (H5Dflush(complete_.id()) < 0) fail();
    close();
  }

 private:
  static Handle access() {
    Handle list = file_access();
    H5Pset_libver_bounds(list.id(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
    keep_metadata(list);                  // otherwise HDF5 may write parts of its index at any time
    H5Pset_cache(list.id(), 0, 0, 0, 0);  // chunks are written completely, so no chunk waits in a cache
    return list;
  }
  Handle group(hid_t file, const char* name) {
    Handle made(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    if (!made) fail();
    return made;
  }
  enum class Packing { none, compressed };
  Handle growing(hid_t parent, const std::string& name, hid_t type, hsize_t chunk, Packing packing) {
    const hsize_t none = 0, unlimited = H5S_UNLIMITED;
    const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(properties.id(), 1, &chunk);
    if (packing == Packing::compressed) {
      H5Pset_shuffle(properties.id());  // groups bytes of equal significance, which compress better
      H5Pset_deflate(properties.id(), compression_level);
    }
    Handle made(H5Dcreate2(parent, name.c_str(), type, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
                H5Dclose);
    if (!made) fail();
    return made;
  }
  Handle scalar(hid_t parent, const std::string& name, hid_t type, const void* value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    Handle made(H5Dcreate2(parent, name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    if (!made || H5Dwrite(made.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) < 0) fail();
    return made;
  }

  /// Closes the file once, so that it is complete before the first sample.
  void lay_out(const Information& about) {
    const Handle file(H5Fcreate(file_name_.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access().id()), H5Fclose);
    if (!file) fail();
    write_attribute(file.id(), "format", std::string(format_name));
    write_attribute(file.id(), "format_version", std::int64_t{format_version});
    write_attribute(file.id(), "name", about.name);
    write_attribute(file.id(), "note", about.note);
    write_attribute(file.id(), "created_utc", about.created_utc);
    write_attribute(file.id(), "library_version", about.library_version);
    write_attribute(file.id(), "library_sha256", about.library_sha256);
    write_attribute(file.id(), "image_sha256", about.image_sha256);
    write_attribute(file.id(), "arm_sha256", about.arm_sha256);
    write_attribute(file.id(), "image_check", about.image_check);
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
    growing(file.id(), "period", H5T_STD_I64LE, chunk_samples_, Packing::compressed);
    write_attribute(growing(file.id(), "time_s", H5T_IEEE_F64LE, chunk_samples_, Packing::compressed).id(), "unit",
                    std::string("s"));
    const Handle signals = group(file.id(), "signals");
    for (const auto signal : about.signals) lay_out_column(signals, protocol::info(signal));
    const Handle simulated = group(file.id(), "simulated");
    for (const auto quantity : about.simulated) lay_out_column(simulated, protocol::info(quantity));
    if (has_overview_) lay_out_overview(file, about);
    const Handle marks = group(file.id(), "marks");
    // Marks are written immediately into chunks of constant size.
    growing(marks.id(), "period", H5T_STD_I64LE, chunk_marks, Packing::none);
    growing(marks.id(), "text", byte_text_type(mark_text_bytes).id(), chunk_marks, Packing::none);
    growing(marks.id(), "kind", byte_text_type(mark_kind_bytes).id(), chunk_marks, Packing::none);
    growing(marks.id(), "clock_utc", byte_text_type(mark_clock_bytes).id(), chunk_marks, Packing::none);
    const Handle clock = group(file.id(), "clock");
    growing(clock.id(), "period", H5T_STD_I64LE, chunk_marks, Packing::none);
    growing(clock.id(), "utc_us", H5T_STD_I64LE, chunk_marks, Packing::none);
    const std::int32_t no = 0;
    scalar(file.id(), "complete", H5T_NATIVE_INT32, &no);
    const hsize_t none = 0;
    scalar(file.id(), "samples", H5T_NATIVE_HSIZE, &none);
  }
  template <class Row>
  void lay_out_column(const Handle& parent, const Row& row) {
    const Handle column =
        growing(parent.id(), std::string(row.name), H5T_IEEE_F32LE, chunk_samples_, Packing::compressed);
    write_attribute(column.id(), "unit", std::string(row.unit));
    write_attribute(column.id(), "help", std::string(row.help));
  }
  void lay_out_overview(const Handle& file, const Information& about) {
    const Handle overview = group(file.id(), "overview");
    const auto add = [&](const Handle& parent, const auto& row) {
      growing(parent.id(), std::string(row.name), H5T_IEEE_F32LE, overview_block_values * chunk_overview_blocks,
              Packing::compressed);
    };
    const Handle signals = group(overview.id(), "signals");
    for (const auto signal : about.signals) add(signals, protocol::info(signal));
    const Handle simulated = group(overview.id(), "simulated");
    for (const auto quantity : about.simulated) add(simulated, protocol::info(quantity));
    const hsize_t none = 0;
    scalar(overview.id(), "blocks", H5T_NATIVE_HSIZE, &none);
  }
  void open_for_writing(const Information& about) {
    file_ = Handle(H5Fopen(file_name_.c_str(), H5F_ACC_RDWR, access().id()), H5Fclose);
    if (!file_) fail();
    // This flag prevents a child process from keeping the disk space of a deleted file in use.
    ::fcntl(descriptor(), F_SETFD, FD_CLOEXEC);
    const auto open = [&](const std::string& path) {
      Handle dataset(H5Dopen2(file_.id(), path.c_str(), H5P_DEFAULT), H5Dclose);
      if (!dataset) fail();
      return dataset;
    };
    period_ = open("/period");
    time_ = open("/time_s");
    const auto open_column = [&](const std::string& path) {
      columns_.push_back(open(path));
      if (has_overview_) overviews_.push_back(open("/overview" + path));
    };
    for (const auto signal : about.signals) open_column(fmt::format("/signals/{}", protocol::info(signal).name));
    for (const auto quantity : about.simulated)
      open_column(fmt::format("/simulated/{}", protocol::info(quantity).name));
    if (has_overview_) overview_blocks_ = open("/overview/blocks");
    mark_period_ = open("/marks/period");
    mark_text_ = open("/marks/text");
    mark_kind_ = open("/marks/kind");
    mark_clock_ = open("/marks/clock_utc");
    clock_period_ = open("/clock/period");
    clock_utc_us_ = open("/clock/utc_us");
    complete_ = open("/complete");
    samples_ = open("/samples");
  }
  void write_samples(std::size_t count) {
    const QuietHdf5 quiet;
    if (count == 0) return;
    if (has_overview_) add_to_overview(count);
    const auto put = [&](const Handle& column, hid_t type, auto& waiting) {
      extend(column, size_, count, type, waiting.data());
      waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(count));
    };
    put(period_, H5T_NATIVE_INT64, periods_);
    put(time_, H5T_NATIVE_DOUBLE, times_s_);
    for (std::size_t j = 0; j < values_.size(); ++j) put(columns_[j], H5T_NATIVE_FLOAT, values_[j]);
    size_ += count;
    if (waiting_blocks() >= chunk_overview_blocks) write_overview(chunk_overview_blocks);
  }
  hsize_t waiting_blocks() const { return waiting_overviews_.empty() ? 0 : waiting_overviews_.front().size(); }
  /// A full chunk of samples has whole blocks. The rest at the end of the recording has no overview.
  void add_to_overview(std::size_t count) {
    for (std::size_t j = 0; j < values_.size(); ++j)
      for (std::size_t begin = 0; begin + overview_block_samples <= count; begin += overview_block_samples)
        waiting_overviews_[j].push_back(overview_of(std::span(values_[j]).subspan(begin, overview_block_samples)));
  }
  /// Writes whole chunks, because a compressed chunk must not change. Until then, the blocks have no overview on disk.
  void write_overview(hsize_t blocks) {
    if (blocks == 0) return;
    for (std::size_t j = 0; j < overviews_.size(); ++j) {
      auto& waiting = waiting_overviews_[j];
      extend(overviews_[j], overview_block_values * blocks_, overview_block_values * blocks, H5T_NATIVE_FLOAT,
             waiting.data());
      waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(blocks));
    }
    blocks_ += blocks;
  }
  int descriptor() const {
    void* handle = nullptr;
    return H5Fget_vfd_handle(file_.id(), H5P_DEFAULT, &handle) < 0 ? -1 : *static_cast<int*>(handle);
  }
  /// Reserves disk space for all data of a flush. A flush that failed halfway would leave an unreadable file.
  void find_room() {
    haddr_t end = 0;
    if (H5Fget_eoa(file_.id(), &end) < 0 || ::posix_fallocate(descriptor(), 0, static_cast<off_t>(end)) != 0) fail();
  }
  /// Closing would write data that the last flush() has not written, possibly to a full disk. This function redirects
  /// the file to /dev/null.
  void let_go() {
    const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere < 0) return;
    ::dup2(nowhere, descriptor());
    ::close(nowhere);
  }
  /// Writes a text, truncated to its length in the file.
  void write_mark_text(const Handle& column, std::string_view text, std::size_t bytes) {
    std::string padded(text.substr(0, bytes));
    padded.resize(bytes);
    extend(column, mark_count_, 1, byte_text_type(bytes).id(), padded.data());
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
    own_.forget();
    columns_.clear();
    overviews_.clear();
    for (Handle* handle : {&period_, &time_, &mark_period_, &mark_text_, &mark_kind_, &mark_clock_, &clock_period_,
                           &clock_utc_us_, &complete_, &samples_, &overview_blocks_, &file_})
      *handle = Handle();
  }
  [[noreturn]] void fail() const {
    std::error_code error;
    const auto space = std::filesystem::space(std::filesystem::absolute(file_name_).parent_path(), error);
    // File systems that are not disks, such as /proc, report no capacity and are not full.
    const bool full = !error && space.capacity > 0 && space.available < 1'000'000;
    throw device::Error(
        fmt::format("{} cannot be written: {}.", name_,
                    full ? "the disk is full. Free some space or choose another location"
                         : "the system refused access. Check that the folder exists and that you may write to it"));
  }

  std::string name_, file_name_;
  std::size_t width_;  ///< number of signals
  bool has_overview_;
  hsize_t chunk_samples_;
  Handle file_, period_, time_, mark_period_, mark_text_, mark_kind_, mark_clock_, clock_period_, clock_utc_us_,
      complete_, samples_, overview_blocks_;
  process::OwnDescriptor own_;         ///< descriptor of the file
  std::vector<Handle> columns_;        ///< signals, then simulated quantities
  std::vector<std::int64_t> periods_;  ///< samples that are not in the file yet, with the columns below
  std::vector<double> times_s_;
  std::vector<std::vector<float>> values_;
  std::vector<Handle> overviews_;                              ///< one for each column
  std::vector<std::vector<OverviewBlock>> waiting_overviews_;  ///< blocks that are not in the file yet
  hsize_t blocks_ = 0;                                         ///< number of blocks in the file
  hsize_t size_ = 0;                                           ///< number of samples in the file
  hsize_t mark_count_ = 0, clock_count_ = 0;
};

}  // namespace

std::unique_ptr<Writer> create_hdf5(const std::filesystem::path& file, const Information& information,
                                    const std::string& name) {
  return std::make_unique<Hdf5Writer>(file, information, name);
}

}  // namespace inkwell::recording
