#include "host/client/recording/formats.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <istream>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host/client/local/text_file.hpp"

namespace inkwell::recording {
namespace {

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Returns std::nullopt if the text is not a whole number or if the number is out of range.
template <class Whole>
std::optional<Whole> whole_number(std::string_view text) {
  Whole value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Returns std::nullopt for times that no board can reach.
std::optional<std::int64_t> period_at(double time_s) {
  constexpr double convertible = 1e18;
  const double periods = time_s * protocol::servo_rate_Hz;
  if (!(periods >= 0.0 && periods < convertible)) return std::nullopt;
  const std::int64_t period = std::llround(periods);
  return can_be_period(period) ? std::optional(period) : std::nullopt;
}

/// Complete lines of a stream. Long files need only a small buffer.
class Lines {
 public:
  explicit Lines(std::istream& stream) : stream_(stream), buffer_(buffer_bytes, '\0') {}

  void go_to(std::uint64_t offset) {
    stream_.clear();  // clears the end-of-file state
    stream_.seekg(static_cast<std::streamoff>(offset));
    offset_ = offset;
    begin_ = end_ = 0;
  }
  /// Returns the next line without its end. The line is valid until the next call. Returns std::nullopt after the last
  /// complete line: if the recording program was killed, the last line may be incomplete.
  std::optional<std::string_view> next() {
    for (std::size_t searched = 0;;) {
      const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
      if (const auto length = rest.find('\n', searched); length != rest.npos) {
        begin_ += length + 1;
        offset_ += length + 1;
        return local::without_carriage_return(rest.substr(0, length));
      }
      searched = rest.size();
      if (!read_more()) return std::nullopt;
    }
  }
  /// Position of the next line in the stream.
  std::uint64_t offset() const { return offset_; }
  bool is_too_long() const { return is_too_long_; }

 private:
  static constexpr std::size_t buffer_bytes = 1 << 18, line_bytes_maximum = 1 << 24;

  bool read_more() {
    buffer_.erase(0, begin_);
    end_ -= begin_;
    begin_ = 0;
    is_too_long_ = end_ > line_bytes_maximum;
    if (is_too_long_) return false;
    buffer_.resize(std::max(buffer_bytes, 2 * end_));
    stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(buffer_.size() - end_));
    const auto count = static_cast<std::size_t>(stream_.gcount());
    end_ += count;
    return count > 0;
  }

  std::istream& stream_;
  std::string buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< bytes of the buffer that are not returned yet
  std::uint64_t offset_ = 0;
  bool is_too_long_ = false;
};

class CsvReader final : public ColumnReader {
 public:
  CsvReader(std::unique_ptr<std::istream> stream, std::string name)
      : name_(std::move(name)), stream_(std::move(stream)), lines_(*stream_) {
    recording_.complete = false;
  }

  /// Reads everything except the samples, and the position of each block of samples.
  Recording read_head() {
    for (std::uint64_t offset = 0; const auto next = lines_.next(); offset = lines_.offset()) {
      ++line_number_;
      const std::string_view line = line_number_ == 1 ? local::without_byte_order_mark(*next) : *next;
      if (line.empty()) continue;
      if (line.starts_with("# "))
        comment(line.substr(2));
      else if (!columns_known_)
        column_names(line);
      else
        index_sample(line, offset);
    }
    if (lines_.is_too_long()) fail(fmt::format("is damaged in line {}: the line is too long", line_number_ + 1));
    if (!is_recording_) fail(fmt::format("does not start with \"# {}\", so it is not a recording", format_name));
    if (!columns_known_) fail("has no line of column names");
    return std::move(recording_);
  }
  const Stretches& stretches() const { return stretches_; }

  void read(std::size_t column, std::size_t begin, std::span<float> values) override {
    for (std::size_t done = 0; done < values.size();) {
      const std::size_t block = (begin + done) / block_samples, first = (begin + done) % block_samples;
      if (block != read_block_) read_block(block);
      const auto& samples = block_columns_[column];
      const std::size_t count = std::min(samples.size() - first, values.size() - done);
      std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(first), count, values.subspan(done).begin());
      done += count;
    }
  }

 private:
  enum class Holds : std::uint8_t { signal, simulated, unknown };

  void comment(std::string_view text) {
    const auto equals = text.find(" = ");
    const auto key = text.substr(0, equals);
    const auto value = equals == text.npos ? std::string_view{} : text.substr(equals + 3);
    auto& about = recording_.information;
    if (key == format_name) {
      is_recording_ = true;
      if (number(value).value_or(0) > format_version)
        recording_.remarks.push_back(fmt::format("{} was written by a newer version of this program.", name_));
    } else if (std::string* const known = text_of(key))
      *known = value;
    else if (key == "protocol_version")
      about.protocol_version = whole_number<std::uint16_t>(value).value_or(0);
    else if (key == "simulation")
      about.simulation = value == "1";
    else if (key == "step_periods")
      about.step_periods = step_periods_of(number(value).value_or(1));
    else if (key == "force_law")
      take_force_law(recording_, value, name_);
    else if (key == "complete")
      recording_.complete = value == "1";
    else if (key.starts_with("mark "))
      mark(key.substr(5), value);
    else if (key.starts_with("clock "))
      clock(key.substr(6), value);
    else if (key.starts_with("parameter "))
      parameter(key.substr(10), value);
  }
  /// Returns the text with this name; null if there is none.
  std::string* text_of(std::string_view key) {
    auto& about = recording_.information;
    const std::pair<std::string_view, std::string*> texts[] = {{"name", &about.name},
                                                               {"note", &about.note},
                                                               {"created_utc", &about.created_utc},
                                                               {"library_version", &about.library_version},
                                                               {"library_sha256", &about.library_sha256},
                                                               {"image_sha256", &about.image_sha256},
                                                               {"arm_sha256", &about.arm_sha256},
                                                               {"image_check", &about.image_check},
                                                               {"firmware_version", &about.firmware_version},
                                                               {"serial_number", &about.serial_number},
                                                               {"arm", &about.arm}};
    const auto found = std::ranges::find(texts, key, &std::pair<std::string_view, std::string*>::first);
    return found == std::end(texts) ? nullptr : found->second;
  }
  void clock(std::string_view period_text, std::string_view time_text) {
    const auto period = whole_number<std::int64_t>(period_text), time_us = whole_number<std::int64_t>(time_text);
    if (period && time_us && can_be_period(*period)) recording_.clock.push_back({*period, *time_us});
  }
  /// `about`: "PERIOD" or "PERIOD KIND CLOCK".
  void mark(std::string_view about, std::string_view text) {
    const auto next = [&about] {
      const auto word = about.substr(0, about.find(' '));
      about.remove_prefix(std::min(about.size(), word.size() + 1));
      return word;
    };
    const auto period = whole_number<std::int64_t>(next());
    const auto kind = device::find_event_kind(next()).value_or(device::EventKind::mark);
    if (period && can_be_period(*period))
      recording_.marks.push_back({*period, std::string(text), kind, std::string(next())});
    else
      recording_.remarks.push_back(fmt::format("The mark \"{}\" of {} has no period and was ignored.", text, name_));
  }
  void parameter(std::string_view name, std::string_view text) {
    const auto known = protocol::find_parameter(name);
    const auto value = number(text);
    if (known && value)
      recording_.information.parameters[*known] = static_cast<float>(*value);
    else
      recording_.remarks.push_back(
          fmt::format("The parameter {} of {} is unknown to this version and was ignored.", name, name_));
  }
  void column_names(std::string_view line) {
    columns_known_ = true;
    if (!line.starts_with("time_s")) fail("does not have time_s as its first column");
    for (line.remove_prefix(6); !line.empty();) {
      line.remove_prefix(1);
      const auto name = line.substr(0, line.find(','));
      auto& about = recording_.information;
      if (const auto signal = protocol::find_signal(name)) {
        about.signals.push_back(*signal);
        holds_.push_back(Holds::signal);
      } else if (const auto simulated = protocol::find_simulated_quantity(name)) {
        about.simulated.push_back(*simulated);
        holds_.push_back(Holds::simulated);
      } else {
        recording_.remarks.push_back(
            fmt::format("The signal {} of {} is unknown to this version and was ignored.", name, name_));
        holds_.push_back(Holds::unknown);
      }
      line.remove_prefix(name.size());
    }
    width_ = recording_.information.signals.size() + recording_.information.simulated.size();
    signals_ = recording_.information.signals.size();
  }
  /// Returns the next number of a line.
  double next_cell(std::string_view& line) const {
    const auto cell = line.substr(0, line.find(','));
    const auto value = number(cell);
    if (!value) fail(fmt::format("is damaged in line {}: \"{}\" is not a number", line_number_, cell));
    line.remove_prefix(std::min(line.size(), cell.size() + 1));
    return *value;
  }
  /// Reads only the time, because reading all values takes long.
  void index_sample(std::string_view line, std::uint64_t offset) {
    const double time_s = next_cell(line);
    const auto period = period_at(time_s);
    if (!period) fail(fmt::format("is damaged in line {}: {} s is not a valid board time", line_number_, time_s));
    if (stretches_.size() % block_samples == 0) blocks_.push_back({offset, line_number_});
    stretches_.append(stretches_.size() == 0 ? *period : period_after(stretches_.last_period(), *period), 1);
  }
  void read_block(std::size_t block) {
    read_block_ = no_block;  // remains if the block is damaged
    block_columns_.assign(width_, {});
    if (lines_.offset() != blocks_[block].offset) lines_.go_to(blocks_[block].offset);
    line_number_ = blocks_[block].line_number - 1;
    const std::size_t count = std::min(block_samples, stretches_.size() - block * block_samples);
    for (std::size_t i = 0; i < count;) {
      ++line_number_;
      const auto line = lines_.next();
      if (!line) fail("has changed since it was opened");
      if (line->empty() || line->starts_with("# ")) continue;
      read_sample(*line);
      ++i;
    }
    read_block_ = block;
  }
  void read_sample(std::string_view line) {
    next_cell(line);
    std::size_t signal = 0, simulated = signals_;
    for (const Holds holds : holds_) {
      const auto value = static_cast<float>(next_cell(line));
      if (holds == Holds::signal) block_columns_[signal++].push_back(value);
      if (holds == Holds::simulated) block_columns_[simulated++].push_back(value);
    }
    if (!line.empty()) fail(fmt::format("is damaged in line {}: it has more values than columns", line_number_));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw device::Error(fmt::format("{} {}. Nothing was loaded.", name_, what));
  }

  static constexpr std::size_t block_samples = 4096, no_block = SIZE_MAX;
  struct Block {
    std::uint64_t offset;     ///< of its first sample in the file
    std::size_t line_number;  ///< of its first sample
  };

  std::string name_;
  std::unique_ptr<std::istream> stream_;
  Lines lines_;
  Recording recording_;
  Stretches stretches_;
  std::vector<Holds> holds_;  ///< for each column after the time
  std::size_t width_ = 0, signals_ = 0;
  std::vector<Block> blocks_;
  std::vector<std::vector<float>> block_columns_;  ///< values of the last read block
  std::size_t read_block_ = no_block;
  std::size_t line_number_ = 0;
  bool is_recording_ = false;
  bool columns_known_ = false;
};

}  // namespace

StoredRecording open_csv(std::unique_ptr<std::istream> stream, const std::string& name) {
  const auto reader = std::make_shared<CsvReader>(std::move(stream), name);
  Recording head = reader->read_head();
  return {std::move(head), reader->stretches(), reader};
}

}  // namespace inkwell::recording
