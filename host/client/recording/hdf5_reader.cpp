#include "host/client/recording/formats.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "host/client/recording/hdf5_input.hpp"

namespace inkwell::recording {
namespace {

class Hdf5Reader final : public ColumnReader {
 public:
  explicit Hdf5Reader(Hdf5Input input) : input_(std::move(input)) {
    if (input_->text_attribute("format") != format_name) input_->fail("is an HDF5 file, but not a recording");
  }

  ~Hdf5Reader() override {
    const QuietHdf5 quiet;
    columns_.clear();
    overviews_.clear();
    input_.reset();
  }

  /// Reads everything except the samples.
  Recording read_head() {
    read_information();
    const auto samples = static_cast<std::uint64_t>(std::max<std::int64_t>(0, input_->whole_number("/samples")));
    std::uint64_t whole = std::min(samples, input_->length_of("/period"));
    for (const auto& path : paths_) whole = std::min(whole, input_->length_of(path));
    read_stretches(whole);
    read_overview_length();
    columns_.resize(paths_.size());
    overviews_.resize(paths_.size());
    const bool is_complete = input_->whole_number("/complete") == 1;
    try {
      read_marks();
      read_clock();
    } catch (const device::Error&) {
      if (is_complete) throw;
      recording_.marks.clear();
      recording_.clock.clear();
      recording_.remarks.push_back(fmt::format(
          "The marks of {} are ignored: the recording program stopped while it wrote a mark, or is writing a mark now.",
          input_->name()));
    }
    recording_.complete = is_complete && whole == samples;
    return std::move(recording_);
  }
  const Stretches& stretches() const { return stretches_; }

  void read(std::size_t column, std::size_t begin, std::span<float> values) override {
    const QuietHdf5 quiet;
    if (!columns_[column]) columns_[column] = input_->real_number_column(paths_[column], stretches_.size());
    input_->read(*columns_[column], begin, values);
  }
  std::size_t overview_blocks() const override { return overview_blocks_; }
  void read_overview(std::size_t column, std::size_t begin, std::span<OverviewBlock> blocks) override {
    const QuietHdf5 quiet;
    auto& overview = overviews_[column];
    if (!overview)
      overview = input_->real_number_column(overview_path(column), overview_block_values * overview_blocks_);
    std::vector<float> values(overview_block_values * blocks.size());
    input_->read(*overview, overview_block_values * begin, values);
    for (std::size_t i = 0; i < blocks.size(); ++i)
      blocks[i] = {values[overview_block_values * i], values[overview_block_values * i + 1],
                   values[overview_block_values * i + 2]};
  }

 private:
  std::string overview_path(std::size_t column) const { return "/overview" + paths_[column]; }
  /// Files of earlier versions have no overview.
  void read_overview_length() {
    if (!input_->has("/overview") || !input_->has("/overview/blocks")) return;
    auto blocks = static_cast<std::uint64_t>(std::max<std::int64_t>(0, input_->whole_number("/overview/blocks")));
    blocks = std::min<std::uint64_t>(blocks, stretches_.size() / overview_block_samples);
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      if (!input_->has(overview_path(i))) return;
      blocks = std::min(blocks, input_->length_of(overview_path(i)) / overview_block_values);
    }
    overview_blocks_ = static_cast<std::size_t>(blocks);
  }
  void read_information() {
    auto& about = recording_.information;
    if (input_->number_attribute("format_version") > format_version)
      recording_.remarks.push_back(fmt::format("{} was written by a newer version of this program.", input_->name()));
    about.name = text("name");
    about.note = text("note");
    about.created_utc = text("created_utc");
    about.library_version = text("library_version");
    about.library_sha256 = text("library_sha256");
    about.image_sha256 = text("image_sha256");
    about.arm_sha256 = text("arm_sha256");
    about.image_check = text("image_check");
    about.firmware_version = text("firmware_version");
    about.protocol_version = static_cast<std::uint16_t>(input_->number_attribute("protocol_version"));
    about.serial_number = text("serial_number");
    about.arm = text("arm");
    about.simulation = input_->number_attribute("simulation") != 0;
    about.step_periods = step_periods_of(static_cast<double>(input_->number_attribute("step_periods")));
    take_force_law(recording_, text("force_law"), input_->name());
    for (const auto& name : input_->names_in("/parameters")) {
      const auto parameter = protocol::find_parameter(name);
      if (!parameter) {
        recording_.remarks.push_back(
            fmt::format("The parameter {} of {} is unknown to this version and was ignored.", name, input_->name()));
        continue;
      }
      about.parameters[*parameter] = input_->real_number("/parameters/" + name);
    }
    about.signals = read_columns("/signals", protocol::find_signal);
    // Files of earlier versions have no group "/simulated".
    if (input_->has("/simulated")) about.simulated = read_columns("/simulated", protocol::find_simulated_quantity);
  }
  std::string text(const char* name) {
    auto found = input_->text_attribute(name);
    if (!found)
      recording_.remarks.push_back(
          fmt::format("The {} of {} is a text of variable length and was ignored.", name, input_->name()));
    return std::move(found).value_or("");
  }
  /// Quantities in the columns of a group, derived from the column names.
  template <class Value>
  std::vector<Value> read_columns(const char* group_name, std::optional<Value> (*find)(std::string_view)) {
    std::vector<Value> found;
    for (const auto& name : input_->names_in(group_name)) {
      if (const auto value = find(name))
        found.push_back(*value);
      else
        recording_.remarks.push_back(
            fmt::format("The signal {} of {} is unknown to this version and was ignored.", name, input_->name()));
    }
    // HDF5 returns names in alphabetical order. The order of the table groups related columns.
    std::sort(found.begin(), found.end());
    if (std::adjacent_find(found.begin(), found.end()) != found.end())
      input_->fail(fmt::format("is damaged: {} contains a name twice", group_name));
    for (const auto value : found) paths_.push_back(fmt::format("{}/{}", group_name, info(value).name));
    return found;
  }
  void read_marks() {
    const std::uint64_t count = std::min(input_->length_of("/marks/period"), input_->length_of("/marks/text"));
    if (count == 0) return;
    const auto mark_periods = periods("/marks/period", count);
    const auto texts = input_->texts("/marks/text", count);
    // Files of earlier versions have neither kinds nor clock times.
    const bool has_kinds = input_->has("/marks/kind");
    const auto kinds = has_kinds ? input_->texts("/marks/kind", count) : std::vector<std::string>(count);
    const auto clocks = has_kinds ? input_->texts("/marks/clock_utc", count) : std::vector<std::string>(count);
    for (std::size_t i = 0; i < count; ++i)
      recording_.marks.push_back(
          {mark_periods[i], texts[i], device::find_event_kind(kinds[i]).value_or(device::EventKind::mark), clocks[i]});
  }
  void read_clock() {
    if (!input_->has("/clock")) return;
    const std::uint64_t count = std::min(input_->length_of("/clock/period"), input_->length_of("/clock/utc_us"));
    const auto clock_periods = periods("/clock/period", count);
    const auto times_us = input_->whole_numbers("/clock/utc_us", count);
    for (std::size_t i = 0; i < count; ++i) recording_.clock.push_back({clock_periods[i], times_us[i]});
  }
  /// Most recordings have no gap, so the first and the last period of a long range show that the range has none.
  void read_stretches(std::uint64_t whole) {
    constexpr std::uint64_t range_samples = 1 << 22;
    const auto column = input_->whole_number_column("/period", whole);
    for (std::uint64_t begin = 0; begin < whole; begin += range_samples)
      read_stretches(column, begin, std::min(whole, begin + range_samples));
  }
  void read_stretches(const Hdf5Input::Dataset& column, std::uint64_t begin, std::uint64_t end) {
    constexpr std::uint64_t block_samples = 4096;  // as in a chunk of the file
    if (end - begin > block_samples) {
      const std::int64_t first = next_periods(column, begin, 1).front(),
                         last = period_after(first, next_periods(column, end - 1, 1).front());
      if (last - first == static_cast<std::int64_t>(end - begin) - 1) return append(first, end - begin);
      const std::uint64_t blocks = (end - begin + block_samples - 1) / block_samples;
      const std::uint64_t middle = begin + blocks / 2 * block_samples;
      read_stretches(column, begin, middle);
      return read_stretches(column, middle, end);
    }
    for (const std::int64_t period : next_periods(column, begin, end - begin)) append(period, 1);
  }
  std::vector<std::int64_t> next_periods(const Hdf5Input::Dataset& column, std::uint64_t begin, std::uint64_t count) {
    std::vector<std::int64_t> periods(count);
    input_->read(column, begin, periods);
    check_are_periods(periods, "/period");
    return periods;
  }
  void append(std::int64_t first, std::uint64_t count) {
    if (stretches_.size() > 0) first = period_after(stretches_.last_period(), first);
    stretches_.append(first, static_cast<std::size_t>(count));
  }
  void check_are_periods(const std::vector<std::int64_t>& periods, std::string_view path) const {
    if (!std::ranges::all_of(periods, can_be_period))
      input_->fail(fmt::format("is damaged: {} contains impossible times", path));
  }
  std::vector<std::int64_t> periods(const std::string& path, std::uint64_t count) {
    auto periods = input_->whole_numbers(path, count);
    check_are_periods(periods, path);
    return periods;
  }

  std::optional<Hdf5Input> input_;
  Recording recording_;
  Stretches stretches_;
  std::vector<std::string> paths_;                                      ///< of the columns
  std::vector<std::optional<Hdf5Input::Dataset>> columns_, overviews_;  ///< opened at the first use
  std::size_t overview_blocks_ = 0;
};

/// A recorder may still write the file.
bool may_be_extended(const std::filesystem::path& file) {
  const Hdf5Input input(file);
  return input.has("/complete") && input.whole_number("/complete") != 1;
}

StoredRecording opened(const std::shared_ptr<Hdf5Reader>& reader) {
  Recording head = reader->read_head();
  return {std::move(head), reader->stretches(), reader};
}

}  // namespace

StoredRecording open_hdf5(const std::filesystem::path& file) {
  const QuietHdf5 quiet;
  const auto index = may_be_extended(file) ? Hdf5Input::Index::stays : Hdf5Input::Index::may_be_dropped;
  return opened(std::make_shared<Hdf5Reader>(Hdf5Input(file, index)));
}

StoredRecording open_hdf5(std::span<const std::byte> content, const std::string& name) {
  const QuietHdf5 quiet;
  return opened(std::make_shared<Hdf5Reader>(Hdf5Input(content, name)));
}

}  // namespace inkwell::recording
